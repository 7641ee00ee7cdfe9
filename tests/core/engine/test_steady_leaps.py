"""Steady sliding is passed over: with the motion that computing each round trip gives, and within the bound that the run states."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import stickslip as ss
from stickslip.engine.creep.drivers.rigid import Multiplier
from stickslip.engine.input.limits import EXACT_TRIPS
from stickslip.friction import FrictionLaw
from tests.core.run.long_runs.problems import differences, stopped_and_continued

PLATE = 0.05 / ss.YEAR
"""A plate rate, m/s."""
EARTH = ss.load_scenario("fig6-slab").problem
LAB = ss.ElasticSlab(2800.0, 3500.0, 1.0, 1e6)
BLOCK = ss.SpringBlock(10.0, 1e4, 1000.0)
SLOW = 1e-3
"""Pull rate in a laboratory, m/s."""


def law(formula: str, **values: float) -> FrictionLaw:
    return ss.friction.FromExpression(formula, values=values)


SMOOTH = law("fw + (f0 - fw)/(1 + (v/vw)**4)**0.25", fw=0.3, f0=0.8, vw=0.1)
RISING, STEEP, FLAT = law("0.6 + 0.1*v"), law("0.6 + 0.05*log(1 + v/1e-4)"), law("0.6 + 0.0001*v")
FALLING = law("0.3 + 0.3/(1 + 0.01*v)")
STATE = ss.friction.RateAndState(0.6, 0.015, 0.01, 1e-5, 1e-4)


def pulled(body: ss.ElasticSlab | ss.SpringBlock, friction: FrictionLaw, rate: float = SLOW) -> ss.Problem:
    """Return a problem that begins a little above static friction, in the direction of the pull."""
    return ss.Problem(body, friction, pull_rate=rate, initial_excess=10.0)


CASES = {
    "fades": pulled(LAB, RISING),
    "fades at once": pulled(LAB, STEEP),
    "swings": pulled(LAB, FLAT),
    "driver gives way": pulled(replace(LAB, driver_impedance=3e6), RISING),
    "driver gives way, friction falls": pulled(replace(LAB, driver_impedance=3e8), FALLING),
    "mass": pulled(replace(LAB, contact_mass=1.0, driver_impedance=3e6), RISING),
    "block": pulled(BLOCK, law("0.6 + 0.001*v")),
    "state": ss.Problem(LAB, STATE, pull_rate=1e-4, initial_load=0.59e6, initial_state=0.09),
}


@pytest.mark.sampled(every=3)
@pytest.mark.parametrize("case", CASES)
def test_a_leap_lands_where_computing_each_round_trip_does(case: str) -> None:
    """Slip at the end within the stated bound and rounding; slip rate within 1e-6 of the driver's rate, the tolerance of leaps."""
    problem = CASES[case]
    end = (3000.0 if case in ("state", "block") else 700.0) * problem.round_trip_time
    exact, leaping = ss.simulate(problem, end, creep_rtol=0.0), ss.simulate(problem, end)
    assert len(exact.creep) == 0
    assert len(leaping.creep) == 1
    assert leaping.creep.round_trips.iloc[0] > 100
    assert len(leaping.history) < len(exact.history)
    slip = float(exact.slip(end))
    assert float(leaping.slip(end)) == pytest.approx(slip, rel=1e-12, abs=float(leaping.creep.error.iloc[0]))
    times = np.linspace(end - 2.0 * problem.round_trip_time, end, 41)
    speed = float(np.abs(exact.slip_rate(times)).max())
    np.testing.assert_allclose(leaping.slip_rate(times), exact.slip_rate(times), rtol=0.0, atol=1e-6 * speed)


@pytest.mark.parametrize("excess", [0.0, 0.02, 1e3, -1e6])
def test_a_slab_slides_at_the_plate_rate_for_480_years(excess: float) -> None:
    """The slab of Fig. 6 under a smooth law, at the strength, above it and below: a million round trips a month, 412 pieces."""
    run = ss.simulate(replace(EARTH, friction=SMOOTH, initial_excess=excess), 480.0 * ss.YEAR)
    assert run.status.name == "finished"
    assert len(run.history) < 500
    assert float(run.creep.error.max()) < 1e-12
    slip = PLATE * run.duration + excess / run.problem.body.stiffness  # what the driver moved and the load lost
    assert float(run.slip(run.duration)) == pytest.approx(slip, rel=0.0, abs=2.0 * PLATE * EARTH.round_trip_time)
    assert "steady sliding" in run.creep_note


@pytest.mark.parametrize("rate", [PLATE, 1.234e-9])
def test_no_error_is_said_to_be_below_rounding(rate: float) -> None:
    """Of pulses that are all the same the next can be told exactly, and yet not better than slip and time are rounded."""
    run = ss.simulate(replace(EARTH, friction=ss.friction.Coulomb(0.6, 0.6), pull_rate=rate, initial_excess=0.0), 1e3 * ss.YEAR)
    assert len(run.creep) == 1
    missed = abs(float(run.slip(run.duration)) - rate * run.duration)
    said = re.search(r"error (?:no larger than (rounding)|at most (\S+) m of slip)", run.creep_note)
    assert said is not None
    assert missed <= (2e-15 * rate * run.duration if said[1] else float(said[2]))


