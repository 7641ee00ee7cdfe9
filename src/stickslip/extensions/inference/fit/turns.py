"""Moments when the drive or the normal load changes: what the run then does has its time from them, and is no event that moves."""

from __future__ import annotations

import numpy as np

from stickslip.extensions.inference.record.resample import Jumps
from stickslip.foundation.arrays import Floats
from stickslip.problem import LoadingHistory, Problem

CHANGES = 0.1
"""A change of the pull rate counts if it is at least this share of the rate's range."""
PRESSED = 0.01
"""A change of the normal load counts if it reaches this share (1) of it within the time between two samples."""
LASTS = 4.0
"""A steep part of a curve belongs to a change of loading at most this many samples before it."""


def changes_of(history: LoadingHistory, duration: float) -> Floats:
    """Return the times (s) when a history begins to change by a tenth of its range or more, before the end of a run."""
    segments = [one for one in history.segments if one.start < duration]
    ends = [*(one.start for one in segments[1:]), duration]
    after = np.array([one.at(end) for one, end in zip(segments, ends, strict=True)])
    jumped = np.array([one.value for one in segments]) - np.append(segments[0].value, after[:-1])
    changed = np.abs(jumped) + np.abs(after - [one.value for one in segments])
    least = CHANGES * float(np.ptp(np.append(after, [one.value for one in segments])))
    return np.array([one.start for one, by in zip(segments, changed, strict=True) if by > least])


def felt(problem: Problem, duration: float, step: float) -> Floats:
    """Return the times (s) when the contact feels that drive or normal load change, ascending; samples are `step` (s) apart."""
    found = [np.zeros(0)]
    if isinstance(problem.pull_rate, LoadingHistory):
        found.append(changes_of(problem.pull_rate, duration) + problem.body.time_to_driver)
    if isinstance(problem.normal_load, LoadingHistory):
        times = problem.normal_load.parts[0]
        before = problem.normal_load.at(np.maximum(np.nextafter(times, -np.inf), 0.0))
        found.append(times[np.abs(problem.normal_load.at(times + step) - before) > PRESSED * np.abs(before)])
    return np.sort(np.concatenate(found))


def moving(jumps: Jumps, turns: Floats, step: float) -> Jumps:
    """Return the jumps of a curve without those that a change of loading makes, which do not move with the numbers of the run."""
    if not len(turns) or not len(jumps.time):
        return jumps
    last = np.searchsorted(turns, jumps.time + 1e-6 * step, side="right") - 1
    since = np.where(last >= 0, jumps.time - turns[np.maximum(last, 0)], np.inf)
    free = since > LASTS * step
    return Jumps(jumps.time[free], jumps.height[free])
