"""A block driven by a spring and a dashpot side by side: closed forms, an own integrator, energy, rest, ground, files and sweeps.

The equation is m dv/dt + damping v + tau = K (D0 + D - u) + driver_damping (V - v), with V the pull rate and D its integral.
"""

from __future__ import annotations

import math
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import quad

import stickslip as ss
from stickslip.contact import steady_slidings
from stickslip.problem import loading_rate
from stickslip.problem.loading import LoadingHistory, PiecewiseLinear, Sinusoidal, Steps
from stickslip.run.reference.rate_and_state import SteadySliding
from tests.command_line import Command
from tests.core.problem.loading.on_dashpot import (
    BLOCK,
    DASHPOT,
    DYNAMIC,
    FORCE,
    GROUND,
    LAW,
    MASS,
    STATIC,
    STIFFNESS,
    in_slip,
    integrated,
)

KNOTS = [0.0, 1.0, 3.0, 7.0]
PULLS: dict[str, LoadingHistory] = {
    "steps": Steps(KNOTS, [0.1, 0.5, 0.02, 0.3]),
    "ramps": PiecewiseLinear(KNOTS, [0.1, 0.5, 0.02, 0.3]),
    "sine": Sinusoidal(0.1, 0.3, 1.7, 0.4),
}
IN_SLIP: dict[str, LoadingHistory] = {
    "steps": Steps(KNOTS, [1.0, 1.3, 0.9, 1.1]),
    "ramps": PiecewiseLinear(KNOTS, [1.0, 1.3, 0.9, 1.1]),
    "sine": Sinusoidal(1.0, 0.2, 1.7, 0.4),
}
"""Pulls (m/s) under which a block that has begun to slide slides on."""
LOADED = 7.0
"""Load (N) that sets the block off at once."""


@pytest.mark.parametrize("kind", IN_SLIP)
def test_sliding_under_a_pull_that_varies_is_the_closed_form(kind: str) -> None:
    """Slip and rate to 1e-12 of their sizes; with the same damping against the ground they are off by 1e-2."""
    times = np.linspace(0.0, 9.0, 61)
    problem = ss.Problem(BLOCK, LAW, pull_rate=IN_SLIP[kind], initial_load=LOADED)
    slip, rate = in_slip(IN_SLIP[kind], LOADED, times)
    run = ss.simulate(problem, 9.0, rtol=1e-12)
    assert rate[1:].min() > 0.0
    assert run.slip(times) == pytest.approx(slip, rel=1e-12, abs=1e-12)
    assert run.slip_rate(times) == pytest.approx(rate, rel=1e-11, abs=1e-12)
    other = ss.simulate(replace(problem, body=replace(BLOCK, damping=GROUND + DASHPOT, driver_damping=0.0)), 9.0)
    assert np.abs(other.slip(times) - slip).max() > 1e-2


@pytest.mark.sampled(every=6)
@pytest.mark.parametrize("turns", [False, True])
@pytest.mark.parametrize("kind", PULLS)
def test_stick_and_slip_are_those_of_an_own_integrator(kind: str, turns: bool) -> None:
    """Slip, rate, work, damped energy and heat after several events to 1e-9, and when each begins to 1e-9 s."""
    body = ss.RotatingBlock(MASS, STIFFNESS, FORCE, GROUND, DASHPOT) if turns else BLOCK
    problem = ss.Problem(body, LAW, pull_rate=PULLS[kind], initial_load=4.0)
    run = ss.simulate(problem, 20.0, rtol=1e-12)
    (slip, rate, _, work, damped, heat), starts = integrated(problem, 20.0)
    assert float(run.slip(20.0)) == pytest.approx(slip, rel=1e-9)
    assert float(run.slip_rate(20.0)) == pytest.approx(rate, rel=1e-8, abs=1e-9)
    assert run.events.start.to_numpy() == pytest.approx(np.array(starts), abs=1e-9)
    energies = run.energy([20.0])
    assert [float(energies[one][0]) for one in ("work", "damped", "heat")] == pytest.approx([work, damped, heat], rel=1e-9)
    assert run.proven.load < 1e-12
    assert run.proven.compared == run.proven.pieces


