"""Powers with an exponent that does not vary, and square roots."""

from __future__ import annotations

import math
import operator
from fractions import Fraction
from typing import Any

import numpy as np

from stickslip.foundation.arrays import Floats
from stickslip.foundation.errors import InputError
from stickslip.foundation.kernels.kernels import exact
from stickslip.friction.formula.expression import RATE, Expression, depends_on
from stickslip.friction.formula.operations.enclosures import LIBRARY, ONE_STEP, Ends, chain, multiply, of_positive, outward, rounded
from stickslip.friction.formula.operations.operation import (
    BallsWriter,
    Dimension,
    Levels,
    Operation,
    Radius,
    Recurrence,
    SeriesWriter,
    oldest_first,
    sum_of,
    unit_text,
    without_zeros,
)
from stickslip.friction.formula.operations.sets import HIGH, LOW, OF_FUNCTION, REFERENCE, SLOPE, STEP, VALUE, Disc


@exact
def _chained(outer: float, inner: float) -> float:
    """Return outer * inner, and 0 where inner is 0: without dependence the product is 0 even if the outer slope is infinite."""
    return outer * inner if inner != 0.0 else 0.0


def _raised(base: Dimension, exponent: Fraction) -> Dimension:
    return without_zeros({name: power * exponent for name, power in base.items()})


def _pow_unit(node: Expression, base: Dimension, exponent: Dimension) -> Dimension:
    if not base and exponent:
        raise InputError(f"its exponent must be a pure number, but is in {unit_text(exponent)}")
    if base and node.arguments[1].operation != "constant":
        raise InputError(f"{unit_text(base)} to a power that is a parameter has no fixed unit; divide it by one first")
    return _raised(base, Fraction(node.arguments[1].value).limit_denominator(1000)) if base else {}


@exact
def _pow_change(w: Floats, n: int, i: int, j: int) -> None:
    base, exponent = w[i, REFERENCE], w[j, REFERENCE]
    start, end = math.pow(base, exponent), math.pow(w[i, VALUE], w[j, VALUE])
    w[n, REFERENCE], w[n, VALUE], w[n, STEP] = start, end, end - start
    if base > 0.0 and w[i, VALUE] > 0.0:
        w[n, STEP] = start * math.expm1(exponent * math.log1p(w[i, STEP] / base))
    w[n, SLOPE] = _chained(exponent * math.pow(w[i, VALUE], exponent - 1.0), w[i, SLOPE])


@exact
def _hull_of_powers(a: float, b: float, c: float, d: float) -> Ends:
    """Return [a, b] to the power of [c, d], without rounding."""
    e, f, g, h = math.pow(a, c), math.pow(a, d), math.pow(b, c), math.pow(b, d)
    if a < 0.0 or math.isnan(e) or math.isnan(f) or math.isnan(g) or math.isnan(h):
        return -math.inf, math.inf
    return min(min(e, f), min(g, h)), max(max(e, f), max(g, h))


@exact
def _pow_bounds(w: Floats, n: int, i: int, j: int) -> None:
    w[n, LOW], w[n, HIGH] = _hull_of_powers(w[i, LOW], w[i, HIGH], w[j, LOW], w[j, HIGH])


@exact
def _sqrt_bounds(w: Floats, n: int, i: int, j: int) -> None:
    w[n, LOW], w[n, HIGH] = -math.inf, math.inf
    if w[i, HIGH] >= 0.0:
        w[n, LOW], w[n, HIGH] = math.sqrt(max(w[i, LOW], 0.0)), math.sqrt(w[i, HIGH])


@exact
def _power(a: float, b: float, c: float, d: float) -> Ends:
    """Return [a, b] to the power of [c, d]."""
    low, high = _hull_of_powers(a, b, c, d)
    return outward(low, high, 2.0 * LIBRARY)


@exact
def _pow_series(w: Floats, n: int, i: int, j: int) -> None:
    """Write the coefficients of a power; with an exponent that varies it is `bounded` as an exponential."""
    a, b, c, d = w[i, 0], w[i, 3], w[j, 0], w[j, 3]
    less, more = rounded(c - 1.0, d - 1.0, ONE_STEP)
    least, most = rounded(c - 2.0, d - 2.0, ONE_STEP)
    low, high = _power(a, b, less, more)
    first = multiply(c, d, low, high)
    low, high = _power(a, b, least, most)
    least, most = multiply(c, d, less, more)
    low, high = multiply(least, most, low, high)
    chain(w, n, i, _power(a, b, c, d), (first, (0.5 * low, 0.5 * high)))


def _pow_bounded(node: Expression) -> Expression:
    base, exponent = node.arguments
    return Expression("exp", (exponent * Expression("log", (base,)),)) if depends_on(exponent, RATE) else node


def _pow_disc(a: Disc, b: Disc) -> Disc:
    """Return a power whose exponent is a number of the law; a whole one above zero may pass zero."""
    exponent, size = b.centre, np.abs(a.centre)
    power = size**exponent
    radius = power * np.expm1(np.abs(exponent) * a.turned)
    radius = np.where((exponent == np.rint(exponent)) & (exponent > 0.0), a.most**exponent - power, radius)
    least = np.minimum(a.least**exponent, a.most**exponent)
    by = OF_FUNCTION * (1.0 + np.abs(exponent) * (1.0 + np.abs(np.log(np.maximum(size, 1e-300)))))
    return Disc(a.centre**exponent, radius, 0.0).rounded(by, least)


def power_difference(reference: float, now: float, step: float, exponent: float) -> Any:
    """Return now**exponent - reference**exponent."""
    if abs(step) < 0.5 * reference:
        return reference**exponent * math.expm1(exponent * math.log1p(step / reference))
    return now**exponent - reference**exponent


