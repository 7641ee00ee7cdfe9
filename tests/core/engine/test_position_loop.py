"""An axis in a position loop follows independent integrators, keeps its energy, and is a block on a spring without an integral."""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.linalg import expm
from scipy.optimize import brentq

import stickslip as ss
from stickslip.foundation.arrays import Floats
from stickslip.problem.scenarios import Scenario, read_scenario
from stickslip.run.check.examine import examine

GAINS: dict[str, float] = {
    "mass": 1.0,
    "proportional_gain": 100.0,
    "normal_force": 10.0,
    "integral_gain": 50.0,
    "derivative_gain": 10.0,
    "damping": 0.5,
}
STEP = 0.1
TIGHT, RTOL = 1e-12, 1e-10


@dataclass
class Axis:
    """Own integrator of an axis under Coulomb friction, with its reference at a steady rate: exponentials between events.

    The motion is (lag, slip rate, integral, 1).
    """

    gains: dict[str, float]
    static: float
    kinetic: float
    rate: float
    grid: float = 1e-3

    def sliding(self, way: float) -> Floats:
        m, kp, ki, kd, c = (
            self.gains[name] for name in ("mass", "proportional_gain", "integral_gain", "derivative_gain", "damping")
        )
        push = (kd * self.rate - way * self.kinetic) / m
        return np.array([[0, -1, 0, self.rate], [kp / m, -(kd + c) / m, 1 / m, push], [ki, 0, 0, 0], [0, 0, 0, 0]])

    def resting(self, since: float, motion: Floats) -> Floats:
        lag = motion[0] + self.rate * since
        gained = self.gains["integral_gain"] * (motion[0] + 0.5 * self.rate * since) * since
        return np.array([lag, 0.0, motion[2] + gained, 1.0])

    def force(self, motion: Floats) -> float:
        kp, kd = self.gains["proportional_gain"], self.gains["derivative_gain"]
        return float(kp * motion[0] + motion[2] + kd * self.rate)

    def events(self, motion: Floats, duration: float) -> list[tuple[float, Floats]]:
        """Return the times (s) when slip begins or ends, and the motion then."""
        time, way, found = 0.0, 0.0, []
        if abs(self.force(motion)) > self.static:
            way = float(np.sign(self.force(motion)))
        while time < duration:
            if way == 0.0:
                since = 0.0
                while abs(self.force(self.resting(since + self.grid, motion))) <= self.static and time + since < duration:
                    since += self.grid
                if time + since >= duration:
                    break
                way = float(np.sign(self.force(self.resting(since + self.grid, motion))))
                since = brentq(self.beyond, since, since + self.grid, (motion, way), xtol=1e-15, rtol=1e-15)
                motion, time = self.resting(since, motion), time + since
                found.append((time, motion))
            flow, first = self.sliding(way), 1e-4 * self.grid
            motion, time, step = expm(flow * first) @ motion, time + first, expm(flow * self.grid)
            while way * (step @ motion)[1] > 0.0 and time < duration:
                motion, time = step @ motion, time + self.grid
            if time >= duration:
                break
            since = brentq(rate_after, 0.0, self.grid, (flow, motion), xtol=1e-15, rtol=1e-15)
            motion, time = expm(flow * since) @ motion, time + since
            motion[1] = 0.0
            found.append((time, motion))
            way = float(np.sign(self.force(motion))) if abs(self.force(motion)) > self.static else 0.0
        return found

    def beyond(self, since: float, motion: Floats, way: float) -> float:
        return way * self.force(self.resting(since, motion)) - self.static


def rate_after(since: float, flow: Floats, motion: Floats) -> float:
    return float((expm(flow * since) @ motion)[1])


def problem(static: float = 0.4, kinetic: float = 0.3, **changed: Any) -> ss.Problem:
    given = {"pull_rate": 0.0, "initial_load": 0.0} | {name: changed.pop(name) for name in list(changed) if name in PROBLEM}
    body = ss.PositionLoop(**{**GAINS, "reference_step": STEP, **changed})
    return ss.Problem(body, ss.friction.Coulomb(static, kinetic), **given)