@pytest.mark.parametrize("kind", PULLS)
def test_work_is_stored_dissipated_or_heat_at_any_time(kind: str) -> None:
    """The balance is below 1e-12 of the work, 1e-4 of which the dashpot takes at least; that of each event is, too."""
    run = ss.simulate(ss.Problem(BLOCK, LAW, pull_rate=PULLS[kind], initial_load=4.0), 40.0)
    energies = run.energy(np.linspace(0.0, 40.0, 301))
    work = float(energies.work[-1])
    assert np.abs(energies.balance).max() < 1e-12 * work
    assert float(energies.damped[-1]) > 1e-4 * work
    whole = run.energetics()
    assert np.abs(whole.balance[:-1]).max() < 1e-12 * work


# ---- a constant pull --------------------------------------------------------------------------------------------------------


def test_a_constant_pull_moves_the_block_as_if_the_ground_had_the_dashpot() -> None:
    """Its load has c V in it, whatever moves: the motion is the same to the bit, and the driver pulls with c V less."""
    problem = ss.Problem(BLOCK, LAW, pull_rate=0.1, initial_load=5.0)
    of_ground = replace(problem, body=replace(BLOCK, damping=GROUND + DASHPOT, driver_damping=0.0))
    run, other = ss.simulate(problem, 60.0), ss.simulate(of_ground, 60.0)
    assert np.array_equal(run.history.store.rate, other.history.store.rate)
    times = np.linspace(0.0, 60.0, 200)
    lacks = DASHPOT * run.slip_rate(times)
    assert run.drive_traction(times) == pytest.approx(other.drive_traction(times) - lacks, rel=1e-13)
    damped, takes = run.energy([60.0]).damped, other.energy([60.0]).damped
    slip = float(run.slip(60.0))
    less = DASHPOT * (0.1 * 0.1 * 60.0 - 2.0 * 0.1 * slip)  # of c (V - v)^2 less c v^2
    assert float(damped[0] - takes[0]) == pytest.approx(less, rel=1e-9)


def test_the_driver_feels_friction_and_the_ground_alone_in_steady_sliding() -> None:
    """The load is S mu + (damping + driver_damping) V, and the spring bears the traction of the driver, S mu + damping V."""
    law = ss.friction.VelocityStrengthening(0.6, 0.01, 1e-6)
    problem = ss.Problem(BLOCK, law, pull_rate=0.2, initial_rate="steady")
    friction = FORCE * float(law.coefficient(0.0, 0.2))
    assert problem.load == pytest.approx(friction + (GROUND + DASHPOT) * 0.2, rel=1e-14)
    run = ss.simulate(problem, 20.0)
    assert run.slip_rate([0.0, 5.0, 20.0]) == pytest.approx(0.2, rel=1e-12)
    assert run.drive_traction([0.0, 20.0]) == pytest.approx(friction + GROUND * 0.2, rel=1e-12)
    assert float(run.energy([20.0]).damped[0]) == pytest.approx(GROUND * 0.04 * 20.0, rel=1e-12)


def test_rest_that_is_leapt_over_costs_the_work_of_the_dashpot() -> None:
    """A block at rest under a slow pull: c V^2 t is damped, (F + c V) V t the work, to 1e-12."""
    held, pull, lasting = 1.0, 1e-6, 9e4
    run = ss.simulate(ss.Problem(BLOCK, LAW, pull_rate=pull, initial_load=held + DASHPOT * pull), lasting)
    assert len(run.history) < 10
    energies = run.energy([0.3 * lasting, lasting])
    times = np.array([0.3, 1.0]) * lasting
    assert energies.damped.to_numpy() == pytest.approx(DASHPOT * pull**2 * times, rel=1e-12)
    stored = held * pull * times + 0.5 * STIFFNESS * (pull * times) ** 2
    assert energies.elastic.to_numpy() == pytest.approx(stored, rel=1e-9)
    assert np.abs(energies.balance).max() < 1e-12 * float(energies.work[-1])


