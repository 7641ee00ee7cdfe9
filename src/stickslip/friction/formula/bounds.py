"""Bound a formula over intervals of slip and slip rate, by interval arithmetic.

The bounds are guaranteed but for rounding, and need not be sharp. `enclosure` has bounds that include rounding.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping

import numpy as np

from stickslip.friction.formula.expression import RATE, SLIP, STATES, Expression, nodes_of

Interval = tuple[float, float]
"""Lower and upper end of an interval."""
EVERYTHING: Interval = (-math.inf, math.inf)
"""The interval of a value about which nothing is known."""


def bounds(tree: Expression, numbers: Mapping[str, float], slip: Interval, rate: Interval) -> Interval:
    """Return bounds of the formula while slip (m) and slip rate (m/s) stay in their intervals, at any state."""
    found: dict[Expression, Interval] = {SLIP: slip, RATE: rate} | dict.fromkeys(STATES, EVERYTHING)
    with np.errstate(all="ignore"):
        for node in nodes_of(tree):
            if node.operation == "parameter":
                found[node] = (numbers[node.name], numbers[node.name])
            elif node.operation == "constant":
                found[node] = (node.value, node.value)
            elif node.arguments:
                found[node] = _of(node, [found[argument] for argument in node.arguments])
    return found[tree]


def _of(node: Expression, arguments: list[Interval]) -> Interval:
    a = arguments[0]
    if node.operation == "mul" and node.arguments[0] == node.arguments[1]:
        return _square(a)
    if node.operation in _RULES:
        return _RULES[node.operation](*arguments)
    if node.operation in _GROWING:
        return _hull(*(float(_GROWING[node.operation](np.float64(end))) for end in a))
    return (-1.0, 1.0)  # sin and cos


_GROWING: dict[str, Callable[[np.float64], np.float64]] = {
    "exp": np.exp,
    "tanh": np.tanh,
    "arcsinh": np.arcsinh,
    "expm1": np.expm1,
    "log1p": lambda x: np.log1p(np.maximum(x, -1.0)),
    "log": lambda x: np.log(np.maximum(x, 0.0)),
    "sqrt": lambda x: np.sqrt(np.maximum(x, 0.0)),
}


def _hull(*ends: float) -> Interval:
    return EVERYTHING if any(math.isnan(end) for end in ends) else (min(ends), max(ends))


def _times(x: float, y: float) -> float:
    """Return x y, with 0 times infinity equal to 0: an infinite end of an interval is never reached."""
    return 0.0 if x == 0.0 or y == 0.0 else float(np.float64(x) * np.float64(y))


def _multiply(a: Interval, b: Interval) -> Interval:
    return _hull(*(_times(x, y) for x in a for y in b))


def _divide(a: Interval, b: Interval) -> Interval:
    if b[0] <= 0.0 <= b[1]:
        return EVERYTHING
    return _multiply(a, (1.0 / b[1], 1.0 / b[0]))


def _square(a: Interval) -> Interval:
    high = max(_times(a[0], a[0]), _times(a[1], a[1]))
    return (0.0 if a[0] <= 0.0 <= a[1] else min(a[0] * a[0], a[1] * a[1])), high


def _power(a: Interval, b: Interval) -> Interval:
    if a[0] < 0.0 or b[0] != b[1] or (a[0] == 0.0 and b[0] < 0.0):
        return EVERYTHING
    return _hull(*(float(np.power(np.float64(end), b[0])) for end in a))


_RULES: dict[str, Callable[..., Interval]] = {
    "add": lambda a, b: _hull(a[0] + b[0], a[1] + b[1]),
    "sub": lambda a, b: _hull(a[0] - b[1], a[1] - b[0]),
    "mul": _multiply,
    "div": _divide,
    "pow": _power,
}
