"""The exponential, and the exponential less one."""

from __future__ import annotations

import math

import numpy as np

from stickslip.foundation.arrays import Floats
from stickslip.foundation.kernels.kernels import exact
from stickslip.friction.formula.expression import Expression
from stickslip.friction.formula.operations.enclosures import LIBRARY, chain, outward
from stickslip.friction.formula.operations.operation import (
    LARGEST_EXPONENT,
    TINIEST,
    BallsWriter,
    Levels,
    Operation,
    Radius,
    Recurrence,
    Scaled,
    SeriesWriter,
)
from stickslip.friction.formula.operations.sets import HIGH, LOW, OF_FUNCTION, REFERENCE, SLOPE, STEP, VALUE, Disc

STAYS_LARGE = LARGEST_EXPONENT - 10.0
"""A harmless overflow counts as constant as long as its exponent stays above this. It begins to count at a larger exponent, so that
a step may end in between."""
KNOWN = 700.0
"""For exponents above this (1), exp on a disc is only known to be larger than e^700, which is enough below a fraction bar."""


def exp_of(node: Expression) -> Expression:
    """Return the node exp(a) for a node exp(a) - 1: the two have the same derivatives."""
    return Expression("exp", node.arguments)


def below(limit: float, argument: str) -> str:
    """Write 1.0 where an argument is below a limit, else 0.0."""
    return f"min(max(1e300 * ({limit!r} - {argument}), 0.0), 1.0)"


@exact
def _exp_change(w: Floats, n: int, i: int, j: int) -> None:
    start, end, step = math.exp(w[i, REFERENCE]), math.exp(w[i, VALUE]), w[i, STEP]
    w[n, REFERENCE], w[n, VALUE], w[n, SLOPE] = start, end, end * w[i, SLOPE]
    # for larger steps a subtraction loses nothing, and expm1 may overflow where start underflows
    w[n, STEP] = start * math.expm1(step) if abs(step) < 1.0 else end - start


@exact
def _expm1_change(w: Floats, n: int, i: int, j: int) -> None:
    _exp_change(w, n, i, j)
    w[n, REFERENCE], w[n, VALUE] = math.expm1(w[i, REFERENCE]), math.expm1(w[i, VALUE])


@exact
def _exp_bounds(w: Floats, n: int, i: int, j: int) -> None:
    w[n, LOW], w[n, HIGH] = math.exp(w[i, LOW]), math.exp(w[i, HIGH])


@exact
def _expm1_bounds(w: Floats, n: int, i: int, j: int) -> None:
    w[n, LOW], w[n, HIGH] = math.expm1(w[i, LOW]), math.expm1(w[i, HIGH])


@exact
def _exp_series(w: Floats, n: int, i: int, j: int) -> None:
    low, high = outward(math.exp(w[i, 0]), math.exp(w[i, 3]), LIBRARY)
    chain(w, n, i, (low, high), ((low, high), (0.5 * low, 0.5 * high)))


@exact
def _expm1_series(w: Floats, n: int, i: int, j: int) -> None:
    low, high = outward(math.expm1(w[i, 0]), math.expm1(w[i, 3]), LIBRARY)
    a, b = outward(math.exp(w[i, 0]), math.exp(w[i, 3]), LIBRARY)
    chain(w, n, i, (max(low, -1.0), max(high, -1.0)), ((a, b), (0.5 * a, 0.5 * b)))


def _exp_disc(a: Disc) -> Disc:
    centre = np.exp(np.minimum(a.centre, KNOWN))
    end = a.centre + a.radius
    tiny = (a.radius > KNOWN) & (end < 0.0)  # expm1 overflows, but no value is larger than 1
    radius = np.where(tiny, np.exp(np.minimum(end, 0.0)) + centre, centre * np.expm1(a.radius))
    radius = np.where(a.centre > KNOWN, np.inf, radius)
    return Disc(centre, radius, 0.0).rounded(OF_FUNCTION, np.exp(np.minimum(a.centre - a.radius, KNOWN)))


def exp_difference(value: float, now: float, step: float, largest: float) -> float:
    """Return exp(now), which no longer grows beyond an exponent, minus its value at the reference."""
    if abs(step) < 1.0:
        return value * math.expm1(step)
    return math.exp(min(now, largest)) - value


