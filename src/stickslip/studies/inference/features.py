"""Features of slip events: drop and duration of the fall of shear, time between events, slip and peak slip rate.

A record and a run are measured in the same way. Means and moments stand in place of single samples and crossings of levels, so that
noise does not shift them and that they change smoothly with the numbers of a problem.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from stickslip.foundation.arrays import Floats
from stickslip.studies.inference.noise import noise_of

DROPS = ("friction_drop", "shear_stress_drop", "shear_force_drop")
"""Names of the fall of shear in an event, by what was measured."""
FEATURES = (*DROPS, "recurrence", "duration", "event_slip", "peak_rate")
"""Everything that is known of events."""
DROP, ABOVE_NOISE = 0.25, 8.0
"""Fall of shear that is a slip event: as a share of the range of the record, and in standard deviations of its noise."""
BESIDE = 0.15
"""Length of the straight lines before and after an event, as a share of the time to the event on that side."""
LEVELS = 0.1, 0.9
"""Shares of the drop between which a fall is looked at first."""
SMOOTHED = 0.2
"""Time over which a slip rate is averaged before its peak is taken, as a share of the duration of the fall."""
GRID = 64
"""Number of times at which such means are taken."""

Between = Callable[[float, float], "Samples"]
"""A function that gives the samples between two times."""


class Samples(NamedTuple):
    """Times (s) that do not descend, and what was measured then, by name (SI)."""

    time: Floats
    values: Mapping[str, Floats]


class Fall(NamedTuple):
    """A fall of shear, as its samples show it at first: its time, its length, and the times between which nothing else falls."""

    at: float
    lasts: float
    after: float
    before: float


def features_in(all_of_it: Samples, between: Between, shear: str) -> dict[str, Floats]:
    """Return the features of each slip event but the first by name, and "time", that of its fall (s); empty without events."""
    falls = _falls(all_of_it.time, all_of_it.values[shear])
    measured = [one for fall in falls if (one := _measured(fall, between, shear)) is not None]
    if len(measured) < 2:
        return {}
    time = np.array([one["time"] for one in measured])
    found = {name: np.array([one[name] for one in measured[1:]]) for name in measured[0]}
    return {**found, "recurrence": np.diff(time)}


def _falls(time: Floats, shear: Floats) -> list[Fall]:
    """Return the falls of shear, without one that has no samples on one of its sides."""
    found, last = list[tuple[float, float]](), 0
    for bottom in arrests_in(shear).tolist():
        top = last + int(np.argmax(shear[last : bottom + 1]))
        high, low = (shear[top] - share * (shear[top] - shear[bottom]) for share in LEVELS)
        falling = shear[top : bottom + 1]
        first = top + int(np.flatnonzero(falling >= high)[-1])
        end = top + int(np.flatnonzero(falling <= low)[0])
        if end > first:
            found.append((_crossing(time, shear, first, high), _crossing(time, shear, end - 1, low)))
        last = bottom
    if not found:
        return []
    begins = [time[0], *(end for _, end in found[:-1])]
    ends = [*(begin for begin, _ in found[1:]), time[-1]]
    return [
        Fall(begin, max(end - begin, 0.0), after, before) for (begin, end), after, before in zip(found, begins, ends, strict=True)
    ]


def _crossing(time: Floats, shear: Floats, i: int, level: float) -> float:
    """Return when shear falls to a level between two samples."""
    step = shear[i] - shear[i + 1]
    share = float(np.clip((shear[i] - level) / step, 0.0, 1.0)) if step > 0.0 else 1.0
    return float(time[i] + share * (time[i + 1] - time[i]))


def _measured(fall: Fall, between: Between, shear: str) -> dict[str, float] | None:
    """Return the features of one event; None if there is too little beside it.

    Shear falls from the straight line before an event to the one after it. The share that has fallen is a distribution over time:
    its mean is the time of the event, and twice its standard deviation the duration. Two jumps of equal height are as far apart,
    and the force of a block, which falls along a cosine, takes 2.3 times as long.
    """
    begin, end = fall.at - fall.lasts, fall.at + 2.0 * fall.lasts
    before, after = (begin - BESIDE * (fall.at - fall.after), begin), (end, end + BESIDE * (fall.before - fall.at))
    if before[0] < fall.after or after[1] > fall.before or fall.lasts <= 0.0:
        return None
    beside = [between(*window) for window in (before, after)]
    upper, lower = (_line(one, shear) for one in beside)
    if upper is None or lower is None:
        return None
    inside = between(begin, end)
    time = np.concatenate([[begin], inside.time, [end]])
    high, low = upper(time), lower(time)
    left = np.concatenate([[1.0], (inside.values[shear] - low[1:-1]) / (high - low)[1:-1], [0.0]])
    mean, square = _moments(left, time - begin)
    spread, at = square - mean**2, begin + mean
    found = {"time": at, f"{shear}_drop": upper(at) - lower(at)}
    found["duration"] = 2.0 * math.sqrt(spread) if spread > 0.0 else math.nan
    if "slip" in inside.values:
        ends = [_line(one, "slip") for one in beside]
        found["event_slip"] = math.nan if ends[0] is None or ends[1] is None else ends[1](at) - ends[0](at)
    if "slip_rate" in inside.values:
        found["peak_rate"] = _peak(inside, SMOOTHED * found["duration"])
    return found if found[f"{shear}_drop"] > 0.0 else None


def _moments(left: Floats, time: Floats) -> tuple[float, float]:
    """Return mean and mean square of a time from the share that is left at each sample.

    Sums at samples make the variance of a smooth fall too small by a sixth of the squared sampling interval, and straight lines
    between samples make it too large by as much (Euler & Maclaurin): the mean square is the mean of both.
    """
    lasts, before, after = np.diff(time), left[:-1], left[1:]
    weighed = time[:-1] * (5.0 * before + after) + time[1:] * (before + 5.0 * after)
    return float(lasts @ (before + after)) / 2.0, float(lasts @ weighed) / 6.0


def _line(samples: Samples, name: str) -> Callable[[Any], Any] | None:
    """Return the straight line through some samples as a function of time; None for fewer than three."""
    time, values = samples.time, samples.values[name]
    if len(time) < 3 or time[-1] <= time[0]:
        return None
    ends = np.concatenate([[time[0]], 0.5 * (time[1:] + time[:-1]), [time[-1]]])  # each sample counts as long as it stands for
    middle = 0.5 * (time[0] + time[-1])
    slope, level = np.polyfit(time - middle, values, 1, w=np.sqrt(np.diff(ends))).tolist()
    return lambda at: level + slope * (at - middle)


def _peak(samples: Samples, over: float) -> float:
    """Return the largest mean of the slip rate over some time."""
    time, rate = samples.time, samples.values["slip_rate"]
    if len(time) < 3 or not over > 0.0:
        return math.nan
    slipped = np.append(0.0, np.cumsum(0.5 * (rate[1:] + rate[:-1]) * np.diff(time)))
    middle = np.linspace(time[0] + 0.5 * over, time[-1] - 0.5 * over, GRID)
    return float(np.max(np.interp(middle + 0.5 * over, time, slipped) - np.interp(middle - 0.5 * over, time, slipped)) / over)


def arrests_in(values: Floats) -> NDArray[np.intp]:
    """Return the indices of the lowest samples after each large drop."""
    known = np.flatnonzero(np.isfinite(values))
    shear = values[known]
    low, high = np.quantile(shear, [0.01, 0.99])
    drop = max(DROP * float(high - low), ABOVE_NOISE * noise_of(shear))
    found, falling, top, bottom = [], False, 0, 0
    for i, value in enumerate(shear.tolist()):
        if falling:
            if value < shear[bottom]:
                bottom = i
            elif value > shear[bottom] + 0.5 * drop:
                found.append(bottom)
                falling, top = False, i
        elif value > shear[top]:
            top = i
        elif value < shear[top] - drop:
            falling, bottom = True, i
    if falling and bottom < len(shear) - 1:
        found.append(bottom)
    return np.asarray(known[np.array(found, int)], np.intp)
