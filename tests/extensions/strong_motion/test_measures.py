"""Measures of a record have the closed forms of a sinusoid, a pulse and straight lines."""

from __future__ import annotations

import math

import numpy as np
import pytest

from stickslip.extensions.strong_motion.measures import measures_of
from stickslip.foundation.constants import GRAVITY
from tests.extensions.strong_motion.made import made_motion


def sinusoid(amplitude: float, frequency: float, cycles: int, samples: int):
    """Return samples of amplitude sin(2 pi f t) over whole cycles, and their interval."""
    interval = cycles / frequency / samples
    return amplitude * np.sin(2.0 * np.pi * frequency * interval * np.arange(samples + 1)), interval


def test_a_sinusoid_has_its_closed_forms():
    amplitude, frequency, cycles = 2.0, 1.25, 10
    found = measures_of(*sinusoid(amplitude, frequency, cycles, 40_000))
    lasting, turning = cycles / frequency, 2.0 * math.pi * frequency
    assert found.pga == pytest.approx(amplitude, rel=1e-6)
    assert found.pgv == pytest.approx(2.0 * amplitude / turning, rel=1e-6)
    assert found.arias == pytest.approx(math.pi / (2.0 * GRAVITY) * 0.5 * amplitude**2 * lasting, rel=1e-6)
    assert found.cav == pytest.approx(2.0 / math.pi * amplitude * lasting, rel=1e-6)
    assert found.duration == pytest.approx(0.9 * lasting, rel=1e-2)
    assert found.mean_period == pytest.approx(1.0 / frequency, rel=3e-2)
    assert found.final_velocity == pytest.approx(0.0, abs=1e-9)
    assert found.final_displacement == pytest.approx(amplitude / turning * lasting, rel=1e-6)


def test_straight_lines_are_integrated_exactly():
    """A rise from 0 to 1 m/s^2 in 2 s, and a fall through 0 to -1 m/s^2 in another 2 s."""
    found = measures_of(np.array([0.0, 1.0, -1.0]), 2.0)
    assert found.pga == 1.0
    assert found.pgv == pytest.approx(1.0 + 0.5, rel=1e-15)  # at 3 s
    assert found.final_velocity == pytest.approx(1.0, rel=1e-15)
    assert found.final_displacement == pytest.approx(2.0 / 3.0 + 2.0 + 2.0 / 3.0, rel=1e-15)
    assert found.arias == pytest.approx(math.pi / (2.0 * GRAVITY) * (2.0 / 3.0 + 2.0 / 3.0), rel=1e-15)
    assert found.cav == pytest.approx(2.0, rel=1e-15)


def test_the_significant_duration_is_cut_exactly_within_segments():
    """Under a constant acceleration the intensity grows evenly: 90 % of 3 s."""
    assert measures_of(np.full(4, 1.7), 1.0).duration == pytest.approx(0.9 * 3.0, rel=1e-14)
    # a^2 = t^2 from 0 to 1 s: shares of t^3
    assert measures_of(np.array([0.0, 1.0]), 1.0).duration == pytest.approx(0.95 ** (1 / 3) - 0.05 ** (1 / 3), rel=1e-14)


def test_the_peak_displacement_lies_between_samples():
    """The velocity 1 - t (from a = 1 for a moment, then -1) passes 0 at 2 s: with samples at 0, 4 s only the peak is between."""
    found = measures_of(np.array([2.0, -2.0]), 4.0)  # v = 2 t - t^2/2, 0 at 4 s; u = t^2 - t^3/6
    assert found.pgv == pytest.approx(2.0, rel=1e-15)
    assert found.pgd == pytest.approx(16.0 - 64.0 / 6.0, rel=1e-14)
    found = measures_of(np.array([1.0, -3.0]), 4.0)  # v = t - t^2/2, 0 at 2 s; u = t^2/2 - t^3/6
    assert found.pgd == pytest.approx(abs(8.0 - 64.0 / 6.0), rel=1e-14)
    found = measures_of(np.array([2.0, -3.0]), 4.0)  # v = 2 t - 5 t^2/8, 0 at 3.2 s; u = t^2 - 5 t^3/24
    assert found.pgd == pytest.approx(3.2**2 - 5.0 * 3.2**3 / 24.0, rel=1e-14)


@pytest.mark.parametrize("seed", range(20))
def test_random_records_agree_with_many_points_between_their_samples(seed: int):
    random = np.random.default_rng(seed)
    coarse, interval, many = random.normal(size=40), 0.1, 500
    time = interval * np.arange(40)
    fine = np.interp(np.linspace(0.0, time[-1], 39 * many + 1), time, coarse)
    found, with_many = measures_of(coarse, interval), measures_of(fine, interval / many)
    for name in ("pga", "pgv", "pgd", "arias", "cav", "duration", "final_velocity", "final_displacement"):
        assert getattr(found, name) == pytest.approx(getattr(with_many, name), rel=1e-6, abs=1e-9), name


def test_what_a_factor_does_to_each_measure():
    motion = made_motion()
    scaled = motion.measures.scaled(2.5)
    for one, other in zip(scaled, measures_of(2.5 * motion.acceleration, motion.interval), strict=True):
        assert one == pytest.approx(other, rel=1e-12, abs=1e-12)


def test_the_mean_period_weighs_squared_amplitudes_by_period():
    """Two sinusoids of 2 and 0.5 Hz, amplitudes 1 and 2: (0.5 + 4 * 2)/5 s. What lies above 20 Hz does not count."""
    time = 0.005 * np.arange(8000)
    both = np.sin(4.0 * np.pi * time) + 2.0 * np.sin(np.pi * time)
    wanted = (0.5 + 4.0 * 2.0) / 5.0
    assert measures_of(both, 0.005).mean_period == pytest.approx(wanted, rel=1e-3)
    assert measures_of(both + np.sin(80.0 * np.pi * time), 0.005).mean_period == pytest.approx(wanted, rel=1e-3)


def test_silence_has_no_mean_period():
    assert math.isnan(measures_of(np.zeros(10), 0.01).mean_period)
