"""Laws with one state and with two, built in and typed, against motion by scipy alone (`states_truth`)."""

from __future__ import annotations

import math

import numpy as np
import pytest

import stickslip as ss
from tests.core.engine.states_truth import (
    AXIS,
    DAHL,
    FAULT,
    FLASH,
    LUGRE,
    RATE,
    SLAB,
    TYPED_LUGRE,
    WARM,
    Truth,
    block_truth,
    largest_difference,
    one_state,
    slab_truth,
    two_states,
)

CLOSE = 1e-7
"""Largest difference (1) from the truth, relative to the largest slip, slip rate or state."""
HEAVY = ss.SpringBlock(mass=1e6, stiffness=1e7, normal_force=1e8)
PERIOD = 0.2
BOTH_WAYS = pytest.mark.parametrize("way", [1.0, -1.0], ids=["forward", "backward"])


def swing(t: float) -> float:
    """Displacement (m) of a driver that swings with 2 mm/s."""
    turn = 2.0 * math.pi / PERIOD
    return 2e-3 / turn * (1.0 - math.cos(turn * t))


@pytest.mark.sampled(every=8)
@pytest.mark.parametrize("one", [LUGRE, TYPED_LUGRE, DAHL, WARM], ids=["lugre", "typed-lugre", "dahl", "two states"])
@BOTH_WAYS
def test_a_reversing_axis_follows_its_hysteresis_loop(one: Truth, way: float) -> None:
    """Slip and states; friction itself; and the balance of energy, in which bristles give back what they hold."""
    second = {"initial_second_state": 0.3} if one is WARM else {}
    pull = ss.loading.Sinusoidal(0.0, way * 2e-3, PERIOD)
    run = ss.simulate(ss.Problem(AXIS, one.law, pull_rate=pull, initial_load=0.0, **second), 0.5)
    t, start = np.linspace(0.0, 0.5, 251), (0.0, 0.0, 0.0, *second.values())
    slip, rate, *states = block_truth(one, AXIS, lambda now: way * AXIS.stiffness * swing(now), start, t, "DOP853")
    assert (np.diff(np.sign(run.slip_rate(t[1:]))) != 0.0).sum() >= 4  # it does reverse
    assert largest_difference(run, t, slip, states) < CLOSE
    friction = AXIS.normal_force * np.array([one.mu(*values) for values in zip(rate, *states, strict=True)])
    assert np.abs(run.traction(t) - friction).max() < 10.0 * CLOSE * np.abs(friction).max()
    energy = run.energy(t)
    assert float(np.abs(energy.balance).max() / np.abs(energy.heat[-1])) < 1e-8


@BOTH_WAYS
def test_bristles_hold_a_load_below_the_strength_and_spring_back(way: float) -> None:
    problem = ss.Problem(AXIS, LUGRE.law, pull_rate=0.0, initial_load=way * 9.0)
    run, t = ss.simulate(problem, 0.2), np.linspace(0.0, 0.2, 201)
    slip, _, *states = block_truth(LUGRE, AXIS, lambda now: way * 9.0, (0.0, 0.0, 0.0), t, "DOP853")
    assert largest_difference(run, t, slip, states) < CLOSE
    assert 0.15 * AXIS.normal_force > 9.0  # below the strength
    assert np.abs(slip).max() < 1e-4  # held by the bristles
    assert np.diff(np.sign(run.slip_rate(t[1:]))).any()  # which spring back


@pytest.mark.slow
def test_flash_heating_weakens_a_block_in_an_earthquake_and_swings_back() -> None:
    state = float(FLASH.law.steady_state(1e-6))
    problem = ss.Problem(HEAVY, FLASH.law, pull_rate=0.01, initial_load=0.7e8, initial_state=state)
    run, t = ss.simulate(problem, 6.0), np.linspace(0.0, 6.0, 121)
    slip, rate, *states = block_truth(FLASH, HEAVY, lambda now: 0.7e8 + 1e5 * now, (0.0, problem.rate, state), t)
    assert rate.max() > 1.0
    assert rate.min() < -0.01
    assert largest_difference(run, t, slip, states) < CLOSE


@pytest.mark.slow
@pytest.mark.sampled(every=6)
@pytest.mark.parametrize(
    "one", [two_states("ageing"), two_states("slip"), two_states("ageing", -0.003)], ids=["ageing", "slip", "b < 0"]
)
@BOTH_WAYS
def test_a_block_follows_two_states(one: Truth, way: float) -> None:
    start = {"initial_load": way * 6.2e6, "initial_state": 100.0, "initial_second_state": 50.0}
    problem = ss.Problem(FAULT, one.law, pull_rate=way * 1e-4, **start)
    run, t = ss.simulate(problem, 60.0), np.linspace(0.0, 60.0, 61)
    at_first = (0.0, problem.rate, math.log(0.1), math.log(50.0 / 2e4))
    slip, _, *w = block_truth(one, FAULT, lambda now: way * (6.2e6 + 1e3 * now), at_first, t)
    assert largest_difference(run, t, slip, np.exp(w) * [[1e3], [2e4]]) < CLOSE
    assert way * slip[-1] > 1e-3


