"""The root of a function that lies farthest to the right, by counts of roots beyond lines."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from stickslip.contact.layer_count import NotCountedError
from stickslip.contact.layer_response import Complex

MOST_LINES = 100
"""Largest number of lines that are looked at."""
MOST_UNKNOWN = 4
"""Largest number of lines without a count."""
MANY_ROOTS = 8
"""With more roots beyond a line than this, one farther right is tried before the roots are looked for."""
BESIDE_ROOT = 1e-8, 2e-13
"""The line beside a root lies farther right by these shares of its growth rate and of its size (1)."""


class SeenBeyond(NamedTuple):
    """Hold the number of roots beyond a line, and places near roots."""

    number: float
    seeds: Complex


def climbed(
    look: Callable[[float], SeenBeyond], polish: Callable[[Complex], list[complex]], low: float, seeds: Complex, step: float
) -> complex:
    """Return the root farthest to the right, given a line (1/s) that lies left of it and places near roots.

    No root lies beyond the line beside it. Raises NotCountedError if no such root is found. `step` (1/s) is how far lines are apart
    as long as it is not known where roots end.
    """
    high, number, unknown = math.inf, 0.0, 0
    for _ in range(MOST_LINES):
        found = [one for one in polish(seeds) if one.real > low]
        best = max(found, key=lambda one: (one.real, -abs(one.imag)), default=None)
        line = math.inf if best is None or number > MANY_ROOTS else _beside(best)
        if not line < high:
            line, best = _middle(low, high, step), None
        if not low < line < high or unknown > MOST_UNKNOWN:
            break
        try:
            seen = look(line)
        except NotCountedError:  # a line farther right may be easier: only the last one must have a count
            low, number, unknown = line, 0.0, unknown + 1
            continue
        if seen.number:
            low, number, seeds = line, seen.number, seen.seeds
        elif best is not None:
            return best
        else:
            high, seeds = line, np.concatenate([seeds, seen.seeds])
    raise NotCountedError


def _beside(root: complex) -> float:
    return root.real + BESIDE_ROOT[0] * abs(root.real) + BESIDE_ROOT[1] * abs(root)


def _middle(low: float, high: float, step: float) -> float:
    if math.isinf(high):
        return max(2.0 * low, low + step)
    if low > 0.0 and high > 4.0 * low:
        return math.sqrt(low * high)
    return 0.5 * (low + high)
