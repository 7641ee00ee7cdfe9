"""The load point as it is measured, with steps of the digitiser and noise that remembers itself, as the loading of a run."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import stickslip as ss
from stickslip.extensions.inference.record.loading import loading_of
from tests.extensions.inference.laboratory import correlated

DIGIT = 0.0765e-6
"""Step (m) of the digitiser of a biaxial machine."""
CLOCK = np.arange(0.0, 1.8, 1e-3)
BEGIN, END, SLOW, FAST = 0.735, 0.79, 22.9e-6, 228.4e-6
RAMP = ss.loading.PiecewiseLinear([0.0, BEGIN, END], [SLOW, SLOW, FAST])
OUTSIDE = (CLOCK < BEGIN - 0.02) | (CLOCK > END + 0.02)
LAW = ss.friction.RateAndState(0.49, 0.0062, 0.0044, 30e-6, SLOW, evolution="slip")
BLOCK = ss.Problem(ss.SpringBlock(8000.0, 1.6e11, 1e8), LAW, pull_rate=RAMP)


def servo_step() -> Any:
    """Return the exact displacement (m) of a servo that takes 55 ms from one rate to another."""
    since = np.clip(CLOCK - BEGIN, 0.0, END - BEGIN)
    return SLOW * CLOCK + (FAST - SLOW) * (0.5 * since**2 / (END - BEGIN) + np.maximum(CLOCK - END, 0.0))


def followed(time: Any, displacement: Any) -> tuple[Any, Any, Any]:
    """Return the history of the load point, its displacement since the start (m) and its rates (m/s) at the samples."""
    record = ss.studies.Record.read({"time (s)": time, "load point (m)": displacement, "mu": 0.5 + 1e-3 * np.sin(time)})
    found: Any = loading_of(record)
    segments = np.array(found.rate.segments)
    ends = np.append(segments[1:, 0], record.clock[-1])
    reached = np.append(0.0, np.cumsum(segments[:, 1] * (ends - segments[:, 0])))
    at = np.interp(record.clock, np.append(segments[:, 0], record.clock[-1]), reached)
    return found.rate, at, segments[np.searchsorted(segments[:, 0], record.clock, side="right") - 1, 1]


SENSORS = {
    "digits alone": (0.0, 0.0),
    "digits and white noise": (0.1e-6, 0.0),
    "noise that remembers 10 samples": (0.05e-6, 10.0),
    "noise that remembers 50 samples": (0.1e-6, 50.0),
}


@pytest.mark.parametrize("digit", [DIGIT, 1e-12], ids=["digitised", "fine"])
@pytest.mark.parametrize("sensor", SENSORS)
def test_a_servo_step_is_followed_in_a_few_parts_whatever_the_noise_remembers(sensor: str, digit: float) -> None:
    size, memory = SENSORS[sensor]
    if size == 0.0 and digit < DIGIT:
        size = 1e-9
    exact = servo_step()
    measured = np.round((exact + size * correlated(len(CLOCK), memory, 1)) / digit) * digit
    noise = max(float(np.std(measured - exact)), digit)
    rate, at, rates = followed(CLOCK, measured)
    missed = at - exact - np.median(at - exact)
    assert len(rate.segments) <= (8 if noise > 0.3 * DIGIT else 20)
    assert np.abs(missed).max() < 5.0 * noise
    np.testing.assert_allclose(rates[OUTSIDE], np.where(CLOCK < BEGIN, SLOW, FAST)[OUTSIDE], rtol=0.01)
    assert (rates[(CLOCK > BEGIN + 0.02) & (CLOCK < END - 0.02)] > SLOW + 0.2 * (FAST - SLOW)).all()  # the ramp is no step


@pytest.mark.parametrize("memory", [0.0, 50.0], ids=["white", "50 samples"])
def test_friction_under_the_measured_loading_is_that_under_the_exact_one(memory: float) -> None:
    """To 1.5e-4, of an effect of 0.012; 0.1 um of noise is 1.6e-4 of friction through the spring."""
    measured = np.round((servo_step() + 0.1e-6 * correlated(len(CLOCK), memory, 1)) / DIGIT) * DIGIT
    rate, _, _ = followed(CLOCK, measured)
    own, exact = (ss.simulate(replace(BLOCK, pull_rate=one), CLOCK[-1]).traction(CLOCK) / 1e8 for one in (rate, RAMP))
    assert np.ptp(exact) > 0.012
    assert np.sqrt(np.mean((own - exact) ** 2)) < 5e-5
    assert np.abs(own - exact)[OUTSIDE].max() < 1.5e-4


def test_a_load_point_that_oscillates_is_motion_and_no_noise() -> None:
    time = np.arange(0.0, 100.0, 0.02)
    exact = 1e-6 * time + 2e-6 * np.sin(0.2 * np.pi * time)
    measured = np.round((exact + 0.05e-6 * correlated(len(time), 0.0, 1)) / DIGIT) * DIGIT
    _, at, _ = followed(time, measured)
    assert np.abs(at - exact - np.median(at - exact)).max() < 0.25e-6


def test_a_hold_between_slides_is_at_rest_under_noise_that_remembers_itself() -> None:
    time = np.arange(0.0, 300.0, 0.1)
    exact = 1e-5 * (np.minimum(time, 100.0) + np.maximum(time - 200.0, 0.0))
    measured = np.round((exact + 0.1e-6 * correlated(len(time), 10.0, 1)) / DIGIT) * DIGIT
    rate, _, rates = followed(time, measured)
    assert len(rate.segments) == 3
    assert (rates[(time > 100.1) & (time < 199.9)] == 0.0).all()