def test_a_block_that_swings_about_the_plate_rate_is_followed_for_centuries() -> None:
    """Without damping its slip rate swings between 0 and twice the pull rate for ever."""
    body = ss.load_scenario("fig6-block-printed").problem.body
    run = ss.simulate(ss.Problem(body, SMOOTH, pull_rate=PLATE, initial_excess=0.0), 480.0 * ss.YEAR)
    assert run.status.name == "finished"
    swing = PLATE * run.problem.round_trip_time
    assert float(run.slip(run.duration)) == pytest.approx(PLATE * run.duration, rel=0.0, abs=swing + run.creep.error.sum())
    last = run.slip_rate(np.linspace(run.duration - run.problem.round_trip_time, run.duration, 200))
    assert last.min() < 0.01 * PLATE
    assert last.max() == pytest.approx(2.0 * PLATE, rel=1e-3, abs=0.0)


def test_backward_sliding_is_the_mirror_image() -> None:
    forward = ss.simulate(CASES["swings"], 3.0)
    load = CASES["swings"].load
    backward = ss.simulate(ss.Problem(LAB, FLAT, pull_rate=-SLOW, initial_load=-load), 3.0)
    assert len(backward.creep) == len(forward.creep) == 1
    assert float(backward.slip(3.0)) == pytest.approx(-float(forward.slip(3.0)), rel=1e-12, abs=0.0)


UNSTABLE = ss.friction.RateAndState(0.6, 0.01, 0.015, 1e-7, 1e-4)


@pytest.mark.sampled(every=3)
@pytest.mark.parametrize(
    "problem",
    [
        pulled(LAB, law("0.3 + 0.3/(1 + 0.001*v)")),  # swings grow by 6e-5 in each round trip and touch rest
        ss.Problem(LAB, UNSTABLE, pull_rate=1e-4, initial_load=0.6e6, initial_state=1e-3),
        pulled(LAB, ss.friction.HyperbolicRate(0.8, 0.3, 1.0)),
    ],
)
def test_what_is_unstable_or_rests_is_not_passed_over(problem: ss.Problem) -> None:
    run = ss.simulate(problem, 600.0 * problem.round_trip_time, max_pieces=200_000)
    assert len(run.creep) == 0


def test_where_nothing_slides_steadily_a_run_that_may_leap_is_the_one_that_may_not() -> None:
    """Slip that lasts a round trip less some rounding: the echoes behind its end are not forgotten with those that it met."""
    leaps, steps = (ss.simulate("granite-slab", 100.0, creep_rtol=rtol) for rtol in (None, 0.0))
    assert len(leaps.history.creep) == 0
    assert leaps.history.store.pieces.tobytes() == steps.history.store.pieces.tobytes()


@pytest.mark.parametrize(("reflection", "slope"), [(-1.0, 1.3e7), (-1.0, 0.7e7), (0.4, 2e7), (-0.3, 3e6)])
def test_a_deviation_is_multiplied_as_the_echo_does(reflection: float, slope: float) -> None:
    """Fading, growing, swinging: the load is r (2 Z v - load) one round trip later, and v is the load over g'."""
    load = 1.0
    for _ in range(7):
        load = reflection * (2.0 * 1e7 * load / slope - load)
    assert Multiplier.of(1e7, reflection, slope).power(7) == pytest.approx(load, rel=1e-12, abs=0.0)


def test_the_first_round_trips_of_sliding_are_all_run() -> None:
    run = ss.simulate(CASES["fades"], 3.0)
    assert run.creep.start_row.iloc[0] == EXACT_TRIPS
    assert len(ss.simulate(CASES["fades"], 0.9 * EXACT_TRIPS * LAB.two_way_time).creep) == 0


@pytest.mark.sampled(every=6)
@pytest.mark.parametrize("case", ["swings", "state"])
@pytest.mark.parametrize("share", [0.03, 0.5, 0.999])
def test_a_resumed_run_leaps_as_if_it_had_not_stopped(case: str, share: float, tmp_path: Path) -> None:
    """Bit for bit, stopped before a leap, within it and after it."""
    problem = CASES[case]
    end = 1e5 * problem.round_trip_time
    whole, first = (ss.simulate(problem, part * end) for part in (1.0, share))
    assert differences(stopped_and_continued(first, end, tmp_path), whole) == []


def test_a_catalogue_says_that_it_slides_steadily() -> None:
    table = ss.catalogue(CASES["fades"], 1e4)
    assert table.attrs["status"] == "finished"
    assert table.attrs["duration"] == 1e4
    assert "slides steadily and stably at the driver's rate: no event will come" in table.attrs["creep"]


def test_an_examination_says_that_no_event_will_come_where_the_run_finds_none() -> None:
    words = "slides steadily and stably at the driver's rate: no event will come"
    assert words in ss.studies.steady(CASES["fades"]).lines()
    run = ss.simulate(CASES["fades"], 1e4)
    assert float(run.slip_rate(np.linspace(0.0, 1e4, 1001)).max()) <= CASES["fades"].pull_rate * (1.0 + 1e-6)


def test_an_examination_does_not_promise_that_no_event_comes_where_rest_is_stronger_than_sliding() -> None:
    block = ss.SpringBlock(mass=1.0, stiffness=1e3, normal_force=10.0, damping=2.0)
    problem = ss.Problem(block, ss.friction.Coulomb(0.6, 0.5), pull_rate=0.001, initial_load=0.0)
    assert len(ss.simulate(problem, 20.0).events) > 1
    assert not any("no event" in line for line in ss.studies.steady(problem).lines())