def exp_value(reference: float, difference: float, step: float, argument: float, largest: float) -> float:
    """Return exp(argument). Far from the reference it may be so small that nothing of it is left in reference + difference."""
    return reference + difference if abs(step) < 1.0 else math.exp(min(argument, largest))


def _exp_order_zero(writer: Levels, node: Expression) -> dict[str, str]:
    a, r, largest = node.arguments[0], writer.reference(node), writer.largest_exponent(node)
    now, step = writer.coefficient(a, 0), writer.difference(a)
    value = f"exp_value({r}, {writer.difference(node)}, {step}, {now}, {largest})"
    lines = writer.level(node, f"exp_difference({r}, {now}, {step}, {largest})", value)
    if writer.saturates(node):
        lines[f"o{writer.index[node]}"] = below(LARGEST_EXPONENT, now or "0.0")
    return lines


def _exp_derivative(writer: Levels, node: Expression, da: str) -> str:
    value = writer.coefficient(node, 0)
    return f"{value} * (o{writer.index[node]} * {da})" if writer.saturates(node) else f"{value} * {da}"


def _exp_coefficient(writer: SeriesWriter, node: Expression, k: int) -> str:
    a = node.arguments[0]
    grows = f"o{writer.index[node]} * " if writer.saturates(node) else ""
    return f"{grows}{writer.coefficient(a, k) or '0.0'} * {writer.coefficient(node, 0)}{writer.weighted(a, node, k)}"


def _exp_radius(balls: BallsWriter, node: Expression) -> str:
    """Write the radius of an exp; 0 for one that is a constant, if its argument stays large along the step."""
    a = node.arguments[0]
    radius = f"exp_radius({balls.centre(a)}, {balls.centre(node)}, {balls.radius(a)})"
    if not balls.formula.saturates(node):
        return radius
    return f"min({radius}, 1e308 * max({below(LARGEST_EXPONENT, balls.centre(a))}, {below(STAYS_LARGE, balls.least(a))}))"


def _exp_least(balls: BallsWriter, node: Expression, _: str) -> str:
    a = node.arguments[0]
    return f"max(1.0 / exp_above({balls.radius(a)} - {balls.centre(a)}), {TINIEST!r})"


EXP = Operation(
    name="exp",
    value=np.exp,
    change=_exp_change,
    slope_formula=lambda node, da: node * da,
    bounds=_exp_bounds,
    taylor=_exp_series,
    disc=_exp_disc,
    order_zero=_exp_order_zero,
    derivative=_exp_derivative,
    recurrence=Recurrence(
        _exp_coefficient,
        weights_of_argument=True,
        scaled=Scaled(
            where=lambda writer, node: writer.is_direct(node.arguments[0]),
            total=lambda writer, node, k: writer.directly_weighted(node.arguments[0], node, k),
            factor=lambda writer, node, k: repr(1.0 / k),
        ),
    ),
    ball=Radius(_exp_radius, _exp_least, logarithm=lambda balls, node, plain: balls.radius(node.arguments[0]) or "0.0"),
    settles=(0,),
    shrinks=True,
    varies_much=True,
    overflows=True,
    called=(
        exp_difference,
        exp_value,
    ),
)


def _expm1_order_zero(writer: Levels, node: Expression) -> dict[str, str]:
    exp = exp_of(node)
    value = f"expm1(min({writer.coefficient(node.arguments[0], 0)}, {writer.largest_exponent(node)}))"
    return writer.level(node, f"{writer.difference(exp)}", value)


def _expm1_disc(a: Disc) -> Disc:
    power = _exp_disc(a)
    return Disc(np.expm1(np.minimum(a.centre, KNOWN)), power.radius, 0.0).rounded(OF_FUNCTION, power.least - 1.0)


EXPM1 = Operation(
    name="expm1",
    value=np.expm1,
    change=_expm1_change,
    slope_formula=lambda node, da: exp_of(node) * da,
    bounds=_expm1_bounds,
    taylor=_expm1_series,
    disc=_expm1_disc,
    order_zero=_expm1_order_zero,
    derivative=lambda writer, node, da: f"{writer.coefficient(exp_of(node), 0)} * {da}",
    recurrence=Recurrence(lambda writer, node, k: f"{writer.coefficient(exp_of(node), k)}"),
    ball=Radius(lambda balls, node: _exp_radius(balls, exp_of(node))),
    companions=lambda node: (exp_of(node), node),
    zeros=(0,),
    settles=(0,),
    shrinks=True,
    varies_much=True,
    overflows=True,
)
