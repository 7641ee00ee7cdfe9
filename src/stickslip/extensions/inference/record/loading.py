"""Turn the load point of a record into a loading history: straight lines that follow its displacement to within the noise."""

from __future__ import annotations

import math
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from stickslip.extensions.inference.record.noise import GAUSSIAN, noise_of, rounding_of
from stickslip.extensions.inference.record.record import Record
from stickslip.foundation.arrays import Floats
from stickslip.foundation.errors import InputError
from stickslip.foundation.headings import KNOWN_COLUMNS
from stickslip.foundation.show import brief
from stickslip.problem import LoadingHistory, PiecewiseLinear, Steps

MOST_PARTS = 2000
"""Largest number of straight parts; a record that needs more is approximated more coarsely."""
SURE = 5.0
"""The mean of some samples may differ from a straight part by this many standard deviations."""
NOISE_OF_BEST_SENSOR = 1e-7
"""Smallest noise, as a share of the range of the displacement: no sensor and no clock is better."""
BLOCKS = 16
"""The noise of means over some width is measured if there are at least this many; beyond that it falls as that of white noise."""
WALK = 1.7
"""If the noise of means grows by more than this factor as their width doubles, twice in turn or at the widest, it is motion. The
noise of a random walk grows by sqrt(2)."""
SWINGS, FEWER = 20, 1.5
"""A rate with more than SWINGS constant parts, and FEWER times as many as straight ones, is taken as straight lines."""
MANY_GAPS = 0.05
"""If more than this share of the samples have gaps, that is how the record was sampled, and no gap is reported."""
GAP = 20.0
"""Two samples have a gap between them if they are more than this many usual steps apart."""


class Loading(NamedTuple):
    """The pull rate of a run (m/s; a number if it is constant), and sentences on how it was made from the record."""

    rate: LoadingHistory | float
    notes: tuple[str, ...]


def loading_of(record: Record) -> Loading | None:
    """Return the pull rate in a record as a loading history; None if the record has no load point.

    A displacement becomes as few straight lines between knots as leave only noise; lines bridge gaps, and a jump is a short line.
    A rate becomes steps in the same way, or straight lines if it swings, as that of a drive does that gives way. Raises InputError
    if there are too few numbers.
    """
    is_rate = record.load_point is None
    given = record.load_rate if is_rate else record.load_point
    if given is None:
        return None
    known = np.isfinite(given)
    time, values = record.clock[known], given[known]
    if len(time) < 2:
        raise InputError(
            f"{record.name}: the load point has fewer than two numbers: give its rate in the scenario, and leave it out"
        )
    least = max(float(np.max(np.abs(values - values[0]))), 1e-3 * float(np.max(np.abs(values))))
    floor = max(rounding_of(values), NOISE_OF_BEST_SENSOR * least, 1e-300)
    allowed = _allowed(time, values, max(noise_of(values), floor), floor)
    noise = float(allowed[0]) / SURE
    cuts, coarser = straight_parts(time, values, allowed, 0 if is_rate else 1)
    if is_rate and len(cuts) > SWINGS and (swinging := _swinging(time, values, allowed, len(cuts) - 1)) is not None:
        told, *others = _notes(record, time, np.array(swinging.values), 1.0, noise)
        return Loading(swinging, (told.replace("parts of constant rate", "straight parts"), *others))
    if is_rate:
        middle = 0.5 * (time[np.array(cuts[1:-1], int) - 1] + time[cuts[1:-1]]) if len(cuts) > 2 else np.zeros(0)
        starts = np.append(0.0, middle)
        rates = np.array([values[first:last].mean() for first, last in pairwise(cuts)])
    else:
        at, heights = _joined(time, values, _knots(time, values, cuts, coarser * noise))
        rates, starts = np.diff(heights) / np.diff(at), np.append(0.0, at[1:-1])
        rates[np.abs(np.diff(heights)) < coarser * noise] = 0.0  # at rest, as far as can be told
    return Loading(_steps(starts, rates), _notes(record, time, rates, coarser, noise))