@pytest.mark.parametrize("pull", [Sinusoidal(5e-7, 3e-5, 3600.0, 0.3), PiecewiseLinear([0.0, 4e4, 9e4], [0.0, 3e-7, -2e-7])])
def test_rest_under_a_pull_that_varies_dissipates_its_square(pull: LoadingHistory) -> None:
    """What is damped at rest is c times the integral of V^2, by quadrature (1e-10), and the load keeps K D + c V to 1e-12."""
    run = ss.simulate(ss.Problem(BLOCK, LAW, pull_rate=pull, initial_load=1.0), 1e5)
    assert len(run.events) == 0
    taken = [
        quad(lambda t: float(pull.at(t)) ** 2, low, low + 500.0, epsabs=0.0, epsrel=1e-12)[0] for low in range(0, 100_000, 500)
    ]
    assert float(run.energy([1e5]).damped[0]) == pytest.approx(DASHPOT * math.fsum(taken), rel=1e-10)
    way = math.fsum(
        quad(lambda t: float(pull.at(t)), low, low + 500.0, epsabs=1e-18, epsrel=1e-12)[0] for low in range(0, 100_000, 500)
    )
    gained = STIFFNESS * way + DASHPOT * (float(pull.at(1e5)) - pull.first)
    assert float(run.load(1e5)) == pytest.approx(1.0 + gained, rel=1e-12)
    assert abs(float(run.energy([1e5]).balance[0])) < 1e-12 * (DASHPOT * math.fsum(taken) + abs(way))


# ---- jumps ------------------------------------------------------------------------------------------------------------------


def test_a_step_of_the_pull_is_a_step_of_the_load_by_the_dashpot() -> None:
    pull = Steps([0.0, 2.0], [0.0, 0.25])
    run = ss.simulate(ss.Problem(BLOCK, LAW, pull_rate=pull, initial_load=4.5), 4.0)
    assert float(run.load(2.0, "left")) == pytest.approx(4.5, rel=1e-15)
    assert float(run.load(2.0)) == pytest.approx(4.5 + DASHPOT * 0.25, rel=1e-15)
    reached = 2.0 + (STATIC * FORCE - 5.5) / (STIFFNESS * 0.25)
    assert run.events.start.iloc[0] == pytest.approx(reached, rel=1e-12)


def test_a_step_beyond_the_strength_sets_the_block_off_at_once() -> None:
    """Its acceleration is then (load + c dV - dynamic friction) / m, to 1e-6 after 1e-6 s."""
    pull = Steps([0.0, 2.0], [0.0, 0.5])
    run = ss.simulate(ss.Problem(BLOCK, LAW, pull_rate=pull, initial_load=5.5), 4.0)
    assert run.events.start.iloc[0] == 2.0
    assert float(run.slip_rate(2.0 + 1e-6)) / 1e-6 == pytest.approx((5.5 + 2.0 - DYNAMIC * FORCE) / MASS, rel=1e-5)


def test_the_ground_may_shake_beside_it() -> None:
    """A ramp of the pull and a sine of the ground's acceleration, then steps of both, against an own integrator to 1e-9."""
    shaken, frequency = Sinusoidal(0.0, 1.1, 2.3, 0.6), 2.0 * math.pi / 2.3
    problem = ss.Problem(BLOCK, LAW, pull_rate=PULLS["steps"], initial_load=2.0, ground_acceleration=shaken)
    run = ss.simulate(problem, 12.0, rtol=1e-12)
    (slip, rate, _, work, damped, _), starts = integrated(problem, 12.0, lambda t: 1.1 * math.sin(frequency * t + 0.6))
    assert run.slip_rate(np.linspace(0.0, 12.0, 999)).min() >= 0.0
    assert float(run.slip(12.0)) == pytest.approx(slip, rel=1e-9)
    assert float(run.slip_rate(12.0)) == pytest.approx(rate, rel=1e-8, abs=1e-9)
    assert run.events.start.to_numpy() == pytest.approx(np.array(starts), abs=1e-9)
    energies = run.energy([12.0])
    assert [float(energies[one][0]) for one in ("work", "damped")] == pytest.approx([work, damped], rel=1e-9)
    assert abs(float(energies.balance[0])) < 1e-12 * work


