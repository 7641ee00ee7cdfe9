"""Cycles of slabs and strings: runs come to them at the pace that the multipliers say, an own integrator closes, loads balance."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
import pytest

import stickslip as ss
from stickslip.extensions.cycles.limit_cycle import LimitCycle
from stickslip.extensions.cycles.section import onsets, passages
from stickslip.extensions.cycles.waves.image import missed_share
from stickslip.extensions.cycles.waves.mesh import mesh_of
from stickslip.extensions.cycles.waves.orbit import WaveOrbit, checked
from stickslip.extensions.cycles.waves.section import WaveSection, place_in
from stickslip.extensions.cycles.waves.sources import source_of

A, B, DISTANCE, REFERENCE, MASS, NORMAL, DRIVE = 0.01, 0.015, 0.01, 0.6, 1e6, 1e8, 1e8
SLAB = ss.ElasticSlab(2800, 3500, 1000, NORMAL, contact_mass=MASS, driver_impedance=DRIVE)


def string(pull: float, share: float = 4.0) -> ss.Problem:
    """Return the bundled drill string behind a drive whose impedance is so many times its own, at a pull rate (rad/s)."""
    problem = ss.load_scenario("drill-string").problem
    body = replace(problem.body, driver_impedance=share * problem.body.impedance)
    return replace(problem, body=body, pull_rate=pull)


@cache
def found(pull: float) -> LimitCycle:
    return ss.studies.cycle(string(pull), near=70.0)


@cache
def slab_that_never_rests() -> LimitCycle:
    law = ss.friction.RateAndState(reference=REFERENCE, a=A, b=B, distance=DISTANCE, rate=1e-6)
    start: dict[str, Any] = {"initial_load": 6.2e7, "initial_state": "steady", "initial_rate": 0.024}
    return ss.studies.cycle(ss.Problem(SLAB, law, pull_rate=0.02, **start), near=30.0)


def test_a_plain_run_comes_to_the_cycle_at_the_pace_of_the_leading_multiplier() -> None:
    """Period and slip rates to 1e-8; the pace to 1e-3, where intervals are still 1e-6 to 1e-4 s off."""
    cycle, run = found(8.7), ss.simulate(string(8.7), 220.0, 1e-12)
    times = onsets(run.history).time
    off = np.diff(times) - cycle.period
    assert off[-3:] == pytest.approx(np.zeros(3), abs=1e-8 * cycle.period)
    close = np.flatnonzero((np.abs(off[:-1]) < 1e-4) & (np.abs(off[:-1]) > 1e-6))
    assert off[close[-1] + 1] / off[close[-1]] == pytest.approx(cycle.multipliers[0].real, rel=1e-3)
    at = np.linspace(0.1, 0.6, 11) * cycle.period
    own = cycle.run.slip_rate(cycle.begin + at)
    assert run.slip_rate(times[-2] + at) == pytest.approx(own, abs=1e-8 * cycle.greatest_rate)


def test_the_mean_torque_is_what_the_drive_gives_at_the_mean_rate() -> None:
    """Zd (V - slip / T), because all that the string keeps is the same after a period; to 2e-6, for sums where traction jumps."""
    cycle = found(8.7)
    times = cycle.begin + np.linspace(0.0, cycle.period, 200_001)
    mean = np.trapezoid(cycle.run.traction(times), times) / cycle.period
    drive = 4.0 * cycle.problem.body.impedance
    assert mean == pytest.approx(drive * (8.7 - cycle.slip / cycle.period), rel=2e-6)


def test_the_drive_works_for_the_heat_and_for_what_it_radiates_itself() -> None:
    """In a period all that is stored comes back, to 1e-9 of the heat; sums of the torque at the drive, which has jumps, to 2e-6."""
    cycle = found(8.7)
    first, last = cycle.run.energy(np.array([cycle.begin, cycle.begin + cycle.period])).to_array().T.to_numpy()
    gained = dict(zip(cycle.run.energy(cycle.begin).data_vars, last - first, strict=True))
    heat = gained["heat"]
    times = cycle.begin + np.linspace(0.0, cycle.period, 100_001)
    torque = cycle.run.drive_traction(times)
    drive = 4.0 * cycle.problem.body.impedance
    work, radiated = (float(np.trapezoid(power, times)) for power in (8.7 * torque, torque**2 / drive))
    assert heat > 0.1 * work
    assert radiated > 0.1 * work
    assert work == pytest.approx(heat + radiated, rel=2e-6)
    for name in ("stored", "elastic", "kinetic"):
        assert abs(gained[name]) < 1e-9 * heat
    assert gained["work"] == pytest.approx(heat, rel=1e-9)


@pytest.mark.parametrize("asked", [{"double": True}, {"resume": "branch.csv"}])
def test_branches_of_waves_refuse_what_needs_a_start_in_a_few_numbers(asked: dict[str, Any]) -> None:
    with pytest.raises(ss.InputError, match="for rigid bodies only, and this is a body of waves: leave it out"):
        ss.studies.follow(found(8.7), "pull_rate", to=9.0, **asked)


def test_an_own_method_of_steps_closes_after_the_period_where_slip_is_smooth() -> None:
    """Runge and Kutta's method with 600 steps in a round trip, from the wave of the cycle: slip rate and state to 1e-7."""
    cycle, per_trip = slab_that_never_rests(), 600
    run, trip, z = cycle.run, SLAB.round_trip_time, SLAB.impedance
    back, step = (z - DRIVE) / (z + DRIVE), trip / per_trip
    steps = math.ceil(cycle.period / step)
    past = cycle.begin + step * np.arange(-per_trip, 1)
    waves = list(2.0 * z * run.slip_rate(past) - run.load(past))
    added = float(run.load(past[-1:])[0]) - back * waves[0]
    rate, state = float(run.slip_rate(past[-1:])[0]), float(run.state(past[-1:])[0])

    def slopes(load: float, v: float, w: float) -> np.ndarray:
        mu = REFERENCE + A * math.log(v / 1e-6) + B * math.log(1e-6 * w / DISTANCE)
        return np.array([(load - z * v - NORMAL * mu) / MASS, 1.0 - v * w / DISTANCE])

    now = np.array([rate, state])
    for n in range(steps):
        low, high = waves[n], waves[n + 1]
        before, after = (waves[n - 1] if n else 3.0 * (low - high) + waves[n + 2]), waves[n + 2]
        middle = (9.0 * (low + high) - before - after) / 16.0
        loads = [back * one + added for one in (low, middle, high)]
        k1 = slopes(loads[0], *now)
        k2 = slopes(loads[1], *(now + 0.5 * step * k1))
        k3 = slopes(loads[1], *(now + 0.5 * step * k2))
        k4 = slopes(loads[2], *(now + step * k3))
        now = now + step / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4)
        waves.append(2.0 * z * now[0] - loads[2])
    at = np.array([cycle.begin + steps * step - cycle.period])
    assert now == pytest.approx([float(run.slip_rate(at)[0]), float(run.state(at)[0])], rel=1e-7)


