"""Laws with two states, built in and typed, against integrators that share no code with the package.

The truths are written with signed slip rates, by hand: scipy's Radau method for a block, with or without mass far from mattering,
and the method of steps for a slab, whose slip rate scipy's brentq finds from the contact equation.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

import stickslip as ss
from stickslip.friction import FromExpression, FromFunction, TwoStateRateAndState
from stickslip.scenarios import Scenario, read_scenario

Floats = NDArray[np.float64]
CLOSE = 1e-7
"""Largest difference (1) from the truth, relative to the largest slip or state."""
FAULT = ss.SpringBlock(mass=1e3, stiffness=1e7, normal_force=1e7)
AXIS = ss.SpringBlock(mass=10.0, stiffness=2e5, normal_force=100.0)
SLAB = ss.ElasticSlab(density=2800.0, wave_speed=3500.0, thickness=100.0, normal_stress=1e7)


class Truth(NamedTuple):
    """A law and, by hand: mu and the rates of change of the states, from signed slip rate (m/s) and states as formulas use them."""

    law: Any
    mu: Callable[[float, float, float], float]
    change: Callable[[float, float, float], tuple[float, float]]


def two_state(evolution: str, second_b: float = 0.006) -> Truth:
    """Rate-and-state friction with the logarithms of both states."""
    a, b, near, far, rate = 0.01, 0.01, 1e-3, 2e-2, 1e-6

    def change(v: float, w: float, w2: float) -> tuple[float, float]:
        v = abs(v)
        if evolution == "ageing":
            return rate * math.exp(-w) / near - v / near, rate * math.exp(-w2) / far - v / far
        y = math.log(max(v, 1e-300) / rate)
        return -v / near * (w + y), -v / far * (w2 + y)

    law = TwoStateRateAndState(0.6, a, b, near, second_b, far, rate, evolution)
    return Truth(law, lambda v, w, w2: a * math.asinh(v / (2.0 * rate) * math.exp((0.6 + b * w + second_b * w2) / a)), change)


WARM = Truth(
    FromExpression(
        "s*(z + v*d*(1 - s*z/(0.1*(1 + w))))/(1 + T)",
        {"s": "1e4 1/m", "d": "1 ms", "w": 0.5, "heat": "30 1/m", "tau": "50 ms"},
        evolution="dz/dt = v - s*v*z/(0.1*(1 + w)); dT/dt = heat*v - T/tau",
        state_unit="m; 1",
        at_reversal="first-changes-sign",
    ),
    lambda v, z, warmth: 1e4 * (z + 1e-3 * (v - abs(v) * 1e4 * z / 0.15)) / (1.0 + warmth),
    lambda v, z, warmth: (v - 1e4 * abs(v) * z / 0.15, 30.0 * abs(v) - warmth / 0.05),
)
"""Bristles that soften as the contact warms up: one state changes its sign at a reversal, the other keeps it."""


def block_truth(
    one: Truth, body: Any, force: Callable[[float], float], start: tuple[float, ...], t: Floats, method: str = "Radau"
) -> Floats:
    """Slip, slip rate and states at times t, by scipy; `force` is that of the spring (N) without slip."""

    def right(now: float, y: Floats) -> list[float]:
        u, v, w, w2 = y
        friction = body.normal_force * one.mu(v, w, w2)
        return [v, (force(now) - body.stiffness * u - friction) / body.mass, *one.change(v, w, w2)]

    found = solve_ivp(right, (0.0, t[-1]), start, method, t, rtol=1e-11, atol=1e-15, max_step=t[-1] / 500)
    return np.asarray(found.y)


def differences(run: Any, t: Floats, slip: Floats, states: Floats) -> list[float]:
    """The largest relative differences of slip and of both states from the truth."""
    found = [(run.slip(t), slip), (run.state(t), states[0]), (run.second_state(t), states[1])]
    return [float(np.abs(ours - truth).max() / np.abs(truth).max()) for ours, truth in found]


@pytest.mark.sampled(every=3)
@pytest.mark.parametrize(
    "one", [two_state("ageing"), two_state("slip"), two_state("ageing", -0.003)], ids=["ageing", "slip", "b < 0"]
)
@pytest.mark.parametrize("way", [1.0, -1.0], ids=["forward", "backward"])
def test_a_block_follows_two_states(one: Truth, way: float) -> None:
    start = {"initial_load": way * 6.2e6, "initial_state": 100.0, "initial_second_state": 50.0}
    problem = ss.Problem(FAULT, one.law, pull_rate=way * 1e-4, **start)
    run, t = ss.simulate(problem, 60.0), np.linspace(0.0, 60.0, 61)
    at_first = (0.0, problem.rate, math.log(0.1), math.log(50.0 / 2e4))
    slip, _, *w = block_truth(one, FAULT, lambda now: way * (6.2e6 + 1e3 * now), at_first, t)
    assert max(differences(run, t, slip, np.exp(w) * [[1e3], [2e4]])) < CLOSE
    assert way * slip[-1] > 1e-3


@pytest.mark.sampled(every=2)
@pytest.mark.parametrize("way", [1.0, -1.0], ids=["forward", "backward"])
def test_bristles_that_warm_up_follow_their_loop(way: float) -> None:
    pull = ss.loading.Sinusoidal(0.0, way * 2e-3, 0.2)
    problem = ss.Problem(AXIS, WARM.law, pull_rate=pull, initial_load=0.0, initial_second_state=0.3)
    run, t = ss.simulate(problem, 0.5), np.linspace(0.0, 0.5, 251)
    turn = 2.0 * math.pi / 0.2
    force = lambda now: way * AXIS.stiffness * 2e-3 / turn * (1.0 - math.cos(turn * now))  # noqa: E731
    slip, _, *states = block_truth(WARM, AXIS, force, (0.0, 0.0, 0.0, 0.3), t, "DOP853")
    assert (np.diff(np.sign(run.slip_rate(t[1:]))) != 0.0).sum() >= 4  # it does reverse
    assert max(differences(run, t, slip, np.array(states))) < CLOSE
    energy = run.energy(t)
    assert float(np.abs(energy.balance).max() / np.abs(energy.heat[-1])) < 1e-8


def slab_truth(one: Truth, problem: Any, t: Floats) -> tuple[Floats, Floats]:
    """Slip and states at times t of a massless slab with a rigid driver: one round trip after the other."""
    body, trip = problem.body, problem.body.two_way_time
    past: list[Any] = []

    def load(s: float) -> float:
        return float(problem.load) if s <= trip or not past else load(s - trip) - 2.0 * body.impedance * rate(s - trip)

    def rate(s: float) -> float:
        return solved(load(s), past[min(int(s / trip), len(past) - 1)](s)[1:])

    def solved(force: float, w: Floats) -> float:
        def missing(v: float) -> float:
            return body.impedance * v + body.normal_stress * one.mu(v, float(w[0]), float(w[1])) - force

        return float(brentq(missing, -100.0, 100.0, xtol=1e-18, rtol=1e-14))

    y, n = np.array([0.0, *problem.states]), 0
    while n * trip < t[-1]:
        found = solve_ivp(
            lambda s, y: [v := solved(load(s), y[1:]), *one.change(v, y[1], y[2])],
            (n * trip, (n + 1) * trip), y, "DOP853", dense_output=True, rtol=1e-11, atol=1e-15, first_step=1e-9, max_step=4e-4,
        )  # fmt: skip
        past.append(found.sol)
        y, n = found.y[:, -1], n + 1
    values = np.array([past[min(int(s / trip), n - 1)](s) for s in t])
    return values[:, 0], values[:, 1:].T


@pytest.mark.parametrize(("one", "load"), [(two_state("ageing"), 7.0e6), (two_state("ageing"), -7.0e6), (WARM, 2.0e6)])
def test_a_slab_follows_the_method_of_steps(one: Truth, load: float) -> None:
    given = (100.0, 3e3) if one is not WARM else (0.0, 0.2)
    problem = ss.Problem(SLAB, one.law, initial_load=load, initial_state=given[0], initial_second_state=given[1])
    duration = 2.4 * SLAB.two_way_time
    run, t = ss.simulate(problem, duration), np.linspace(0.0, duration, 33)
    slip, states = slab_truth(one, problem, t)
    seen = np.exp(states) * [[1e3], [2e4]] if one is not WARM else states
    assert max(differences(run, t, slip, seen)) < CLOSE


def test_equal_states_are_one_state_of_the_sum() -> None:
    """Two states with one distance are one with b + second_b: relative 1e-9."""
    two = TwoStateRateAndState(0.6, 0.01, 0.009, 1e-3, 0.006, 1e-3)
    one = ss.friction.RateAndState(0.6, 0.01, 0.015, 1e-3)
    start: dict[str, Any] = {"pull_rate": 1e-5, "initial_load": 6.2e6, "initial_state": 1e4}
    problems = ss.Problem(FAULT, two, **start, initial_second_state=1e4), ss.Problem(FAULT, one, **start)
    runs = [ss.simulate(problem, 100.0) for problem in problems]
    t = np.linspace(1.0, 100.0, 50)
    assert runs[0].slip(t) == pytest.approx(runs[1].slip(t), rel=1e-9)
    assert runs[0].second_state(t) == pytest.approx(runs[1].state(t), rel=1e-8)


def test_a_typed_and_a_traced_law_give_the_numbers_of_that_of_the_package() -> None:
    """With states that are the logarithms themselves: relative 1e-8."""
    numbers: dict[str, Any] = {"mu_0": 0.6, "a": 0.01, "b": 0.01, "c": 0.006, "r": "1 um/s", "near": "1 mm", "far": "20 mm"}
    friction = "a*arcsinh(v/(2*r)*exp((mu_0 + b*x + c*y)/a))"
    typed = FromExpression(friction, numbers, evolution="dx/dt = (r*exp(-x) - v)/near\ndy/dt = (r*exp(-y) - v)/far")

    @FromFunction(state=("x", "y"), **numbers)
    def traced(v: Any, x: Any, y: Any, mu_0: Any, a: Any, b: Any, c: Any, r: Any, near: Any, far: Any) -> Any:
        mu = a * np.arcsinh(v / (2 * r) * np.exp((mu_0 + b * x + c * y) / a))
        return mu, (r * np.exp(-x) - v) / near, (r * np.exp(-y) - v) / far

    start: dict[str, Any] = {"pull_rate": 1e-4, "initial_load": 6.2e6}
    logs = {"initial_state": math.log(0.1), "initial_second_state": math.log(50.0 / 2e4)}
    problems = [ss.Problem(FAULT, law, **start, **logs) for law in (typed, traced)]
    problems.append(ss.Problem(FAULT, two_state("ageing").law, **start, initial_state=100.0, initial_second_state=50.0))
    t = np.linspace(1.0, 60.0, 30)
    slips = [ss.simulate(problem, 60.0).slip(t) for problem in problems]
    assert slips[0] == pytest.approx(slips[2], rel=1e-8)
    assert slips[1] == pytest.approx(slips[2], rel=1e-8)


def test_a_law_of_two_states_starts_healed_or_steady() -> None:
    """Steady states in closed form, rel 1e-12; two states that depend on each other, rel 1e-9."""
    law = two_state("ageing").law
    steady = ss.Problem(FAULT, law, pull_rate=1e-5)
    assert steady.states == pytest.approx([math.log(0.1), math.log(0.1)], rel=1e-12)
    assert steady.load == pytest.approx(1e7 * float(law.steady_coefficient(1e-5)), rel=1e-12)
    coupled = FromExpression("0.3 + 0.1*x + 0.1*y", evolution="dx/dt = 1 + 0.5*y - x; dy/dt = 2 - 0.25*x - y")
    healed = ss.Problem(FAULT, coupled, initial_load=0.0)
    assert healed.states == pytest.approx([2.0 / 1.125, 2.0 - 0.5 / 1.125], rel=1e-9)


def test_a_steady_state_is_worked_out_from_the_pull_rate() -> None:
    """Closed form, rel 1e-12, in a scenario whose pull rate is changed, too."""
    law, start = two_state("ageing").law, {"initial_load": 6.2e6, "initial_second_state": 50.0}
    problem = ss.Problem(FAULT, law, pull_rate=1e-4, initial_state="steady", **start)
    assert problem.given_states == pytest.approx((10.0, 50.0), rel=1e-12)
    assert "initial_state='steady'" in repr(problem)
    scenario = read_scenario(Scenario(problem, 60.0).to_toml(), "steady")
    assert scenario.problem == problem
    faster = scenario.with_values({"loading.pull_rate": 1e-3}).problem
    assert faster.given_states == pytest.approx((1.0, 50.0), rel=1e-12)
    backward = ss.Problem(
        AXIS, ss.friction.LuGre(**ss.friction.LuGre.example), pull_rate=-0.1, initial_load=0.0, initial_state="steady"
    )
    assert backward.states[0] == pytest.approx(-0.1 / 1e4, rel=1e-6)


def test_a_run_with_two_states_is_saved_resumed_and_drawn(tmp_path: Any) -> None:
    start = {"initial_load": 6.2e6, "initial_state": 100.0, "initial_second_state": 50.0}
    problem = ss.Problem(FAULT, two_state("slip").law, pull_rate=1e-4, **start)
    whole, half = ss.simulate(problem, 60.0), ss.simulate(problem, 30.0)
    half.to_netcdf(tmp_path / "run.nc")
    again = ss.open_solution(tmp_path / "run.nc")
    t = np.linspace(0.0, 60.0, 61)
    assert (again.second_state(t[:30]) == half.second_state(t[:30])).all()
    assert (ss.resume(tmp_path / "run.nc", 60.0).second_state(t) == whole.second_state(t)).all()
    assert again.curves[-2:] == ("state", "second_state")
    assert again.plot.second_state().axes[0].get_ylabel() == "second state (s)"
    assert again.to_dataset(t[:30])["second_state"].attrs["units"] == "s"
    assert read_scenario(Scenario(problem, 60.0).to_toml(), "again").problem == problem


REFUSED: dict[str, tuple[Callable[[], Any], str]] = {
    "second state missing": (
        lambda: ss.Problem(FAULT, two_state("ageing").law, initial_load=6e6, initial_state=1.0),
        "needs initial_second_state, the state theta_2",
    ),
    "second state of one": (
        lambda: ss.Problem(FAULT, ss.friction.LuGre(**ss.friction.LuGre.example), initial_load=0.0, initial_second_state=1.0),
        "initial_second_state: LuGre has no second state variable",
    ),
    "three states": (
        lambda: FromExpression("0.3 + x + y + z", evolution="dx/dt = -x; dy/dt = -y; dz/dt = -z"),
        "a law has at most 2 states, this one has 3",
    ),
    "one name twice": (
        lambda: FromExpression("0.3 + x", evolution="dx/dt = -x; dx/dt = -2*x"),
        "cannot be called x, which is taken",
    ),
    "one unit for two": (
        lambda: FromExpression("0.3 + x + y", evolution="dx/dt = -x; dy/dt = -y", state_unit="m"),
        'give one unit for each state, such as "m; 1"',
    ),
    "no second to keep": (
        lambda: FromExpression("0.3 + x", evolution="dx/dt = -x", at_reversal="first-changes-sign"),
        "the law has no second state; changes-sign is for one state",
    ),
    "two numbers for two states": (
        lambda: FromFunction(lambda v, x, y: (0.3 + x + y, -x), state=("x", "y")),
        "it must return three numbers, the friction coefficient and dx/dt and dy/dt",
    ),
    "steady at rest": (
        lambda: ss.Problem(FAULT, two_state("ageing").law, initial_load=6e6, initial_state="steady", initial_second_state=1.0),
        "initial_state 'steady': the pull rate is 0 at first: give a number",
    ),
    "no direct effect": (
        lambda: TwoStateRateAndState(0.6, 0.0, 0.01, 1e-3, 0.006, 1e-2),
        "TwoStateRateAndState: a must be greater than 0",
    ),
    "a second state that is not there": (
        lambda: ss.simulate(ss.Problem(AXIS, ss.friction.Dahl(0.1, 1e4), initial_load=0.0), 0.01).second_state(0.0),
        "second_state: Dahl has no second state variable",
    ),
}


@pytest.mark.parametrize("name", REFUSED)
def test_what_a_law_of_two_states_lacks_is_told_in_one_line(name: str) -> None:
    make, message = REFUSED[name]
    with pytest.raises(ss.InputError) as caught:
        make()
    assert message in str(caught.value)
    assert "\n" not in str(caught.value)
