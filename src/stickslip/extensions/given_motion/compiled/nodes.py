"""Radau's points of a step of a state, with the matrices of collocation at them (Hairer & Wanner 1996, section IV.5).

A step is [0, 1]. Point 0 is its start, points 1 to STATE_STAGES are Radau's, and the last one is its end.
"""

from __future__ import annotations

import numpy as np
from numpy.polynomial import legendre

from stickslip.foundation.arrays import Floats

STATE_STAGES = 5
"""Number of Radau points in a step (1), which gives order 9 at the ends of steps and 6 between them."""
PLACES_IN_STEP = STATE_STAGES + 1
"""Number of points with the start of the step (1)."""


def _radau_points() -> Floats:
    """Return 0 and the zeros of P_s - P_(s-1), mapped to [0, 1] (P is a Legendre polynomial); the last one is 1."""
    series = np.zeros(STATE_STAGES + 1)
    series[-2:] = -1.0, 1.0
    zeros = np.sort(legendre.legroots(series).real)
    for _ in range(3):
        zeros -= legendre.legval(zeros, series) / legendre.legval(zeros, legendre.legder(series))
    zeros[-1] = 1.0
    return np.append(0.0, 0.5 * (1.0 + zeros))


def values_at_places(places: Floats) -> Floats:
    """Return a matrix whose row i gives the value at place i of the polynomial through values at the points."""
    gaps = places[:, None] - PLACES_OF_POINTS
    hit = gaps == 0.0
    basis = WEIGHTS / np.where(hit, 1.0, gaps)
    found = basis / basis.sum(axis=1, keepdims=True)
    return np.asarray(np.where(hit.any(axis=1, keepdims=True), hit, found), float)


PLACES_OF_POINTS = _radau_points()
"""The points of a step, from 0 to 1 (1)."""
_GAPS = PLACES_OF_POINTS[:, None] - PLACES_OF_POINTS + np.eye(PLACES_IN_STEP)
WEIGHTS = 1.0 / _GAPS.prod(axis=1)
"""The barycentric weights of interpolation at the points."""
SLOPES = WEIGHTS / WEIGHTS[:, None] / _GAPS
"""Matrix from values at the points to derivatives at the points."""
np.fill_diagonal(SLOPES, 0.0)
np.fill_diagonal(SLOPES, -SLOPES.sum(axis=1))
BETWEEN_POINTS = 0.5 * (PLACES_OF_POINTS[1:] + PLACES_OF_POINTS[:-1])
"""Places halfway between the points (1), where the defect of a step is measured: it is 0 at the points."""
VALUES_BETWEEN = values_at_places(BETWEEN_POINTS)
"""Matrix from values at the points to values at these places."""
SLOPES_BETWEEN = VALUES_BETWEEN @ SLOPES
"""Matrix from values at the points to derivatives at these places."""
