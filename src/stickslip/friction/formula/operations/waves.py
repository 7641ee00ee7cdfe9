"""Sine and cosine; each needs the other."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from stickslip.foundation.arrays import Floats
from stickslip.foundation.kernels.kernels import exact
from stickslip.friction.formula.expression import Expression
from stickslip.friction.formula.operations.enclosures import LIBRARY, Ends, chain
from stickslip.friction.formula.operations.operation import BallsWriter, Levels, Operation, Radius, Recurrence, Scaled, SeriesWriter
from stickslip.friction.formula.operations.sets import HIGH, LOW, OF_FUNCTION, REFERENCE, SLOPE, STEP, VALUE, Disc


def both(node: Expression) -> tuple[Expression, Expression]:
    """Return sine and cosine of a node's argument."""
    return Expression("sin", node.arguments), Expression("cos", node.arguments)


@exact
def _sin_change(w: Floats, n: int, i: int, j: int) -> None:
    a, step, end = w[i, REFERENCE], w[i, STEP], w[i, VALUE]
    half = math.sin(0.5 * step)
    w[n, REFERENCE], w[n, VALUE], w[n, SLOPE] = math.sin(a), math.sin(end), math.cos(end) * w[i, SLOPE]
    w[n, STEP] = 2.0 * half * (math.cos(a) * math.cos(0.5 * step) - math.sin(a) * half)


@exact
def _cos_change(w: Floats, n: int, i: int, j: int) -> None:
    a, step, end = w[i, REFERENCE], w[i, STEP], w[i, VALUE]
    half = math.sin(0.5 * step)
    w[n, REFERENCE], w[n, VALUE], w[n, SLOPE] = math.cos(a), math.cos(end), -math.sin(end) * w[i, SLOPE]
    w[n, STEP] = -2.0 * half * (math.sin(a) * math.cos(0.5 * step) + math.cos(a) * half)


TURN = 2.0 * np.pi
"""One period of sin and cos (rad)."""


@exact
def _holds(low: float, high: float, offset: float) -> bool:
    """Return True if `offset` plus a whole number of turns may lie in an interval (rad), rounding included."""
    first, last = low / TURN - offset, high / TURN - offset
    slack = LIBRARY * (2.0 + max(abs(first), abs(last)))
    return math.floor(last + slack) >= math.ceil(first - slack)


@exact
def _between(low: float, high: float, one: float, other: float, top: float) -> Ends:
    """Return the bounds of sin or cos from its values at both ends, without rounding; the largest is `top` turns beyond 0."""
    if not (abs(low) < 1e15 and abs(high) < 1e15 and high - low < TURN):
        return -1.0, 1.0
    least = -1.0 if _holds(low, high, top + 0.5) else min(one, other)
    return least, 1.0 if _holds(low, high, top) else max(one, other)


@exact
def _within_one(low: float, high: float, one: float, other: float, top: float) -> Ends:
    """Return the same, rounding included."""
    least, most = _between(low, high, one, other, top)
    return max(least - LIBRARY, -1.0), min(most + LIBRARY, 1.0)


@exact
def _sin_bounds(w: Floats, n: int, i: int, j: int) -> None:
    low, high = w[i, LOW], w[i, HIGH]
    w[n, LOW], w[n, HIGH] = _between(low, high, math.sin(low), math.sin(high), 0.25)


@exact
def _cos_bounds(w: Floats, n: int, i: int, j: int) -> None:
    low, high = w[i, LOW], w[i, HIGH]
    w[n, LOW], w[n, HIGH] = _between(low, high, math.cos(low), math.cos(high), 0.0)


@exact
def _sin_series(w: Floats, n: int, i: int, j: int) -> None:
    low, high = w[i, 0], w[i, 3]
    a, b = _within_one(low, high, math.sin(low), math.sin(high), 0.25)
    c, d = _within_one(low, high, math.cos(low), math.cos(high), 0.0)
    chain(w, n, i, (a, b), ((c, d), (-0.5 * b, -0.5 * a)))


