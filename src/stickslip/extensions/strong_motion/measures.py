"""What one number says of a strong motion: peaks, Arias intensity, duration, mean period, and where the ground ends.

The acceleration is a straight line from sample to sample. Integrals of it, of its magnitude and of its square are exact, and so are
the peaks of velocity and displacement, which lie between samples. The ground is at rest before the first sample.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from scipy.fft import next_fast_len

from stickslip.foundation.arrays import Floats
from stickslip.foundation.constants import GRAVITY

SHARES = (0.05, 0.95)
"""Shares of the Arias intensity between which the significant duration lies (D5-95)."""
PERIODS = (0.05, 4.0)
"""Periods (s) over which the mean period is taken: frequencies of 20 to 0.25 Hz."""
COARSEST_FREQUENCIES = 0.05
"""Largest distance (Hz) between the frequencies of the mean period; shorter records are padded with zeros."""
HALVINGS = 60
"""Number of halvings of a segment, after which a time in it is exact."""


class StrongMotionMeasures(NamedTuple):
    """Measures of a record, all in SI; g is 9.80665 m/s^2."""

    pga: float
    """Peak ground acceleration (m/s^2), the largest magnitude."""
    pgv: float
    """Peak ground velocity (m/s)."""
    pgd: float
    """Peak ground displacement (m) while it shakes."""
    arias: float
    """Arias intensity (m/s): pi/(2 g) times the integral of the square of the acceleration. Arias 1970."""
    duration: float
    """Significant duration D5-95 (s): from 5 to 95 % of the Arias intensity. Trifunac & Brady 1975, Bull. Seismol. Soc. Am. 65."""
    mean_period: float
    """Mean period Tm (s) of the squared Fourier amplitudes from 0.25 to 20 Hz. Rathje, Abrahamson & Bray 1998, J. Geotech. 124."""
    cav: float
    """Cumulative absolute velocity (m/s): the integral of the magnitude of the acceleration. EPRI 1988."""
    final_velocity: float
    """Velocity of the ground (m/s) at the last sample; far from 0 if the instrument has an offset."""
    final_displacement: float
    """Displacement of the ground (m) at the last sample."""

    def scaled(self, factor: float) -> StrongMotionMeasures:
        """Return the measures of the record times a factor > 0."""
        grow = {name: factor * getattr(self, name) for name in ("pga", "pgv", "pgd", "cav", "final_velocity", "final_displacement")}
        return self._replace(arias=factor * factor * self.arias, **grow)


def measures_of(acceleration: Floats, interval: float) -> StrongMotionMeasures:
    """Return the measures of an acceleration (m/s^2) at even intervals (s)."""
    begin, end = acceleration[:-1], acceleration[1:]
    velocity = np.concatenate([[0.0], np.cumsum(0.5 * interval * (begin + end))])
    steps = interval * (velocity[:-1] + interval * (2.0 * begin + end) / 6.0)
    displacement = np.concatenate([[0.0], np.cumsum(steps)])
    squares = np.concatenate([[0.0], np.cumsum(interval * (begin * begin + begin * end + end * end) / 3.0)])
    early, late = (_time_of(share * squares[-1], acceleration, squares, interval) for share in SHARES)
    return StrongMotionMeasures(
        pga=float(np.abs(acceleration).max()),
        pgv=_peak_velocity(acceleration, velocity, interval),
        pgd=_peak_displacement(acceleration, velocity, displacement, interval),
        arias=math.pi / (2.0 * GRAVITY) * float(squares[-1]),
        duration=late - early,
        mean_period=mean_period(acceleration, interval),
        cav=float(_magnitudes(begin, end).sum()) * interval,
        final_velocity=float(velocity[-1]),
        final_displacement=float(displacement[-1]),
    )


def mean_period(acceleration: Floats, interval: float) -> float:
    """Return the mean period (s) of an acceleration at even intervals (s); NaN if it has nothing at those frequencies."""
    points = next_fast_len(max(len(acceleration), math.ceil(1.0 / (COARSEST_FREQUENCIES * interval))), real=True)
    frequencies = np.fft.rfftfreq(points, interval)
    power = np.abs(np.fft.rfft(acceleration, points)) ** 2
    inside = (frequencies * PERIODS[1] >= 1.0) & (frequencies * PERIODS[0] <= 1.0)
    total = float(power[inside].sum())
    return float((power[inside] / frequencies[inside]).sum()) / total if total > 0.0 else math.nan


def _magnitudes(begin: Floats, end: Floats) -> Floats:
    """Return the mean magnitude of straight lines between two values each."""
    sizes = np.abs(begin) + np.abs(end)
    turned = begin * end < 0.0
    return np.where(turned, 0.5 * (begin * begin + end * end) / np.where(sizes > 0.0, sizes, 1.0), 0.5 * sizes)


def _peak_velocity(acceleration: Floats, velocity: Floats, interval: float) -> float:
    """Return the largest magnitude of the velocity, which may lie where the acceleration passes 0 between two samples."""
    begin, end = acceleration[:-1], acceleration[1:]
    (turns,) = np.nonzero(begin * end < 0.0)
    inside = velocity[turns] + 0.5 * interval * begin[turns] ** 2 / (begin[turns] - end[turns])
    return float(max(np.abs(velocity).max(), np.abs(inside).max(initial=0.0)))


def _peak_displacement(acceleration: Floats, velocity: Floats, displacement: Floats, interval: float) -> float:
    """Return the largest magnitude of the displacement, which may lie where the velocity passes 0 between two samples."""
    begin, change = acceleration[:-1], np.diff(acceleration) / interval
    square = begin * begin - 2.0 * change * velocity[:-1]
    (n,) = np.nonzero(square >= 0.0)
    start, speed, slope, place = begin[n], velocity[n], change[n], displacement[n]
    larger = -(start + np.copysign(np.sqrt(square[n]), start))  # of one sign, so that no digits cancel
    peak = float(np.abs(displacement).max())
    with np.errstate(divide="ignore", invalid="ignore"):
        for time in (larger / slope, 2.0 * speed / larger):
            reached = place + time * (speed + time * (0.5 * start + time * slope / 6.0))
            peak = max(peak, float(np.abs(reached[(time > 0.0) & (time < interval)]).max(initial=0.0)))
    return peak


def _time_of(wanted: float, acceleration: Floats, squares: Floats, interval: float) -> float:
    """Return when (s) the integral of the squared acceleration reaches a value."""
    n = min(max(int(np.searchsorted(squares, wanted)) - 1, 0), len(acceleration) - 2)
    value, slope = float(acceleration[n]), float(acceleration[n + 1] - acceleration[n]) / interval
    missing, low, high = wanted - float(squares[n]), 0.0, interval
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        reached = middle * (value * value + middle * (value * slope + middle * slope * slope / 3.0))
        low, high = (middle, high) if reached < missing else (low, middle)
    return n * interval + high