def _swinging(time: Floats, values: Floats, allowed: Floats, steps: int) -> PiecewiseLinear | None:
    """Return a rate (m/s) as straight lines between knots; None if `steps` of constant rate are hardly more than these lines."""
    cuts, coarser = straight_parts(time, values, allowed)
    if coarser > 1.0 or FEWER * (len(cuts) - 1) > steps:
        return None
    at, heights = _joined(time, values, _knots(time, values, cuts, float(allowed[0]) / SURE))
    return PiecewiseLinear(at.tolist(), heights.tolist())


def normal_of(record: Record) -> tuple[PiecewiseLinear, tuple[str, ...]]:
    """Return the normal load of a record as straight lines between knots, found as those of a load point are, and a note.

    Raises InputError if there is no such column, too few numbers, or one that is not above 0.
    """
    if record.normal is None:
        raise InputError(f"{record.name}: normal='record' needs a column normal_stress or normal_force")
    known = np.isfinite(record.normal)
    time, values = record.clock[known], record.normal[known]
    unit = KNOWN_COLUMNS[record.normal_name].unit
    if len(time) < 2:
        raise InputError(f"{record.name}: {record.normal_name} has fewer than two numbers: leave normal='record' out")
    if not (values > 0.0).all():
        lowest = int(np.argmin(values))
        least = f"{brief(float(values[lowest]), unit)} at {record.time[known][lowest]:.6g} s"
        raise InputError(f"{record.name}: {record.normal_name} must stay above 0 {unit}, got {least}: the contact would be open")
    floor = max(rounding_of(values), NOISE_OF_BEST_SENSOR * float(np.ptp(values)), NOISE_OF_BEST_SENSOR * float(values.max()))
    allowed = _allowed(time, values, max(noise_of(values), floor), floor)
    noise = float(allowed[0]) / SURE
    cuts, coarser = straight_parts(time, values, allowed)
    at, heights = _joined(time, values, _knots(time, values, cuts, coarser * noise))
    if not (heights > 0.0).all():
        raise InputError(f"{record.name}: {record.normal_name} comes so close to 0 {unit} that its noise would open the contact")
    parts = f"{len(at) - 1} straight part{'s' if len(at) > 2 else ''}"
    note = f"{record.normal_name} is followed in {parts}, within {brief(coarser * noise, unit, 3)}"
    return PiecewiseLinear(at.tolist(), heights.tolist()), (note,)


def later(history: PiecewiseLinear, by: float) -> PiecewiseLinear:
    """Return the rest of a history from a time (s) on, which becomes its 0 s."""
    left = np.array(history.times)
    left = left[left > by]
    times = [0.0, *(left - by).tolist()] if len(left) else [0.0, 1.0]
    return PiecewiseLinear(times, history.at(by + np.array(times)).tolist())


def _steps(starts: Floats, rates: Floats) -> Steps | float:
    changed = np.append(True, np.diff(rates) != 0.0)
    if changed.sum() == 1:
        return float(rates[0])
    return Steps(starts[changed].tolist(), rates[changed].tolist())


def _notes(record: Record, time: Floats, rates: Floats, coarser: float, noise: float) -> tuple[str, ...]:
    what, of = ("rate", "slip_rate") if record.load_point is None else ("displacement", "slip")
    unit = record.unit_of(of)
    parts = f"{len(rates)} part{'s' if len(rates) > 1 else ''} of constant rate"
    within = f"its noise of {brief(noise, unit, 3)}"
    within = within if coarser == 1.0 else f"{brief(coarser * noise, unit, 3)}, {coarser:g} times its noise"
    found = [f"the {what} of the load point is followed in {parts}, within {within}"]
    steps = np.diff(time)
    gaps = int((steps > GAP * float(np.median(steps))).sum())
    if 0 < gaps < MANY_GAPS * len(steps):
        found.append(f"the load point has {gaps} gap{'s' if gaps > 1 else ''}, over which its rate is taken as constant")
    return tuple(found)


