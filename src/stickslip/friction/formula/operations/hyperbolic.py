"""The hyperbolic tangent, and the inverse of the hyperbolic sine."""

from __future__ import annotations

import math

import numpy as np

from stickslip.foundation.arrays import Floats
from stickslip.foundation.kernels.kernels import exact
from stickslip.friction.formula.expression import Expression, nodes_of
from stickslip.friction.formula.operations.enclosures import LIBRARY, Ends, chain, multiply, outward, square
from stickslip.friction.formula.operations.operation import Levels, Operation, Radius, Recurrence, SeriesWriter
from stickslip.friction.formula.operations.sets import HIGH, LOW, OF_FUNCTION, REFERENCE, SLOPE, STEP, VALUE, Disc


@exact
def _tanh_change(w: Floats, n: int, i: int, j: int) -> None:
    """Write the change of tanh, with tanh x - tanh y = sinh(x - y) / (cosh x cosh y) near the reference.

    Farther from it a subtraction loses no digits.
    """
    a, step, now = w[i, REFERENCE], w[i, STEP], w[i, VALUE]
    start, end, across = math.tanh(a), math.tanh(now), math.cosh(now)  # where it overflows, 1 / cosh is 0
    w[n, REFERENCE], w[n, VALUE], w[n, SLOPE] = start, end, w[i, SLOPE] / across / across
    # with the same sign, both may differ from 1 or -1 only in their last digits: subtraction would cancel even for large steps
    near = abs(step) < 1.0 or (abs(step) < 300.0 and a * now > 0.0)
    w[n, STEP] = math.sinh(step) / math.cosh(a) / across if near else end - start


def _tanh_disc(a: Disc) -> Disc:
    """Return tanh, by |tanh z - tanh m| = |sinh(z - m)| / (|cosh z| |cosh m|), or by 2 / |exp(2 z) + 1| far from zero.

    |cosh z| is at least |cosh m| (cos r - |tanh m| sinh r) for a radius r below pi / 2, and at least sinh of the real part.
    """
    centre, size = np.tanh(a.centre), np.cosh(a.centre)
    apart, sinh = np.abs(a.centre) - a.radius, np.sinh(a.radius)
    least = np.maximum(size * (np.cos(np.minimum(a.radius, 2.0)) - np.abs(centre) * sinh), np.sinh(apart))
    near = np.where(least > 0.0, sinh / (least * size), np.inf)
    far = np.where(apart > 0.0, 4.0 / np.expm1(2.0 * apart), np.inf)
    return Disc(centre, np.fmin(near, far), 0.0).rounded(OF_FUNCTION)


@exact
def _sizes(a: float, b: float) -> Ends:
    """Return the largest and the smallest magnitude in an interval."""
    return max(-a, b), max(max(a, -b), 0.0)


@exact
def _across(x: float) -> float:
    """Return 1 / cosh(x)**2 for x >= 0."""
    e = math.exp(-2.0 * min(x, 1e3))
    return 4.0 * e / ((1.0 + e) * (1.0 + e))


@exact
def _across_on(a: float, b: float) -> Ends:
    """Return the bounds of 1 / cosh(x)**2, which falls with the magnitude of x."""
    largest, smallest = _sizes(a, b)
    low, high = outward(_across(largest), _across(smallest), 4.0 * LIBRARY)
    return min(low, 1.0), min(high, 1.0)


@exact
def _tanh_bounds(w: Floats, n: int, i: int, j: int) -> None:
    w[n, LOW], w[n, HIGH] = math.tanh(w[i, LOW]), math.tanh(w[i, HIGH])


@exact
def _tanh_series(w: Floats, n: int, i: int, j: int) -> None:
    low, high = outward(math.tanh(w[i, 0]), math.tanh(w[i, 3]), LIBRARY)
    low, high = max(low, -1.0), min(high, 1.0)
    a, b = _across_on(w[i, 0], w[i, 3])
    less, more = multiply(low, high, a, b)
    chain(w, n, i, (low, high), ((a, b), (-more, -less)))


@exact
def logistic(w: Floats, n: int, i: int, j: int) -> None:
    """Write the coefficients of 1 / (1 + exp(a)), which is no operation of its own but in `Operation.bounded`."""
    low, high = outward(1.0 / (1.0 + math.exp(w[i, 3])), 1.0 / (1.0 + math.exp(w[i, 0])), 2.0 * LIBRARY)
    a, b = _across_on(0.5 * w[i, 0], 0.5 * w[i, 3])
    a, b = 0.25 * a, 0.25 * b
    c, d = outward(math.tanh(0.5 * w[i, 0]), math.tanh(0.5 * w[i, 3]), LIBRARY)
    less, more = multiply(c, d, a, b)
    chain(w, n, i, (max(low, 0.0), min(high, 1.0)), ((-b, -a), (0.5 * less, 0.5 * more)))


def tanh_difference(value: float, now: float, step: float) -> float:
    """Return tanh(now) minus its value at the reference."""
    if abs(step) < 1.0 or (abs(step) < 300.0 and now * value > 0.0):  # on one side both may be 1 but for their last digits
        return math.sinh(step) / math.cosh(now - step) / math.cosh(now)
    return math.tanh(now) - value


def _tanh_order_zero(writer: Levels, node: Expression) -> dict[str, str]:
    a = node.arguments[0]
    return writer.level(node, f"tanh_difference({writer.reference(node)}, {writer.coefficient(a, 0)}, {writer.difference(a)})")


def _tanh_derivative(writer: Levels, node: Expression, da: str) -> str:
    value = writer.coefficient(node, 0)
    return f"(1.0 - {value} * {value}) * {da}"


