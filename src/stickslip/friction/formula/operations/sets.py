"""What rules of operations write: changes between two points, and sets of values, as intervals or as discs of complex numbers."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from stickslip.foundation.arrays import Floats
from stickslip.foundation.kernels.kernels import exact

Interval = tuple[Any, Any]
"""Lower and upper end of an interval: numbers, or arrays with the ends of many."""
EVERYTHING: Interval = (-math.inf, math.inf)
"""The interval of a value about which nothing is known."""


LOW, HIGH = range(2)
"""Columns of the ends of a node's interval; rules write the row n of a node from the rows i and j of its arguments."""
REFERENCE, STEP, VALUE, SLOPE = range(4)
"""Columns of the table of changes, in which each node has a row: its value at the reference point, its change to the end point, its
value there, and its derivative there. The value at the end point is computed independently: reference + change would lose the
digits of a value that has become small."""


@exact
def put(w: Floats, n: int, low: float, high: float) -> None:
    """Write an interval, or everything where an end is not a number."""
    if math.isnan(low) or math.isnan(high):
        low, high = -math.inf, math.inf
    w[n, LOW], w[n, HIGH] = low, high


@exact
def times(x: float, y: float) -> float:
    """Return x y, with 0 times infinity equal to 0: an infinite end of an interval is never reached."""
    return 0.0 if x == 0.0 or y == 0.0 else x * y


@exact
def multiplied(a: float, b: float, c: float, d: float) -> tuple[float, float]:
    """Return [a, b] times [c, d], without rounding: the hull of the four products of the ends."""
    p, q, r, s = a * c, a * d, b * c, b * d
    if math.isnan(p + q + r + s):
        p, q, r, s = times(a, c), times(a, d), times(b, c), times(b, d)
    return min(min(p, q), min(r, s)), max(max(p, q), max(r, s))


@exact
def squared(a: float, b: float) -> tuple[float, float]:
    """Return [a, b] squared, which is never negative, without rounding."""
    first, last = a * a, b * b
    return 0.0 if a * b <= 0.0 else min(first, last), max(first, last)


ROUNDING_OF_OPERATION = 1.2e-16
"""Relative rounding (1) of a sum, product or quotient."""
OF_FUNCTION = 8.0 * ROUNDING_OF_OPERATION
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

    def rounded(self, by: ArrayLike = ROUNDING_OF_OPERATION, least: ArrayLike = 0.0) -> Disc:
        """Return the disc with a radius that contains a relative rounding of its centre, and with a better lower bound."""
        size = np.abs(self.centre)
        radius = self.radius + by * size
        return Disc(self.centre, radius, np.fmax(np.fmax(size - radius, np.multiply(least, 1.0 - 1e-14)), 0.0))
