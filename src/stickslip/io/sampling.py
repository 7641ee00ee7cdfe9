"""Sample a run at evenly spaced times: exact values or, on request, values low-passed to half the sampling rate."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import TypedDict

import numpy as np

from stickslip.foundation.arrays import Floats
from stickslip.foundation.errors import InputError
from stickslip.solution.evaluation import Readings
from stickslip.solution.window import Window

MOST_VALUES = 20_000_000
"""Largest number of values computed for a series: one for each sample or, with the filter, some FINER len(NODES) = 64."""
FINER = 8
"""Number of averages for each sample; the filter keeps one of them."""
_GAUSS = np.polynomial.legendre.leggauss(8)
NODES, WEIGHTS = 0.5 * (1.0 + _GAUSS[0]), 0.5 * _GAUSS[1]
"""Gauss's rule on [0, 1] with eight nodes: between breaking points the curves of a slipping contact are smooth."""
BLOCK = 1 << 17
"""Number of times that are looked up together, which bounds the memory."""


@dataclass(frozen=True)
class SampledRun:
    """A run at `rate` samples per second, from a time `start` (s) on.

    `slip` (m) counts from t = 0 of the run or window; `slip_rate` is in m/s, `traction` in Pa (block: N). Away from the contact
    they are displacement since then, velocity and shear stress.
    """

    start: float
    rate: float
    slip: Floats
    slip_rate: Floats
    traction: Floats

    @property
    def time(self) -> Floats:
        """Times of the samples, s: start + k/rate."""
        return self.start + np.arange(len(self.slip)) / self.rate


class Sampling(TypedDict, total=False):
    """The optional arguments of `sample` that functions which write series hand on to it."""

    start: float | None
    end: float | None
    antialias: bool


def sample(
    run: Readings,
    sampling_rate: float,
    *,
    start: float | None = None,
    end: float | None = None,
    antialias: bool = False,
    x: float = 0.0,
) -> SampledRun:
    """Sample a run, or a window on it in local time, at evenly spaced times, `sampling_rate` a second (Hz).

    The interval from `start` to `end` (s) is by default that of a figure of the run; `x` is the distance from the contact (m),
    other than 0 for a slab only. Without the filter, the values are the solution's at the times of the samples, right limits at
    shocks.

    With `antialias` the run is low-passed to half the sampling rate, because a shock has no highest frequency. It is averaged over
    an eighth of the sampling interval, by Gauss's rule between breaking points, then filtered (linear phase, Kaiser window, no
    delay). This spreads each shock over some samples before and after it. The filter needs scipy.

    Raises InputError if the rate is not positive, a time lies outside the run, or there are more than 2e7 samples (with the filter
    3.1e5).
    """
    first, last = (own if given is None else given for own, given in zip(run.shown, (start, end), strict=True))
    if not (0.0 < sampling_rate < math.inf):
        raise InputError(f"sampling rate must be a positive number of samples a second, got {sampling_rate!r}")
    if not run.history.span[0] <= first < last <= run.history.span[1]:
        low, high = run.history.span
        raise InputError(f"samples must lie within the run, {low:g} to {high:g} s, got {first:g} to {last:g} s")
    count = _count((last - first) * sampling_rate, MOST_VALUES // (FINER * len(NODES)) if antialias else MOST_VALUES)
    if antialias:
        from scipy import signal

        fine = first + np.arange((count - 1) * FINER + 1) / (FINER * sampling_rate)
        means = _means(run, fine, 1.0 / (FINER * sampling_rate), x)
        # beyond its ends a series is continued by its end values
        return SampledRun(first, sampling_rate, *(signal.resample_poly(one, 1, FINER, padtype="edge") for one in means))
    return SampledRun(first, sampling_rate, *_values(run, np.minimum(first + np.arange(count) / sampling_rate, last), x))


def _count(wanted: float, most: int) -> int:
    """Return the number of samples in `wanted` sampling intervals, the first included. Raises InputError if it exceeds `most`."""
    if not wanted < most:
        raise InputError(f"{wanted:.3g} samples are too many: use a lower rate, or a single event (at most {most})")
    return math.floor(wanted * (1.0 + 1e-12)) + 1


def _values(run: Readings, time: Floats, x: float) -> list[Floats]:
    """Return slip since the start, slip rate and traction, right limits; away from the contact displacement, velocity, stress."""

    def slip(t: Floats) -> Floats:
        return run.event_slip(t) if isinstance(run, Window) else run.slip(t) - run.problem.initial_slip

    blocks = np.split(time, range(BLOCK, len(time), BLOCK))
    if x != 0.0:
        displaced, *others = (np.concatenate(parts) for parts in zip(*(run.field(x, block) for block in blocks), strict=True))
        return [displaced - run.field(x, 0.0).displacement, *others]
    return [np.concatenate([read(block) for block in blocks]) for read in (slip, run.slip_rate, run.traction)]


def _means(run: Readings, time: Floats, width: float, x: float) -> Iterator[Floats]:
    """Yield averages of the same quantities over `width` (s) around each time, by Gauss's rule between breaking points."""
    low, high = run.history.span
    bounds = np.clip(np.append(time - 0.5 * width, time[-1] + 0.5 * width), low, high)
    breaks = run.breaks[(run.breaks > bounds[0]) & (run.breaks < bounds[-1])]
    edges = np.union1d(bounds, breaks)
    lengths, cells = np.diff(edges), np.searchsorted(edges, bounds[:-1])
    nodes = edges[:-1, None] + lengths[:, None] * NODES
    for one in _values(run, nodes.ravel(), x):
        yield np.add.reduceat(lengths * (one.reshape(nodes.shape) @ WEIGHTS), cells) / np.diff(bounds)
