"""Reduce long records to means over neighbouring samples; spread jumps of a run over samples."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from stickslip.engine import Side
from stickslip.extensions.inference.record.loading import GAP
from stickslip.extensions.inference.record.noise import noise_of, rounding_of
from stickslip.extensions.inference.record.record import Record
from stickslip.foundation.arrays import Floats

RAMP = 2
"""A jump is spread over at least this many samples, so that both samples beside it change as it moves."""
UNSURE = 1.0 / math.sqrt(24.0)
"""Standard deviation of these two samples, as a share of the height of the jump.

If the ramp over two samples moves by a share x of the time between them, each sample changes by x/2. With this standard deviation
the two samples determine x to 1/sqrt(12), the standard deviation of a time that may be anywhere between them.
"""
STEEP = 0.5
"""A steep part counts as a jump if it changes by more than this share of the curve's range in the time between two samples."""
SAMPLES_AROUND_JUMP = 3
"""The jump of the data is searched among this many samples on each side of the jump of the run."""


class Jumps(NamedTuple):
    """Times of jumps (s), ascending, and their heights (after minus before)."""

    time: Floats
    height: Floats


def jumps_in(curve: Callable[[Floats, Side], Floats], breaks: Floats, least: float, step: float = 0.0) -> Jumps:
    """Return the jumps of a curve that are higher than `least`; `curve` gives its values at times, from the left or the right.

    A part between two breaks that is too steep for samples `step` (s) apart counts as a jump at its middle.
    """
    if not len(breaks):
        return Jumps(breaks, breaks)
    left, right = curve(breaks, "left"), curve(breaks, "right")
    height, between = right - left, left[1:] - right[:-1]
    steep = (np.abs(between) > least) & (step * np.abs(between) > STEEP * float(np.ptp(left)) * np.diff(breaks))
    chosen = np.abs(height) > least
    time = np.concatenate([breaks[chosen], 0.5 * (breaks[1:] + breaks[:-1])[steep]])
    order = np.argsort(time, kind="stable")
    return Jumps(time[order], np.concatenate([height[chosen], between[steep]])[order])


