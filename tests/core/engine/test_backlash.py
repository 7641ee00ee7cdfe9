"""A body beside a play moves as solve_ivp with events does: free in the play, on its spring outside, at rest under friction."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import stickslip as ss
from stickslip.foundation.arrays import Floats
from stickslip.problem.scenarios import Scenario, read_scenario
from stickslip.run.check.examine import examine


class Own:
    """A block with a play under Coulomb friction, moved by solve_ivp between located events; the state is (slip, slip rate)."""

    def __init__(self, given: ss.Problem, pulled: Any, force: Any = lambda _: 0.0) -> None:
        self.body: Any = given.body
        law: Any = given.friction
        self.static, self.kinetic = law.static * self.body.normal_force, law.dynamic * self.body.normal_force
        self.pulled, self.force, self.half = pulled, force, 0.5 * self.body.backlash
        first = given.load - self.body.driver_damping * pulled(0.0)[1]
        self.first_lag = first / self.body.stiffness + self.half * float(np.sign(first))
        self.way, self.side = 0, int(np.sign(first))

    def lag(self, time: float, slip: float) -> float:
        return float(self.first_lag + self.pulled(time)[0] - slip)

    def load(self, time: float, slip: float) -> float:
        spring = self.body.stiffness * (self.lag(time, slip) - self.side * self.half) if self.side else 0.0
        return float(spring + self.body.driver_damping * self.pulled(time)[1] + self.force(time))

    def moves(self, time: float, motion: Floats) -> Floats:
        drag = (self.body.damping + self.body.driver_damping) * motion[1]
        force = self.load(time, motion[0]) - drag - self.way * self.kinetic
        return np.array([motion[1], force / self.body.mass if self.way else 0.0])

    def arrests(self, _: float, motion: Floats) -> float:
        return float(self.way * motion[1]) if self.way else 1.0

    def yields(self, time: float, motion: Floats) -> float:
        return 1.0 if self.way else self.static - abs(self.load(time, motion[0]))

    def leaves_side(self, time: float, motion: Floats) -> float:
        lag = self.lag(time, motion[0])
        return self.half - abs(lag) if self.side == 0 else self.side * lag - self.half

    def run(self, times: Floats, breaks: tuple[float, ...] = ()) -> tuple[Floats, list[float]]:
        """Return slip and slip rate (rows) at times (s), and when slip begins (s)."""
        time, motion, begins, found = 0.0, np.zeros(2), [], np.zeros((2, len(times)))
        stops = sorted({*(one for one in breaks if one < times[-1]), float(times[-1])})
        events: list[Any] = [self.arrests, self.yields, self.leaves_side]
        events = [terminal(one) for one in events]
        while time < times[-1] - 1e-12:
            pull = self.load(time, motion[0])
            if self.way == 0 and abs(pull) > self.static * (1.0 - 1e-12):
                self.way = int(math.copysign(1, pull))
                begins.append(time)
            if self.way and motion[1] == 0.0:  # off the place where the arrest would be found at once
                motion = motion + 1e-11 * self.moves(time, motion)
            stop = next(one for one in stops if one > time + 1e-12)
            options: dict[str, Any] = {"rtol": 1e-12, "atol": 1e-15, "events": events, "dense_output": True, "max_step": 0.01}
            solved = solve_ivp(self.moves, (time, stop), motion, "DOP853", **options)
            inside = (times >= time) & (times <= solved.t[-1])
            if inside.any():
                found[:, inside] = solved.sol(times[inside])
            time, motion = float(solved.t[-1]), solved.y[:, -1].copy()
            if solved.t_events[0].size:
                motion[1], self.way = 0.0, 0
            elif solved.t_events[2].size:
                self.side = 0 if self.side else int(math.copysign(1, self.lag(time, motion[0])))
        return found, begins


def terminal(event: Any) -> Any:
    """Return an event that ends the integration where it falls through zero."""

    def crossing(time: float, motion: Floats) -> float:
        return float(event(time, motion))

    crossing.terminal, crossing.direction = True, -1  # type: ignore[attr-defined]
    return crossing


def there_and_back(rate: float, size: float) -> tuple[ss.loading.Waypoints, Any, tuple[float, ...]]:
    """Return a way of the driver forth and back and forth again, as a loading and as a function."""
    turns = size / rate
    at = np.array([0.0, turns, 3.0 * turns, 5.0 * turns])
    way = np.array([0.0, size, -size, size])

    def pulled(time: float) -> tuple[float, float]:
        n = min(int(np.searchsorted(at, time, side="right")) - 1, 2)
        slope = (way[n + 1] - way[n]) / (at[n + 1] - at[n])
        return float(way[n] + slope * (time - at[n])), float(slope)

    return ss.loading.Waypoints(at.tolist(), way.tolist()), pulled, tuple(at[1:].tolist())


@pytest.mark.sampled(every=5)
@pytest.mark.parametrize("seed", range(5))
def test_a_block_with_a_play_moves_as_solve_ivp_says_in_both_directions(seed: int) -> None:
    draw = np.random.default_rng(seed)
    static = draw.uniform(0.15, 0.3)
    body = ss.SpringBlock(
        mass=draw.uniform(0.5, 2.0),
        stiffness=draw.uniform(50.0, 200.0),
        normal_force=10.0,
        damping=draw.uniform(0.0, 2.0),
        backlash=draw.uniform(0.005, 0.03),
    )
    pull, pulled, breaks = there_and_back(draw.uniform(0.05, 0.15), 0.1)
    given = ss.Problem(body, ss.friction.Coulomb(static, static * draw.uniform(0.5, 0.9)), pull_rate=pull, initial_load=0.0)
    times = np.linspace(0.0, breaks[-1], 400)
    own, begins = Own(given, pulled).run(times, breaks)
    run = ss.simulate(given, float(times[-1]), rtol=1e-11)
    assert len(begins) > 1
    assert own[0].max() > 0.03
    assert own[0].min() < -0.03
    compare(run, times, own)


def compare(run: ss.Solution, times: Floats, own: Floats) -> None:
    """Compare a run with own values of slip and slip rate, its own proof, and the balance of its energies."""
    np.testing.assert_allclose(run.slip(times), own[0], rtol=0.0, atol=3e-9)
    np.testing.assert_allclose(run.slip_rate(times), own[1], rtol=0.0, atol=1e-7)
    check_account(run)


def check_account(run: ss.Solution) -> None:
    proven = run.proven
    assert proven.compared > 0
    assert proven.residual < 1e-7
    assert proven.load < 1e-11
    assert proven.rest < 1e-11
    assert proven.rate < 1e-9
    energy = run.energy(np.linspace(0.0, run.duration, 50))
    assert np.abs(energy.balance).max() < 1e-9 * max(float(np.abs(energy.work).max()), 1.0)


@pytest.mark.sampled(every=3)
@pytest.mark.parametrize("seed", range(3))
def test_a_dashpot_and_a_force_act_in_the_play_too(seed: int) -> None:
    """The end of spring and dashpot swings, and a force jumps; a body in the play is dragged by them alone."""
    draw = np.random.default_rng(100 + seed)
    body = ss.SpringBlock(1.0, 150.0, 10.0, driver_damping=draw.uniform(2.0, 6.0), backlash=draw.uniform(0.01, 0.03))
    mean, amplitude, period, phase = 0.02, draw.uniform(0.1, 0.3), draw.uniform(0.7, 1.5), draw.uniform(0.0, 1.0)
    turn = 2.0 * math.pi / period

    def pulled(time: float) -> tuple[float, float]:
        swung = (math.cos(phase) - math.cos(turn * time + phase)) / turn
        return mean * time + amplitude * swung, mean + amplitude * math.sin(turn * time + phase)

    pushed = ss.loading.Steps([0.0, 1.0, 2.2], [0.0, draw.uniform(1.0, 3.0), -1.5])
    given = ss.Problem(
        body,
        ss.friction.Coulomb(0.2, 0.15),
        pull_rate=ss.loading.Sinusoidal(mean, amplitude, period, phase),
        force=pushed,
        initial_load=body.driver_damping * pulled(0.0)[1],
    )
    steps = np.array(pushed.values)
    times = np.linspace(0.0, 4.0, 401)
    own, begins = Own(given, pulled, lambda time: steps[np.searchsorted(pushed.times, time, side="right") - 1]).run(
        times, (1.0, 2.2)
    )
    run = ss.simulate(given, 4.0, rtol=1e-11)
    assert len(begins) > 1
    compare(run, times, own)


def test_a_swing_across_the_play_has_its_period_in_closed_form() -> None:
    """Almost no friction: half a swing on the spring on each side, and the width of the play at constant rate between them."""
    play, rate = 0.04, 0.3
    body = ss.SpringBlock(1.0, 100.0, 10.0, backlash=play)
    given = ss.Problem(body, ss.friction.Coulomb(1e-15, 1e-15), pull_rate=0.0, initial_load=0.0, initial_rate=rate)
    run = ss.simulate(given, 20.0, rtol=1e-12)
    period = 2.0 * math.pi / 10.0 + 2.0 * play / rate
    k = np.arange(1, 18)
    np.testing.assert_allclose(run.slip(k * period), 0.0, rtol=0.0, atol=1e-10)
    np.testing.assert_allclose(run.slip_rate(k * period), rate, rtol=1e-10)
    np.testing.assert_allclose(run.slip(0.25 * period + k * period), 0.5 * play + rate / 10.0, rtol=1e-10)
    inside = np.linspace(-0.9, 0.9, 7) * 0.5 * play / rate
    np.testing.assert_allclose(run.load(3 * period + inside), 0.0, rtol=0.0, atol=1e-12)


def test_lost_motion_is_the_backlash_and_the_stretch_that_friction_holds() -> None:
    """A pull that turns: the body stays until the end has come back by b + 2 F/K, to rounding, and the hysteresis is as wide."""
    play, stiffness, friction = 0.02, 200.0, 2.0
    body = ss.SpringBlock(1.0, stiffness, 10.0, damping=30.0, backlash=play)
    pull, _, breaks = there_and_back(0.05, 0.1)
    given = ss.Problem(body, ss.friction.Coulomb(0.2, 0.2), pull_rate=pull, initial_load=0.0)
    run = ss.simulate(given, breaks[-1], rtol=1e-11)
    starts, ends = run.events.start.to_numpy(), run.events.end.to_numpy()
    at = 0.5 * play + friction / stiffness
    assert starts[0] == pytest.approx(at / 0.05, rel=1e-13)
    for k, turn, way in ((1, breaks[0], -1.0), (2, breaks[1], 1.0)):
        rests_at = float(run.slip(ends[k - 1]))
        pulled_to = 0.1 * -way
        assert starts[k] == pytest.approx(turn + (pulled_to - (rests_at + way * at)) * -way / 0.05, rel=1e-12)


LAWS = {
    "rate-and-state": ss.friction.RateAndState(0.2, 0.01, 0.015, 1e-3, 1e-3),
    "lugre": ss.friction.LuGre(0.2, 0.15, 0.05, 3e3),
}


@pytest.mark.sampled(every=2)
@pytest.mark.parametrize("name", LAWS)
def test_a_law_with_a_state_goes_through_the_play_as_solve_ivp_says(name: str) -> None:
    """The pull turns while the body slides, so that the spring lets go and takes it up on the other side."""
    law: Any = LAWS[name]
    body = ss.SpringBlock(1.0, 100.0, 10.0, 2.0, backlash=0.02)
    swing, period = 0.2, 2.0
    pull = ss.loading.Sinusoidal(0.0, swing, period, 0.5 * math.pi)
    given = ss.Problem(
        body, law, pull_rate=pull, initial_load=2.0, initial_rate=0.2, **({} if name == "lugre" else {"initial_state": 5e-3})
    )
    run = ss.simulate(given, 3.0, rtol=1e-11)
    first = float(np.ravel(run.state(0.0))[0])
    turn = 2.0 * math.pi / period

    def moves(t: float, y: Floats) -> list[float]:
        slip, rate, state = y
        lag = 2.0 / 100.0 + 0.01 + swing / turn * math.sin(turn * t) - slip
        spring = 100.0 * (lag - max(min(lag, 0.01), -0.01))
        if name == "lugre":
            steady = (law.dynamic + (law.static - law.dynamic) * math.exp(-((rate / law.rate) ** 2))) / law.stiffness
            change = rate - abs(rate) * state / steady
            friction = law.stiffness * state + law.damping * change + law.viscosity * rate
        else:
            size = abs(rate)
            change = 1.0 - size * state / law.distance
            friction = (
                law.a
                * math.asinh(
                    size / (2.0 * law.rate) * math.exp((law.reference + law.b * math.log(law.rate * state / law.distance)) / law.a)
                )
                * math.copysign(1.0, rate)
            )
        return [rate, spring - 2.0 * rate - 10.0 * friction, change]

    times = np.linspace(0.0, 3.0, 301)
    own = solve_ivp(moves, (0.0, 3.0), [0.0, 0.2, first], "LSODA", times, rtol=1e-11, atol=1e-13, max_step=1e-3).y
    np.testing.assert_allclose(run.slip(times), own[0], rtol=0.0, atol=1e-7)
    assert run.proven.load < 1e-10
    assert run.proven.unproven == 0


def test_a_play_of_none_is_a_block_as_it_was() -> None:
    given = ss.Problem(ss.SpringBlock(1.0, 100.0, 10.0), ss.friction.Coulomb(0.3, 0.2), pull_rate=0.05, initial_load=0.0)
    t = np.linspace(0.0, 5.0, 101)
    none = replace(given, body=replace(given.body, backlash=0.0))
    assert np.array_equal(ss.simulate(none, 5.0).slip(t), ss.simulate(given, 5.0).slip(t))


def turning(play: float = 0.02, **more: Any) -> ss.Problem:
    pull, _, _ = there_and_back(0.1, 0.1)
    body = ss.SpringBlock(1.0, 100.0, 10.0, 1.0, backlash=play, **more)
    return ss.Problem(body, ss.friction.Coulomb(0.25, 0.18), pull_rate=pull, initial_load=0.0)


@pytest.mark.slow
def test_a_body_that_turns_obeys_the_same_numbers_and_a_run_is_resumed_to_the_bit(tmp_path: Any) -> None:
    given, t = turning(), np.linspace(0.0, 5.0, 201)
    whole = ss.simulate(given, 5.0)
    turns = ss.RotatingBlock(1.0, 100.0, 10.0, 1.0, backlash=0.02)
    assert np.array_equal(ss.simulate(replace(given, body=turns), 5.0).slip(t), whole.slip(t))
    for end in (0.05, 1.13, 1.31, 2.9):  # in the play and out of it, at rest and in slip
        ss.simulate(given, end).to_netcdf(tmp_path / "part.nc")
        assert np.array_equal(ss.resume(tmp_path / "part.nc", 5.0).slip(t), whole.slip(t))


def test_on_a_belt_the_play_is_between_body_and_wall() -> None:
    """A belt that swings moves the block as a pull does, but for the inertia of its frame, which is a force m dw/dt."""
    mean, amplitude, turn = 0.02, 0.2, 2.0 * math.pi / 1.3
    pull = ss.loading.Sinusoidal(mean, amplitude, 1.3, 0.3)
    body = ss.SpringBlock(1.0, 150.0, 10.0, 1.0, backlash=0.02)
    given = ss.Problem(body.on_belt(), ss.friction.Coulomb(0.2, 0.15), pull_rate=pull, initial_load=0.0)

    def pulled(time: float) -> tuple[float, float]:
        swung = (math.cos(0.3) - math.cos(turn * time + 0.3)) / turn
        return mean * time + amplitude * swung, mean + amplitude * math.sin(turn * time + 0.3)

    first = given.load
    run = ss.simulate(given, 4.0, rtol=1e-11)
    inertia = lambda time: amplitude * turn * math.cos(turn * time + 0.3)  # noqa: E731
    times = np.linspace(0.0, 4.0, 401)
    own, begins = Own(given, pulled, inertia).run(times)
    assert len(begins) > 1
    assert first == 0.0
    compare(run, times, own)


def test_a_stop_inside_the_play_is_left_by_what_the_spring_takes_up() -> None:
    run = ss.simulate(turning(0.04, stop_ahead=0.03, restitution=0.5), 5.0)
    check_account(run)
    assert (run.shocks.cause == "stop").any()
    assert float(run.slip(np.linspace(0.0, 5.0, 500)).max()) <= 0.03


@pytest.mark.parametrize("seed", [3, 11, 12, 29, 34])
def test_an_end_that_comes_back_to_a_small_play_passes_its_edges(seed: int) -> None:
    """At rest, with a play of millionths of a metre: the lag at its edge is the difference of much larger ways, and is rounded."""
    draw = np.random.default_rng(seed)
    play = 10.0 ** draw.uniform(-7.0, -3.0)
    pull = ss.loading.PiecewiseLinear([0.0, 0.3, 0.9, 1.7], [0.0, 3e-4, -3e-4, 3e-4 * draw.uniform(0.5, 1.5)])
    body = ss.SpringBlock(0.6, 2645.0, 1.43, 24.0, backlash=play)
    run = ss.simulate(ss.Problem(body, ss.friction.Coulomb(0.4, 0.3), pull_rate=pull, initial_load=0.0), 1.7)
    assert run.duration == 1.7
    assert str(run.status).startswith("finished")
    check_account(run)


def test_years_of_rest_outside_the_play_are_leaped_over() -> None:
    """The play is taken up in 20 000 s, some 30 000 periods; what the spring needs then, a million times as long, is one leap."""
    play, rate = 2e-5, 1e-9
    body = ss.SpringBlock(1.0, 1e2, 10.0, backlash=play)
    given = ss.Problem(body, ss.friction.Coulomb(0.6, 0.5), pull_rate=rate, initial_load=0.0)
    run = ss.simulate(given, 6.5e7)
    assert float(run.events.start.iloc[0]) == pytest.approx((0.5 * play + 6.0 / 1e2) / rate, rel=1e-12)
    assert len(run.history) < 40_000
    assert float(run.load(5e7)) == pytest.approx(1e2 * (rate * 5e7 - 0.5 * play), rel=1e-12)


def test_check_says_what_is_lost_in_the_play_and_when_it_is_taken_up() -> None:
    body = ss.SpringBlock(1.0, 100.0, 10.0, backlash=0.02)
    given = ss.Problem(body, ss.friction.Coulomb(0.3, 0.2), pull_rate=0.05, initial_load=0.0)
    told = examine(Scenario(given, 0.5))
    facts = {fact.name: fact.value for fact in told.derived}
    assert facts["lost motion"] == pytest.approx(0.02 + 2 * 3.0 / 100.0, rel=1e-15)
    assert facts["first slip"] == pytest.approx((0.01 + 0.03) / 0.05, rel=1e-15)
    assert float(ss.simulate(given, 2.0).events.start.iloc[0]) == pytest.approx(facts["first slip"], rel=1e-13)
    assert any("before the play is taken up" in text for text in told.warnings)
    assert "in the play no spring holds it" in told.stability


def test_a_scenario_has_a_play_which_a_parameter_changes() -> None:
    text = """
