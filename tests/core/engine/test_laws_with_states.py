"""Laws with one state and with two: where they start, what is the same law, what is refused, and what is saved."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import stickslip as ss
from stickslip.friction import FromExpression, FromFunction, TwoStateRateAndState
from stickslip.problem.scenarios import Scenario, read_scenario
from tests.core.engine.drawn import example_problem
from tests.core.engine.states_truth import AXIS, FAULT, HEALING, LIGHT, LUGRE, SLAB, two_states
from tests.messages import refused


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
    problems.append(ss.Problem(FAULT, two_states("ageing").law, **start, initial_state=100.0, initial_second_state=50.0))
    t = np.linspace(1.0, 60.0, 30)
    slips = [ss.simulate(problem, 60.0).slip(t) for problem in problems]
    assert slips[0] == pytest.approx(slips[2], rel=1e-8)
    assert slips[1] == pytest.approx(slips[2], rel=1e-8)


def test_a_law_of_two_states_starts_healed_or_steady() -> None:
    """Steady states in closed form, rel 1e-12; two states that depend on each other, rel 1e-9."""
    law = two_states("ageing").law
    steady = ss.Problem(FAULT, law, pull_rate=1e-5)
    assert steady.states == pytest.approx([math.log(0.1), math.log(0.1)], rel=1e-12)
    assert steady.load == pytest.approx(1e7 * float(law.steady_coefficient(1e-5)), rel=1e-12)
    several = FromExpression("0.3 + 0.01*z", evolution="dz/dt = (1 - z)*(2 - z)*(3 - z)")
    assert float(several.steady_state(1e-3)) == pytest.approx(1.0, rel=1e-15)  # of two that are stable the one nearest 0
    coupled = FromExpression("0.3 + 0.1*x + 0.1*y", evolution="dx/dt = 1 + 0.5*y - x; dy/dt = 2 - 0.25*x - y")
    healed = ss.Problem(FAULT, coupled, initial_load=0.0)
    assert healed.states == pytest.approx([2.0 / 1.125, 2.0 - 0.5 / 1.125], rel=1e-9)


def test_a_steady_state_is_worked_out_from_the_pull_rate() -> None:
    """Closed form, rel 1e-12, in a scenario whose pull rate is changed, too."""
    law, start = two_states("ageing").law, {"initial_load": 6.2e6, "initial_second_state": 50.0}
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


def test_a_law_with_a_state_starts_healed_at_rest_or_steady() -> None:
    assert ss.Problem(LIGHT, HEALING.law, initial_load=0.0).states[0] == pytest.approx(0.2, rel=1e-14)
    assert ss.Problem(AXIS, LUGRE.law, initial_load=0.0).states[0] == 0.0
    steady = ss.Problem(AXIS, LUGRE.law, pull_rate=-1e-3)
    assert steady.rate == -1e-3
    assert steady.states[0] == pytest.approx(-(0.1 + 0.05 * math.exp(-1.0)) / 1e4, rel=1e-14)
    assert ss.simulate(steady, 1.0).slip_rate(1e-6) == pytest.approx(-1e-3, rel=1e-6)


def test_a_massless_contact_whose_friction_falls_with_slip_rate_ends_in_words() -> None:
    law = ss.friction.FromExpression("0.6 + z - 0.2*(1 - exp(-v/0.01))", evolution="dz/dt = -z")
    problem = ss.Problem(SLAB, law, initial_load=0.61e7)
    assert "as long as friction" in ss.uniqueness(problem).summary
    with pytest.raises(ss.InputError, match="no step from here obeys the contact equation"):
        ss.simulate(problem, 1.0)
    with_mass = ss.ElasticSlab(2800.0, 3500.0, 100.0, 1e7, contact_mass=1e3)
    assert ss.simulate(ss.Problem(with_mass, law, initial_load=0.61e7), 0.1).status.ok


@pytest.mark.parametrize("kind", ["lugre", "dahl"])
def test_a_slab_that_hangs_in_its_bristles_finishes_at_loose_tolerances(kind: str) -> None:
    """Forces that nearly balance have no direction. Slip after twenty round trips: rel 10 rtol of that at 1e-10."""
    problem = example_problem(kind, "slab")
    exact = float(ss.simulate(problem, 3.0).slip(3.0))
    for rtol in np.geomspace(1e-6, 1e-8, 5):
        run = ss.simulate(problem, 3.0, rtol=float(rtol))
        assert run.status.ok
        assert float(run.slip(3.0)) == pytest.approx(exact, rel=10.0 * rtol, abs=0.0)


def test_a_run_with_two_states_is_saved_resumed_and_drawn(tmp_path: Any) -> None:
    start = {"initial_load": 6.2e6, "initial_state": 100.0, "initial_second_state": 50.0}
    problem = ss.Problem(FAULT, two_states("slip").law, pull_rate=1e-4, **start)
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
        lambda: ss.Problem(FAULT, two_states("ageing").law, initial_load=6e6, initial_state=1.0),
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
        lambda: ss.Problem(FAULT, two_states("ageing").law, initial_load=6e6, initial_state="steady", initial_second_state=1.0),
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
    with refused(message):
        make()