PROBLEM = ("pull_rate", "initial_load", "initial_rate", "normal_load")


@pytest.mark.sampled(every=2)
@pytest.mark.parametrize("rate", [0.0, 2e-3])
def test_hunting_meets_exponentials_between_roots_of_rest(rate: float) -> None:
    solution = ss.simulate(problem(pull_rate=rate), 200.0, rtol=TIGHT)
    first = np.array([STEP, 0.0, -GAINS["derivative_gain"] * rate, 1.0])  # the load of the start is all that is felt
    expected = Axis(GAINS, 4.0, 3.0, rate).events(first, 200.0)
    times = np.array([time for time, _ in expected])
    begun = solution.events.start.to_numpy()
    ended = begun + solution.events.duration.to_numpy()
    found = np.sort(np.concatenate([begun, ended]))[1:][: len(times)]
    assert len(times) > 6
    assert found[: len(times)] == pytest.approx(times[: len(found)], rel=1e-10)
    lags = np.array([motion[0] for _, motion in expected])
    slips = STEP + rate * times - solution.slip(times)
    assert slips == pytest.approx(lags, abs=1e-11)


def test_hunting_goes_on_where_static_friction_exceeds_kinetic_friction_and_fades_where_it_does_not() -> None:
    hunts = ss.simulate(problem(), 3000.0).events.slip.abs().to_numpy()
    assert hunts[-20:] == pytest.approx(np.full(20, hunts[-1]), rel=0.05)
    fades = ss.simulate(problem(0.3, 0.3), 3000.0).events
    assert len(fades) < 15
    assert abs(fades.slip.to_numpy()[-1]) < 0.05 * hunts[-1]


def test_a_loop_without_friction_is_three_exponentials() -> None:
    body = {name: value for name, value in GAINS.items() if name != "damping"}
    given = ss.Problem(ss.PositionLoop(**body, reference_step=STEP), ss.friction.Coulomb(0.0, 0.0), 0.01, initial_load=0.0)
    solution = ss.simulate(given, 4.0, rtol=1e-13)
    t = np.linspace(0.1, 4.0, 9)
    flow = Axis(body | {"damping": 0.0}, 0.0, 0.0, 0.01).sliding(1.0)
    exact = np.array([expm(flow * time) @ np.array([STEP, 0.0, -GAINS["derivative_gain"] * 0.01, 1.0]) for time in t])
    assert STEP + 0.01 * t - solution.slip(t) == pytest.approx(exact[:, 0], abs=1e-13)
    assert solution.slip_rate(t) == pytest.approx(exact[:, 1], abs=1e-12)


LUGRE: dict[str, float] = {"static": 0.4, "dynamic": 0.3, "rate": 2e-3, "stiffness": 2e4, "damping": 20.0, "viscosity": 0.1}
TURNING = ss.loading.Waypoints([0.0, 0.7, 1.5, 4.0], [0.0, 0.03, 0.03, -0.02])
PULLS = {"swing": ss.loading.Sinusoidal(0.001, 0.05, 2.0, 0.4), "ways": TURNING}