def _allowed(time: Floats, values: Floats, noise: float, floor: float) -> Floats:
    """Return how far means over 1, 2, 4, ... neighbouring samples may lie from a straight part, shape (n,).

    That is `SURE` standard deviations of such a mean. These are measured on the values themselves: sensors hum and digitisers
    round, so that neighbouring errors are correlated and a mean contains the noise of its own width and of all larger widths. No
    mean is surer than the last digit.
    """
    sums = [np.append(0.0, np.cumsum(one - one[0])) for one in (time, values)]
    own = [noise]
    while 2 ** len(own) * BLOCKS <= len(values):
        own.append(_noise_of_means(sums[0], sums[1], 2 ** len(own)))
    grows = [*(after > WALK * before for before, after in pairwise(own)), True]
    motion = next((k for k, twice in enumerate(pairwise(grows)) if all(twice)), len(own) - 1)
    sizes = [noise]
    for k in range(1, len(values).bit_length()):
        white = sizes[-1] / math.sqrt(2.0)
        sizes.append(max(own[k], white) if k <= motion else white)
    beyond = np.cumsum(np.square(sizes)[::-1])[::-1] + sizes[-1] ** 2
    return np.asarray(np.maximum(SURE * np.sqrt(0.5 * beyond), floor))


def _noise_of_means(time_sums: Floats, sums: Floats, width: int) -> float:
    """Return the standard deviation of means over `width` samples, each compared with the line between its neighbours."""
    first = np.arange(0, len(sums) - width, max(width // 4, 1))
    t, y = ((total[first + width] - total[first]) / width for total in (time_sums, sums))
    apart = min(width, 4)
    t0, t1, t2 = t[: -2 * apart], t[apart:-apart], t[2 * apart :]
    share = (t1 - t0) / (t2 - t0)
    bends = y[apart:-apart] - (1.0 - share) * y[: -2 * apart] - share * y[2 * apart :]
    return float(np.median(np.abs(bends / np.sqrt(1.0 + (1.0 - share) ** 2 + share**2)))) / GAUSSIAN


def straight_parts(time: Floats, values: Floats, allowed: Floats, order: int = 1) -> tuple[list[int], float]:
    """Return the first index of each straight (order 1) or constant (0) part and the number of samples, and a factor on `allowed`.

    `allowed` is how far means over 1, 2, 4, ... samples may lie from a part. The factor says how much more had to be allowed to
    keep the number of parts below `MOST_PARTS`.
    """
    coarser = 1.0
    while True:
        cuts = _cuts(time, values, coarser * allowed, order)
        if len(cuts) - 1 <= MOST_PARTS:
            return _without_needless(time, values, cuts, coarser * allowed, order), coarser
        coarser *= 4.0


def _cuts(time: Floats, values: Floats, allowed: Floats, order: int) -> list[int]:
    """Return the ends of parts that leave only noise, as indices; the search stops a little above the largest number of parts."""
    open_parts, ends = [(0, len(time))], list[int]()
    while open_parts and len(ends) + len(open_parts) <= 2 * MOST_PARTS:
        first, last = open_parts.pop()
        at = None if last - first < 3 else _worst(time[first:last], values[first:last], allowed, order)
        if at is None:
            ends.append(first)
        else:
            open_parts += [(first, first + at), (first + at, last)]
    ends += [first for first, _ in open_parts]
    return [*sorted(ends), len(time)]


def _line(time: Floats, values: Floats) -> tuple[float, float]:
    """Return the least-squares line: its level at the middle time, and its slope."""
    t = time - time.mean()
    spread = float(t @ t)
    return float(values.mean()), float(t @ (values - values.mean())) / spread if spread > 0.0 else 0.0


def _rest(time: Floats, values: Floats, order: int) -> Floats:
    level, slope = _line(time, values)
    return np.asarray(values - level - (slope * (time - time.mean()) if order else 0.0))


def _is_noise(rest: Floats, allowed: Floats) -> bool:
    """Return True if means over 1, 2, 4, ... neighbouring samples are as small as noise makes them."""
    sums = np.append(0.0, np.cumsum(rest))
    for k in range(len(rest).bit_length()):
        width = 2**k
        step = max(width // 2, 1)
        if np.max(np.abs(sums[width::step] - sums[:-width:step])) > width * allowed[k]:
            return False
    return True


def _worst(time: Floats, values: Floats, allowed: Floats, order: int) -> int | None:
    """Return where to cut a part that is not straight, or None if it is.

    A line is cut at the sample farthest from the chord between its ends, a constant at the largest sum of residuals.
    """
    rest = _rest(time, values, order)
    if _is_noise(rest, allowed):
        return None
    if order == 0:
        return int(np.argmax(np.abs(np.cumsum(rest)[:-1]))) + 1
    width = max(min(len(values) // 8, 16), 1)
    begin, end = values[:width].mean(), values[-width:].mean()
    t0, t1 = time[:width].mean(), time[-width:].mean()
    away = np.abs(values - begin - (end - begin) * (time - t0) / (t1 - t0))
    return int(np.clip(np.argmax(away[1:-1]) + 1, 1, len(values) - 1))


def _without_needless(time: Floats, values: Floats, cuts: list[int], allowed: Floats, order: int) -> list[int]:
    """Return the cuts without those that are not needed because both parts together leave only noise."""
    kept = [cuts[0]]
    for i in range(1, len(cuts) - 1):
        first, last = kept[-1], cuts[i + 1]
        if not _is_noise(_rest(time[first:last], values[first:last], order), allowed):
            kept.append(cuts[i])
    return [*kept, cuts[-1]]


def _knots(time: Floats, values: Floats, cuts: list[int], noise: float) -> list[float]:
    """Return the times where neighbouring lines meet; if they do not meet near the cut, a jump between two knots replaces them."""
    found = [float(time[0])]
    for first, at, last in zip(cuts[:-2], cuts[1:-1], cuts[2:], strict=True):
        left, right = float(time[at - 1]), float(time[at])
        (a, p), (b, q) = (_line(time[part], values[part]) for part in (slice(first, at), slice(at, last)))
        t1, t2 = float(time[first:at].mean()), float(time[at:last].mean())
        if p != q and at - first > 1 and last - at > 1:
            meet, room = (b - a + p * t1 - q * t2) / (p - q), 2.0 * (right - left) + SURE * noise / abs(p - q)
            if left - room <= meet <= right + room:
                found.append(float(np.clip(meet, t1, t2)))
                continue
        found += [left, right]
    found.append(float(time[-1]))
    ascending = [found[0]]
    for knot in found[1:]:
        if knot > ascending[-1] + 1e-12 * (found[-1] - found[0]):
            ascending.append(knot)
    return ascending


def _joined(time: Floats, values: Floats, knots: list[float]) -> tuple[Floats, Floats]:
    """Return knots and heights of the continuous, piecewise straight line closest to the values."""
    from scipy.sparse import csr_matrix
    from scipy.sparse.linalg import spsolve

    at = np.array(knots)
    n = np.clip(np.searchsorted(at, time, side="right") - 1, 0, len(at) - 2)
    share = (time - at[n]) / (at[n + 1] - at[n])
    rows = np.arange(len(time))
    matrix = csr_matrix(
        (np.concatenate([1.0 - share, share]), (np.concatenate([rows, rows]), np.concatenate([n, n + 1]))), (len(time), len(at))
    )
    # knots without samples beside them lie on the straight line between the samples
    straight = np.interp(at, time, values)
    weak = 1e-8
    normal = (matrix.T @ matrix).tolil()
    normal.setdiag(normal.diagonal() + weak)
    return at, np.asarray(spsolve(normal.tocsc(), matrix.T @ (values - np.interp(time, at, straight)))) + straight
