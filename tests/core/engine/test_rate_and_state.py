"""Rate-and-state friction: stability against the linearised system, histories against scipy, both directions, both bodies."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import stickslip as ss
from stickslip.run.reference.rate_and_state import SteadySliding

NORMAL, SPEED = 1e8, 1e-4
LAW = ss.friction.RateAndState(0.6, 0.01, 0.015, 1e-5, 1e-6)
SLIDING = SteadySliding(NORMAL, LAW.a, LAW.b, LAW.distance, SPEED)
CRITICAL = NORMAL * (LAW.b - LAW.a) / LAW.distance
"""Stiffness (Pa/m) below which quasi-static sliding is unstable."""


def law_of(evolution: str) -> ss.friction.RateAndState:
    return ss.friction.RateAndState(LAW.reference, LAW.a, LAW.b, LAW.distance, LAW.rate, evolution=evolution)


def steady(body: Any, law: ss.friction.RateAndState, off: float = 1.0) -> ss.Problem:
    """Steady sliding at SPEED, but for a state that is off by a factor."""
    load = NORMAL * float(law.steady_coefficient(SPEED)) + (body.damping if isinstance(body, ss.SpringBlock) else 0.0) * SPEED
    return ss.Problem(body, law, pull_rate=SPEED, initial_load=load, initial_state=off * float(law.steady_state(SPEED)))


def growth(solution: ss.Solution, start: float) -> float:
    """Rate (1/s) at which the swings of the slip rate about SPEED grow, from its maxima after `start`."""
    from scipy.signal import argrelmax  # here, because its import takes as long as the collection of a hundred tests

    time = np.linspace(start, solution.duration, 40_001)
    rate = solution.slip_rate(time) / SPEED - 1.0
    top = argrelmax(rate, order=100)[0]
    assert len(top) >= 4
    return float(np.polyfit(time[top], np.log(rate[top]), 1)[0])


def slowest_root(mass: float, stiffness: float, damping: float) -> complex:
    return SLIDING.block_growth(stiffness, mass, damping)


@pytest.mark.sampled(every=2)
@pytest.mark.parametrize(("damping", "evolution", "share"), [(0.0, "ageing", 0.98), (2e9, "slip", 1.02)])
def test_a_block_grows_at_the_rate_of_the_linearised_system(damping: float, evolution: str, share: float) -> None:
    """k_c = S (b - a) / Dc - damping V / Dc, for hardly any mass.

    Measured growth against the linearised system: 2e-6 of the frequency of the swings, whose amplitude is 1e-4.
    """
    critical = SLIDING.critical_stiffness(0.0, damping)
    assert critical == pytest.approx(CRITICAL - damping * SPEED / LAW.distance, rel=1e-14)
    root = slowest_root(1.0, share * critical, damping)
    assert (root.real > 0.0) == (share < 1.0)
    assert abs(slowest_root(1.0, critical, damping).real) < 1e-4 * abs(root.imag)
    period = 2.0 * np.pi / abs(root.imag)
    block = ss.SpringBlock(1.0, share * critical, NORMAL, damping)
    run = ss.simulate(steady(block, law_of(evolution), 1.0001), 12.0 * period)
    assert growth(run, 3.0 * period) == pytest.approx(root.real, rel=0.0, abs=2e-6 * abs(root.imag))


def test_steady_sliding_has_the_coefficient_of_the_closed_form() -> None:
    """mu_ss = reference + (a - b) ln(v / rate), and b ln 2 more for PRZ, whose steady theta is 2 Dc / v. Relative 1e-12."""
    for evolution in ("ageing", "slip", "prz"):
        law = law_of(evolution)
        more = law.b * np.log(2.0) if evolution == "prz" else 0.0
        expected = law.reference + (law.a - law.b) * np.log(SPEED / law.rate) + more
        assert float(law.steady_coefficient(SPEED)) == pytest.approx(expected, rel=1e-12)
        w = law.inner_state(float(law.steady_state(SPEED)))
        assert float(law.state_rate(law, 0.0, SPEED, w)) == pytest.approx(0.0, abs=1e-12 * SPEED / law.distance)


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"initial_load": 6e7}, "needs initial_state"),
        ({"initial_load": 6e7, "initial_state": 0.0}, "initial_state must be greater than 0 s"),
        ({"initial_load": 6e7, "initial_state": float("nan")}, "initial_state must be finite"),
        ({"initial_excess": 0.0, "initial_state": 1.0}, "no static strength"),
    ],
)
def test_bad_starts_are_refused_in_one_line(given: dict[str, float], message: str) -> None:
    with pytest.raises(ss.InputError, match=f"^Problem: [^\n]*{message}[^\n]*$"):
        ss.Problem(ss.SpringBlock(1.0, 1.0, 1e8), LAW, **given)


def test_bad_laws_are_refused_in_one_line() -> None:
    with pytest.raises(ss.InputError, match=r"^RateAndState: a must be greater than 0[^\n]*$"):
        ss.friction.RateAndState(0.6, 0.0, 0.015, 1e-5)
    with pytest.raises(ss.InputError, match=r"evolution 'agein' is unknown; did you mean 'ageing'"):
        ss.friction.RateAndState(0.6, 0.01, 0.015, 1e-5, evolution="agein")
    with pytest.raises(ss.InputError, match=r"^SlipPlusRate: rate must be a law without a state"):
        ss.friction.SlipPlusRate(ss.friction.LinearSlipWeakening(0.6, 0.5, 0.1), LAW)
    with pytest.raises(ss.InputError, match=r"^state: Coulomb has no state variable$"):
        ss.simulate(ss.Problem(ss.SpringBlock(1.0, 1.0, 1.0), ss.friction.Coulomb(0.6, 0.5), initial_load=0.0), 1.0).state(0.5)


def test_waves_merged_in_a_crowd_are_met_in_time_by_a_contact_with_a_state() -> None:
    """Two tolerances agree to 1e-8 where one run merges and the other does not; loads in the root of time were 6e-3 off."""
    law = ss.friction.RateAndState(0.6, 0.01, 0.015, 0.01, 1e-6)
    slab = ss.ElasticSlab(2800, 3500, 1000, NORMAL, driver_impedance=1e8, driver_integral_gain=1e8)
    problem = ss.Problem(slab, law, pull_rate=0.02, initial_load=6.2e7, initial_state=2.0)
    merged, alone = (ss.simulate(problem, 23.5, rtol) for rtol in (1e-13, 1e-10))
    assert "merged" in merged.rounding_note
    assert "merged" not in alone.rounding_note
    times = np.linspace(22.3, 23.4, 12)
    assert merged.slip_rate(times) == pytest.approx(alone.slip_rate(times), rel=1e-8)