def with_bristles(pull: Any, times: Floats) -> Floats:
    """Return the slip (m) of the axis under LuGre friction at times (s), from rest: solve_ivp from break to break of the pull."""
    g, law = GAINS, LUGRE

    def flow(t: float, x: Floats, start: float, value: float, slope: float) -> list[float]:
        lag, v, q, z = x
        pulls = value + slope * (t - start) + pull.tone.amplitude * np.sin(pull.tone.frequency * t + pull.tone.phase)
        held = law["dynamic"] + (law["static"] - law["dynamic"]) * np.exp(-((v / law["rate"]) ** 2))
        bends = v - law["stiffness"] * abs(v) * z / held
        friction = law["stiffness"] * z + law["damping"] * bends + law["viscosity"] * v
        force = g["proportional_gain"] * lag + q + g["derivative_gain"] * (pulls - v) - g["damping"] * v
        return [pulls - v, (force - g["normal_force"] * friction) / g["mass"], g["integral_gain"] * lag, bends]

    before = 0.0 if pull.rests_before else pull.first  # what the load of the start has in it
    motion, found = np.array([0.0, 0.0, -g["derivative_gain"] * before, 0.0]), []
    edges = [*pull.parts[0][pull.parts[0] < times[-1]], times[-1]]
    for n, (begin, end) in enumerate(pairwise(edges)):
        inside = times[(times > begin) & (times <= end)]
        part = pull.parts[:, n]
        solved = solve_ivp(flow, (begin, end), motion, "Radau", np.unique([*inside, end]), args=tuple(part), rtol=1e-10, atol=1e-13)
        motion = solved.y[:, -1]
        lag = solved.y[0, : len(inside)]
        found.append(way_of(pull, inside) - lag)
    return np.concatenate(found)


def way_of(pull: Any, times: Floats) -> Floats:
    """Return the way (m) of the reference up to times (s), by quadrature between its breaks."""
    edges = [*pull.parts[0], 1e9]
    total = np.zeros(len(times))
    for begin, end in pairwise(edges):
        x, w = np.polynomial.legendre.leggauss(60)
        for n, time in enumerate(times):
            if time > begin:
                high = min(time, end)
                inside = begin + 0.5 * (high - begin) * (1.0 + x)
                total[n] += 0.5 * (high - begin) * float(w @ pull.at(inside))
    return total


@pytest.mark.slow
@pytest.mark.sampled(every=2)
@pytest.mark.parametrize("pull", PULLS)
def test_bristles_under_a_moving_reference_meet_another_integrator(pull: str) -> None:
    start = {"initial_load": 0.0, "initial_rate": 0.0, "initial_state": 0.0}
    given = ss.Problem(ss.PositionLoop(**GAINS), ss.friction.LuGre(**LUGRE), PULLS[pull], **start)
    solution = ss.simulate(given, 3.5, rtol=1e-10)
    t = np.linspace(0.4, 3.2, 8)
    assert solution.slip(t) == pytest.approx(with_bristles(PULLS[pull], t), abs=2e-9)
    assert np.ptp(way_of(PULLS[pull], t)) > 1e-2
    check_account(solution)


@pytest.mark.parametrize("integral", [0.0, 10.0])
def test_waypoints_begin_from_a_reference_at_rest(integral: float) -> None:
    """The same way begun a moment (1e-6 s) later makes the same motion, to 5e-7 m; it ends within what friction holds, 1e-5 m."""
    body = ss.PositionLoop(1.0, 100.0, 0.01, derivative_gain=20.0, integral_gain=integral)
    ways = ss.loading.Waypoints([0.0, 1.0], [0.0, 0.05]), ss.loading.Waypoints([0.0, 1e-6, 1.0], [0.0, 0.0, 0.05])
    runs = [ss.simulate(ss.Problem(body, ss.friction.Coulomb(0.1, 0.1), one, initial_load=0.0), 30.0) for one in ways]
    times = np.linspace(0.0, 30.0, 301)
    assert runs[0].slip(times) == pytest.approx(runs[1].slip(times), abs=5e-7)
    assert float(runs[0].slip(30.0)) == pytest.approx(0.05, abs=2e-5)
    check_account(runs[0])


def test_a_block_with_a_dashpot_begins_from_waypoints_at_rest_too() -> None:
    body = ss.SpringBlock(1.0, 100.0, 0.01, driver_damping=20.0)
    way = ss.loading.Waypoints([0.0, 1.0], [0.0, 0.05])
    solution = ss.simulate(ss.Problem(body, ss.friction.Coulomb(0.1, 0.1), way, initial_load=0.0), 10.0)
    assert float(solution.slip(10.0)) == pytest.approx(0.05, abs=2e-5)
    check_account(solution)


