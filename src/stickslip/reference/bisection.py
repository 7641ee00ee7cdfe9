"""Bisection: slow, and hard to get wrong."""

from __future__ import annotations

from collections.abc import Callable


def bisect(function: Callable[[float], float], low: float, high: float) -> float:
    """The sign change of a function between low and high, to the last bit. Raises ValueError where there is none."""
    start = function(low) > 0.0
    if (function(high) > 0.0) == start:
        raise ValueError(f"no sign change between {low!r} and {high!r}")
    while low < (middle := 0.5 * (low + high)) < high:
        if (function(middle) > 0.0) == start:
            low = middle
        else:
            high = middle
    return middle