@exact
def _cos_series(w: Floats, n: int, i: int, j: int) -> None:
    low, high = w[i, 0], w[i, 3]
    a, b = _within_one(low, high, math.cos(low), math.cos(high), 0.0)
    c, d = _within_one(low, high, math.sin(low), math.sin(high), 0.25)
    chain(w, n, i, (a, b), ((-d, -c), (-0.5 * b, -0.5 * a)))


def _disc(own: Any, other: Any, radius: Any) -> Disc:
    """Return sin or cos, from both at the centre: sin(m + d) = sin m cos d + cos m sin d."""
    moved = np.abs(own) * 2.0 * np.sinh(0.5 * radius) ** 2 + np.abs(other) * np.sinh(radius)
    return Disc(own, moved, 0.0).rounded(OF_FUNCTION)


def _order_zero(writer: Levels, node: Expression, is_sine: bool) -> dict[str, str]:
    a, j = node.arguments[0], writer.index[node.arguments[0]]
    sine, cosine = (writer.reference(one) for one in both(node))
    turned = {f"g{j}": f"sine({writer.difference(a)})", f"h{j}": f"versine({writer.difference(a)})"}
    step = f"{cosine} * g{j} - {sine} * h{j}" if is_sine else f"-{sine} * g{j} - {cosine} * h{j}"
    return turned | writer.level(node, step)


def _radius(balls: BallsWriter, node: Expression, is_sine: bool) -> str:
    sine, cosine = (balls.size(one) for one in both(node))
    own, other = (sine, cosine) if is_sine else (cosine, sine)
    return f"sine_radius({own}, {other}, {balls.radius(node.arguments[0])})"


def _scaled(partner: int, minus: str) -> Scaled:
    return Scaled(
        where=lambda writer, node: writer.is_direct(node.arguments[0]),
        total=lambda writer, node, k: writer.directly_weighted(node.arguments[0], both(node)[partner], k),
        factor=lambda writer, node, k: f"{minus}{1.0 / k!r}",
    )


def _grown(writer: SeriesWriter, node: Expression, partner: int, k: int) -> str:
    """Write the k-th coefficient of a function whose derivative is its partner."""
    a, other = node.arguments[0], both(node)[partner]
    return f"{writer.coefficient(a, k) or '0.0'} * {writer.coefficient(other, 0)}{writer.weighted(a, other, k)}"


SIN = Operation(
    name="sin",
    value=np.sin,
    change=_sin_change,
    slope_formula=lambda node, da: both(node)[1] * da,
    bounds=_sin_bounds,
    taylor=_sin_series,
    disc=lambda a: _disc(np.sin(a.centre), np.cos(a.centre), a.radius),
    order_zero=lambda writer, node: _order_zero(writer, node, is_sine=True),
    derivative=lambda writer, node, da: f"{writer.coefficient(both(node)[1], 0)} * {da}",
    recurrence=Recurrence(lambda writer, node, k: _grown(writer, node, 1, k), weights_of_argument=True, scaled=_scaled(1, "")),
    ball=Radius(lambda balls, node: _radius(balls, node, is_sine=True)),
    companions=both,
    zeros=(0,),
)
COS = Operation(
    name="cos",
    value=np.cos,
    change=_cos_change,
    slope_formula=lambda node, da: 0.0 - both(node)[0] * da,
    bounds=_cos_bounds,
    taylor=_cos_series,
    disc=lambda a: _disc(np.cos(a.centre), np.sin(a.centre), a.radius),
    order_zero=lambda writer, node: _order_zero(writer, node, is_sine=False),
    derivative=lambda writer, node, da: f"-{writer.coefficient(both(node)[0], 0)} * {da}",
    recurrence=Recurrence(
        lambda writer, node, k: f"-({_grown(writer, node, 0, k)})", weights_of_argument=True, scaled=_scaled(0, "-")
    ),
    ball=Radius(lambda balls, node: _radius(balls, node, is_sine=False)),
    companions=both,
)