[body]
kind = "spring-block"
mass = 1
stiffness = 100
normal_force = 10
backlash = "2 cm"

[friction]
kind = "coulomb"
static = 0.3
dynamic = 0.2

[loading]
pull_rate = 0.05

[initial]
load = 0.0

[run]
duration = 2.0
"""
    given = read_scenario(text, "play").problem
    assert given == ss.Problem(ss.SpringBlock(1.0, 100.0, 10.0, backlash=0.02), given.friction, 0.05, initial_load=0.0)
    assert given.parameters["body.backlash"].put(0.04).body.backlash == 0.04  # type: ignore[attr-defined]


@pytest.mark.parametrize(
    ("make", "text"),
    [
        (lambda: ss.SpringBlock(1.0, 1.0, 1.0, backlash=-0.1), "SpringBlock: backlash must be at least 0 m"),
        (lambda: ss.SpringBlock(1.0, 0.0, 1.0, backlash=0.1), "SpringBlock: backlash needs a spring to be beside: give stiffness"),
        (lambda: ss.RotatingBlock(1.0, 0.0, 1.0, backlash=0.1), "RotatingBlock: backlash needs a spring"),
    ],
)
def test_a_play_beside_no_spring_is_refused(make: Any, text: str) -> None:
    with pytest.raises(ss.InputError, match=text):
        make()
