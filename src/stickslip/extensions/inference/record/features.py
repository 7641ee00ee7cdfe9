"""Features of slip events: shear before and after its fall, duration of the fall, time between events, slip and peak slip rate.

Features of a record and of a run are measured in the same way. They are means and moments, not single samples or level crossings:
noise does not shift them, and they change smoothly with the numbers of a problem.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from stickslip.extensions.inference.record.noise import noise_of
from stickslip.foundation.arrays import Floats
from stickslip.foundation.show import brief

LEVELS_OF_SHEAR = ("peak", "rest", "drop")
"""Features of shear, appended to its name as in "friction_peak": shear before the fall, after it, and the difference."""
FEATURES = ("recurrence", "duration", "event_slip", "peak_rate")
"""Other features of events."""
DROP, OF_RANGE, ABOVE_NOISE = 0.25, 0.25, 8.0
"""Least fall of shear in a slip event: as a share of the usual fall, of the range of shear, and in standard deviations of noise."""
BESIDE_EVENT = 0.15
"""Length of the straight lines before and after an event, as a share of the time to the event on that side."""
BEGUN, ENDED = 0.1, 0.9
"""A first estimate of a fall extends between these shares of the drop."""
SMOOTHED = 0.2
"""The peak slip rate is the largest mean over this share of the duration of the fall."""
SMALLEST_DROP = 1e-3
"""Smallest drop of a record without noise, as a share of its range."""
NUMBER_OF_MEANS = 64
"""Number of such means."""

Between = Callable[[float, float], "Samples"]
"""A function that gives the samples between two times."""


class Samples(NamedTuple):
    """Times (s) in ascending order (repeats allowed), and the values measured then, by name (SI)."""

    time: Floats
    values: Mapping[str, Floats]


class Fall(NamedTuple):
    """A first estimate of a fall of shear: its time, its duration, and the times of the neighbouring falls."""

    at: float
    lasts: float
    after: float
    before: float


def features_in(all_of_it: Samples, between: Between, shear: str) -> dict[str, Floats]:
    """Return the features of each slip event except the first, by name, and the "time" of its fall (s); empty without events.

    If contact and machine move backwards, shear and slip are negative and count by their magnitude.
    """
    sign = direction_of(all_of_it.values[shear])

    def forwards(begin: float, end: float) -> Samples:
        one = between(begin, end)
        return one if sign > 0.0 else Samples(one.time, {name: -values for name, values in one.values.items()})

    falls = _falls(all_of_it.time, sign * all_of_it.values[shear])
    measured = [None if fall is None else _measured(fall, forwards, shear) for fall in falls]
    pairs = [(before, this) for before, this in pairwise(measured) if before is not None and this is not None]
    if not pairs:
        return {}
    found = {name: np.array([this[name] for _, this in pairs]) for name in pairs[0][1]}
    return {**found, "recurrence": np.array([this["time"] - before["time"] for before, this in pairs])}


def levels_in(found: Mapping[str, Floats], between: Between, shear: str) -> dict[str, Floats]:
    """Return the levels of shear as tables of events have them: the largest before a fall, the smallest after it.

    `found` are the features of events, with their times. Half a recurrence belongs to each side of an event.
    """
    peaks, rests = list[float](), list[float]()
    for at, lasts in zip(found["time"].tolist(), (0.5 * found["recurrence"]).tolist(), strict=True):
        around = between(at - lasts, at + lasts)
        values = direction_of(around.values[shear]) * around.values[shear]
        top = int(np.argmax(np.where(around.time <= at, values, -math.inf)))
        peaks.append(float(values[top]))
        rests.append(float(np.min(values[top:])))
    peak, rest = np.array(peaks), np.array(rests)
    return dict(zip((f"{shear}_{level}" for level in LEVELS_OF_SHEAR), (peak, rest, peak - rest), strict=True))


def direction_of(shear: Floats) -> float:
    """Return 1, or -1 if shear is negative most of the time."""
    return -1.0 if np.nanmedian(shear) < 0.0 else 1.0


def _falls(time: Floats, shear: Floats) -> list[Fall | None]:
    """Return the falls of shear in their order, None for one that has no samples on one of its sides."""
    found, last = list[tuple[float, float] | None](), 0
    shear = _without_lone(shear)
    for bottom in arrests_in(shear).tolist():
        top = last + int(np.argmax(shear[last : bottom + 1]))
        high, low = (shear[top] - share * (shear[top] - shear[bottom]) for share in (BEGUN, ENDED))
        falling = shear[top : bottom + 1]
        first = top + int(np.flatnonzero(falling >= high)[-1])
        end = top + int(np.flatnonzero(falling <= low)[0])
        found.append((_crossing(time, shear, first, high), _crossing(time, shear, end - 1, low)) if end > first else None)
        last = bottom
    falls, after = list[Fall | None](), float(time[0])
    for i, one in enumerate(found):
        before = next((later[0] for later in found[i + 1 :] if later is not None), float(time[-1]))
        falls.append(None if one is None else Fall(one[0], max(one[1] - one[0], 0.0), after, before))
        after = after if one is None else one[1]
    return falls


def _crossing(time: Floats, shear: Floats, i: int, level: float) -> float:
    """Return when shear falls to a level between two samples."""
    step = shear[i] - shear[i + 1]
    share = float(np.clip((shear[i] - level) / step, 0.0, 1.0)) if step > 0.0 else 1.0
    return float(time[i] + share * (time[i + 1] - time[i]))


def _measured(fall: Fall, between: Between, shear: str) -> dict[str, float] | None:
    """Return the features of one event; None if there is too little beside it.

    Straight lines before and after an event, extended to the time of its fall, give peak and rest. The share of the fall completed
    so far is a distribution over time: its mean is the time of the event, and twice its standard deviation is the duration. For
    two jumps of equal height this duration is the time between them. The force of a block falls along a cosine, which takes 2.3
    times this duration.
    """
    begin, end = fall.at - fall.lasts, fall.at + 2.0 * fall.lasts
    before, after = (begin - BESIDE_EVENT * (fall.at - fall.after), begin), (end, end + BESIDE_EVENT * (fall.before - fall.at))
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
    peak, rest = float(upper(at)), float(lower(at))
    found = {"time": at, f"{shear}_peak": peak, f"{shear}_rest": rest, f"{shear}_drop": peak - rest}
    found["duration"] = 2.0 * math.sqrt(spread) if spread > 0.0 else math.nan
    if "slip" in inside.values:
        ends = [_line(one, "slip") for one in beside]
        found["event_slip"] = math.nan if ends[0] is None or ends[1] is None else ends[1](at) - ends[0](at)
    if "slip_rate" in inside.values:
        found["peak_rate"] = _peak(inside, SMOOTHED * found["duration"])
    return found if found[f"{shear}_drop"] > 0.0 else None


def _moments(left: Floats, time: Floats) -> tuple[float, float]:
    """Return mean and mean square of a time from the share still to fall at each sample.

    For a smooth fall, sums over samples make the variance too small by a sixth of the squared sampling interval, and straight lines
    between samples make it too large by as much (Euler & Maclaurin). The mean square is the average of both.
    """
    lasts, before, after = np.diff(time), left[:-1], left[1:]
    weighed = time[:-1] * (5.0 * before + after) + time[1:] * (before + 5.0 * after)
    return float(lasts @ (before + after)) / 2.0, float(lasts @ weighed) / 6.0


def _known(samples: Samples, name: str) -> tuple[Floats, Floats]:
    known = np.isfinite(samples.values[name])
    return samples.time[known], samples.values[name][known]


def _line(samples: Samples, name: str) -> Callable[[Any], Any] | None:
    """Return the straight line through some samples as a function of time; None for fewer than three."""
    time, values = _known(samples, name)
    if len(time) < 3 or time[-1] <= time[0]:
        return None
    ends = np.concatenate([[time[0]], 0.5 * (time[1:] + time[:-1]), [time[-1]]])  # each sample counts by the time it stands for
    middle = 0.5 * (time[0] + time[-1])
    slope, level = np.polyfit(time - middle, values, 1, w=np.sqrt(np.diff(ends))).tolist()
    return lambda at: level + slope * (at - middle)


def _peak(samples: Samples, over: float) -> float:
    """Return the largest mean of the slip rate over a time `over` (s)."""
    time, rate = _known(samples, "slip_rate")
    if len(time) < 3 or not over > 0.0:
        return math.nan
    slipped = np.append(0.0, np.cumsum(0.5 * (rate[1:] + rate[:-1]) * np.diff(time)))
    middle = np.linspace(time[0] + 0.5 * over, time[-1] - 0.5 * over, NUMBER_OF_MEANS)
    return float(np.max(np.interp(middle + 0.5 * over, time, slipped) - np.interp(middle - 0.5 * over, time, slipped)) / over)


def arrests_in(values: Floats) -> NDArray[np.intp]:
    """Return the indices of the lowest samples after each large drop of the magnitude of shear.

    A drop is large in comparison with the usual drop. So neither the drift of a sensor nor one far larger drop, as when the machine
    is unloaded, hides events.
    """
    known = np.flatnonzero(np.isfinite(values))
    if len(known) < 2:
        return np.zeros(0, np.intp)
    shear = _without_lone(direction_of(values) * values[known])
    least, heights = _least_drop(shear)
    found = _drops(shear, least) if len(heights) else []
    return np.asarray(known[np.array([bottom for bottom, _ in found], int)], np.intp)


def about_falls(values: Floats, unit: str) -> str:
    """Return how the slip events of a record are found: the least drop that counts, and how many drops of its shear do not."""
    shear = _without_lone(direction_of(values) * values[np.isfinite(values)])
    least, heights = _least_drop(shear)
    told = (
        f"an event is a fall of more than {brief(least, unit, 3)}, the largest of {DROP:g} of the usual fall, {OF_RANGE:g} of the"
    )
    found, seen = len(_drops(shear, least)), len(heights)
    told += f" range of shear and {ABOVE_NOISE:g} times its noise: {found} of {seen} falls above the noise are as large"
    return f"{told}, and the first of them has no event before it" if found else told


def _least_drop(shear: Floats) -> tuple[float, Floats]:
    """Return the least drop of a slip event, and the heights of all drops above the noise."""
    noise = ABOVE_NOISE * noise_of(shear)
    heights = np.array([height for _, height in _drops(shear, max(noise, SMALLEST_DROP * float(np.ptp(shear))))])
    if not len(heights):
        return noise, heights
    sizes = np.sort(heights)[::-1]
    usual = sizes[int(np.searchsorted(np.cumsum(sizes), 0.5 * float(sizes.sum())))]  # half of all that falls, falls in such drops
    low, high = np.quantile(_without_trend(shear), [0.01, 0.99])
    return max(DROP * float(usual), OF_RANGE * float(high - low), noise), heights


def _without_trend(shear: Floats) -> Floats:
    """Return shear minus its least-squares line."""
    place = np.linspace(-1.0, 1.0, len(shear))
    return np.asarray(shear - shear.mean() - place * (place @ shear) / (place @ place))


def _drops(shear: Floats, least: float) -> list[tuple[int, float]]:
    """Return the index of the lowest sample, and the height, of each drop larger than `least`."""
    found, falling, top, bottom = list[tuple[int, float]](), False, 0, 0
    values = shear.tolist()
    for i, value in enumerate(values):
        if falling:
            if value < values[bottom]:
                bottom = i
            elif value > values[bottom] + 0.5 * least:
                found.append((bottom, values[top] - values[bottom]))
                falling, top = False, i
        elif value > values[top]:
            top = i
        elif value < values[top] - least:
            falling, bottom = True, i
    if falling and bottom < len(values) - 1:
        found.append((bottom, values[top] - values[bottom]))
    return found


def _without_lone(shear: Floats) -> Floats:
    """Return the median of each sample and its neighbours, so that a lone sample far off is no event."""
    if len(shear) < 3:
        return shear
    inner = np.median([shear[:-2], shear[1:-1], shear[2:]], axis=0)
    return np.concatenate([shear[:1], inner, shear[-1:]])