def check_account(solution: ss.Solution) -> None:
    """Assert that the energies balance, the contact equation is proven, and the load follows from slip and reference."""
    energy = solution.energy(np.linspace(0.0, solution.duration, 7))
    assert abs(energy.balance).max() < 1e-9 * max(float(energy.heat.max()), 1e-9)
    proven, scale = solution.proven, solution.problem.normal
    assert proven.residual < 1e-6 * scale
    assert proven.load < 1e-9 * scale


def test_energies_balance_and_the_run_is_proven() -> None:
    check_account(ss.simulate(problem(pull_rate=2e-3), 60.0))
    check_account(ss.simulate(problem(pull_rate=TURNING), 60.0))


def test_a_loop_without_an_integral_is_a_block_on_a_spring_bit_for_bit() -> None:
    gains = GAINS | {"integral_gain": 0.0}
    block = ss.SpringBlock(1.0, 100.0, 10.0, damping=0.5, driver_damping=10.0)
    for law in (ss.friction.Coulomb(0.4, 0.3), ss.friction.LuGre(**LUGRE)):
        other = {} if law.sticks else {"initial_state": 0.0, "initial_rate": 0.0}
        problems = (ss.Problem(body, law, 0.02, initial_load=0.5, **other) for body in (ss.PositionLoop(**gains), block))
        one, two = (ss.simulate(given, 20.0) for given in problems)
        t = np.linspace(0.0, 20.0, 301)
        assert np.array_equal(one.slip(t), two.slip(t))
        assert np.array_equal(one.load(t), two.load(t))


@pytest.mark.slow
def test_a_run_goes_on_bit_for_bit_from_a_file(tmp_path: Path) -> None:
    given = problem(pull_rate=PULLS["swing"])
    whole = ss.simulate(given, 30.0)
    ss.simulate(given, 11.0).to_netcdf(tmp_path / "half.nc")
    longer = ss.resume(tmp_path / "half.nc", 30.0)
    t = np.linspace(0.0, 30.0, 401)
    assert np.array_equal(whole.slip(t), longer.slip(t))
    assert np.array_equal(whole.load(t), longer.load(t))
    longer.to_netcdf(tmp_path / "whole.nc")
    assert np.array_equal(ss.open_solution(tmp_path / "whole.nc").load(t), whole.load(t))


def test_an_axis_that_turns_obeys_the_same_numbers() -> None:
    given = problem()
    other = {"normal_force": "normal_torque", "mass": "inertia"}
    turns = {other.get(name, name): number for name, number in GAINS.items()}
    rotary = replace(given, body=ss.RotaryLoop(**turns, reference_step=STEP))
    t = np.linspace(0.0, 100.0, 301)
    assert np.array_equal(ss.simulate(rotary, 100.0).slip(t), ss.simulate(given, 100.0).slip(t))


def test_a_long_rest_is_a_few_pieces() -> None:
    slow = problem(integral_gain=0.05)
    solution = ss.simulate(slow, 2e4)
    rests = solution.events.start.to_numpy()[1:] - (solution.events.start + solution.events.duration).to_numpy()[:-1]
    assert rests.max() > 1e3
    assert len(solution.history) < 60 + 2e4 / slow.round_trip_time


def test_a_loop_on_ground_that_moves_feels_its_inertia() -> None:
    moves = ss.loading.PiecewiseLinear([0.0, 1.0, 2.0, 9.0], [0.0, 3.0, 0.0, 0.0])
    check_account(ss.simulate(replace(problem(pull_rate=0.02), ground_acceleration=moves), 8.0))


def test_a_loop_is_refused_on_a_belt() -> None:
    with pytest.raises(ss.InputError, match="PositionLoop: a loop is not followed on a belt"):
        ss.PositionLoop(**GAINS).on_belt()


def said(given: ss.Problem) -> Any:
    return examine(Scenario(given, 10.0))


