"""Onset, arrest, folds, knots and echoes lie where closed forms put them, to 1e-12 relative."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

import stickslip as ss
from tests.problems import IMPEDANCE, MODULUS, NORMAL, RATE_LAW, ROUND, SLAB, THICKNESS

F = ss.friction


def slips_from(run: ss.Solution) -> float:
    store = run.history.store
    return float(run.history.start[np.flatnonzero(store.mode)[0]])


def test_the_onset_of_a_slowly_loaded_slab_has_its_closed_form() -> None:
    """beta = tau0 + G V t / h reaches the strength at -excess h / (G V), here inside the first round trip."""
    pull, excess = 0.01, -1.2e5
    run = ss.simulate(ss.Problem(SLAB, RATE_LAW, pull_rate=pull, initial_excess=excess), 5.0)
    assert slips_from(run) == pytest.approx(-excess * THICKNESS / (MODULUS * pull), rel=1e-12, abs=0.0)


def test_a_knot_of_a_law_is_passed_at_its_slip() -> None:
    """Linear weakening over D on a slab without pull: the knot is passed exactly at slip D, and v then stays constant."""
    law = F.LinearSlipWeakening(0.8, 0.3, 2.0)
    run = ss.simulate(ss.Problem(SLAB, law, initial_excess=1e4), 5.0)
    store = run.history.store
    behind = np.flatnonzero(store.law_piece == 1)[0]
    assert store.law_slip[behind] == pytest.approx(2.0, rel=1e-12, abs=0.0)
    # exponential growth: u = (excess / k)(exp(k t / Z) - 1), k = S (mus - mud) / D
    k = NORMAL * 0.5 / 2.0
    passed = math.log1p(2.0 * k / 1e4) * IMPEDANCE / k
    assert run.history.start[behind] == pytest.approx(passed, rel=1e-11, abs=0.0)


def test_echoes_come_back_at_the_same_phase() -> None:
    """A breaking point and all its echoes share the offset in the round trip, to the last bit."""
    law = F.LinearSlipWeakening(0.8, 0.6, 1.0)
    run = ss.simulate(ss.Problem(SLAB, law, pull_rate=0.5, initial_excess=1e6), 8 * ROUND)
    store = run.history.store
    for row in range(1, int(store.trip[-1])):
        here, before = (set(store.phase_from[store.trip == n]) for n in (row, row - 1))
        assert before <= here


@pytest.mark.parametrize("rtol", [1e-10, 1e-12, 1e-14])
def test_micro_events_just_above_critical_end_at_their_fold_at_any_tolerance(rtol: float) -> None:
    """The second generation at alpha_c + 1e-6 lasts 10 to 15 microseconds: steps towards its folds must not shrink for ever."""
    law = replace(RATE_LAW, alpha=IMPEDANCE / (NORMAL * 0.5) + 1e-6)
    run = ss.simulate(ss.Problem(SLAB, law, pull_rate=0.05 / ss.YEAR, initial_excess=0.0), 93_900.0, rtol=rtol)
    assert run.status.name == "finished"
    second = run.shocks.iloc[2:4]
    assert list(second.cause) == ["echo", "fold"]
    assert second.rate_before.iloc[1] == pytest.approx(1.30153e-5, rel=1e-5, abs=0.0)


def test_maximal_rule_begins_slip_at_the_fold_under_a_smooth_load() -> None:
    """There g turns: v - v1 starts as the root of time. Contact equation and energy balance hold all the way."""
    slab = replace(SLAB, driver_impedance=0.0)
    problem = ss.Problem(slab, RATE_LAW, pull_rate=2.6, initial_load=60e6, selection="maximal")
    run = ss.simulate(problem, 12.0)
    assert list(run.shocks.cause) == ["fold", "fold", "echo", "echo", "echo"]
    q = math.sqrt(1.0 / (IMPEDANCE / (NORMAL * 0.5)))
    onset = (30e6 + IMPEDANCE * (2 * q - 1) - 60e6) / (IMPEDANCE * 2.6 / (ROUND / 2))
    assert run.shocks.time.iloc[0] == pytest.approx(onset, rel=1e-12, abs=0.0)
    times = np.concatenate([np.linspace(0.0, 12.0, 2001), onset + 10.0 ** np.arange(-12, 0)])
    rate = run.slip_rate(times)
    assert np.all(rate[:-12] >= 0.0)
    by_law = IMPEDANCE * rate + NORMAL * RATE_LAW.coefficient(0.0, rate)
    assert by_law[rate > 0] == pytest.approx(run.load(times)[rate > 0], rel=1e-11, abs=0.0)
    assert float(np.abs(run.energy([6.0, 12.0]).balance).max() / run.energy(12.0).heat[0]) < 1e-12


def test_maximal_rule_arrests_at_the_fold_that_it_has_come_back_to() -> None:
    """At the fold the load may lie a rounding above the end of rest: no step is taken there, and slip stays a number.

    The slip is the integral of the fastest root of Z v + S mu(v) = beta between the two passages of the fold.
    """
    scenario = ss.load_scenario("fig4-loop")
    run = ss.simulate(replace(scenario.problem, selection="maximal"), scenario.duration)
    start, end = run.shocks.time
    load = run.load(start + (end - start) * 0.5 * (1.0 - np.cos(np.pi * np.linspace(0.0, 1.0, 4001)))) - 30e6
    half = 0.5 * (load - IMPEDANCE)  # (Z v - load) (1 + v) + drop = 0, with alpha = 1 s/m
    rate = (half + np.sqrt(np.maximum(half**2 + IMPEDANCE * (load - 50e6), 0.0))) / IMPEDANCE
    weight = (end - start) * 0.5 * np.pi * np.sin(np.pi * np.linspace(0.0, 1.0, 4001))
    slip = float(np.trapezoid(rate * weight, np.linspace(0.0, 1.0, 4001)))
    assert float(run.slip(scenario.duration)) == pytest.approx(slip, rel=1e-5, abs=0.0)
