"""Cycles behind a machine: runs come to them at the pace of their multipliers, the gain that integrates closes every lag, and an
own integrator of slab and machine together comes back to where it began, and to the cycle at the same pace.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
import pytest

import stickslip as ss
from stickslip.extensions.cycles.limit_cycle import LimitCycle
from stickslip.extensions.cycles.section import onsets, passages

A, B, DISTANCE, REFERENCE, NORMAL, FAR = 0.01, 0.015, 0.01, 0.6, 1e8, 5.5e7
GAIN, INTEGRAL, INERTIA, PULL = 1e8, 3e7, 1e7, 0.02
SLAB = ss.ElasticSlab(2800, 3500, 1000, NORMAL, driver_impedance=GAIN, driver_integral_gain=INTEGRAL, driver_inertia=INERTIA)


def string(pull: float = 4.0, gain: float = 300.0) -> ss.Problem:
    """Return the bundled drill string behind a speed controller without inertia, at a pull rate (rad/s)."""
    problem = ss.load_scenario("drill-string").problem
    body = replace(problem.body, driver_impedance=2000.0, driver_integral_gain=gain)
    return replace(problem, body=body, pull_rate=pull)


@cache
def turning() -> LimitCycle:
    return ss.studies.cycle(string(), near=50.0)


@cache
def with_a_mass() -> LimitCycle:
    law = ss.friction.RateAndState(reference=REFERENCE, a=A, b=B, distance=DISTANCE, rate=1e-6)
    problem = ss.Problem(SLAB, law, pull_rate=PULL, far_stress=FAR, initial_load=6.2e7, initial_state=2.0)
    return ss.studies.cycle(problem, near=80.0, rtol=1e-10)


def test_a_plain_run_comes_to_the_cycle_at_the_pace_of_the_leading_multiplier() -> None:
    """Period and slip rates to 1e-9; the pace to 2e-3, where intervals are still 1e-8 to 1e-5 s off."""
    cycle, run = turning(), ss.simulate(string(), 150.0, 1e-12)
    times = onsets(run.history).time
    off = np.diff(times) - cycle.period
    assert off[-2:] == pytest.approx(np.zeros(2), abs=1e-9 * cycle.period)
    close = np.flatnonzero((np.abs(off[:-1]) < 1e-5) & (np.abs(off[:-1]) > 1e-8))
    assert off[close[-1] + 1] / off[close[-1]] == pytest.approx(cycle.multipliers[0].real, rel=2e-3)
    at = np.linspace(0.1, 0.6, 11) * cycle.period
    own = cycle.run.slip_rate(cycle.begin + at)
    assert run.slip_rate(times[-2] + at) == pytest.approx(own, abs=1e-9 * cycle.greatest_rate)


@pytest.mark.parametrize("found", [turning, with_a_mass])
def test_a_gain_that_integrates_leaves_no_lag(found: Callable[[], LimitCycle]) -> None:
    """Slip is the pull rate times the period, to 1e-9, or its push would go on to change."""
    cycle = found()
    assert cycle.slip == pytest.approx(cycle.problem.first_pull_rate * cycle.period, rel=1e-9)


@pytest.mark.parametrize("found", [turning, with_a_mass])
def test_all_that_is_stored_comes_back_and_the_work_is_the_heat(found: Callable[[], LimitCycle]) -> None:
    """To 1e-9 of the heat; the work is that of gains and far stress, less what the gain takes up."""
    cycle = found()
    first, last = cycle.run.energy(np.array([cycle.begin, cycle.begin + cycle.period])).to_array().T.to_numpy()
    gained = dict(zip(cycle.run.energy(cycle.begin).data_vars, last - first, strict=True))
    for name in ("stored", "elastic", "kinetic"):
        assert abs(gained[name]) < 1e-9 * gained["heat"]
    assert gained["work"] == pytest.approx(gained["heat"], rel=1e-9)
    assert gained["radiated"] > 1e-3 * gained["heat"]


@pytest.mark.slow
def test_a_top_drive_with_inertia_under_soft_torque_leaves_a_cycle_of_a_higher_mode() -> None:
    """Tuned to 5 s, at a bit without inertia under LuGre's law: a run has settled to the period to 1e-10, and the lag is none."""
    problem = ss.load_scenario("drill-string").problem
    law = ss.friction.LuGre(static=0.8, dynamic=0.5, rate=1.1, stiffness=100.0, viscosity=0.003)
    body = replace(problem.body, inertia=0.0).with_soft_torque("5 s")
    start: dict[str, Any] = {"initial_load": 0.5 * body.normal_load, "initial_state": 0.0}
    driven = ss.Problem(body, law, pull_rate=4.0, **start)
    cycle, run = ss.studies.cycle(driven, near=60.0, rtol=1e-10), ss.simulate(driven, 200.0, 1e-10)
    section: Any = cycle.orbit.section
    times = passages(run.history, section.rate).time
    assert np.diff(times)[-3:] == pytest.approx(np.full(3, cycle.period), rel=1e-10)
    assert cycle.slip == pytest.approx(4.0 * cycle.period, rel=1e-10)
    assert cycle.period == pytest.approx(2.0 * body.round_trip_time, rel=1e-3)
    assert cycle.stable


