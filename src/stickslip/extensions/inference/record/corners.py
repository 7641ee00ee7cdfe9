"""Corners of a record's load point and normal load: changes that take no more than a few samples, and what is not known of them."""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from stickslip.extensions.inference.record.loading import NOISE_OF_BEST_SENSOR
from stickslip.extensions.inference.record.noise import noise_of, rounding_of
from stickslip.extensions.inference.record.record import Record
from stickslip.foundation.arrays import Floats
from stickslip.problem import LoadingHistory, PiecewiseLinear, Steps

SHORT_CORNER = 8
"""A part of a load point with at most this many samples belongs to the change of rate between the parts beside it."""
SHARE_OF_NEIGHBOURS = 0.1
"""So does a longer one of at most this share of the parts beside it."""
NEARLY = 0.25
"""A part counts as shorter by this factor if its rate is nearly that of a part beside it."""
CLEAR = 0.1
"""A change of rate counts if it is at least this share of the largest rate."""
EVENLY = 0.5
"""Standard deviation of a time that may be anywhere between two samples, as a share of the time between them.

That of an even distribution is 1/sqrt(12). With it a step at a sample lies 1.7 standard deviations away, and several of them in one
record would pull the numbers.
"""
TRIED = 100
"""Number of times of a servo that are tried before the best of them is improved."""
FITS = 1.5
"""A servo is taken if it follows the load point to within this many standard deviations of its noise, on average."""
SAMPLES_COMPARED = 8.0
"""A change is compared with the load point over this many samples on both sides, and over more if the servo takes longer."""
SHARP = 0.25
"""A corner is sharp if a servo of more than this share of the time between samples would be seen."""
STEEP = 0.5
"""A normal load jumps if it changes between two samples by this share of its range, or by SHARE_OF_NEIGHBOURS of itself."""


@dataclass(frozen=True)
class Corners:
    """Changes of a pull rate in steps, and how well they are known.

    `rate` has a step for each change, at the time (s) where straight lines through the load point meet. `unsure` are the standard
    deviations of these times (s), 0 for changes that are too small to count. A servo may round the corners: the rate approaches
    each new value as exp(-t/servo), and the load point comes to the same lines. `servo` (s) fits the load point best, with the
    standard deviation `spread`. `seen` is True if the load point itself shows it: without a servo, the lines do not follow it.
    `keeps` is False if the load point turns so sharply that it may be what the machine was told, and not what it did: a servo then
    comes later than it.
    """

    rate: Steps
    unsure: tuple[float, ...]
    servo: float
    spread: float
    seen: bool
    keeps: bool = True


class _Change(NamedTuple):
    """A change of rate: where it begins and ends (s), the rates before and after, and the time at which a step moves as far."""

    begin: float
    end: float
    before: float
    after: float
    at: float


def corners_of(record: Record, rate: LoadingHistory | float) -> Corners | None:
    """Return the corners of a load point whose rate follows a record; None without any, or if a servo does not round them."""
    if not isinstance(rate, Steps) or len(record) < 4 * SHORT_CORNER:
        return None
    steps = _collapsed(rate, record.clock)
    if len(steps) == 0 or not any(_is_clear(one, steps) for one in steps):
        return None
    times, values = [0.0, *(one.at for one in steps)], [steps[0].before, *(one.after for one in steps)]
    if not all(after - before > 0.0 for before, after in pairwise(times)):
        return None
    sharp, spacing = Steps(times, values), np.array([_spacing(record.clock, one) for one in steps])
    if record.load_point is None:
        if any(one.end - one.begin > 2.5 * step for one, step in zip(steps, spacing, strict=True)):
            return None
        return Corners(sharp, tuple((EVENLY * spacing).tolist()), 0.0, float(np.median(spacing)), seen=False, keeps=False)
    return _rounded(record, sharp, steps, float(np.median(spacing)))