def bare(distance: float) -> ss.Problem:
    """Return a slab without a mass behind a rigid driver, under rate and state: only slip takes something of its waves."""
    law = ss.friction.RateAndState(reference=0.6, a=0.01, b=0.015, distance=distance)
    slab = ss.ElasticSlab(density=2800.0, wave_speed=3500.0, thickness=1e4, normal_stress=1e8)
    return ss.Problem(slab, law, pull_rate=0.05, initial_load=5.4e7, initial_state="steady")


def test_a_slab_behind_a_rigid_driver_comes_to_a_cycle_next_to_where_steady_sliding_becomes_unstable() -> None:
    """Its runs settle there: the last intervals between passages of a long run are the period, to 1e-9."""
    found = ss.studies.cycle(bare(0.13), near=400.0)
    assert found.stable is True
    assert found.stick_share == 0.0
    history = ss.simulate(bare(0.13), 1500.0).history
    last = np.diff(passages(history).time)[-3:]
    assert last == pytest.approx([found.period] * 3, rel=1e-9)


def test_a_slight_motion_of_a_slab_that_decays_slowly_to_steady_sliding_is_no_cycle() -> None:
    """A disturbance of 1e-3 of the pull rate fades at 1.3e-4 /s with a period of 29.6 s, so that each return nearly closes."""
    problem = replace(bare(0.167), initial_rate=0.05005, initial_load=None, initial_state=None)
    history = ss.simulate(problem, 150.0, 1e-12).history
    section = WaveSection(problem, False)
    met = section.met(history)
    source = source_of(history, float(met.time[-1]))
    period = float(met.time[-1] - met.time[-2])
    back = section.returned(place_in(history, met, len(met.time) - 1, mesh_of(source, source.kinks(period))), period)
    assert missed_share(back) < 0.03
    with pytest.raises(ss.InputError, match="leads to steady sliding: no other cycle is near this run"):
        checked(WaveOrbit(back, section, missed_share(back), 1, 0.0))


