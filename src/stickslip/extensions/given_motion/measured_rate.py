"""The slip rate of a record, as measured or as the slope of a smooth curve through measured slip, and draws of its error."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from stickslip.extensions.given_motion.measured import MeasuredMotion
from stickslip.foundation.arrays import Floats

OF_THIRD_DIFFERENCE = 20.0
"""Variance of a third difference of white noise over that of the noise: 1 + 9 + 9 + 1."""
MEDIAN_OF_NORMAL = 0.6744897501960817
"""Median magnitude of a normal variable, in standard deviations."""
MOST_FOLLOWED = 0.9
"""A curve does not follow more than this share (1) of the samples: too little would be left to tell noise by."""
DRAWS_OF_TRACE = 12
"""Draws for an estimate of how many of the samples a smooth curve follows."""


@dataclass(frozen=True, eq=False)
class MeasuredRate:
    """A slip rate (m/s) at the samples, and what draws one of its possible errors."""

    values: Floats
    draw: Callable[[np.random.Generator], Floats] | None
    """Returns an error of the slip rate (m/s) at all samples; None if the rate counts as exact."""
    note: str


def rate_of_record(record: MeasuredMotion, deviation: float | None, *, smooth: bool) -> MeasuredRate:
    """Return the slip rate of a record; `deviation` is that of the noise of its rate (m/s) or its slip (m), None to estimate it."""
    given = record.motion_deviation if deviation is None else np.full(len(record.time), deviation)
    if record.rate is None:
        return _smooth(record, record.slip, given, of_slip=True)
    if smooth:
        return _smooth(record, record.rate, given, of_slip=False)
    estimated = given is None
    noise = np.full(len(record.time), white_noise(record.rate)) if given is None else given
    unit = "rad/s" if record.turns else "m/s"
    size = float(np.sqrt(np.mean(noise**2)))
    if size <= 1e-9 * float(np.abs(record.rate).max()):
        return MeasuredRate(record.rate, None, "the slip rate counts as exact")
    how = "estimated from its differences" if estimated else "as given"
    return MeasuredRate(record.rate, lambda draw: draw.normal(0.0, noise), f"noise of the slip rate: {size:.3g} {unit}, {how}")


def white_noise(values: Floats) -> float:
    """Return the standard deviation of white noise on a smooth curve with a few jumps, from the median of third differences."""
    return float(np.median(np.abs(np.diff(values, 3))) / (MEDIAN_OF_NORMAL * np.sqrt(OF_THIRD_DIFFERENCE)))


def _smooth(record: MeasuredMotion, values: Floats | None, given: Floats | None, *, of_slip: bool) -> MeasuredRate:
    """Return the slope of a smoothing spline through slip, or one through a rate; its smoothness is found by cross-validation."""
    from scipy.interpolate import make_smoothing_spline

    assert values is not None
    time, count = record.time / record.time[-1], len(record.time)
    size = float(np.abs(values - values.mean()).max()) or 1.0
    penalty = _penalty(time, values / size)
    spline = make_smoothing_spline(time, values / size, lam=penalty)

    def of(curve: Floats) -> Floats:
        fitted = make_smoothing_spline(time, curve, lam=penalty)
        return np.asarray(fitted.derivative()(time) / record.time[-1] if of_slip else fitted(time))

    draw, followed = np.random.default_rng(0), []
    for _ in range(DRAWS_OF_TRACE):
        signs = draw.choice([-1.0, 1.0], count)
        followed.append(float(signs @ make_smoothing_spline(time, signs, lam=penalty)(time)))
    free = max(count - float(np.mean(followed)), 1.0)
    left = float(np.sqrt(np.sum((values / size - spline(time)) ** 2) / free)) * size
    noise = np.full(count, left) if given is None else given
    unit = ("rad" if record.turns else "m") + ("" if of_slip else "/s")
    what = "slip" if of_slip else "slip rate"
    curve = f"a smoothing spline through {what} that follows {count - free:.0f} numbers"
    note = f"slip rate from {curve}; noise of {what}: {left:.3g} {unit}"
    if left <= 1e-9 * size:
        return MeasuredRate(of(values), None, note)
    return MeasuredRate(of(values), lambda draw: of(draw.normal(0.0, noise)), note)


def _penalty(time: Floats, values: Floats) -> float:
    """Return the penalty of roughness by generalised cross-validation, on a grid of powers refined around the best."""
    from scipy.interpolate import make_smoothing_spline

    count, draw = len(time), np.random.default_rng(1)
    signs = draw.choice([-1.0, 1.0], (DRAWS_OF_TRACE // 3, count))

    def score(power: float) -> float:
        lam = 10.0**power
        left = np.sum((values - make_smoothing_spline(time, values, lam=lam)(time)) ** 2)
        followed = np.mean([one @ make_smoothing_spline(time, one, lam=lam)(time) for one in signs])
        return float(left / (1.0 - followed / count) ** 2) if followed < MOST_FOLLOWED * count else math.inf

    powers = np.arange(-18.0, 0.5, 1.5)
    best = powers[int(np.argmin([score(float(one)) for one in powers]))]
    finer = best + np.array([-1.0, -0.5, 0.0, 0.5, 1.0])
    return float(10.0 ** finer[int(np.argmin([score(float(one)) for one in finer]))])