def test_check_says_whether_it_hunts_and_why() -> None:
    assert any("static friction exceeds that of sliding by 1 N" in text for text in said(problem()).chosen)
    assert any(text.startswith("does not hunt") for text in said(problem(0.3, 0.3)).chosen)
    falling = replace(problem(), friction=ss.friction.ExponentialStribeck(0.4, 0.3, 0.05, 1.0))
    assert any(text.startswith("may hunt") for text in said(falling).chosen)
    assert any("the reference jumps by 0.1 m at the start" in text for text in said(problem()).chosen)


def test_check_counts_the_jump_of_the_reference_at_the_start() -> None:
    """The step of 0.1 m makes a load of 10 N, and waypoints one of kd V(0) = 4 N; 3 N of friction slip at once."""
    held = ss.PositionLoop(1.0, 100.0, 10.0, reference_step=0.1)
    stepped = said(ss.Problem(held, ss.friction.ExponentialStribeck(0.4, 0.3, 0.01), 0.005, initial_load=0.0))
    assert stepped.start.startswith("slips at once: the load, with the jump of the reference, exceeds the static strength by 6 N")
    turned = ss.Problem(held, ss.friction.Coulomb(0.4, 0.3), 0.005, initial_load=0.0)
    assert ss.simulate(turned, 1.0).events.start[0] == 0.0
    back = replace(turned, body=replace(held, reference_step=-0.1))
    assert said(back).start.startswith("slips backwards at once")
    led = replace(held, reference_step=0.0, derivative_gain=40.0)
    ways = ss.loading.Waypoints([0.0, 1.0], [0.0, 0.1])
    found = said(ss.Problem(led, ss.friction.Coulomb(0.3, 0.3), ways, initial_load=0.0))
    assert "exceeds the static strength by 1 N" in found.start


def test_check_names_an_integral_gain_that_is_too_large() -> None:
    given = ss.PositionLoop(1.0, 100.0, 10.0, integral_gain=5000.0, derivative_gain=10.0, reference_step=0.1)
    found = said(ss.Problem(given, ss.friction.Coulomb(0.3, 0.3), 0.005, initial_load=0.0))
    assert any("exceeds the largest ki 1000 N/m/s" in text for text in found.chosen)
    assert "neither body nor driver damps" not in str(found.steady)


@pytest.mark.parametrize("share", [0.98, 1.02])
def test_steady_motion_and_rest_are_stable_by_rouths_condition(share: float) -> None:
    law = ss.friction.ExponentialStribeck(0.4, 0.3, 0.05, 1.0)
    rate = 0.03
    slope = -10.0 * 0.1 / 0.05 * np.exp(-rate / 0.05)
    body = GAINS | {"derivative_gain": 40.0}
    edge = (40.0 + 0.5 + slope) * 100.0 / 1.0
    given = ss.Problem(ss.PositionLoop(**body | {"integral_gain": share * edge}), law, pull_rate=rate, initial_rate="steady")
    found = said(given)
    (steady,) = found.steady.slidings
    roots = np.roots([1.0, 40.5 + slope, 100.0, share * edge])
    assert steady.stable == (share < 1.0) == bool((roots.real < 0.0).all())
    assert steady.growth == pytest.approx(roots.real.max(), rel=1e-6)
    first = (40.0 + 0.5 - 20.0) * 100.0
    held = replace(given, body=replace(given.body, integral_gain=share * first), initial_rate=None, initial_load=0.0)  # type: ignore[type-var]
    assert said(held).stability.startswith("stable in slip" if share < 1.0 else "oscillates with growing amplitude in slip")


def test_a_scenario_of_positions_is_read_and_written() -> None:
    given = Scenario(problem(pull_rate=TURNING, stop_ahead=0.2, restitution=0.5), 3.0)
    again = read_scenario(given.to_toml(), "again")
    assert again == given
    assert again.problem.pull_rate.kind == "waypoints"  # type: ignore[union-attr]
