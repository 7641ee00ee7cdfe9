"""Sample a run at evenly spaced times: exact values or, on request, values low-passed to half the sampling rate."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import NamedTuple, TypedDict

import numpy as np

from stickslip.foundation.arguments import check_whole
from stickslip.foundation.arrays import Floats
from stickslip.foundation.errors import InputError
from stickslip.solution.evaluation import Curve, Readings
from stickslip.solution.window import Window

MOST_VALUES = 20_000_000
"""Largest number of values computed for a series: one for each sample or, with the filter, some FINER len(SAMPLING_NODES) = 64."""
TIMES_OF_SERIES = 1001
"""Number of times of a series if neither a rate nor a number is given: a thousand equal steps."""
FINER = 8
"""Number of averages for each sample; the filter keeps one of them."""
_GAUSS = np.polynomial.legendre.leggauss(8)
SAMPLING_NODES, SAMPLING_WEIGHTS = 0.5 * (1.0 + _GAUSS[0]), 0.5 * _GAUSS[1]
"""Gauss's rule on [0, 1] with eight nodes: between breaking points the curves of a slipping contact are smooth."""
TIMES_TOGETHER = 1 << 17
"""Look up this many times together, which bounds the memory."""
Read = Callable[[Floats], Sequence[Floats]]
"""A function that reads several quantities of a run at given times (s)."""


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


class Span(TypedDict, total=False):
    """The optional arguments of functions that sample a run, which those that write series hand on to them."""

    start: float | None
    end: float | None
    antialias: bool


class EvenTimes(NamedTuple):
    """Evenly spaced times: the first and the last possible one (s), samples a second, and how many there are."""

    first: float
    last: float
    rate: float
    number: int

    @property
    def times(self) -> Floats:
        """The times, s."""
        return np.minimum(self.first + np.arange(self.number) / self.rate, self.last)


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
    even = _even_times(run, sampling_rate, start, end, antialias=antialias)
    return SampledRun(even.first, sampling_rate, *_sampled(run, _since_the_start(run, x), even, antialias=antialias))


def sampled_curves(
    run: Readings,
    names: Sequence[Curve],
    *,
    sampling_rate: float | None = None,
    points: int | None = None,
    start: float | None = None,
    end: float | None = None,
    antialias: bool = False,
) -> tuple[Floats, list[Floats]]:
    """Return evenly spaced times (s) and the values of several curves there, at a rate (Hz) or at a number of `points`.

    The points include `start` and `end`; without either there are `TIMES_OF_SERIES` of them. Otherwise as `sample`.
    """
    if sampling_rate is not None and points is not None:
        raise InputError("samples: give either a sampling rate or a number of points, got both")
    if sampling_rate is None:
        number = check_whole("the number of points", TIMES_OF_SERIES if points is None else points, least=2)
        _bounded(number, antialias=antialias)
        first, last = _interval(run, start, end)
        even = EvenTimes(first, last, (number - 1) / (last - first), number)
    else:
        even = _even_times(run, sampling_rate, start, end, antialias=antialias)
    return even.times, list(_sampled(run, lambda t: [getattr(run, name)(t) for name in names], even, antialias=antialias))


def _interval(run: Readings, start: float | None, end: float | None) -> tuple[float, float]:
    """Return the first and the last time (s) of a series. Raises InputError unless they lie within the run, in this order."""
    first, last = (own if given is None else given for own, given in zip(run.shown, (start, end), strict=True))
    low, high = run.history.begun, run.history.span[1]
    if not low <= first < last <= high:
        raise InputError(f"samples must lie within the run, {low:g} to {high:g} s, got {first:g} to {last:g} s")
    return first, last


def _even_times(run: Readings, sampling_rate: float, start: float | None, end: float | None, *, antialias: bool) -> EvenTimes:
    """Return the times of `sampling_rate` samples a second; the last one may be earlier than the end."""
    if not (0.0 < sampling_rate < math.inf):
        raise InputError(f"sampling rate must be a positive number of samples a second, got {sampling_rate!r}")
    first, last = _interval(run, start, end)
    wanted = _bounded((last - first) * sampling_rate, antialias=antialias)
    return EvenTimes(first, last, sampling_rate, math.floor(wanted * (1.0 + 1e-12)) + 1)


def _bounded(wanted: float, *, antialias: bool) -> float:
    """Return a number of samples, or of the intervals between them. Raises InputError if there are too many."""
    most = MOST_VALUES // (FINER * len(SAMPLING_NODES)) if antialias else MOST_VALUES
    if not wanted < most:
        raise InputError(f"{wanted:.3g} samples are too many: use a lower rate, or a single event (at most {most})")
    return wanted


def _sampled(run: Readings, read: Read, even: EvenTimes, *, antialias: bool) -> list[Floats]:
    """Return what `read` reads of a run at evenly spaced times, low-passed if wanted."""
    if not antialias:
        return _values(read, even.times)
    from scipy import signal

    fine = even.first + np.arange((even.number - 1) * FINER + 1) / (FINER * even.rate)
    means = _means(run, read, np.asarray(fine, float), 1.0 / (FINER * even.rate))
    # beyond its ends a series is continued by its end values
    return [signal.resample_poly(one, 1, FINER, padtype="edge") for one in means]


def _since_the_start(run: Readings, x: float) -> Read:
    """Return what reads slip since the start, slip rate and traction; away from the contact displacement, velocity, stress."""
    if x == 0.0:
        slip = run.event_slip if isinstance(run, Window) else lambda t: run.slip(t) - run.problem.initial_slip
        return lambda t: [slip(t), run.slip_rate(t), run.traction(t)]
    first = run.field(x, 0.0).displacement

    def inside(t: Floats) -> Sequence[Floats]:
        displaced, *others = run.field(x, t)
        return [displaced - first, *others]

    return inside


def _values(read: Read, time: Floats) -> list[Floats]:
    """Return the quantities at times, right limits."""
    blocks = np.split(time, range(TIMES_TOGETHER, len(time), TIMES_TOGETHER))
    return [np.concatenate(parts) for parts in zip(*(read(block) for block in blocks), strict=True)]


def _means(run: Readings, read: Read, time: Floats, width: float) -> list[Floats]:
    """Return averages of the quantities over `width` (s) around each time, by Gauss's rule between breaking points."""
    low, high = run.history.begun, run.history.span[1]
    bounds = np.clip(np.append(time - 0.5 * width, time[-1] + 0.5 * width), low, high)
    breaks = run.breaks[(run.breaks > bounds[0]) & (run.breaks < bounds[-1])]
    edges = np.union1d(bounds, breaks)
    lengths, cells = np.diff(edges), np.searchsorted(edges, bounds[:-1])
    nodes = edges[:-1, None] + lengths[:, None] * SAMPLING_NODES
    return [
        np.add.reduceat(lengths * (one.reshape(nodes.shape) @ SAMPLING_WEIGHTS), cells) / np.diff(bounds)
        for one in _values(read, nodes.ravel())
    ]