def _tanh_coefficient(writer: SeriesWriter, node: Expression, k: int) -> str:
    a, square = node.arguments[0], node * node
    slope = f"(1.0 - {writer.coefficient(square, 0)})"
    return f"{writer.coefficient(a, k) or '0.0'} * {slope} - (0.0{writer.weighted(a, square, k)})"


TANH = Operation(
    name="tanh",
    value=np.tanh,
    change=_tanh_change,
    slope_formula=lambda node, da: (1.0 - node * node) * da,
    bounds=_tanh_bounds,
    taylor=_tanh_series,
    disc=_tanh_disc,
    order_zero=_tanh_order_zero,
    derivative=_tanh_derivative,
    recurrence=Recurrence(_tanh_coefficient, weights_of_argument=True),
    ball=Radius(lambda balls, node: f"tanh_radius({balls.size(node.arguments[0])}, {balls.radius(node.arguments[0])})"),
    companions=lambda node: (node, node * node),
    zeros=(0,),
    settles=(0,),
    called=(tanh_difference,),
)


def root_of(node: Expression) -> Expression:
    """Return the node sqrt(1 + a^2) for a node arcsinh(a)."""
    return Expression("sqrt", (1.0 + node.arguments[0] * node.arguments[0],))


@exact
def _arcsinh_change(w: Floats, n: int, i: int, j: int) -> None:
    """Write the change of arcsinh, by arcsinh x - arcsinh y = arcsinh((x - y) (1 + p q - x y) / (p + q)).

    Here p = sqrt(1 + x^2) and q = sqrt(1 + y^2). Where the squares would overflow, subtract.
    """
    x, y = w[i, VALUE], w[i, REFERENCE]
    p, q, xy = math.hypot(1.0, x), math.hypot(1.0, y), x * y
    w[n, REFERENCE], w[n, VALUE], w[n, SLOPE] = math.asinh(y), math.asinh(x), w[i, SLOPE] / p
    if max(p, q) > 1e150:
        w[n, STEP] = w[n, VALUE] - w[n, REFERENCE]
    else:
        gap = (1.0 + x * x + y * y) / (p * q + xy) if xy > 0.0 else p * q - xy
        w[n, STEP] = math.asinh(w[i, STEP] * (1.0 + gap) / (p + q))


@exact
def _arcsinh_bounds(w: Floats, n: int, i: int, j: int) -> None:
    w[n, LOW], w[n, HIGH] = math.asinh(w[i, LOW]), math.asinh(w[i, HIGH])


@exact
def _arcsinh_series(w: Floats, n: int, i: int, j: int) -> None:
    largest, smallest = _sizes(w[i, 0], w[i, 3])
    a, b = outward(1.0 / math.hypot(1.0, largest), 1.0 / math.hypot(1.0, smallest), 2.0 * LIBRARY)
    a, b = min(a, 1.0), min(b, 1.0)
    c, d = square(a, b)
    c, d = multiply(c, d, a, b)
    less, more = multiply(w[i, 0], w[i, 3], c, d)
    value = outward(math.asinh(w[i, 0]), math.asinh(w[i, 3]), LIBRARY)
    chain(w, n, i, value, ((a, b), (-0.5 * more, -0.5 * less)))


def arcsinh_difference(reference: float, now: float, step: float) -> float:
    """Return arcsinh(now) - arcsinh(reference) = arcsinh(step (1 + p q - x y) / (p + q)), p^2 = 1 + x^2, q^2 = 1 + y^2."""
    if abs(reference) > 1e150 or abs(now) > 1e150:  # their squares are no numbers
        return math.asinh(now) - math.asinh(reference)
    p, q, xy = math.sqrt(1.0 + now * now), math.sqrt(1.0 + reference * reference), now * reference
    gap = (1.0 + now * now + reference * reference) / (p * q + xy) if xy > 0.0 else p * q - xy
    return math.asinh(step * (1.0 + gap) / (p + q))


def _arcsinh_order_zero(writer: Levels, node: Expression) -> dict[str, str]:
    a = node.arguments[0]
    return writer.level(node, f"arcsinh_difference({writer.reference(a)}, {writer.coefficient(a, 0)}, {writer.difference(a)})")


def _arcsinh_derivative(writer: Levels, node: Expression, da: str) -> str:
    a0 = writer.coefficient(node.arguments[0], 0)
    return f"{da} / (sqrt(1.0 + {a0} * {a0}) if abs({a0}) < 1e150 else abs({a0}))"


def _arcsinh_coefficient(writer: SeriesWriter, node: Expression, k: int) -> str:
    ak = writer.coefficient(node.arguments[0], k) or "0.0"
    return f"({ak} - (0.0{writer.weighted(node, root_of(node), k)})) * i{writer.index[node]}"


ARCSINH = Operation(
    name="arcsinh",
    math_name="asinh",
    value=np.arcsinh,
    change=_arcsinh_change,
    slope_formula=lambda node, da: da / root_of(node),
    bounds=_arcsinh_bounds,
    taylor=_arcsinh_series,
    # its derivative 1 / sqrt((z - i)(z + i)) has its singularities at i and -i
    disc=lambda a: Disc(np.arcsinh(a.centre), -np.log1p(-a.radius / np.hypot(1.0, a.centre)), 0.0).rounded(OF_FUNCTION),
    order_zero=_arcsinh_order_zero,
    derivative=_arcsinh_derivative,
    recurrence=Recurrence(
        _arcsinh_coefficient, divisor=lambda writer, node: f"{writer.coefficient(root_of(node), 0)}", weights_of_result=True
    ),
    ball=Radius(lambda balls, node: f"arcsinh_radius({balls.size(node.arguments[0])}, {balls.radius(node.arguments[0])})"),
    companions=lambda node: (*nodes_of(root_of(node)), node),
    zeros=(0,),
    called=(arcsinh_difference,),
)
