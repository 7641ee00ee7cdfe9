"""Newton's method in a bracket: the one root finder of this package."""

from __future__ import annotations

import math
from collections.abc import Callable

_NEAR = 1e-8
"""Relative step below which Newton's method, were it exact, would be done after one more step."""


def bracketed_newton(
    function: Callable[[float], tuple[float, float]], low: float, high: float, start: float, rising: bool
) -> float:
    """The root, to rounding, of a function that returns its value and its slope and is monotone between low and high.

    `rising` says whether the value is negative at low or at high. Bisects where Newton leaves the bracket or hardly gains, and
    stops where steps no longer make the value smaller: rounding has then taken over.
    """
    x, last = start, high - low
    value, slope = function(x)
    for _ in range(200):
        if value == 0.0 or math.nextafter(low, high) >= high:
            break
        low, high = (low, x) if (value > 0.0) == rising else (x, high)
        step = -value / slope if slope else math.inf
        newton = low < x + step < high and (abs(step) <= 0.5 * last or abs(step) <= _NEAR * abs(x))
        if not newton:
            step = 0.5 * (low + high) - x
        last, x, before = abs(step), x + step, value
        value, slope = function(x)
        if newton and last <= _NEAR * abs(x) and abs(value) >= 0.5 * abs(before):
            break
    return x
