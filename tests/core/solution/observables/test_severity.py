"""The severity of stick-slip: closed forms of a block that sticks and slips, steady sliding, rest, and what is refused."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

import stickslip as ss

MASS, SPRING, NORMAL, PULL = 2.0, 300.0, 50.0, 0.1
COULOMB = ss.Problem(ss.SpringBlock(MASS, SPRING, NORMAL), ss.friction.Coulomb(0.6, 0.5), pull_rate=PULL, initial_excess=0.0)


def cycle(pull: float) -> tuple[float, float]:
    """Return period (s) and peak rate (m/s) of the block under dry friction: v = V + A sin(w t) - V cos(w t) in slip."""
    swing, frequency = 0.1 * NORMAL / math.sqrt(SPRING * MASS), math.sqrt(SPRING / MASS)
    slips = 2.0 * (math.pi - math.atan(swing / pull)) / frequency
    return slips + 0.2 * NORMAL / (SPRING * pull), pull + math.hypot(swing, pull)


@pytest.mark.parametrize("pull", [0.01, 0.1, 1.0])
def test_dry_friction_has_the_severity_of_its_closed_form_over_whole_cycles(pull: float) -> None:
    period, peak = cycle(pull)
    run = ss.simulate(replace(COULOMB, pull_rate=pull), 8.0 * period)
    for start, cycles in ((0.3, 1), (1.7, 4), (2.0, 6)):
        found = ss.studies.severity(run, start * period, (start + cycles) * period)
        assert found == pytest.approx(peak / (2.0 * pull), rel=1e-9)


def test_a_window_between_two_turns_has_the_range_of_its_ends() -> None:
    run = ss.simulate(COULOMB, 1.0)
    frequency, swing = math.sqrt(SPRING / MASS), 0.1 * NORMAL / math.sqrt(SPRING * MASS)

    def rate(t: float) -> float:
        return PULL + swing * math.sin(frequency * t) - PULL * math.cos(frequency * t)

    def slip(t: float) -> float:
        return PULL * t + (swing * (1.0 - math.cos(frequency * t)) - PULL * math.sin(frequency * t)) / frequency

    expected = (rate(0.1) - rate(0.02)) * 0.08 / (2.0 * (slip(0.1) - slip(0.02)))
    assert ss.studies.severity(run, "20 ms", 0.1) == pytest.approx(expected, rel=1e-9)


def test_steady_sliding_has_none_and_rest_no_number() -> None:
    steady = ss.Problem(COULOMB.body, ss.friction.VelocityStrengthening(0.5, 0.01, 0.1), pull_rate=PULL, initial_rate="steady")
    assert ss.studies.severity(ss.simulate(steady, 10.0)) <= 1e-14
    rest = replace(COULOMB, pull_rate=0.0, initial_excess=-1.0)
    assert math.isnan(ss.studies.severity(ss.simulate(rest, 10.0)))


def test_it_is_that_of_samples() -> None:
    run = ss.simulate("drill-string", "60 s")
    rates = run.slip_rate(np.linspace(40.0, 60.0, 40_001))
    sampled = float(np.ptp(rates) / (2.0 * rates.mean()))
    assert ss.studies.severity(run) == pytest.approx(sampled, rel=1e-4)


@pytest.mark.parametrize(
    ("start", "end", "message"),
    [
        (0.5, 0.5, r"severity: start and end must ascend within the run, 0 to 1 s, got 0.5 and 0.5 s"),
        (-0.5, 0.5, "severity: start and end must ascend .*"),
        (0.0, 1.5, "severity: start and end must ascend .*"),
        ("1 m", None, "severity: start must be .*"),
    ],
)
def test_times_outside_the_run_are_refused(start: float, end: float, message: str) -> None:
    with pytest.raises(ss.InputError, match=f"^{message}$"):
        ss.studies.severity(ss.simulate(COULOMB, 1.0), start, end)


def test_something_else_than_a_run_is_refused() -> None:
    with pytest.raises(ss.InputError, match=r"^severity: needs a Solution, got "):
        ss.studies.severity(COULOMB)  # type: ignore[arg-type]
