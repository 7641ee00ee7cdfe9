"""The logarithm, and the logarithm of one more than its argument."""

from __future__ import annotations

import math

import numpy as np

from stickslip.foundation.arrays import Floats
from stickslip.foundation.kernels.kernels import exact
from stickslip.friction.formula.expression import Expression
from stickslip.friction.formula.operations.enclosures import LIBRARY, ONE_STEP, Ends, chain, of_positive, outward, rounded, square
from stickslip.friction.formula.operations.operation import Levels, Operation, Radius, Recurrence, SeriesWriter
from stickslip.friction.formula.operations.sets import HIGH, LOW, OF_FUNCTION, REFERENCE, SLOPE, STEP, VALUE, Disc


def log_difference(reference: float, now: float, step: float) -> float:
    """Return log(now) - log(reference)."""
    if abs(step) < 0.5 * abs(reference):
        return math.log1p(step / reference)
    return math.log(now / reference)


@exact
def _log_change(w: Floats, n: int, i: int, j: int) -> None:
    w[n, REFERENCE], w[n, VALUE] = math.log(w[i, REFERENCE]), math.log(w[i, VALUE])
    w[n, STEP], w[n, SLOPE] = math.log1p(w[i, STEP] / w[i, REFERENCE]), w[i, SLOPE] / w[i, VALUE]


@exact
def _log1p_change(w: Floats, n: int, i: int, j: int) -> None:
    w[n, REFERENCE], w[n, VALUE] = math.log1p(w[i, REFERENCE]), math.log1p(w[i, VALUE])
    w[n, STEP], w[n, SLOPE] = math.log1p(w[i, STEP] / (1.0 + w[i, REFERENCE])), w[i, SLOPE] / (1.0 + w[i, VALUE])


@exact
def _log_bounds(w: Floats, n: int, i: int, j: int) -> None:
    w[n, LOW], w[n, HIGH] = -math.inf, math.inf
    if w[i, HIGH] >= 0.0:
        w[n, LOW], w[n, HIGH] = math.log(max(w[i, LOW], 0.0)), math.log(w[i, HIGH])


@exact
def _log1p_bounds(w: Floats, n: int, i: int, j: int) -> None:
    w[n, LOW], w[n, HIGH] = -math.inf, math.inf
    if w[i, HIGH] >= -1.0:
        w[n, LOW], w[n, HIGH] = math.log1p(max(w[i, LOW], -1.0)), math.log1p(w[i, HIGH])


@exact
def _log_series(w: Floats, n: int, i: int, j: int) -> None:
    low, high = -math.inf, math.inf
    if w[i, 3] >= 0.0:
        low, high = outward(math.log(max(w[i, 0], 0.0)), math.log(w[i, 3]), LIBRARY)
    _by_inverse(w, n, i, (low, high), (w[i, 0], w[i, 3]))


@exact
def _log1p_series(w: Floats, n: int, i: int, j: int) -> None:
    low, high = -math.inf, math.inf
    if w[i, 3] >= -1.0:
        low, high = outward(math.log1p(max(w[i, 0], -1.0)), math.log1p(w[i, 3]), LIBRARY)
    _by_inverse(w, n, i, (low, high), rounded(1.0 + w[i, 0], 1.0 + w[i, 3], ONE_STEP))


@exact
def _by_inverse(w: Floats, n: int, i: int, value: Ends, argument: Ends) -> None:
    """Write the coefficients of a logarithm from its bounds and those of its argument."""
    c, d = of_positive(argument[0], argument[1])
    less, more = square(c, d)
    chain(w, n, i, value, ((c, d), (-0.5 * more, -0.5 * less)))


def _coefficient(writer: SeriesWriter, node: Expression, k: int) -> str:
    a = node.arguments[0]
    return f"({writer.coefficient(a, k) or '0.0'} - (0.0{writer.weighted(node, a, k)})) * i{writer.index[node]}"


def _log_order_zero(writer: Levels, node: Expression) -> dict[str, str]:
    a = node.arguments[0]
    return writer.level(node, f"log_difference({writer.reference(a)}, {writer.coefficient(a, 0)}, {writer.difference(a)})")


LOG = Operation(
    name="log",
    value=np.log,
    change=_log_change,
    slope_formula=lambda node, da: da / node.arguments[0],
    bounds=_log_bounds,
    taylor=_log_series,
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
    change=_log1p_change,
    slope_formula=lambda node, da: da / (1.0 + node.arguments[0]),
    bounds=_log1p_bounds,
    taylor=_log1p_series,
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
