"""A contact that starts in motion: in steady sliding, where load and friction balance, or at a given rate."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import stickslip as ss
from stickslip.foundation.quantities import quantity
from stickslip.friction import FrictionLaw
from stickslip.run.check.stability import start_of
from tests.messages import refused

NORMAL, SPEED = 1e8, 1e-4
LAW = ss.friction.RateAndState(0.6, 0.01, 0.015, 1e-5, 1e-6)
BLOCK = ss.SpringBlock(1e3, 1e10, NORMAL, damping=1e6)
SLAB = ss.ElasticSlab(2800, 3500, 3.0, NORMAL, contact_mass=2e3)
IMPEDANCE = SLAB.impedance
STICKING = ss.friction.HyperbolicRate(0.8, 0.3, 0.01)
BODIES = {
    "block": BLOCK,
    "slab, rigid": SLAB,
    "slab, half-space": replace(SLAB, driver_impedance=0.3 * IMPEDANCE),
    "slab, matched": replace(SLAB, driver_impedance=IMPEDANCE),
    "slab, dead load": replace(SLAB, driver_impedance=0.0),
}
EACH_BODY = pytest.mark.parametrize("name", BODIES)
BOTH_WAYS = pytest.mark.parametrize("way", [1, -1])


@pytest.mark.sampled(every=30)
@EACH_BODY
@BOTH_WAYS
@pytest.mark.parametrize("evolution", ["ageing", "slip", "prz"])
def test_without_load_and_state_it_starts_in_steady_sliding_and_stays_there(name: str, way: int, evolution: str) -> None:
    """Slip rate within 1e-10 of the pull rate for four Dc, although it is unstable; the kinetic energy of the body stays, too."""
    law, body = replace(LAW, evolution=evolution), BODIES[name]
    problem = ss.Problem(body, law, pull_rate=way * SPEED)
    friction = NORMAL * float(law.steady_coefficient(SPEED))
    assert problem.load == pytest.approx(way * (friction + body.damping * SPEED), rel=1e-15)
    run = ss.simulate(problem, 4.0 * law.distance / SPEED)
    times = np.linspace(0.0, run.duration, 300)
    assert run.slip_rate(times) == pytest.approx(way * SPEED, rel=1e-10)
    assert float(run.slip_rate(0.0, side="left")) == way * SPEED
    assert float(run.traction(0.0, side="left")) == pytest.approx(way * friction, rel=1e-14)
    assert run.state(times) == pytest.approx(float(law.steady_state(SPEED)), rel=1e-10)
    mass = body.inertia + (body.density * body.thickness if isinstance(body, ss.ElasticSlab) else 0.0)
    energy = run.energy(times[::23])
    assert np.abs(energy.kinetic).max() < 1e-9 * 0.5 * mass * SPEED**2
    assert np.abs(energy.balance).max() < 1e-11 * float(energy.heat[-1])
    if isinstance(body, ss.ElasticSlab):
        field = run.field(np.linspace(0.0, body.thickness, 7), times[:, None])
        assert field.velocity == pytest.approx(way * SPEED, rel=1e-10)
        assert field.stress == pytest.approx(way * friction, rel=1e-12)


@BOTH_WAYS
@pytest.mark.parametrize("share", [0.55, 0.6, 0.7])
def test_load_and_state_start_it_at_the_rate_at_which_they_balance(share: float, way: int) -> None:
    """Without damping v0 = 2 rate sinh(load / (S a)) exp(-(reference + b w) / a); with it, the balance closes to rounding.

    A relative error of 1e-15 of the load is one of 7e-14 of v0.
    """
    load, w = way * share * NORMAL, LAW.inner_state(0.3)
    undamped = ss.Problem(replace(BLOCK, damping=0.0), LAW, SPEED, initial_load=load, initial_state=0.3)
    exact = 2.0 * LAW.rate * np.sinh(load / (NORMAL * LAW.a)) * np.exp(-(LAW.reference + LAW.b * w) / LAW.a)
    assert undamped.rate == pytest.approx(exact, rel=1e-12)
    damped = ss.Problem(BLOCK, LAW, SPEED, initial_load=load, initial_state=0.3)
    resisted = BLOCK.damping * abs(damped.rate) + NORMAL * float(LAW.coefficient(0.0, abs(damped.rate), w))
    assert way * resisted == pytest.approx(load, rel=1e-14)
    assert 0.0 < way * damped.rate < way * undamped.rate
    assert float(ss.simulate(damped, 1e-6).slip_rate(0.0)) == damped.rate


def waves_towards(problem: ss.Problem) -> Callable[[float], float]:
    """The wave tau + Z v that reaches the contact before its own waves come back, from stress and velocity in the slab at t = 0.

    v(x) = v0 + (V - v0) x / h, and a uniform stress load - Z v0; at the driver sigma = far - Zd (v - V), or v = V.
    """
    body = problem.body
    assert isinstance(body, ss.ElasticSlab)
    stress, driver = problem.load - IMPEDANCE * problem.rate, body.driver_impedance

    def velocity(x: float) -> float:
        return problem.rate + (problem.pull_rate - problem.rate) * x / body.thickness

    def arriving(t: float) -> float:
        way = body.wave_speed * t
        if way < body.thickness:
            return stress + IMPEDANCE * velocity(way)
        down = IMPEDANCE * velocity(2.0 * body.thickness - way) - stress
        if np.isinf(driver):
            return 2.0 * IMPEDANCE * problem.pull_rate - down
        return (2.0 * (stress + driver * problem.pull_rate) + down * (1.0 - driver / IMPEDANCE)) / (1.0 + driver / IMPEDANCE)

    return arriving


@pytest.mark.sampled(every=4)
@pytest.mark.parametrize("name", [name for name in BODIES if name != "block"])
def test_a_slab_out_of_balance_agrees_with_scipy_from_the_start(name: str) -> None:
    """The first round trip, in which all that arrives is the initial state of the slab: 1e-8 of the slip, 1e-7 of ln v.

    The pull rate and Z v0 are large enough for the initial velocities to count: they change the load by up to 3 times S a.
    """
    body = BODIES[name]
    start = {"initial_load": 0.62 * NORMAL, "initial_state": 1e-4, "initial_rate": 0.3}
    problem = ss.Problem(body, LAW, pull_rate=0.2, **start)
    arriving, trip = waves_towards(problem), body.round_trip_time

    def derivative(t: float, y: Any) -> list[float]:
        rate = np.exp(y[1])
        friction = NORMAL * float(LAW.coefficient(0.0, rate, y[2]))
        force = arriving(t) - IMPEDANCE * rate - friction
        return [rate, force / (SLAB.contact_mass * rate), float(LAW.state_rate(LAW, 0.0, rate, y[2]))]

    values, times = [], []
    first = [0.0, np.log(0.3), LAW.inner_state(1e-4)]
    for begin, end in ((0.0, 0.5 * trip * (1.0 - 1e-12)), (0.5 * trip * (1.0 + 1e-12), trip * (1.0 - 1e-12))):
        times.append(np.linspace(begin, end, 20))
        found = solve_ivp(derivative, (begin, end), first, method="Radau", rtol=1e-11, atol=1e-14, t_eval=times[-1])
        values.append(found.y)
        first = found.y[:, -1].tolist()
    theirs, at = np.concatenate(values, axis=1), np.concatenate(times)
    run = ss.simulate(problem, trip)
    assert run.load(at) == pytest.approx(np.array([arriving(t) for t in at]), rel=1e-13)
    assert run.slip(at) == pytest.approx(theirs[0], rel=0.0, abs=1e-8 * theirs[0][-1])
    assert np.log(run.slip_rate(at)) == pytest.approx(theirs[1], rel=0.0, abs=1e-7)


@pytest.mark.sampled(every=5)
@EACH_BODY
def test_the_energy_balances_with_the_kinetic_energy_of_the_start(name: str) -> None:
    """Over ten round trips; at the start a slab with velocities from v0 to V has rho h (v0^2 + v0 V + V^2) / 6."""
    body, fast, pull = BODIES[name], 0.3, 0.2
    start = {"initial_load": 0.6 * NORMAL, "initial_state": 1e-4, "initial_rate": fast}
    run = ss.simulate(ss.Problem(body, LAW, pull_rate=pull, **start), 10.0 * SLAB.two_way_time, rtol=1e-12)
    energy = run.energy(np.linspace(0.0, run.duration, 41))
    assert np.abs(energy.balance).max() < 1e-9 * float(energy.heat[-1])
    late = run.duration
    own = 0.5 * body.inertia * (float(run.slip_rate(late)) ** 2 - fast**2)
    if isinstance(body, ss.ElasticSlab):
        x = np.linspace(0.0, body.thickness, 20_001)
        own += 0.5 * body.density * np.trapezoid(run.field(x, np.full(x.shape, late)).velocity ** 2, x)
        own -= body.density * body.thickness * (fast**2 + fast * pull + pull**2) / 6.0
    assert float(energy.kinetic[-1]) == pytest.approx(own, rel=1e-5)


def test_an_initial_rate_of_zero_starts_from_rest_under_its_load() -> None:
    problem = ss.Problem(BLOCK, LAW, pull_rate=SPEED, initial_load=0.6 * NORMAL, initial_state=0.1, initial_rate=0.0)
    run = ss.simulate(problem, 1e-3)
    assert (problem.rate, float(run.slip_rate(0.0)), float(run.traction(0.0, side="left"))) == (0.0, 0.0, 0.6 * NORMAL)
    assert float(run.slip_rate(1e-9)) > 0.0


def test_with_initial_rate_0_a_small_mass_starts_as_none_does() -> None:
    """Slip after 2 s, within 1e-3; a start at the rate that balances is 16 % off, whatever the mass."""
    slab, law = ss.ElasticSlab(2800.0, 3500.0, 1e3, 5e7), ss.friction.RateAndState(0.6, 0.01, 0.015, 1e-3, 1e-6)
    given = {"friction": law, "pull_rate": 1e-2, "initial_load": 3.1e7, "initial_state": 1.0}
    light = replace(slab, contact_mass=1e3)
    none, rest = (ss.simulate(ss.Problem(body, initial_rate=0.0, **given), 2.0) for body in (slab, light))
    balanced = ss.simulate(ss.Problem(light, **given), 2.0)
    slip = float(none.slip(2.0))
    assert float(rest.slip(2.0)) == pytest.approx(slip, rel=1e-3, abs=0.0)
    assert abs(float(balanced.slip(2.0)) / slip - 1.0) > 0.1
    assert "rate = 0" in start_of(balanced.problem)
    assert "rate = 0" not in start_of(rest.problem)


STEADY = "the pull rate is 0 at first, so nothing slides steadily"
REFUSED: dict[str, tuple[dict[str, Any], str]] = {
    "no pull": ({}, STEADY),
    "no rate": ({"initial_rate": 0.0, "pull_rate": SPEED}, "initial_rate is 0, so nothing slides steadily"),
    "state without load": ({"initial_state": 1.0, "pull_rate": SPEED}, "needs either initial_load or initial_excess"),
    "load without state": ({"initial_load": 6e7, "pull_rate": SPEED}, "needs initial_state, the state theta"),
    "too much load": (
        {"body": replace(BLOCK, damping=0.0), "initial_load": 9e8, "initial_state": 1.0},
        "at any slip rate up to 1000 m/s: give initial_rate",
    ),
    "no mass": (
        {"body": replace(SLAB, contact_mass=0.0), "initial_rate": 1e-3, "initial_load": 6e7, "initial_state": 1.0},
        "a contact without mass has no slip rate of its own",
    ),
    "a branch that falls": (
        {"body": replace(SLAB, contact_mass=0.0), "friction": ss.friction.HyperbolicRate(0.8, 0.3, 1.0), "initial_rate": 1e-3},
        "at 1 mm/s friction falls faster with the slip rate than waves carry away",
    ),
    "steady with a load": (
        {"initial_rate": "steady", "pull_rate": SPEED, "initial_load": 6e7, "initial_state": 1.0},
        "leave them out",
    ),
    "steady at rest": ({"initial_rate": "steady"}, STEADY),
    "driven too little": (
        {"body": BODIES["slab, half-space"], "initial_rate": "steady", "friction": STICKING, "far_stress": 1e6},
        "the driver does not keep the contact sliding",
    ),
    "driven too much": (
        {"body": BODIES["slab, half-space"], "initial_rate": "steady", "pull_rate": SPEED, "far_stress": 1e12},
        "the driver drives the contact ever faster",
    ),
    "no unit": ({"initial_rate": "3 kg", "pull_rate": SPEED}, "initial_rate must be a number in m/s"),
}


@pytest.mark.parametrize("name", REFUSED)
def test_what_cannot_start_is_refused_in_one_line(name: str) -> None:
    given, message = REFUSED[name]
    with refused(message):
        ss.Problem(**({"body": BLOCK, "friction": LAW} | given))


@pytest.mark.sampled(every=3)
@EACH_BODY
@pytest.mark.parametrize("mass", [0.0, 2e3])
@BOTH_WAYS
def test_a_contact_that_can_stick_may_start_in_steady_sliding(name: str, mass: float, way: int) -> None:
    """It slides on at the pull rate, to 1e-9 for ten round trips, under a load below its static strength."""
    body = BODIES[name]
    body = replace(body, contact_mass=mass) if isinstance(body, ss.ElasticSlab) else replace(body, mass=2e3, damping=5e5)
    problem = ss.Problem(body, STICKING, pull_rate=0.3 * way, initial_rate="steady")
    friction = body.normal_load * float(STICKING.coefficient(0.0, 0.3))
    assert problem.rate == 0.3 * way
    assert problem.load == pytest.approx(way * (friction + 0.3 * body.damping), rel=1e-15)
    run = ss.simulate(problem, 10.0 * problem.round_trip_time)
    times = np.linspace(0.0, run.duration, 200)
    assert run.slip_rate(times) == pytest.approx(0.3 * way, rel=1e-9)
    assert run.traction(times) == pytest.approx(way * friction, rel=1e-9)
    assert float(run.slip_rate(0.0, side="left")) == 0.3 * way
    energy = run.energy(times[::19])
    assert np.abs(energy.balance).max() < 1e-9 * float(energy.heat.max())


@pytest.mark.parametrize("driver", [0.3, 3.0])
def test_a_driver_that_gives_way_determines_the_rate_of_steady_sliding(driver: float) -> None:
    """Zd v + S mu(v) = far stress + Zd V, to 1e-13 of it; the contact then keeps the rate, to 1e-9."""
    body = replace(SLAB, contact_mass=0.0, driver_impedance=driver * IMPEDANCE)
    problem = ss.Problem(body, STICKING, pull_rate=0.3, far_stress=9e7, initial_rate="steady")
    drive = 9e7 + 0.3 * body.driver_impedance
    friction = NORMAL * float(STICKING.coefficient(0.0, problem.rate))
    assert body.driver_impedance * problem.rate + friction == pytest.approx(drive, rel=1e-13)
    assert problem.rate > 0.5
    run = ss.simulate(problem, 5.0 * problem.round_trip_time)
    assert run.slip_rate(np.linspace(0.0, run.duration, 100)) == pytest.approx(problem.rate, rel=1e-9)


SCENARIO = """
[body]
kind = "spring-block"
mass = 1000
stiffness = 1e10
normal_force = "100 MN"
[friction]
kind = "rate-and-state"
reference = 0.6
a = 0.01
b = 0.015
distance = "10 um"
[loading]
pull_rate = "0.1 mm/s"
[initial]
INITIAL
[run]
duration = "0.2 s"
"""


@pytest.mark.sampled(every=3)
@pytest.mark.parametrize(
    ("initial", "rate"),
    [
        ('rate = "1 mm/s"', 1e-3),
        ('rate = "1 mm/s"\nload = "60 MN"\nstate = "0.2 s"', 1e-3),
        ('rate = "steady"', "steady"),
    ],
)
def test_scenario_and_file_keep_the_initial_rate_bit_for_bit(initial: str, rate: float | str | None, tmp_path: Path) -> None:
    path = tmp_path / "start.toml"
    path.write_text(SCENARIO.replace("INITIAL", initial))
    scenario = ss.load_scenario(path)
    assert scenario.problem.initial_rate == rate
    run = ss.simulate(scenario)
    path.write_text(scenario.to_toml())
    assert ss.load_scenario(path).problem == scenario.problem
    run.to_netcdf(tmp_path / "run.nc")
    back = ss.open_solution(tmp_path / "run.nc")
    times = np.linspace(0.0, run.duration, 50)
    assert back.problem == run.problem
    assert np.array_equal(back.slip_rate(times), run.slip_rate(times))
    ss.simulate(scenario.problem, 0.1).to_netcdf(tmp_path / "half.nc")
    assert np.array_equal(ss.resume(tmp_path / "half.nc", 0.2).slip_rate(times), run.slip_rate(times))


def test_the_initial_rate_can_be_set(tmp_path: Path) -> None:
    path = tmp_path / "start.toml"
    path.write_text(SCENARIO.replace("INITIAL", 'load = "60 MN"\nstate = "0.2 s"'))
    scenario = ss.load_scenario(path)
    assert scenario.with_values({"initial.rate": "2 mm/s"}).problem.rate == 2e-3
    assert scenario.with_values({"initial.rate": 2e-3}).problem.parameters["initial.rate"].put(1e-5).rate == 1e-5


@dataclass(frozen=True)
class Smooth(FrictionLaw):
    """mu = top v / (v + rate): without state and without rest."""

    kind = "smooth"
    sticks = False
    many = True

    top: float = quantity("1", "friction at high slip rate", above=0)
    rate: float = quantity("m/s", "slip rate of half of it", above=0)

    @staticmethod
    def formula(law: Any, u: Any, v: Any) -> Any:
        return law.top * v / (v + law.rate)

    def range(self) -> tuple[float, float]:
        return 0.0, self.top


def test_a_law_without_state_starts_so_too() -> None:
    """S top v / (v + rate) = load at v = rate load / (S top - load)."""
    block = ss.SpringBlock(1.0, 100.0, 10.0)
    problem = ss.Problem(block, Smooth(0.6, 1e-3), initial_load=-1.0)
    assert problem.rate == pytest.approx(-1e-3 / 5.0, rel=1e-15)
    steady = ss.Problem(block, Smooth(0.6, 1e-3), pull_rate=1e-2)
    assert ss.simulate(steady, 5.0).slip_rate(np.linspace(0.0, 5.0, 50)) == pytest.approx(1e-2, rel=1e-12)
