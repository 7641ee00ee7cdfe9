"""Cycles of bodies in a position loop, at hard stops and in a play, against matrix exponentials, DOP853 and closed forms."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import stickslip as ss
from stickslip.extensions.cycles.tangent import Tangent
from tests.extensions.cycles.by_scipy import WEIGHTS, WIDE, Axis, BlockWithPlay, CurvedAxis

F = ss.friction
MASS, KP, KI, KD, NORMAL, STATIC, DYNAMIC, STEP = 1.0, 100.0, 200.0, 8.0, 10.0, 0.6, 0.4, 0.05
SIX = (MASS, KP, KI, KD, STATIC * NORMAL, DYNAMIC * NORMAL)
COULOMB = F.Coulomb(STATIC, DYNAMIC)


def loop(way: float = math.inf, restitution: float = 0.0, **gains: float) -> ss.PositionLoop:
    """Return an axis whose reference steps by STEP, with a stop at a way beyond the reference."""
    numbers: dict[str, float] = {"integral_gain": KI, "derivative_gain": KD, "reference_step": STEP} | gains
    stop = {"stop_ahead": numbers["reference_step"] + way, "restitution": restitution} if way < math.inf else {}
    return ss.PositionLoop(mass=MASS, proportional_gain=KP, normal_force=NORMAL, **numbers, **stop)


def held(body: Any, law: F.FrictionLaw = COULOMB, **more: float) -> ss.Problem:
    return ss.Problem(body, law, **({"pull_rate": 0.0, "initial_load": 0.0} | more))  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("gains", "way", "restitution", "pull", "impacts"),
    [
        ({}, math.inf, 0.0, 0.0, 0),
        ({}, math.inf, 0.0, 0.01, 0),
        ({}, 0.01, 0.0, 0.0, 1),
        ({}, 0.01, 0.8, 0.0, 1),
        ({"integral_gain": 400.0, "derivative_gain": 2.0}, 1e-3, 0.8, 0.0, 2),
        ({"integral_gain": 800.0, "derivative_gain": 2.0}, 5e-4, 0.9, 0.0, 3),
    ],
    ids=["set point", "ramp", "rest at a stop", "bounce", "two slips", "three slips"],
)
def test_hunting_under_coulomb_friction_is_that_of_matrix_exponentials(
    gains: dict[str, float], way: float, restitution: float, pull: float, impacts: int
) -> None:
    """Lag, period and multiplier to 1e-8, and rest leaves no second one."""
    found = ss.studies.cycle(held(loop(way, restitution, **gains), pull_rate=pull))
    own = Axis(*SIX, pull=pull, stop=-way, restitution=restitution)
    own = replace(own, **{{"integral_gain": "ki", "derivative_gain": "kd"}[name]: value for name, value in gains.items()})
    lag = float(found.orbit.place[0])
    mode = found.orbit.closed.history.store.mode[: found.orbit.closed.piece + 2]
    place, period, multiplier = own.cycle(0.999 * lag, 1.001 * lag, int(((mode[1:] == 1) & (mode[:-1] == 0)).sum()))
    assert lag == pytest.approx(place, rel=1e-10)
    assert found.period == pytest.approx(period, rel=1e-10)
    assert found.multipliers == pytest.approx([multiplier, 0.0], abs=1e-8)
    assert found.orbit.closed.impacts == impacts
    assert found.slip == pytest.approx(pull * period, rel=1e-10)
    if not gains and way == math.inf and pull == 0.0:  # it goes as far behind the set point as beyond it
        assert found.swing == pytest.approx(2.0 * lag, rel=1e-10)


@pytest.mark.parametrize(("way", "restitution", "pull"), [(math.inf, 0.0, 0.01), (0.01, 0.6, 0.0)], ids=["ramp", "bounce"])
def test_hunting_under_a_stribeck_law_is_that_of_dop853(way: float, restitution: float, pull: float) -> None:
    """Lag and period to 1e-9, multiplier to 1e-7."""
    found = ss.studies.cycle(held(loop(way, restitution), F.ExponentialStribeck(STATIC, DYNAMIC, rate=0.02), pull_rate=pull))
    own, lag = CurvedAxis(*SIX, pull=pull, stop=-way, restitution=restitution, rate=0.02), float(found.orbit.place[0])
    place, period, multiplier = own.cycle(0.999 * lag, 1.001 * lag)
    assert (lag, found.period) == pytest.approx((place, period), rel=1e-9)
    assert found.multipliers[0] == pytest.approx(multiplier, abs=1e-7)


def test_a_cycle_through_a_play_is_that_of_dop853() -> None:
    """It comes back to 1e-8, and the derivative of its return by the load is the multiplier to 1e-6: bristles forget."""
    law = F.LuGre(0.6, 0.05, rate="10 mm/s", stiffness=1e3, damping=3.0, viscosity=0.04)
    found = ss.studies.cycle(held(ss.SpringBlock(1.0, 1e3, NORMAL, backlash=8e-3), law, pull_rate=0.1, initial_state=0.0))
    own = BlockWithPlay(1.0, 1e3, NORMAL, 0.1, 4e-3, 0.6, 0.05, 0.01, 1e3, 3.0, 0.04)
    load, bend = found.orbit.place
    ends = np.array([own.returned(load * (1.0 + 1e-4 * n), bend, found.period) for n in (*WIDE, 0.0)])
    assert ends[-1] == pytest.approx([load, bend, found.period], rel=1e-8)
    assert found.least_traction < 0.0
    assert found.multipliers[0] == pytest.approx(WEIGHTS @ ends[:4, 0] / (1e-4 * load), abs=1e-6)


def test_disturbances_behind_a_bounce_are_those_of_a_thrown_body() -> None:
    """Under a constant load: the derivatives of slip rate and lag by those at the start in closed form, to 1e-9."""
    push, friction, gap, rate, back, lasts = 6.0, DYNAMIC * NORMAL, 0.02, 0.1, 0.7, 0.115
    body = loop(0.0, back, integral_gain=1e-12, derivative_gain=0.0, reference_step=gap)
    body = replace(body, proportional_gain=1e-9, stop_ahead=gap)
    history = ss.simulate(held(body, initial_load=push, initial_rate=rate), lasts, 1e-12).history
    grown = Tangent(history, len(history) - 1, 1.0).grown()
    ahead, behind = (push - friction) / MASS, (push + friction) / MASS
    hit = math.sqrt(rate**2 + 2.0 * ahead * gap)
    left = lasts - (hit - rate) / ahead
    assert history.store.mode.tolist() == [1, -1]
    by_rate, by_gap = (rate / hit - 1.0) / ahead, 1.0 / hit  # of the time of the impact
    rates = [-back * rate / hit - behind * by_rate, -back * ahead / hit - behind * by_gap]
    lags = [back * rate / hit * left - back * hit * by_rate, back * ahead / hit * left - back * hit * by_gap]
    lags = [one + behind * left * by for one, by in zip(lags, (by_rate, by_gap), strict=True)]
    assert grown[1, 1:] == pytest.approx(rates, rel=1e-9)
    assert grown[2, 1:] == pytest.approx(lags, rel=1e-9)


@pytest.mark.parametrize(
    ("law", "more"),
    [
        (F.LuGre(STATIC, DYNAMIC, rate="10 mm/s", stiffness=1e3, damping=3.0), {"initial_state": 0.0}),
        (F.LaggedFriction(rate=F.HyperbolicRate(0.6, 0.3, 10.0), time=0.02), {"initial_state": 0.0, "pull_rate": 0.02}),
    ],
    ids=["bristles about a set point", "lagged friction on a ramp"],
)
def test_cycles_of_loops_under_laws_with_states_close_and_have_the_multipliers_of_differences(
    law: F.FrictionLaw, more: dict[str, float]
) -> None:
    """Differences of fourth order of runs, to 1e-6; two more periods of a run, to 1e-7 of the greatest slip rate."""
    found = ss.studies.cycle(held(loop(), law, **more))
    orbit, columns = found.orbit, []
    for n, extent in enumerate(orbit.extent):
        step = 1e-4 * extent * np.eye(len(orbit.extent))[n]
        ends = np.array([orbit.section.returned(orbit.place + k * step, orbit.period).end for k in WIDE])
        columns.append(WEIGHTS @ ends / (1e-4 * extent))
    own = np.linalg.eigvals(np.array(columns).T)
    assert found.multipliers[0] == pytest.approx(own[np.abs(own).argmax()], abs=1e-6)
    rates = ss.simulate(found.problem, 3.0 * found.period, 1e-12).slip_rate(np.array([0.01, 1.01, 2.01]) * found.period)
    assert np.ptp(rates) <= 1e-7 * found.greatest_rate


def test_an_axis_that_turns_and_one_that_slides_have_the_same_cycle() -> None:
    turned = ss.RotaryLoop(MASS, KP, NORMAL, KI, KD, reference_step=STEP)
    assert ss.studies.cycle(held(turned)).period == pytest.approx(ss.studies.cycle(held(loop())).period, rel=1e-13)


def test_without_an_integral_gain_a_ramp_pulls_the_axis_as_a_spring_pulls_a_block() -> None:
    """A step of the reference at the start is behind it."""
    block = ss.SpringBlock(MASS, KP, NORMAL, driver_damping=2.0)
    one, other = (ss.studies.cycle(held(body, pull_rate=0.05)) for body in (block, loop(integral_gain=0.0, derivative_gain=2.0)))
    assert other.period == pytest.approx(one.period, rel=1e-11)
    assert other.multipliers == pytest.approx([0.0], abs=0.0)


def test_a_stop_ahead_and_its_mirror_behind_have_the_same_cycle() -> None:
    ahead = ss.studies.cycle(held(loop(0.01, 0.5)))
    behind = ss.studies.cycle(held(replace(loop(reference_step=-STEP), stop_behind=STEP + 0.01, restitution=0.5)))
    assert behind.period == pytest.approx(ahead.period, rel=1e-9)
    assert behind.multipliers[0] == pytest.approx(ahead.multipliers[0], abs=1e-8)


@pytest.mark.parametrize(
    ("body", "more", "said"),
    [
        (loop(integral_gain=0.0), {}, "without an integral gain"),
        (loop(0.01), {"pull_rate": 0.01}, "carries the axis to its stop"),
        (loop(), {"pull_rate": -0.01}, "0 or above"),
        (loop(), {"pull_rate": ss.loading.Steps([0.0, 1.0], [0.0, 0.1])}, "a set point or a ramp"),
        (ss.SpringBlock(1.0, 1e3, NORMAL, stop_ahead=1.0), {"pull_rate": 0.1}, "carries the body to its stop"),
        (ss.SpringBlock(1.0, 1e3, NORMAL, backlash=1e-3), {}, "above 0"),
    ],
)
def test_what_has_no_cycle_is_refused_in_one_line(body: Any, more: dict[str, Any], said: str) -> None:
    with pytest.raises(ss.InputError, match=said) as error:
        ss.studies.cycle(held(body, **more))
    assert "\n" not in str(error.value)
    assert str(error.value).startswith("cycle: ")


def test_a_set_point_that_is_reached_has_no_cycle() -> None:
    with pytest.raises(ss.InputError, match=r"^cycle: .*(does not come back|no cycle|no longer).*does not hunt$"):
        ss.studies.cycle(held(loop(derivative_gain=40.0), F.ExponentialStribeck(STATIC, DYNAMIC, rate=0.1)))