def power_value(reference: float, difference: float, base: float, exponent: float) -> Any:
    """Return base**exponent. Far from the reference nothing of it may be left in reference + difference."""
    return reference + difference if abs(difference) < 0.5 * abs(reference) else base**exponent


def _pow_order_zero(writer: Levels, node: Expression) -> dict[str, str]:
    a, b = node.arguments
    now, exponent = writer.coefficient(a, 0), writer.reference(b)
    difference = f"power_difference({writer.reference(a)}, {now}, {writer.difference(a)}, {exponent})"
    return writer.level(node, difference, f"power_value({writer.reference(node)}, {writer.difference(node)}, {now}, {exponent})")


def _pow_derivative(writer: Levels, node: Expression, da: str, _: str | None) -> str:
    a, b = node.arguments
    return f"{writer.reference(b)} * {writer.coefficient(node, 0)} / {writer.coefficient(a, 0)} * {da}"


def _pow_coefficient(writer: SeriesWriter, node: Expression, k: int) -> str:
    a, exponent = node.arguments[0], writer.reference(node.arguments[1])
    terms = [
        f"({k - i}.0 * {exponent} - {i}.0) * {x} * {writer.coefficient(node, i)}"
        for i, j in oldest_first([(j, k - j) for j in range(k)])
        if (x := writer.coefficient(a, j)) is not None
    ]
    return f"({sum_of(terms)}) * ({1.0 / k!r} * i{writer.index[node]})"


def _power_radius(balls: BallsWriter, node: Expression, exponent: str) -> str:
    return f"power_radius({balls.size(node)}, {exponent}, {balls.logarithm(node.arguments[0])})"


def _turned(balls: BallsWriter, node: Expression, exponent: str) -> str:
    return f"{exponent} * {balls.logarithm(node.arguments[0])}"


def _exponent_size(balls: BallsWriter, node: Expression) -> str:
    return f"abs({balls.centre(node.arguments[1])})"


POW = Operation(
    name="pow",
    sign="**",
    rank=4,
    numpy_name="power",
    value=operator.pow,
    change=_pow_change,
    slope_formula=lambda node, da, _: node.arguments[1] * node.arguments[0] ** (node.arguments[1] - 1.0) * da,
    bounds=_pow_bounds,
    taylor=_pow_series,
    bounded=_pow_bounded,
    disc=_pow_disc,
    unit=_pow_unit,
    order_zero=_pow_order_zero,
    derivative=_pow_derivative,
    recurrence=Recurrence(_pow_coefficient, divisor=lambda writer, node: f"{writer.coefficient(node.arguments[0], 0)}"),
    ball=Radius(
        lambda balls, node: _power_radius(balls, node, _exponent_size(balls, node)),
        logarithm=lambda balls, node, plain: _turned(balls, node, _exponent_size(balls, node)),
    ),
    shrinks=True,
    varies_much=True,
    called=(
        power_difference,
        power_value,
    ),
)


@exact
def _sqrt_change(w: Floats, n: int, i: int, j: int) -> None:
    start, end = math.sqrt(w[i, REFERENCE]), math.sqrt(w[i, VALUE])
    w[n, REFERENCE], w[n, VALUE], w[n, SLOPE] = start, end, _chained(0.5 / end, w[i, SLOPE])
    w[n, STEP] = w[i, STEP] / (start + end) if start + end > 0.0 else 0.0


@exact
def _sqrt_series(w: Floats, n: int, i: int, j: int) -> None:
    low, high = -math.inf, math.inf
    if w[i, 3] >= 0.0:
        low, high = outward(math.sqrt(max(w[i, 0], 0.0)), math.sqrt(w[i, 3]), LIBRARY)
    a, b = of_positive(2.0 * low, 2.0 * high)
    c, d = of_positive(w[i, 0], w[i, 3])
    less, more = multiply(a, b, c, d)
    chain(w, n, i, (low, high), ((a, b), (-0.25 * more, -0.25 * less)))


def _sqrt_disc(a: Disc) -> Disc:
    centre = np.sqrt(a.centre)
    return Disc(centre, centre * np.expm1(0.5 * a.turned), 0.0).rounded(OF_FUNCTION, np.sqrt(a.least))


def _sqrt_order_zero(writer: Levels, node: Expression) -> dict[str, str]:
    a = node.arguments[0]
    now = writer.coefficient(a, 0)
    return writer.level(node, f"{writer.difference(a)} / (sqrt({now}) + {writer.reference(node)})", f"sqrt({now})")


def _sqrt_coefficient(writer: SeriesWriter, node: Expression, k: int) -> str:
    ak = writer.coefficient(node.arguments[0], k) or "0.0"
    return f"({ak} - ({writer.products(node, node, k, range(1, k))})) * i{writer.index[node]}"


SQRT = Operation(
    name="sqrt",
    value=np.sqrt,
    change=_sqrt_change,
    slope_formula=lambda node, da: 0.5 * da / node,
    bounds=_sqrt_bounds,
    taylor=_sqrt_series,
    disc=_sqrt_disc,
    unit=lambda node, a: _raised(a, Fraction(1, 2)),
    order_zero=_sqrt_order_zero,
    derivative=lambda writer, node, da: f"{da} / (2.0 * {writer.coefficient(node, 0)})",
    recurrence=Recurrence(_sqrt_coefficient, divisor=lambda writer, node: f"2.0 * {writer.coefficient(node, 0)}"),
    ball=Radius(
        lambda balls, node: _power_radius(balls, node, "0.5"),
        least=lambda balls, node, plain: f"sqrt({balls.least(node.arguments[0])})",
        logarithm=lambda balls, node, plain: _turned(balls, node, "0.5"),
    ),
    zeros=(0,),
    carries=(0,),
)
