"""Cycles under laws with states, rests, reversals and jumps: differences of runs, closure in longer runs, and what is refused."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import stickslip as ss
from tests.extensions.cycles.problems import DAMPING, DYNAMIC, MASS, NORMAL, STATIC, STIFFNESS, coulomb, rate_and_state, stribeck

BLOCK = ss.SpringBlock(MASS, STIFFNESS, NORMAL)
F = ss.friction
BRISTLES = F.LuGre(static=0.15, dynamic=0.1, rate="1 mm/s", stiffness="1e4 1/m", damping="3 s/m", viscosity="0.04 s/m")
DAMPED = ss.SpringBlock(MASS, STIFFNESS, NORMAL, damping=DAMPING)
HEAVY_DRIVER = ss.ElasticSlab(2800.0, 3500.0, 1e4, 1e8, contact_mass=1e5, driver_impedance=1e6, driver_inertia=1e6)
COLUMN = ss.SoilColumn(2000.0, 200.0, 20.0, 1e5, damping_ratio=0.05)
RATE_AND_STATE = F.RateAndState(0.6, 0.01, 0.015, 1e-5, 1e-6)
LAGGED = F.LaggedFriction(rate=F.HyperbolicRate(0.8, 0.3, 10.0), time=0.05)


@pytest.mark.parametrize(
    "problem",
    [
        ss.Problem(BLOCK, BRISTLES, pull_rate=1e-3, initial_load=0.0, initial_state=0.0),
        ss.Problem(
            ss.SpringBlock(MASS, STIFFNESS, NORMAL, damping=DAMPING), LAGGED, pull_rate=0.1, initial_load=0.0, initial_state=0.0
        ),
        rate_and_state("slip"),
    ],
    ids=["bristles that reverse", "a state at rest", "slip law"],
)
def test_multipliers_are_those_of_differences_of_runs_and_longer_runs_repeat_themselves(problem: ss.Problem) -> None:
    """Central differences of 1e-5 of the extent, to 1e-5; three periods, to 1e-7 of the greatest slip rate."""
    found = ss.studies.cycle(problem)
    orbit, columns = found.orbit, []
    for n, extent in enumerate(orbit.extent):
        step = np.zeros(len(orbit.extent))
        step[n] = 1e-5 * extent
        ends = [orbit.section.returned(orbit.place + sign * step, orbit.period).end for sign in (1.0, -1.0)]
        columns.append((ends[0] - ends[1]) / (2.0 * step[n]))
    own = np.linalg.eigvals(np.array(columns).T)
    assert found.multipliers[0] == pytest.approx(own[np.abs(own).argmax()], abs=1e-5)
    rates = ss.simulate(found.problem, 3.0 * found.period, 1e-12).slip_rate(np.array([0.3, 1.3, 2.3]) * found.period)
    assert np.ptp(rates) <= 1e-7 * found.greatest_rate


@pytest.mark.parametrize(
    "problem",
    [
        ss.Problem(BLOCK.on_belt(), F.Coulomb(STATIC, DYNAMIC), pull_rate=0.1, initial_load=0.0),
        ss.Problem(ss.RotatingBlock(MASS, STIFFNESS, NORMAL), F.Coulomb(STATIC, DYNAMIC), pull_rate=0.1, initial_load=0.0),
    ],
    ids=["belt", "what turns"],
)
def test_a_body_on_a_belt_and_one_that_turns_have_the_cycle_of_the_block(problem: ss.Problem) -> None:
    found, block = ss.studies.cycle(problem), ss.studies.cycle(coulomb())
    assert found.period == pytest.approx(block.period, rel=1e-12)
    assert found.greatest_rate == pytest.approx(block.greatest_rate, rel=1e-12)


def test_a_dashpot_beside_the_spring_changes_the_tractions_alone_where_it_damps_as_the_ground_does() -> None:
    """The damping c (V - v) is that of the ground with the load c V less: stiffness and slip are the same."""
    ground, beside = (ss.studies.cycle(coulomb(**{name: 0.5})) for name in ("damping", "driver_damping"))
    assert beside.period == pytest.approx(ground.period, rel=1e-11)
    assert beside.slip == pytest.approx(ground.slip, rel=1e-11)


def test_slip_that_heals_at_each_arrest_makes_a_cycle() -> None:
    """Its period and slip are those of the third and fourth event of a run, to 1e-10."""
    law = F.LinearSlipWeakening(0.6, 0.4, 1e-3, memory="since-arrest")
    problem = ss.Problem(BLOCK, law, pull_rate=0.1, initial_load=0.0)
    events = ss.simulate(problem, 2.0, 1e-12).catalogue(0.0)
    found = ss.studies.cycle(problem)
    assert found.period == pytest.approx(events.start[3] - events.start[2], rel=1e-10)
    assert found.slip == pytest.approx(events.slip[3], rel=1e-10)


def test_backward_slip_under_a_law_of_its_own_is_part_of_the_cycle() -> None:
    law = F.BothWays(F.Coulomb(0.9, 0.1), F.Coulomb(0.3, 0.05))
    found = ss.studies.cycle(ss.Problem(BLOCK, law, pull_rate=0.1, initial_load=0.0))
    events = found.run.slip_rate(np.linspace(0.0, found.period, 2001))
    assert found.least_rate < -0.1
    assert found.least_rate == pytest.approx(events.min(), rel=1e-4)


def test_static_friction_that_is_no_larger_than_dynamic_gives_no_multiplier() -> None:
    """Rest is grazed: all motion with less swing repeats itself too."""
    found = ss.studies.cycle(ss.Problem(BLOCK, F.Coulomb(0.5, 0.5), pull_rate=0.1, initial_load=0.0))
    assert found.stable is None
    assert np.isnan(found.multipliers).all()
    assert "rest" in found.stability_text
    assert found.period == pytest.approx(2.0 * math.pi * math.sqrt(MASS / STIFFNESS), rel=1e-7)


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"body": ss.ElasticSlab(2800.0, 3500.0, 1e4, 1e8)}, "each moment of the round trip"),
        ({"body": ss.ElasticSlab(2800.0, 3500.0, 1e4, 1e8, contact_mass=1e5)}, "sharp waves back whole"),
        (
            {"body": ss.ElasticSlab(2800.0, 3500.0, 1e4, 1e8)},
            "with contact_mass above 0 and a driver of finite impedance they move",
        ),
        ({"body": replace(HEAVY_DRIVER, contact_mass=0.0)}, "above 0 and a driver without driver_inertia they move together"),
        ({"body": ss.ElasticSlab(2800.0, 3500.0, 1e4, 1e8, driver_impedance=1e7)}, "with contact_mass above 0 they move together"),
        ({"body": HEAVY_DRIVER}, "no run comes to a cycle; leave driver_inertia out"),
        (
            {"body": HEAVY_DRIVER, "friction": RATE_AND_STATE, "initial_state": 1.0},
            "no run comes to a cycle; leave driver_inertia or contact_mass out",
        ),
        ({"body": replace(HEAVY_DRIVER, driver_impedance=0.0)}, "dead load"),
        ({"body": COLUMN, "friction": RATE_AND_STATE, "initial_state": 1.0}, "dead load"),
        ({"body": ss.ElasticSlab(2800.0, 3500.0, 1e4, 1e8, contact_mass=1e5, driver_impedance=0.0)}, "dead load"),
        ({"body": ss.SpringBlock(MASS, STIFFNESS, NORMAL, stop_ahead=1.0)}, "to its stop"),
        ({"body": ss.SpringBlock(MASS, 0.0, NORMAL, driver_damping=1.0)}, "spring"),
        ({"friction": F.SinusoidalSlip(1.0, 0.5, 5.0)}, "changes with slip"),
        ({"force": 1.0}, "must be steady"),
        ({"pull_rate": ss.loading.Sinusoidal(0.1, amplitude=0.01, period=1.0)}, "pull rate must be a number"),
        ({"pull_rate": 0.0}, "above 0"),
        ({"pull_rate": -0.1}, "above 0"),
    ],
)
def test_what_is_not_followed_is_refused_in_one_line(changes: dict[str, Any], said: str) -> None:
    given: dict[str, Any] = {"body": BLOCK, "friction": F.Coulomb(STATIC, DYNAMIC), "pull_rate": 0.1, "initial_load": 0.0}
    with pytest.raises(ss.InputError, match=said) as error:
        ss.studies.cycle(ss.Problem(**(given | changes)))
    assert "\n" not in str(error.value)
    assert str(error.value).startswith("cycle: ")


def test_a_run_of_one_period_that_has_too_many_pieces_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    """As if a million were ten: what the run says of itself is told."""
    monkeypatch.setattr("stickslip.problem.run_options.MAX_PIECES", 10)
    with pytest.raises(ss.InputError, match="cycle: a run of one period did not reach its end: too many pieces") as error:
        ss.studies.cycle(stribeck(0.1, initial_load=0.0), near=2.0)
    assert "\n" not in str(error.value)


def test_where_steady_sliding_takes_all_no_cycle_is_found() -> None:
    with pytest.raises(ss.InputError, match=r"^cycle: .*(no other cycle|no cycle|does not come back)"):
        ss.studies.cycle(stribeck(1.0, initial_load=0.0))


def test_wrong_arguments_of_follow_are_told() -> None:
    found = ss.studies.cycle(coulomb())
    for along, to, said in (
        ("pul_rate", 1.0, "did you mean 'pull_rate'"),
        ("pull_rate", 0.1, "already"),
        ("pull_rate", "3 kg", "m/s"),
        ("initial.load", 1.0, "no number on which a cycle depends"),
    ):
        with pytest.raises(ss.InputError, match=said):
            ss.studies.follow(found, along, to=to)
    with pytest.raises(ss.InputError, match="needs a cycle"):
        ss.studies.follow(coulomb(), to=1.0)  # type: ignore[arg-type]
    with pytest.raises(ss.InputError, match="steps must be 1 or more"):
        ss.studies.follow(found, to=1.0, steps=0)


@pytest.mark.parametrize(
    "problem", [ss.Problem(DAMPED, LAGGED, pull_rate=0.1, initial_load=0.0, initial_state=0.0), rate_and_state()]
)
def test_the_cycle_next_to_a_run_that_settles_is_that_at_the_end_of_a_long_run(problem: ss.Problem) -> None:
    """Period to 1e-9, multipliers to 1e-6; the long run takes 40 periods."""
    early = ss.studies.cycle(problem)
    long = ss.studies.cycle(
        replace(early.problem, initial_load=1.001 * float(early.problem.initial_load or 0.0)), 40.0 * early.period
    )
    assert early.period == pytest.approx(long.period, rel=1e-9)
    assert early.multipliers == pytest.approx(long.multipliers, rel=1e-6, abs=1e-6)