def _collapsed(rate: Steps, clock: Floats) -> list[_Change]:
    """Return the changes between parts of constant rate; short parts on the way from one rate to the next belong to the change."""
    starts, values = np.array(rate.times), np.array(rate.values)
    ends = np.append(starts[1:], max(float(clock[-1]), float(starts[-1])))
    count, lasts = np.diff(np.searchsorted(clock, np.append(starts, np.inf))), ends - starts
    found = []
    for i, j in pairwise(_plateaus(count, lasts, values)):
        begin, end, before, after = float(ends[i]), float(starts[j]), float(values[i]), float(values[j])
        if before == after:  # something too short to be seen between two parts of one rate: no step moves as far
            return []
        at = end - (float(values[i + 1 : j] @ lasts[i + 1 : j]) - before * (end - begin)) / (after - before)
        if not begin - (end - begin) <= at <= end + (end - begin):
            return []
        found.append(_Change(begin, end, before, after, at))
    return found


def _plateaus(count: NDArray[np.intp], lasts: Floats, values: Floats) -> list[int]:
    """Return the numbers of the parts that are neither short nor much shorter than the parts beside them.

    A part whose rate is nearly that of a part beside it, as that of the end of an approach, may be longer. One between two parts of
    nearly the same rate is on no way from one rate to another: it is a step there and back, however short it is beside them.
    """
    least = CLEAR * float(np.max(np.abs(values)))
    kept = [i for i in range(len(lasts)) if count[i] > SHORT_CORNER or i in (0, len(lasts) - 1)]
    while len(kept) > 2:
        beside = [max(lasts[i], lasts[j]) for i, j in zip(kept[:-2], kept[2:], strict=True)]
        change = np.abs(np.diff(values[kept]))
        share = lasts[kept[1:-1]] / beside * np.where(np.minimum(change[1:], change[:-1]) > least, 1.0, NEARLY)
        there_and_back = np.abs(values[kept[2:]] - values[kept[:-2]]) <= least
        share[there_and_back & (np.minimum(change[1:], change[:-1]) > least)] = np.inf
        if share.min() > SHARE_OF_NEIGHBOURS:
            break
        del kept[1 + int(np.argmin(share))]
    return kept


def _is_clear(one: _Change, changes: list[_Change]) -> bool:
    rates = [changes[0].before, *(each.after for each in changes)]
    return abs(one.after - one.before) > CLEAR * max(abs(rate) for rate in rates)


def _spacing(clock: Floats, one: _Change) -> float:
    """Return the time between the samples beside a change."""
    k = int(np.clip(np.searchsorted(clock, one.at), 1, len(clock) - 1))
    return float(clock[k] - clock[k - 1])


def _rounded(record: Record, sharp: Steps, changes: list[_Change], spacing: float) -> Corners | None:
    """Return the corners with the servo that rounds them best; None if none follows the load point."""
    assert record.load_point is not None
    known = np.isfinite(record.load_point)
    time, moved = record.clock[known], record.load_point[known]
    noise = max(noise_of(moved), rounding_of(moved), NOISE_OF_BEST_SENSOR * float(np.ptp(moved)))
    rest, edges = moved - _displacement(sharp, time), [0.0, *(one.at for one in changes), float(time[-1])]
    rooms = [0.4 * min(one.at - a, b - one.at) for one, a, b in zip(changes, edges[:-2], edges[2:], strict=True)]
    chosen = [(one, room) for one, room in zip(changes, rooms, strict=True) if _is_clear(one, changes)]
    reach, widest = SAMPLES_COMPARED * spacing, max(room for _, room in chosen)
    while True:
        near = [_Near.of(one, min(reach, room), time, rest) for one, room in chosen]
        fit = _best_servo([one for one in near if len(one.since)], noise, 0.25 * reach, spacing)
        if fit.servo < 0.12 * reach or reach > widest:
            break
        reach *= 2.0
    if not fit.follows:
        return None
    unsure = tuple(
        2.0 * noise / abs(one.after - one.before) / math.sqrt(_fewest(time, one, edges)) if _is_clear(one, changes) else 0.0
        for one in changes
    )
    return Corners(sharp, unsure, fit.servo, fit.spread, fit.seen, keeps=fit.seen or fit.spread > SHARP * spacing)


