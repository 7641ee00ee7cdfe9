"""Two of Radau's methods for a linear equation: places and coefficients. One tells the error of the other."""

from __future__ import annotations

import numpy as np
from numpy.polynomial import legendre

from stickslip.foundation.arrays import Floats

STAGES = (8, 7)
"""Points of the method that is used and of the one that it is compared with (1); their orders are twice that less one."""
USED, COMPARED = range(2)
"""Places of the two in the tables."""
MOST_STAGES = max(STAGES)
"""Room for the points of a method (1)."""


def radau_places(stages: int) -> Floats:
    """Return the zeros of P_s - P_(s-1) on (0, 1], up to 1; P is a Legendre polynomial."""
    series = np.zeros(stages + 1)
    series[-2:] = -1.0, 1.0
    zeros = np.sort(legendre.legroots(series).real)
    for _ in range(3):
        zeros -= legendre.legval(zeros, series) / legendre.legval(zeros, legendre.legder(series))
    zeros[-1] = 1.0
    return np.asarray(0.5 * (1.0 + zeros))


def radau_coefficients(places: Floats) -> Floats:
    """Return the integrals from 0 to each place of the polynomials that are 1 at one place and 0 at all others."""
    count, seen = len(places), 2.0 * places - 1.0
    known = legendre.legvander(seen, count)
    integrals = np.empty((count, count))
    integrals[:, 0] = places
    for k in range(1, count):
        integrals[:, k] = (known[:, k + 1] - known[:, k - 1]) / (2.0 * (2 * k + 1))
    return np.asarray(np.linalg.solve(known[:, :count].T, integrals.T).T)


RADAU_PLACES = np.zeros((len(STAGES), MOST_STAGES))
"""Places (1) of the points in a step, for each method."""
COEFFICIENTS = np.zeros((len(STAGES), MOST_STAGES, MOST_STAGES))
"""Coefficients (1) of each method; the last row has the weights of a whole step."""
for _method, _stages in enumerate(STAGES):
    RADAU_PLACES[_method, :_stages] = radau_places(_stages)
    COEFFICIENTS[_method, :_stages, :_stages] = radau_coefficients(RADAU_PLACES[_method, :_stages])
