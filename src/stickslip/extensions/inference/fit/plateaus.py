"""Plateaus of friction at constant rates of the load point: their levels, their transients, and whether they drift."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from stickslip.extensions.inference.fit.part import Part
from stickslip.foundation.arrays import Floats
from stickslip.problem import LoadingHistory, Problem

TAIL, LEAST = 0.3, 8
"""The plateau at a constant rate is the median over this last share of its samples; it needs at least so many samples."""
SHORT_PLATEAU = 0.1
"""Parts of constant rate that are shorter than this share of the usual one, in time and in motion, belong to a step of a servo."""
ONE_PLATEAU = 0.05
"""Neighbouring parts whose rates differ by less than this share are one plateau."""
CLEAR = 5.0
"""A transient counts if it is higher than this many standard deviations of the noise."""
LAST_SHARE, MEANS = 0.5, 6
"""A drift is looked for in means over this many pieces of this last share of each plateau."""
DRIFT_WORTH_A_TRY = 2.5
"""A drift is worth a try if it is larger than this many standard errors: the fit then decides."""
APART_DRIFTS = 9.0
"""Slip and time explain a drift differently well if twice the log-likelihoods differ by this much."""


class RatePlateau(NamedTuple):
    """Friction at the end of a part of constant rate (m/s), with its samples: time (s) and friction; all as magnitudes.

    `moved` is the displacement of the load point at the first of them (m), and `way` 1 or -1, its direction.
    """

    rate: float
    friction: float
    time: Floats
    samples: Floats
    moved: float = 0.0
    way: float = 1.0

    @property
    def slip(self) -> Floats:
        """How far the load point has moved at the samples (m): slip, but for the stretch of the machine."""
        return np.asarray(self.moved + self.rate * (self.time - self.time[0]))

    def without(self, drift: PlateauDrift | None) -> RatePlateau:
        """Return the plateau as it would be without a drift."""
        if drift is None:
            return self
        samples = self.samples - (drift.value * self.slip if drift.with_slip else self.way * drift.value * self.time)
        level = float(np.median(samples[-math.ceil(TAIL * len(samples)) :]))
        return self._replace(friction=level, samples=samples)


class PlateauDrift(NamedTuple):
    """A drift of plateaus: friction per metre of slip (`with_slip`) or per second, and its standard error.

    `told` is True if the record tells slip from time. `rates` is the number of different rates, `plateaus` that of plateaus.
    """

    value: float
    error: float
    with_slip: bool
    told: bool
    rates: int
    plateaus: int

    @property
    def seen(self) -> bool:
        """True if the drift is large enough to be worth a try."""
        return abs(self.value) > DRIFT_WORTH_A_TRY * self.error


def plateaus_of(problem: Problem, part: Part, friction: Floats) -> list[RatePlateau]:
    """Return the plateaus of a part of a record, in their order.

    Stretches without motion, with too few samples, or as short as the step of a servo are skipped; the samples of the latter belong
    to the plateau after them.
    """
    known, clock = np.isfinite(friction), part.record.clock
    clock, friction = clock[known], friction[known]
    stretches = _joined(_stretches(problem.pull_rate if part.loading is None else part.loading, part.duration))
    found, moved, first = list[RatePlateau](), 0.0, 0.0
    least = _usual([one.lasts for one in stretches]), _usual([one.moves for one in stretches])
    for one in stretches:
        if one.lasts < SHORT_PLATEAU * least[0] and one.moves < SHORT_PLATEAU * least[1]:
            moved += one.moves
            continue
        inside = slice(*np.searchsorted(clock, [first, one.end]).tolist())
        time, values = clock[inside], friction[inside]
        if one.rate != 0.0 and one.steady and len(time) >= LEAST:
            level = abs(float(np.median(values[-math.ceil(TAIL * len(values)) :])))
            begun = moved - abs(one.rate) * (one.begin - float(time[0]))
            found.append(RatePlateau(abs(one.rate), level, time, np.abs(values), begun, math.copysign(1.0, one.rate)))
        moved += one.moves
        first = one.end
    return found


class _Stretch(NamedTuple):
    """A part of a loading: its times (s), its mean rate (m/s), and True if the rate is constant."""

    begin: float
    end: float
    rate: float
    steady: bool

    @property
    def lasts(self) -> float:
        return self.end - self.begin

    @property
    def moves(self) -> float:
        return abs(self.rate) * self.lasts


def _stretches(loading: LoadingHistory | float, duration: float) -> list[_Stretch]:
    if not isinstance(loading, LoadingHistory):
        return [_Stretch(0.0, duration, loading, steady=True)]
    segments = [one for one in loading.segments if one.start < duration]
    ends = [*(one.start for one in segments[1:]), duration]
    found = list[_Stretch]()
    for one, end in zip(segments, ends, strict=True):
        last = one.at(end)
        steady = abs(last - one.value) <= ONE_PLATEAU * max(abs(last), abs(one.value)) and not loading.tone.amplitude
        found.append(_Stretch(one.start, end, 0.5 * (one.value + last), steady))
    return found


def _joined(stretches: Sequence[_Stretch]) -> list[_Stretch]:
    """Return stretches, of which neighbours with nearly the same rate have become one."""
    found = list[_Stretch]()
    for one in stretches:
        before = found[-1] if found else None
        alike = before is not None and abs(one.rate - before.rate) <= ONE_PLATEAU * max(abs(one.rate), abs(before.rate))
        if before is not None and alike and one.steady and before.steady:
            mean = (before.rate * before.lasts + one.rate * one.lasts) / (one.end - before.begin)
            found[-1] = _Stretch(before.begin, one.end, mean, steady=True)
        else:
            found.append(one)
    return found


def _usual(sizes: Sequence[float]) -> float:
    """Return the size to which half of the total belongs in smaller ones."""
    ordered = np.sort(sizes)
    total = np.cumsum(ordered)
    return float(ordered[int(np.searchsorted(total, 0.5 * total[-1]))]) if len(ordered) else 0.0


def transients_of(plateaus: Sequence[RatePlateau], noise: float) -> tuple[float, float]:
    """Return the direct effect per factor e of rate, and the slip (m) over which it decays by a factor e; NaN if none is clear."""
    effects, distances = list[float](), list[float]()
    for before, after in pairwise(plateaus):
        logs = math.log(after.rate / before.rate)
        if abs(logs) < 0.1:
            continue
        height = math.copysign(1.0, logs) * (after.samples - before.friction)
        top = int(np.argmax(height[: len(height) // 2]))
        rest = np.abs(after.samples[top:] - after.friction)
        if height[top] > CLEAR * noise:
            effects.append(float(height[top]) / abs(logs))
            below = np.flatnonzero(rest < rest[0] / math.e)
            if rest[0] > CLEAR * noise and len(below):
                distances.append(after.rate * float(after.time[top + below[0]] - after.time[top]))
    return float(np.median(effects or [math.nan])), float(np.median([one for one in distances if one > 0.0] or [math.nan]))


def drift_of(parts: Sequence[Sequence[RatePlateau]], with_slip: bool | None = None) -> PlateauDrift | None:
    """Return the drift of plateaus of several parts of a record, seen or not; None if there is too little to look at.

    Means over pieces of the settled plateaus are fitted with a level for each rate, as friction may depend on rate in any way, and
    with one slope, along slip or along time. A plateau whose transient has not ended changes like a drift for a while: whoever asks
    lets the fit decide. `with_slip` chooses between slip and time.
    """
    plateaus = [one for plateaus in parts for one in plateaus]
    pieces = [row for plateaus in parts for one in plateaus for row in _pieces(one)]
    if len(pieces) < MEANS or len({one.way for one in plateaus}) > 1:
        return None
    table = np.array(pieces)
    rates = _groups(table[:, 0])
    level = (rates[:, None] == np.unique(rates)).astype(float)
    by_slip, by_time = (_slope(level, table[:, 3], table[:, column]) for column in (1, 2))
    count = len(table) - level.shape[1] - 1
    gain = count * math.log(max(by_time[2], 1e-300) / max(by_slip[2], 1e-300))
    with_slip = gain > -1.0 if with_slip is None else with_slip  # if they are alike, it is what rigs have more often
    slope, error, _ = by_slip if with_slip else by_time
    way = 1.0 if with_slip else plateaus[0].way  # both friction and slip are negative where the load point moves back
    return PlateauDrift(way * slope, error, with_slip, abs(gain) > APART_DRIFTS, level.shape[1], len(plateaus))


def _pieces(one: RatePlateau) -> Iterator[tuple[float, float, float, float]]:
    """Yield rate, displacement, time and friction of means over pieces of the settled end of a plateau."""
    first = len(one.time) - math.ceil(LAST_SHARE * len(one.time))
    if len(one.time) - first < MEANS:
        return
    slip, time, samples = one.slip[first:], one.time[first:], one.samples[first:]
    for chosen in np.array_split(np.arange(len(time)), MEANS):
        yield one.rate, float(slip[chosen].mean()), float(time[chosen].mean()), float(samples[chosen].mean())


def _groups(rates: Floats) -> Floats:
    """Return the number of the group of each rate: rates that differ by less than `ONE_PLATEAU` are one."""
    order = np.argsort(rates)
    apart = np.append(0, np.cumsum(np.diff(np.log(rates[order])) > ONE_PLATEAU))
    found = np.empty(len(rates))
    found[order] = apart
    return found


def _slope(level: Floats, values: Floats, along: Floats) -> tuple[float, float, float]:
    """Return the slope of values along something, beside levels, its standard error, and the sum of squares that is left."""
    scale = float(np.ptp(along)) or 1.0
    matrix = np.column_stack([along / scale, level])
    found, _, rank, _ = np.linalg.lstsq(matrix, values, rcond=1e-9)
    rest = values - matrix @ found
    left, free = float(rest @ rest), max(len(values) - rank, 1)
    memory = min(max(float(rest[1:] @ rest[:-1]) / max(left, 1e-300), 0.0), 0.9)
    spread = np.linalg.pinv(matrix.T @ matrix, rcond=1e-9)[0, 0] * left / free * (1.0 + memory) / (1.0 - memory)
    return float(found[0]) / scale, math.sqrt(max(spread, 0.0)) / scale, left