def rate_of(load: float, state: float, guess: float) -> float:
    """Return the slip rate at which Z v + S mu is a load, by Newton's iteration on its logarithm."""
    x, z = math.log(guess), SLAB.impedance
    for _ in range(50):
        v = math.exp(x)
        mu = REFERENCE + A * (x - math.log(1e-6)) + B * math.log(1e-6 * state / DISTANCE)
        change = (z * v + NORMAL * mu - load) / (z * v + NORMAL * A)
        x -= change
        if abs(change) < 1e-15:
            break
    return math.exp(x)


def walked(per_trip: int, lasts: float, push: float = 1.0) -> Any:
    """Return slip rate and state behind a machine with a mass, at all steps from the start of its cycle on.

    Time is that of the contact: rate and push of the machine are those with which the wave of the moment met it half a round trip
    before. The push begins with a factor. Runge and Kutta's fourth-order steps, with cubics between the steps of the wave.
    """
    cycle, z = with_a_mass(), SLAB.impedance
    step = SLAB.round_trip_time / per_trip
    past = cycle.begin + step * np.arange(-per_trip, 1)
    waves = list(2.0 * z * cycle.run.slip_rate(past) - cycle.run.load(past))
    start: Any = cycle.orbit.closed
    sent, pushed = start.start.kept

    def slopes(wave: float, now: Any, guess: float) -> tuple[Any, float]:
        state, turns, pushing = now
        v = rate_of(2.0 * z * turns - wave, state, guess)
        force = GAIN * (PULL - turns) + pushing + FAR - z * turns + wave
        return np.array([1.0 - v * state / DISTANCE, force / INERTIA, INTEGRAL * (PULL - turns)]), v

    now = np.array([float(cycle.run.state(past[-1:])[0]), sent / (2.0 * z), push * pushed])
    v, found = float(cycle.run.slip_rate(past[-1:])[0]), []
    for n in range(math.ceil(lasts / step)):
        low, high = waves[n], waves[n + 1]
        before, after = (waves[n - 1] if n else 3.0 * (low - high) + waves[n + 2]), waves[n + 2]
        middle = (9.0 * (low + high) - before - after) / 16.0
        k1, v = slopes(low, now, v)
        k2, _ = slopes(middle, now + 0.5 * step * k1, v)
        k3, _ = slopes(middle, now + 0.5 * step * k2, v)
        k4, _ = slopes(high, now + step * k3, v)
        now = now + step / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4)
        _, v = slopes(high, now, v)
        waves.append(2.0 * z * v - (2.0 * z * now[1] - high))
        found.append((v, now[0]))
    return np.array(found).T


def test_an_own_integrator_of_slab_and_machine_comes_back() -> None:
    """With 200 steps in a round trip, from the wave of the cycle: slip rate and state to 1e-8."""
    cycle, per_trip = with_a_mass(), 200
    rates, states = walked(per_trip, cycle.period)
    at = np.array([cycle.begin + len(rates) * SLAB.round_trip_time / per_trip - cycle.period])
    assert [rates[-1], states[-1]] == pytest.approx([float(cycle.run.slip_rate(at)[0]), float(cycle.run.state(at)[0])], rel=1e-8)


@pytest.mark.slow
def test_in_an_own_integrator_a_push_that_is_off_fades_at_the_pace_of_the_multiplier() -> None:
    """Intervals between passages of the slip rate change from one to the next, and these changes by the factor, to 5e-3."""
    cycle = with_a_mass()
    section: Any = cycle.orbit.section
    rates, _ = walked(100, 6.3 * cycle.period, 1.001)
    logs = np.log(rates / section.rate)
    up = np.flatnonzero((logs[:-1] < 0.0) & (logs[1:] >= 0.0))
    times = np.array([n + np.polyfit(logs[n - 1 : n + 3], [-1.0, 0.0, 1.0, 2.0], 3)[-1] for n in up])
    steps = np.diff(times, 2)
    assert steps[-1] / steps[-2] == pytest.approx(cycle.multipliers[0].real, rel=5e-3)


def test_a_branch_refuses_values_where_the_driver_keeps_other_numbers() -> None:
    with pytest.raises(ss.InputError, match="integral_gain = 0 N m/rad has a number of its own more or less: begin"):
        ss.studies.follow(turning(), "body.driver_integral_gain", to=0.0, steps=1)


def test_a_branch_follows_a_gain_to_the_cycle_of_its_end() -> None:
    """Period to 1e-8 of the cycle near a run with that gain; the leading multipliers to 1e-5."""
    branch = ss.studies.follow(turning(), "body.driver_integral_gain", to=320.0, steps=1)
    end, near = branch.points[-1], ss.studies.cycle(string(gain=320.0), near=50.0)
    assert end.value == 320.0
    assert end.measures.period == pytest.approx(near.period, rel=1e-8)
    assert end.multipliers[0] == pytest.approx(near.multipliers[0], rel=1e-5)