def spread(values: Floats, time: Floats, jumps: Jumps, width: int) -> Floats:
    """Return values at samples with each jump replaced by a ramp over `width` samples around it.

    The values then change steadily as a jump moves.
    """
    result = values.copy()
    for at, height in zip(jumps.time.tolist(), jumps.height.tolist(), strict=True):
        k = int(np.searchsorted(time, at)) - 1
        if not 0 <= k < len(time) - 1:
            continue
        near = slice(max(k - width // 2, 0), k + width // 2 + 2)
        away = (time[near] - at) / (width * (time[k + 1] - time[k]))
        share = np.maximum(0.5 - np.abs(away), 0.0)
        result[near] += np.where(away < 0.0, share, -share) * height
    return result


def unsure(time: Floats, data: Floats, jumps: Jumps) -> Floats:
    """Return the standard deviation that the unknown time of each jump adds to the two samples beside the jump of the data."""
    added = np.zeros(len(time))
    change = np.nan_to_num(np.diff(data))
    for at, height in zip(jumps.time.tolist(), jumps.height.tolist(), strict=True):
        k = int(np.searchsorted(time, at)) - 1
        if 0 <= k < len(change):
            first = max(k - SAMPLES_AROUND_JUMP, 0)
            k = first + int(np.argmax(change[first : k + SAMPLES_AROUND_JUMP + 1] * height))
            added[k : k + 2] += (UNSURE * height) ** 2
    return np.sqrt(added)


MOST_FITTED = 100_000
"""Parts with more samples than this are reduced before a fit."""
SURE, FARTHEST = 5.0, 6.0
"""A bin is replaced by its mean if a bend stays below SURE, and each sample below FARTHEST, standard deviations from a line."""
COARSEST = 1e6
"""Largest factor on the noise in these comparisons."""
SMALLEST_NOISE = 1e-9
"""Smallest noise, as a share of the range of a quantity."""


@dataclass(frozen=True)
class Bins:
    """Groups of neighbouring samples: first index and number of samples of each."""

    first: NDArray[np.intp]
    count: NDArray[np.intp]

    def sums(self, values: Floats) -> Floats:
        """Return the sum over each bin."""
        return np.asarray(np.add.reduceat(values, self.first))

    def is_mixed(self, values: Floats, noise: float) -> NDArray[np.bool_]:
        """Return True for bins whose values differ from a line by more than noise, or are partly missing."""
        missing = self.sums((~np.isfinite(values)).astype(float))
        i = np.arange(len(values)) - np.repeat(self.first, self.count)
        t = (2.0 * i + 1.0) / np.repeat(self.count, self.count) - 1.0
        values = np.where(np.isfinite(values), values, 0.0)
        rest = values - np.repeat(self.sums(values) / self.count, self.count)
        slope = self.sums(rest * t) / np.maximum(self.sums(t * t), 1e-300)
        rest = rest - np.repeat(slope, self.count) * t
        mixed = np.maximum.reduceat(np.abs(rest), self.first) > FARTHEST * noise
        for shape in (1.5 * t**2 - 0.5, 2.5 * t**3 - 1.5 * t):  # Legendre's polynomials: a bend, and a step
            mixed |= np.abs(self.sums(rest * shape)) > SURE * noise * np.sqrt(self.sums(shape * shape))
        return np.asarray((mixed | (missing > 0.0)) & (missing < self.count))

    def split(self, whole: NDArray[np.bool_]) -> Bins:
        """Return the bins with those that are not `whole` split into single samples."""
        single = np.repeat(~whole, self.count)
        begins = single.copy()
        begins[self.first] = True
        first = np.flatnonzero(begins)
        return Bins(first, np.diff(np.append(first, len(single))))


def resampled(record: Record, most: int = MOST_FITTED) -> tuple[Record, tuple[str, ...]]:
    """Return the record with about `most` samples at most, and a sentence on what was done.

    Groups of samples without a gap are replaced by their means, so that fast changes are averaged and not aliased into slow ones.
    Where a measured quantity bends or jumps within a group, its samples stay.
    """
    if len(record) <= most:
        return record, ()
    size = -(-len(record) // most)
    bins, between = _bins(record.time, size), _bins(record.time, size, size // 2)
    known = {name: values for name, values in record.measured.items() if np.isfinite(values).any()}
    noise = {name: _noise(values) for name, values in known.items()}
    coarser = 1.0
    while True:
        single = np.zeros(len(record), bool)
        single[[0, -1]] = True  # the run begins and ends with the record
        for name, values in known.items():
            for groups in (bins, between):
                single |= np.repeat(groups.is_mixed(values, coarser * noise[name]), groups.count)
        kept = bins.split(bins.sums(single.astype(float)) == 0.0)
        if len(kept.first) <= 2 * most or coarser > COARSEST:
            return _means(record, kept), (_told(record, kept, size, coarser),)
        coarser *= 4.0


def _noise(values: Floats) -> float:
    low, high = float(np.nanmin(values)), float(np.nanmax(values))
    return max(noise_of(values), rounding_of(values), SMALLEST_NOISE * max(high - low, 1e-3 * max(abs(low), abs(high)), 1e-300))


def _bins(time: Floats, size: int, shift: int = 0) -> Bins:
    """Return groups of `size` samples, fewer beside gaps; the first group after a gap is shorter by `shift`."""
    steps = np.diff(time)
    begins = np.flatnonzero(np.append(True, steps > GAP * float(np.median(steps))))
    since = np.arange(len(time)) - np.repeat(begins, np.diff(np.append(begins, len(time))))
    first = np.flatnonzero((since == 0) | ((since + shift) % size == 0))
    return Bins(first, np.diff(np.append(first, len(time))))


def _means(record: Record, bins: Bins) -> Record:
    def mean(values: Floats) -> Floats:
        return bins.sums(values) / bins.count

    usual = float(np.median(bins.count))
    measured = {name: mean(values) for name, values in record.measured.items()}
    deviations = {name: np.sqrt(mean(values**2) / bins.count * usual) for name, values in record.deviations.items()}
    loads = [None if one is None else mean(one) for one in (record.load_point, record.load_rate)]
    relative = np.sqrt(usual / bins.count)
    return replace(
        record,
        time=mean(record.time),
        measured=measured,
        deviations=deviations,
        load_point=loads[0],
        load_rate=loads[1],
        relative=relative,
        normal=None if record.normal is None else mean(record.normal),
    )


def _told(record: Record, bins: Bins, size: int, coarser: float) -> str:
    single = int((bins.count == 1).sum())
    text = f"the {len(record)} samples of {record.name} became {len(bins.first)}: means over {size}"
    if single:
        text += f", and {single} samples as they are, where a measured quantity bends or jumps"
    return text if coarser == 1.0 else f"{text} by more than {coarser:g} times its noise"
