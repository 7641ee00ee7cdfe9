"""Distance between two runs in slip, and the time at which a run passes a slip rate that another one jumps over."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from stickslip.contact.roots import sign_change
from stickslip.foundation.arrays import Floats
from stickslip.solution.solution import Solution

UNIFORM = 2001
"""Number of evenly spaced times at which runs are compared; times within the pieces of both histories are added."""
INSIDE = np.linspace(0.0, 1.0, 5)[:-1]
"""Positions of the times within each piece of a history, as shares of its length."""


@dataclass(frozen=True)
class Difference:
    """A difference in slip between two runs (m): mean and largest magnitude over time, and signed value at the end."""

    mean: float
    largest: float
    end: float


def difference(one: Solution, other: Solution, until: float) -> Difference:
    """Return the slip of `one` minus the slip of `other`, from t = 0 to `until` (s)."""
    time = np.unique(np.concatenate([np.linspace(0.0, until, UNIFORM), _inside(one, 0.0, until), _inside(other, 0.0, until)]))
    gap = one.slip(time) - other.slip(time)
    mean = float(np.trapezoid(np.abs(gap), time)) / until
    return Difference(mean, float(np.abs(gap).max()), float(gap[-1]))


def _inside(solution: Solution, start: float, end: float) -> Floats:
    """Return times from start to end (s), four in every piece of the history, and the end."""
    breaks = solution.breaks
    times = (breaks[:-1, None] + np.diff(breaks)[:, None] * INSIDE).ravel()
    return np.append(times[(times >= start) & (times <= end)], min(end, float(breaks[-1])))


def passage(solution: Solution, level: float, rising: bool, near: float, span: tuple[float, float]) -> float:
    """Return the time (s) in a span (start, end) at which the slip rate passes a level (m/s), upwards if `rising`.

    If there are several such times, the result is the one nearest to `near`; it is NaN if there is none.
    """
    time = _inside(solution, *span)
    beyond = (solution.slip_rate(time) > level) == rising
    steps = np.flatnonzero(beyond[1:] & ~beyond[:-1])
    if not steps.size:
        return math.nan
    step = int(steps[np.argmin(np.abs(time[steps] - near))])
    way = 1.0 if rising else -1.0
    return sign_change(lambda t: way * (float(solution.slip_rate(t)) - level), float(time[step]), float(time[step + 1]))
