"""Values of polynomials at many places, each place on a polynomial of its own: a table of series, a row and a place for each."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from stickslip.foundation.arrays import Floats


@np.errstate(under="ignore")  # the last coefficients of a short step vanish
def horner(coefficients: Floats, x: Floats) -> Floats:
    """Evaluate polynomials (one per row, ascending coefficients) at x (one value per row)."""
    value = coefficients[:, -1].copy()
    for k in range(coefficients.shape[1] - 2, -1, -1):
        value *= x
        value += coefficients[:, k]
    return value


def values_at(series: Floats, row: NDArray[np.intp], x: Floats) -> Floats:
    """Evaluate the polynomial series[row[n]] (ascending coefficients) at x[n]."""
    rows, place = _needed(row)
    return horner(_spread(series[rows], place), x)


@np.errstate(under="ignore")
def integrals_at(series: Floats, speed: Floats, bend: Floats, row: NDArray[np.intp], x: Floats) -> Floats:
    """Integrate the polynomial series[row[n]] from 0 to x[n] over a time with d time = (speed + 2 bend x) dx."""
    rows, place = _needed(row)
    series, speed, bend = series[rows], speed[rows, None], bend[rows, None]
    powers = np.arange(1, series.shape[1] + 1)
    straight = x * horner(_spread(speed * series / powers, place), x)
    return straight + x**2 * horner(_spread(2.0 * bend * series / (powers + 1), place), x) if bend.any() else straight


def _needed(row: NDArray[np.intp]) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Return rows of a table among which are all that are asked for, at most as many, and where in them each one is."""
    first, last = (int(row.min()), int(row.max())) if len(row) else (0, -1)
    if last - first < len(row):
        return np.arange(first, last + 1), row - first
    return row, np.arange(len(row))


def _spread(series: Floats, place: NDArray[np.intp]) -> Floats:
    """Return series[place], with the coefficients of one power beside each other in memory, as Horner's rule takes them."""
    return np.take(np.ascontiguousarray(series.T), place, axis=1).T