LAB = ss.SpringBlock(1e3, 1.5e10, 1e8, damping=1e6)


@pytest.mark.slow
@pytest.mark.sampled(every=6)
@pytest.mark.parametrize("evolution", ["ageing", "slip", "prz"])
@BOTH_WAYS
def test_a_block_that_is_launched_follows_one_state_through_a_stick_slip_event(evolution: str, way: float) -> None:
    """Ten times too fast, out of balance, and soft enough for an event: slip, state, ln v and the balance of kinetic energy."""
    one = one_state(ss.friction.RateAndState(0.6, 0.01, 0.015, 1e-5, RATE, evolution=evolution))
    given = {"initial_load": way * 6.1e7, "initial_state": 0.2, "initial_rate": way * 1e-3}
    run = ss.simulate(ss.Problem(LAB, one.law, pull_rate=way * 1e-4, **given), 4.0)
    t = np.linspace(0.0, 4.0, 81)
    start = (0.0, way * 1e-3, one.law.inner_state(0.2))
    slip, rate, w = block_truth(one, LAB, lambda now: way * (6.1e7 + LAB.stiffness * 1e-4 * now), start, t)
    assert float(run.slip_rate(0.0)) == way * 1e-3
    assert run.events.peak_rate.max() > 1e-2
    assert way * run.slip(t) == pytest.approx(way * slip, rel=0.0, abs=1e-6 * abs(slip[-1]))
    assert np.log(run.state(t) * RATE / 1e-5) == pytest.approx(w, rel=0.0, abs=1e-5)
    assert np.log(way * run.slip_rate(t)) == pytest.approx(np.log(way * rate), rel=0.0, abs=1e-5)
    energy, moving = run.energy(t), 0.5 * LAB.mass * (run.slip_rate(t) ** 2 - 1e-6)
    assert np.abs(energy.balance).max() < 1e-9 * float(energy.heat[-1])
    assert energy.kinetic.to_numpy() == pytest.approx(moving, rel=1e-12, abs=1e-12 * np.abs(moving).max())


# ---- slab ----------------------------------------------------------------------------------------------------------------------

AGEING, SLIP, PRZ = (
    one_state(ss.friction.RateAndState(0.6, 0.01, 0.015, 1e-3, RATE, evolution=one)) for one in ("ageing", "slip", "prz")
)
ON_A_SLAB: dict[str, tuple[Truth, float, tuple[float, ...]]] = {
    "lugre": (LUGRE, 2.0e6, (0.0,)),
    "ageing": (AGEING, 6.5e6, (10.0,)),
    "lugre, backward": (LUGRE, -2.0e6, (0.0,)),
    "dahl": (DAHL, 1.5e6, (0.0,)),
    "flash heating": (FLASH, 7.2e6, (float(FLASH.law.steady_state(1e-6)),)),
    "slip": (SLIP, 6.5e6, (10.0,)),
    "prz": (PRZ, 6.5e6, (10.0,)),
    "two states": (two_states("ageing"), 7.0e6, (100.0, 3e3)),
    "two states, backward": (two_states("ageing"), -7.0e6, (100.0, 3e3)),
    "warm bristles": (WARM, 2.0e6, (0.0, 0.2)),
}
"""Law, load (Pa) and states at first."""


@pytest.mark.sampled(every=14)
@pytest.mark.parametrize("name", ON_A_SLAB)
def test_a_slab_follows_the_method_of_steps(name: str) -> None:
    one, load, at_first = ON_A_SLAB[name]
    given = dict(zip(("initial_state", "initial_second_state"), at_first, strict=False))
    problem = ss.Problem(SLAB, one.law, pull_rate=math.copysign(1e-3, load), initial_load=load, **given)
    run, t = ss.simulate(problem, 2.4 * SLAB.two_way_time), np.linspace(0.0, 2.4 * SLAB.two_way_time, 33)
    slip, states = slab_truth(one, problem, t)
    logarithms = {1: [[1e3]], 2: [[1e3], [2e4]]}
    by_logarithm = isinstance(one.law, ss.friction.RateAndState | ss.friction.TwoStateRateAndState)
    assert largest_difference(run, t, slip, np.exp(states) * logarithms[len(states)] if by_logarithm else states) < CLOSE
