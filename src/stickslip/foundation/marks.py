"""Marks of missing numbers: what loggers and programs write where nothing was measured."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from stickslip.foundation.arrays import Floats

MARKS = (-999.0, -999.25, -9999.0, -9999.25, -99999.0)
"""Numbers that stand for none in the logs of many programs."""
HUGE = 1e20
"""Numbers of this size are marks as well, as 1e30 and 1.7e38: no quantity of a test reaches it in any unit."""
CLOSE_TO_MARK = 0.01
"""A number before or after that is as close to a mark as this share of it makes the mark a number of the same curve."""
FACTOR_OF_MARK = 6.0
"""A mark may be off what its neighbours make likely by so much more than half of the other samples are off."""
AROUND = 16
"""Number of samples to each side that say how much a column changes from sample to sample."""
MARKS_TOGETHER = 10_000
"""Number of marks that are looked at together, so that memory is bounded."""


def marked(values: Floats, declared: float | None = None) -> NDArray[np.bool_]:
    """Return True where a column, in the unit in which it is written, holds a mark of a missing number, in runs of any length.

    `declared` is the mark that the file itself names. The other marks are ordinary numbers, too. One of them is data if its curve
    passes through it: if the last or the next number beside it is within 1 % of it, if it alone lies between the two, or if it is
    no farther from the straight line between them than six times what is usual for the samples around, or in the column.
    """
    with np.errstate(invalid="ignore"):
        found = np.abs(values) >= HUGE
    found &= np.isfinite(values)
    if declared is not None:
        found |= values == declared
    maybe = np.zeros(len(values), bool)
    for mark in MARKS:
        maybe |= values == mark
    maybe &= ~found
    if maybe.any():
        found[maybe] = ~_continues(values, maybe, np.flatnonzero(np.isfinite(values) & ~found & ~maybe))[_run_of(values, maybe)]
    return np.asarray(found)


def _begins(values: Floats, maybe: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Return True for the first sample of each run of one mark."""
    same = maybe[1:] & maybe[:-1] & (values[1:] == values[:-1])
    return np.asarray(maybe & ~np.append(False, same))


def _run_of(values: Floats, maybe: NDArray[np.bool_]) -> NDArray[np.intp]:
    """Return the number of the run of each marked sample."""
    return np.asarray(np.cumsum(_begins(values, maybe))[maybe] - 1)


def _continues(values: Floats, maybe: NDArray[np.bool_], known: NDArray[np.intp]) -> NDArray[np.bool_]:
    """Return True for each run of a mark that continues the numbers at the indices `known`; see `marked`."""
    begins = np.flatnonzero(_begins(values, maybe))
    if not len(known):
        return np.zeros(len(begins), bool)
    numbers, marks = values[known], values[begins]
    lengths = np.bincount(_run_of(values, maybe))
    place = np.searchsorted(known, begins)  # of the next number among those that are known
    before = np.where(place > 0, numbers[np.maximum(place - 1, 0)], np.nan)
    after = np.where(place < len(known), numbers[np.minimum(place, len(known) - 1)], np.nan)
    close = np.fmin(np.abs(before - marks), np.abs(after - marks)) <= CLOSE_TO_MARK * np.abs(marks)
    between = (np.minimum(before, after) <= marks) & (marks <= np.maximum(before, after)) & (lengths == 1)
    inside = np.isfinite(before) & np.isfinite(after)
    likely = np.where(inside, 0.5 * (before + after), np.where(np.isfinite(before), before, after))
    usual = np.where(inside, _usual(_bends(numbers), place), _usual(np.abs(np.diff(numbers)), place))
    return np.asarray(close | between | (np.abs(marks - likely) <= FACTOR_OF_MARK * usual))


def _bends(numbers: Floats) -> Floats:
    """Return how far each number but the first and the last is from the mean of its neighbours."""
    return np.asarray(np.abs(numbers[1:-1] - 0.5 * (numbers[:-2] + numbers[2:])))


def _usual(changes: Floats, places: NDArray[np.intp]) -> Floats:
    """Return the median of the changes around each place, or of all of them if that is larger; 0 if there are none."""
    if not len(changes):
        return np.zeros(len(places))
    everywhere, found = float(np.median(changes)), []
    for begin in range(0, len(places), MARKS_TOGETHER):
        window = places[begin : begin + MARKS_TOGETHER, None] + np.arange(-AROUND, AROUND)
        outside = (window < 0) | (window >= len(changes))
        around = np.where(outside, np.nan, changes[np.clip(window, 0, len(changes) - 1)])
        around[np.isnan(around).all(axis=1)] = everywhere
        found.append(np.nanmedian(around, axis=1))
    return np.asarray(np.maximum(np.concatenate(found), everywhere))


def sentences(values: Floats, where: NDArray[np.bool_], name: str) -> list[str]:
    """Return a sentence for each kind of mark in a column, `where` it is marked."""
    found = []
    for mark in np.unique(values[where]).tolist():
        count = int((values[where] == mark).sum())
        found.append(f"{mark:.7g} marks a missing number of {name} in {count} row{'s' * (count > 1)}")
    return found
