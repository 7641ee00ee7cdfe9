"""The logarithm, and the logarithm of one more than its argument."""

from __future__ import annotations

import math

import numpy as np

from stickslip.foundation.arrays import Floats
from stickslip.friction.formula.expression import Expression
from stickslip.friction.formula.operations.enclosures import ONE_STEP, function, of_positive, outward, square
from stickslip.friction.formula.operations.operation import Levels, Operation, Radius, Recurrence, SeriesWriter
from stickslip.friction.formula.operations.sets import OF_FUNCTION, Disc, growing


def log_difference(reference: float, now: float, step: float) -> float:
    """Return log(now) - log(reference)."""
    if abs(step) < 0.5 * abs(reference):
        return math.log1p(step / reference)
    return math.log(now / reference)


def _slopes(a: Floats) -> tuple[Floats, Floats]:
    """Return bounds of f' and f''/2 of a logarithm."""
    inverse = of_positive(a)
    return inverse, -0.5 * square(inverse)[::-1]


def _coefficient(writer: SeriesWriter, node: Expression, k: int) -> str:
    a = node.arguments[0]
    return f"({writer.coefficient(a, k) or '0.0'} - (0.0{writer.weighted(node, a, k)})) * i{writer.index[node]}"


def _log_order_zero(writer: Levels, node: Expression) -> dict[str, str]:
    a = node.arguments[0]
    return writer.level(node, f"log_difference({writer.reference(a)}, {writer.coefficient(a, 0)}, {writer.difference(a)})")


LOG = Operation(
    name="log",
    value=np.log,
    step=lambda start, end, a: np.log1p(a.step / a.reference),
    slope=lambda end, a: a.slope / a.value,
    slope_formula=lambda node, da: da / node.arguments[0],
    bounds=growing(np.log, least=0.0),
    taylor=function(growing(np.log, least=0.0), lambda value, a: _slopes(a)),
    disc=lambda a: Disc(np.log(a.centre), a.turned, 0.0).rounded(OF_FUNCTION),
    order_zero=_log_order_zero,
    derivative=lambda writer, node, da: f"{da} / {writer.coefficient(node.arguments[0], 0)}",
    recurrence=Recurrence(
        _coefficient, divisor=lambda writer, node: f"{writer.coefficient(node.arguments[0], 0)}", weights_of_result=True
    ),
    ball=Radius(lambda balls, node: balls.logarithm(node.arguments[0])),
    called=(log_difference,),
)


def _log1p_order_zero(writer: Levels, node: Expression) -> dict[str, str]:
    a = node.arguments[0]
    now = writer.coefficient(a, 0)
    return writer.level(node, f"log_difference(1.0 + {writer.reference(a)}, 1.0 + {now}, {writer.difference(a)})", f"log1p({now})")


LOG1P = Operation(
    name="log1p",
    value=np.log1p,
    step=lambda start, end, a: np.log1p(a.step / (1.0 + a.reference)),
    slope=lambda end, a: a.slope / (1.0 + a.value),
    slope_formula=lambda node, da: da / (1.0 + node.arguments[0]),
    bounds=growing(np.log1p, least=-1.0),
    taylor=function(growing(np.log1p, least=-1.0), lambda value, a: _slopes(outward(1.0 + a, ONE_STEP, 0.0))),
    disc=lambda a: Disc(np.log1p(a.centre), Disc(1.0 + a.centre, a.radius, 0.0).turned, 0.0).rounded(OF_FUNCTION),
    order_zero=_log1p_order_zero,
    derivative=lambda writer, node, da: f"{da} / (1.0 + {writer.coefficient(node.arguments[0], 0)})",
    recurrence=Recurrence(
        _coefficient, divisor=lambda writer, node: f"1.0 + {writer.coefficient(node.arguments[0], 0)}", weights_of_result=True
    ),
    ball=Radius(lambda balls, node: f"log_radius(abs(1.0 + {balls.centre(node.arguments[0])}), {balls.radius(node.arguments[0])})"),
    zeros=(0,),
    called=(log_difference,),
)
