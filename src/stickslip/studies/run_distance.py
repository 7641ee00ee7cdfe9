"""How far two runs are apart, and when a run does what another one does in a jump."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from stickslip.solution.solution import Solution
from stickslip.trajectory.history import Floats

UNIFORM = 2001
"""Times at which runs are compared at least; more where either of them varies."""
INSIDE = np.linspace(0.0, 1.0, 5)[:-1]
"""Where in each piece of a history, as shares of its length."""
HALVINGS = 80


@dataclass(frozen=True)
class Difference:
    """Of the slip of two runs (m): mean and largest magnitude over time, and the difference at the end."""

    mean: float
    largest: float
    end: float


def difference(one: Solution, other: Solution, until: float) -> Difference:
    """Slip of `one` minus slip of `other` from t = 0 to `until` (s)."""
    time = np.unique(np.concatenate([np.linspace(0.0, until, UNIFORM), _inside(one, 0.0, until), _inside(other, 0.0, until)]))
    gap = one.slip(time) - other.slip(time)
    mean = float(np.trapezoid(np.abs(gap), time)) / until
    return Difference(mean, float(np.abs(gap).max()), float(gap[-1]))


def _inside(solution: Solution, start: float, end: float) -> Floats:
    """Times from start to end (s), some in every piece of the history."""
    breaks = solution.breaks
    times = (breaks[:-1, None] + np.diff(breaks)[:, None] * INSIDE).ravel()
    return np.append(times[(times >= start) & (times <= end)], min(end, float(breaks[-1])))


def passage(solution: Solution, level: float, rising: bool, near: float, start: float, end: float) -> float:
    """When the slip rate passes a level (m/s) up- or downwards between start and end (s): the time nearest to `near`, or NaN."""
    time = _inside(solution, start, end)
    beyond = (solution.slip_rate(time) > level) == rising
    steps = np.flatnonzero(beyond[1:] & ~beyond[:-1])
    if not steps.size:
        return math.nan
    step = int(steps[np.argmin(np.abs(time[steps] - near))])
    low, high = float(time[step]), float(time[step + 1])
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        if not low < middle < high:
            break
        if (float(solution.slip_rate(middle)) > level) == rising:
            high = middle
        else:
            low = middle
    return high
