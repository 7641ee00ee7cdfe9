"""Find the constant interval behind a column of times that were rounded when they were written."""

from __future__ import annotations

import numpy as np

from stickslip.foundation.arrays import Floats
from stickslip.foundation.errors import InputError

MOST_DECIMALS = 9
"""Times with more decimals than this are taken as exact to so many."""
LAST_DIGIT = 0.5001
"""A number that was rounded is off by at most this share (1) of a unit of its last digit."""
SINGLE = 2.0**-24
"""Largest rounding (1) of a number of four bytes, as many recorders keep times."""
LEAST_DIGITS, MOST_DIGITS = 1, 15
"""An interval is taken to be the number with the fewest significant digits, within these bounds, that fits all times."""


def interval_of(times: Floats) -> float:
    """Return the constant interval (s) between times (s) that may have been rounded to some decimals.

    It is one over a whole number of samples per second, if such a rate fits, and else the shortest number that does. Raises
    InputError that says where the interval changes, if there is none.
    """
    if (count := len(times)) < 2:
        raise InputError(f"a record needs at least two samples, got {count}")
    since = times - times[0]
    off = _rounding(times) * (1.0 if times[0] == 0.0 else 2.0) + SINGLE * np.abs(times[1:])
    place = np.arange(1.0, count)
    least, most = (since[1:] - off) / place, (since[1:] + off) / place
    low, high = float(least.max()), float(most.min())
    if not high > 0.0 or low > high:
        raise InputError(_where_it_changes(times))
    return _simplest(max(low, 0.0), high)


def _rounding(times: Floats) -> float:
    """Return by how much (s) times may be off, from the decimals that they have."""
    for decimals in range(MOST_DECIMALS + 1):
        many = times * 10.0**decimals
        if np.abs(many - np.rint(many)).max() <= 1e-6 + SINGLE * np.abs(many).max():
            return LAST_DIGIT * 10.0**-decimals
    return LAST_DIGIT * 10.0**-MOST_DECIMALS


def _simplest(low: float, high: float) -> float:
    """Return the simplest number from low to high (s): one over a whole rate, or the one with the fewest digits."""
    middle = 0.5 * (low + high)
    rate = round(1.0 / middle)
    if rate > 1 and low <= 1.0 / rate <= high and not low <= 1.0 / (rate + 1) and not 1.0 / (rate - 1) <= high:
        return 1.0 / rate
    for digits in range(LEAST_DIGITS, MOST_DIGITS + 1):
        found = float(f"{middle:.{digits - 1}e}")
        if low <= found <= high:
            return found
    return middle


def _where_it_changes(times: Floats) -> str:
    """Return where a column of times first leaves the interval that most of it has, in words."""
    steps = np.diff(times)
    usual = float(np.median(steps))
    if usual <= 0.0:
        usual = float((times[-1] - times[0]) / (len(times) - 1))
    k = int(np.argmax(np.abs(steps - usual)))
    found = f"the interval varies: it is {usual:.6g} s, but from {times[k]:.9g} to {times[k + 1]:.9g} s it is {steps[k]:.6g} s"
    if steps[k] <= 0.0:
        return f"{found}: sort the rows, or keep one of each time"
    missing = round(float(steps[k]) / usual) - 1
    cure = f"fill this gap of {missing} sample{'s' * (missing > 1)}" if missing > 0 else "resample the record evenly"
    return f"{found}: {cure}, or give the points as piecewise-linear"
