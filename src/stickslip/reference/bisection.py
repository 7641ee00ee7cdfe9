"""Bisection, which is slow but simple enough to serve as a reference."""

from __future__ import annotations

from collections.abc import Callable


def bisect(function: Callable[[float], float], low: float, high: float) -> float:
    """Return the place between low and high at which a function changes sign, to the last bit.

    Raises ValueError if the function has the same sign at both ends.
    """
    start = function(low) > 0.0
    if (function(high) > 0.0) == start:
        raise ValueError(f"no sign change between {low!r} and {high!r}")
    while low < (middle := 0.5 * (low + high)) < high:
        if (function(middle) > 0.0) == start:
            low = middle
        else:
            high = middle
    return middle