# ---- stability --------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("damping", [0.0, 3.0, 30.0])
def test_steady_sliding_is_as_stable_as_both_dampings_make_it(damping: float) -> None:
    """The growth rate is that of Rice & Ruina's cubic with damping + driver_damping, to 1e-9 of its size."""
    law = ss.friction.RateAndState(reference=0.6, a=0.01, b=0.015, distance=1e-3, rate=1e-2)
    body = ss.SpringBlock(1.0, 30.0, 100.0, damping=1.0, driver_damping=damping)
    sliding = steady_slidings(ss.Problem(body, law, pull_rate=1e-2, initial_rate="steady")).slidings[0]
    known = SteadySliding(100.0, 0.01, 0.015, 1e-3, 1e-2)
    growth = known.block_growth(30.0, 1.0, 1.0 + damping)
    assert sliding.growth == pytest.approx(growth.real, rel=1e-9)
    assert sliding.stable is bool(known.critical_stiffness(1.0, 1.0 + damping) < 30.0)


# ---- files, commands, sweeps ------------------------------------------------------------------------------------------------

TEXT = """
title = "A head on a soft mount"
[body]
kind = "spring-block"
mass = "2 kg"
stiffness = "50 N/m"
normal_force = "10 N"
driver_damping = "4 N s/m"
[friction]
kind = "coulomb"
static = 0.6
dynamic = 0.5
[loading.pull_rate]
kind = "steps"
times = ["0 s", "1 s", "3 s"]
values = ["0.1 m/s", "0.5 m/s", "0.02 m/s"]
[initial]
load = "4 N"
[run]
duration = "20 s"
"""


@pytest.mark.slow
def test_a_run_from_a_file_is_kept_and_resumed_to_the_bit(tmp_path: Path) -> None:
    path = tmp_path / "mount.toml"
    path.write_text(TEXT, encoding="utf-8")
    scenario = ss.load_scenario(str(path))
    assert scenario.problem.body == ss.SpringBlock(2.0, 50.0, 10.0, driver_damping=4.0)
    whole = ss.simulate(scenario)
    opened = ss.open_solution(whole.to_netcdf(tmp_path / "run.nc"))
    assert opened.problem == scenario.problem
    assert np.array_equal(opened.energy([20.0]).damped, whole.energy([20.0]).damped)
    for stop in (0.7, 1.0, 2.2):
        ss.simulate(scenario, stop, checkpoint=tmp_path / "part.nc")
        assert np.array_equal(ss.resume(tmp_path / "part.nc", 20.0).history.store.rate, whole.history.store.rate)


def test_bad_numbers_are_refused_in_one_line() -> None:
    with pytest.raises(ss.InputError, match=r"^SpringBlock: driver_damping must be at least 0 N s/m, got -1") as told:
        replace(BLOCK, driver_damping=-1.0)
    assert "\n" not in str(told.value)
    with pytest.raises(ss.InputError, match="driver_damping must be a number in N m s"):
        ss.RotatingBlock(1.0, 1.0, 1.0, driver_damping="3 kg")


def test_check_says_how_damped_swings_are_and_what_the_dashpot_bears(command: Command, tmp_path: Path) -> None:
    """(damping + driver_damping) / (2 sqrt(K m)) = 0.2, c V = 0.4 N, and the load grows by K V + c dV/dt while the block rests."""
    path = tmp_path / "mount.toml"
    path.write_text(TEXT, encoding="utf-8")
    told = command("check", str(path)).out
    assert re.search(r"damping ratio +0\.2 ", told)
    assert re.search(r"c V +0\.4 N +part of the load", told)
    assert "damping + driver_damping + S mu'(v) = 4 N s/m" in told
    ramp = ss.Problem(BLOCK, LAW, pull_rate=PULLS["ramps"], initial_load=4.0)
    assert loading_rate(ramp) == pytest.approx(STIFFNESS * 0.1 + DASHPOT * 0.4, rel=1e-14)
