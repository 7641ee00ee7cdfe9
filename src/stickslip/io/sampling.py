"""A run at evenly spaced times: exact values there, or, if wanted, what is left of them below half the sampling rate."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stickslip.foundation.errors import InputError
from stickslip.solution.evaluation import Readings
from stickslip.solution.window import Window

Floats = NDArray[np.float64]

MOST = 20_000_000
"""Values that are computed for the longest series: one a sample, with the filter some hundred."""
FINER = 8
"""With a filter there are so many averages to a sample."""
_GAUSS = np.polynomial.legendre.leggauss(8)
NODES, WEIGHTS = 0.5 * (1.0 + _GAUSS[0]), 0.5 * _GAUSS[1]
"""For averages between breaking points, a cell or less apart: there the run is a polynomial."""
BLOCK = 1 << 17
"""Times that are looked up together: keeps the memory bounded."""


@dataclass(frozen=True)
class Series:
    """Slip (m) since the start of what is sampled, slip rate (m/s) and traction (Pa; block: N), `rate` samples a second from
    the time `start` (s) on. Away from the contact: displacement since then, velocity and shear stress."""

    start: float
    rate: float
    slip: Floats
    slip_rate: Floats
    traction: Floats

    @property
    def time(self) -> Floats:
        """Times of the samples, s: start + k/rate."""
        return self.start + np.arange(len(self.slip)) / self.rate


def sample(
    run: Readings,
    sampling_rate: float,
    *,
    start: float | None = None,
    end: float | None = None,
    antialias: bool = False,
    x: float = 0.0,
) -> Series:
    """A run, or a window on it, `sampling_rate` times a second (Hz) from `start` to `end` (s; default: all that is shown).

    x is the distance (m) from the contact, in a slab (`Readings.field`). Values are those of the solution at the times of the
    samples, from the right where one falls on a shock. A shock has no highest frequency: with `antialias` the run is averaged over
    an eighth of the distance of the samples (exactly, where the contact slips) and low-passed to half the sampling rate (linear
    phase, Kaiser window, no delay), which spreads each shock over some samples before and after it. Needs scipy.
    Raises InputError for a rate that is not positive, times outside the run or more than 2e7 samples.
    """
    first, last = (own if given is None else given for own, given in zip(run.shown, (start, end), strict=True))
    if not (0.0 < sampling_rate < math.inf):
        raise InputError(f"sampling rate must be a positive number of samples a second, got {sampling_rate!r}")
    if not run.history.span[0] <= first < last <= run.history.span[1]:
        low, high = run.history.span
        raise InputError(f"samples must lie within the run, {low:g} to {high:g} s, got {first:g} to {last:g} s")
    count = _count((last - first) * sampling_rate, MOST // (FINER * len(NODES)) if antialias else MOST)
    if antialias:
        fine = first + np.arange((count - 1) * FINER + 1) / (FINER * sampling_rate)
        return Series(first, sampling_rate, *(_thinned(one) for one in _means(run, fine, 1.0 / (FINER * sampling_rate), x)))
    return Series(first, sampling_rate, *_values(run, np.minimum(first + np.arange(count) / sampling_rate, last), x))


def _count(wanted: float, most: int) -> int:
    """Samples in a time of so many distances."""
    if not wanted < most:
        raise InputError(f"{wanted:.3g} samples are too many: take a lower rate, or an event of it (at most {most})")
    return math.floor(wanted * (1.0 + 1e-12)) + 1


def _values(run: Readings, time: Floats, x: float) -> list[Floats]:
    """Slip since the start, slip rate and traction, right limits."""

    def slip(t: Floats) -> Floats:
        return run.event_slip(t) if isinstance(run, Window) else run.slip(t) - run.problem.initial_slip

    blocks = np.split(time, range(BLOCK, len(time), BLOCK))
    if x != 0.0:
        displaced, *others = (np.concatenate(parts) for parts in zip(*(run.field(x, block) for block in blocks), strict=True))
        return [displaced - run.field(x, 0.0).displacement, *others]
    return [np.concatenate([read(block) for block in blocks]) for read in (slip, run.slip_rate, run.traction)]


def _means(run: Readings, time: Floats, width: float, x: float) -> Iterator[Floats]:
    """Averages of the same over `width` (s) around each time, by Gauss's rule between the breaking points of the run."""
    low, high = run.history.span
    bounds = np.clip(np.append(time - 0.5 * width, time[-1] + 0.5 * width), low, high)
    breaks = run.breaks[(run.breaks > bounds[0]) & (run.breaks < bounds[-1])]
    edges = np.union1d(bounds, breaks)
    lengths, cells = np.diff(edges), np.searchsorted(edges, bounds[:-1])
    nodes = edges[:-1, None] + lengths[:, None] * NODES
    for one in _values(run, nodes.ravel(), x):
        yield np.add.reduceat(lengths * (one.reshape(nodes.shape) @ WEIGHTS), cells) / np.diff(bounds)


def _thinned(values: Floats) -> Floats:
    """Every eighth value of the low-passed series; both ends go on as they are."""
    from scipy import signal

    return np.asarray(signal.resample_poly(values, 1, FINER, padtype="edge"))
