"""A run at evenly spaced times: exact values there, or, if wanted, what is left of them below half the sampling rate."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from stickslip.errors import InputError
from stickslip.evolution.readings import Readings

Floats = NDArray[np.float64]

MOST = 20_000_000
"""Samples of the longest series, those of the filter included."""
FINER = 16
"""With a filter the run is sampled so many times finer first."""


@dataclass(frozen=True)
class Series:
    """Slip (m) since the start of what is sampled, slip rate (m/s) and traction (Pa; block: N), `rate` samples a second from
    the time `start` (s) on."""

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
    run: Readings, sampling_rate: float, *, start: float | None = None, end: float | None = None, antialias: bool = False
) -> Series:
    """A run, or a window on it, `sampling_rate` times a second (Hz) from `start` to `end` (s; default: all that is shown).

    Values are those of the solution at the times of the samples, from the right where one falls on a shock. A shock has no
    highest frequency: with `antialias` the run is sampled 16 times finer and low-passed to half the sampling rate (linear phase,
    Kaiser window, no delay), which spreads each shock over some samples before and after it. Needs scipy.
    Raises InputError for a rate that is not positive, times outside the run, more than 2e7 samples, and without scipy.
    """
    first, last = (own if given is None else given for own, given in zip(run.shown, (start, end), strict=True))
    if not (0.0 < sampling_rate < math.inf):
        raise InputError(f"sampling rate must be a positive number of samples a second, got {sampling_rate!r}")
    if not run.history.span[0] <= first < last <= run.history.span[1]:
        low, high = run.history.span
        raise InputError(f"samples must lie within the run, {low:g} to {high:g} s, got {first:g} to {last:g} s")
    finer = FINER if antialias else 1
    wanted = (last - first) * sampling_rate
    if not wanted * finer < MOST:
        raise InputError(f"{wanted:.3g} samples are too many: take a lower rate, or an event of it (at most {MOST // finer})")
    count = math.floor(wanted * (1.0 + 1e-12)) + 1
    time = np.minimum(first + np.arange((count - 1) * finer + 1) / (finer * sampling_rate), last)
    slip = run.event_slip(time) if "event_slip" in run.curves else run.slip(time) - run.problem.initial_slip  # type: ignore[attr-defined]
    values = [slip, run.slip_rate(time), run.traction(time)]
    if antialias:
        values = [_thinned(one, finer) for one in values]
    return Series(first, sampling_rate, *values)


def _thinned(values: Floats, factor: int) -> Floats:
    """Every factor-th value of the low-passed series; both ends go on as they are."""
    signal = _scipy_signal()
    return np.asarray(signal.resample_poly(values, 1, factor, padtype="edge"))


def _scipy_signal() -> Any:
    try:
        from scipy import signal
    except ImportError:
        raise InputError("the anti-alias filter needs scipy: pip install 'stickslip[seismology]'") from None
    return signal