def test_where_disturbances_of_a_slab_grow_no_cycle_is_near() -> None:
    """Its exponent is above 0 by three standard errors, and the run never comes back to itself."""
    growth = ss.studies.lyapunov(bare(0.05), 1200.0)
    assert growth.exponent > 3.0 * growth.error
    with pytest.raises(ss.InputError, match=r"the run does not come back: its wave is \d+ % off at best: it has not settled"):
        ss.studies.cycle(bare(0.05), near=200.0)


def behind_a_gain(rate: float, gain: float) -> ss.Problem:
    """Return a slab with mass and an integral gain (Pa/m) of its driver, whose friction falls over a slip rate (m/s)."""
    slab = ss.ElasticSlab(2800, 3500, 1000, 1e7, contact_mass=2e6, driver_impedance=3e7, driver_integral_gain=gain)
    law: Any = ss.friction.Coulomb(0.8, 0.5) if rate == 0.0 else ss.friction.PowerStribeck(0.63, 0.27, rate)
    return ss.Problem(slab, law, pull_rate=1.0, initial_load=0.0)


@pytest.mark.parametrize(("rate", "gain", "steady"), [(0.0, 0.0, 0.833333), (0.0, 1e7, 1.0), (0.077, 1e6, 1.0)])
def test_a_run_that_comes_to_steady_sliding_says_so_and_at_what_slip_rate(rate: float, gain: float, steady: float) -> None:
    """Behind an impedance alone it is V - mu N/g = 1 - 5e6/3e7 m/s; an integral gain brings it to the pull rate, however slowly."""
    sentence = f"cycle: the run comes to steady sliding at {steady:g} m/s: no cycle is near this run"
    with pytest.raises(ss.InputError, match=f"^{sentence}$"):
        ss.studies.cycle(behind_a_gain(rate, gain))


@pytest.mark.slow
def test_a_branch_doubles_its_period_where_a_multiplier_is_minus_one() -> None:
    """Runs on both sides of the edge show it: one period in between them, then two."""
    branch = ss.studies.follow(found(9.0), "pull_rate", to=9.03, steps=1)
    (edge,) = branch.edges
    assert edge.name == "period doubling"
    assert edge.orbit.multipliers[0] == pytest.approx(-1.0, abs=1e-5)
    beyond = np.diff(onsets(ss.simulate(string(edge.value + 0.04), 400.0, 1e-10).history).time)[-4:]
    assert beyond[2:] == pytest.approx(beyond[:2], rel=2e-3)
    assert abs(beyond[1] - beyond[0]) > 0.02
    doubled = ss.studies.cycle(string(edge.value + 0.04), near=70.0)
    assert doubled.stable
    assert doubled.period == pytest.approx(beyond[:2].sum(), rel=1e-6)