class _Near(NamedTuple):
    """Samples near a corner: times since then (s), and how far the load point is ahead of the lines, per change of rate (s)."""

    since: Floats
    ahead: Floats
    change: float

    @classmethod
    def of(cls, one: _Change, reach: float, time: Floats, rest: Floats) -> _Near:
        away = np.abs(time - one.at)
        inside, beside = away <= reach, (away > reach) & (away <= 2.0 * reach)
        level = float(rest[beside].mean()) if beside.any() else 0.0
        change = one.after - one.before
        return cls(time[inside] - one.at, (rest[inside] - level) / change, change)


class _Servo(NamedTuple):
    """A servo: its time and the standard deviation of that (s), and whether it follows the load point, and is seen in it."""

    servo: float
    spread: float
    follows: bool
    seen: bool


def _best_servo(near: list[_Near], noise: float, longest: float, spacing: float) -> _Servo:
    """Return the servo whose approach is closest to the load point near some corners."""
    from scipy.optimize import minimize_scalar

    def square(servo: float) -> float:
        return sum(float(np.sum((one.change * (one.ahead - rounding(one.since, servo))) ** 2)) for one in near) / noise**2

    tried = np.append(0.0, np.geomspace(0.03 * spacing, max(longest, spacing), TRIED))
    squares, count = np.array([square(one) for one in tried.tolist()]), max(sum(len(one.since) for one in near), 1)
    best = int(np.argmin(squares))
    ends = float(tried[max(best - 1, 0)]), float(tried[min(best + 1, TRIED)])
    servo = float(minimize_scalar(square, bounds=ends, method="bounded", options={"xatol": 1e-4 * ends[1]}).x)
    least = min(square(servo), float(squares[best]))
    unit = max(1.0, least / count)
    own = np.flatnonzero(squares <= least + unit)
    follows, seen = least <= FITS**2 * count, bool(squares[0] > least + 9.0 * unit)
    if seen:
        small = 0.02 * servo
        bend = (square(servo + small) - 2.0 * square(servo) + square(servo - small)) / small**2
        return _Servo(servo, math.sqrt(2.0 * unit / max(bend, 1e-300)), follows, seen)
    high = float(tried[min(own[-1] + 1 if len(own) else best + 1, TRIED)])
    return _Servo(0.5 * high, 0.5 * high, follows, seen)


def _fewest(time: Floats, one: _Change, edges: list[float]) -> int:
    """Return the smaller number of samples on the two lines that meet at a change."""
    k = edges.index(one.at)
    return max(1, min(int(np.count_nonzero((time > a) & (time < b))) for a, b in (edges[k - 1 : k + 1], edges[k : k + 2])))


def rounding(since: Floats, servo: float) -> Floats:
    """Return how far a servo is ahead of a corner (m per m/s), at times since the corner (s); it began `servo` (s) earlier."""
    if servo == 0.0:
        return np.zeros(len(since))
    begun = np.maximum(since + servo, 0.0)
    return np.asarray(begun - servo * -np.expm1(-begun / servo) - np.maximum(since, 0.0))


def _displacement(rate: Steps, time: Floats) -> Floats:
    moved = rate.values[0] * time
    for at, (before, after) in zip(rate.times[1:], pairwise(rate.values), strict=True):
        moved = moved + (after - before) * np.maximum(time - at, 0.0)
    return np.asarray(moved)


def jumps_of(normal: PiecewiseLinear, clock: Floats) -> tuple[int, ...]:
    """Return the numbers of the straight parts in which a normal load jumps from one sample to the next."""
    times, values = np.array(normal.times), np.array(normal.values)
    change, lasts = np.abs(np.diff(values)), np.diff(times)
    k = np.clip(np.searchsorted(clock, times[:-1], side="right"), 1, len(clock) - 1)
    spacing = clock[k] - clock[k - 1]
    high = change > np.minimum(STEEP * max(float(np.ptp(values)), 1e-300), SHARE_OF_NEIGHBOURS * np.abs(values[:-1]))
    return tuple(np.flatnonzero(high & (lasts < 1.5 * spacing)).tolist())
