"""Sets of values for the rules of operations: intervals of numbers, and discs of complex numbers."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import reduce
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from stickslip.foundation.arrays import Floats

Interval = tuple[Any, Any]
"""Lower and upper end of an interval: numbers, or arrays with the ends of many. Rules have both ends as one array."""
EVERYTHING: Interval = (-math.inf, math.inf)
"""The interval of a value about which nothing is known."""


def hull(*ends: Any) -> Floats:
    """Return the smallest interval with these numbers; everything where one of them is not a number."""
    low = reduce(np.minimum, ends)
    return unless(np.isnan(low), np.array([low, reduce(np.maximum, ends)]))


def known(ends: Floats) -> Floats:
    """Return an interval, or everything where an end is not a number."""
    return unless(np.isnan(ends).any(axis=0), ends)


def unless(unknown: Any, known: Floats) -> Floats:
    """Return an interval, or everything where nothing is known."""
    return np.array([np.where(unknown, -np.inf, known[0]), np.where(unknown, np.inf, known[1])]) if unknown.any() else known


def multiplied(a: Floats, b: Floats) -> Floats:
    """Return a b: the hull of the four products of the ends.

    0 times infinity is 0: an infinite end of an interval is never reached.
    """
    found = _hull_of_four(*(x * y for x in a for y in b))
    return found if not np.isnan(found).any() else _hull_of_four(*(times(x, y) for x in a for y in b))


def times(x: Any, y: Any) -> Any:
    """Return x y, with 0 times infinity equal to 0."""
    return np.nan_to_num(np.multiply(x, y), nan=0.0, posinf=np.inf, neginf=-np.inf)


def _hull_of_four(p: Any, q: Any, r: Any, s: Any) -> Floats:
    return np.array(
        [np.minimum(np.minimum(p, q), np.minimum(r, s)), np.maximum(np.maximum(p, q), np.maximum(r, s))],
    )


def squared(a: Floats) -> Floats:
    """Return a**2, which is never negative."""
    first, last = a * a
    return np.array([np.where(a[0] * a[1] <= 0.0, 0.0, np.minimum(first, last)), np.maximum(first, last)])


def growing(function: Callable[[Any], Any], least: float = -math.inf) -> Callable[..., Floats]:
    """Return the rule that bounds a function which grows with its argument, from the least argument that it has on."""

    def bounds(_: Any, a: Floats) -> Floats:
        if math.isinf(least):
            return np.asarray(function(a))
        return unless(a[1] < least, np.asarray(function(np.maximum(a, least))))

    return bounds


ROUNDING = 1.2e-16
"""Relative rounding (1) of a sum, product or quotient."""
OF_FUNCTION = 8.0 * ROUNDING
"""The same of a function of the mathematical library: four units in the last place."""


class Disc(NamedTuple):
    """A disc: its real centre, its radius, and a lower bound of the magnitude of all values that the node may have in it.

    An exponential varies by orders of magnitude on a disc and stays away from zero, which a radius alone cannot express.
    """

    centre: Any
    radius: Any
    least: Any

    @classmethod
    def of(cls, centre: ArrayLike, radius: ArrayLike = 0.0) -> Disc:
        """Return the disc with a given centre and radius."""
        middle = np.asarray(centre, float)
        return cls(middle, radius, np.maximum(np.abs(middle) - radius, 0.0))

    @property
    def most(self) -> Any:
        """The largest magnitude in the disc."""
        return np.abs(self.centre) + self.radius

    @property
    def turned(self) -> Any:
        """An upper bound of |log(value / centre)|, which is not a number where the disc reaches zero."""
        return -np.log1p(-self.radius / np.abs(self.centre))

    def rounded(self, by: ArrayLike = ROUNDING, least: ArrayLike = 0.0) -> Disc:
        """Return the disc with a radius that contains a relative rounding of its centre, and with a better lower bound."""
        size = np.abs(self.centre)
        radius = self.radius + by * size
        return Disc(self.centre, radius, np.fmax(np.fmax(size - radius, np.multiply(least, 1.0 - 1e-14)), 0.0))
