"""Derivatives from seven values of a function beside each other, of orders 2, 4 and 6, and how far they can be trusted."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from stickslip.foundation.arrays import Floats

SIDES = {"both": (0, 1, -1, 2, -2, 3, -3), "above": (0, 1, 2, 3, 4, 5, 6), "below": (0, -1, -2, -3, -4, -5, -6)}
"""Places of the seven values in steps, by the side on which they lie: the first three give the order 2, five 4, and all 6."""
ROUNDING_SHARE = 4.0 * float(np.finfo(float).eps)
"""Rounding of one value (1), as a share of the largest."""
SPARE_NOISE = 3.0
"""The noise that is counted, over that which is measured (1): a value beside others has more than they by chance."""


class Slope(NamedTuple):
    """The derivatives of several functions and estimates of their errors, in the unit of the derivatives."""

    slope: Floats
    error: Floats
    noise: Floats
    """That part of the errors which is noise of the values."""


def weights(places: tuple[int, ...]) -> Floats:
    """Return the factors of values at these places (steps) in the derivative at 0, times the step."""
    powers = np.vander(np.array(places, float), increasing=True).T
    return np.linalg.solve(powers, np.eye(len(places))[1])


def sixth_difference(values: Floats, side: str) -> Floats:
    """Return the sixth difference of seven values, over what noise of size 1 in each makes of it."""
    order = np.argsort(SIDES[side])
    factors = np.array([1.0, -6.0, 15.0, -20.0, 15.0, -6.0, 1.0])
    return np.asarray(np.abs(factors @ values[order]) / np.linalg.norm(factors))


def slope_of(values: Floats, side: str, step: float) -> Slope:
    """Return the derivative of each column of `values`, with seven rows in the order of SIDES, a `step` apart.

    The error has two parts: the difference between the derivatives of orders 6 and 4, which is the error of the latter where the
    function is smooth, and the noise of the values. That is measured by their sixth difference, which sees a kink at the middle,
    too: there all orders agree on the mean of the slopes to both sides.
    """
    places = SIDES[side]
    fourth, sixth = (weights(places[:count]) @ values[:count] / step for count in (5, 7))
    left = sixth_difference(values, side)
    noise = np.maximum(left, np.median(left)) + ROUNDING_SHARE * np.abs(values).max()
    noise *= SPARE_NOISE * float(np.linalg.norm(weights(places))) / step
    return Slope(sixth, np.abs(sixth - fourth) + noise, noise)
