"""Hunting followed along a gain: where it ends, folds and grazes a stop, against solutions without the package."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.optimize import brentq, root

import stickslip as ss
from stickslip.extensions.cycles.hunting import growth_of_small_hunting
from tests.extensions.cycles.by_scipy import WEIGHTS, WIDE, Axis, CurvedAxis

F = ss.friction
MASS, KP, KI, NORMAL, STATIC, DYNAMIC = 1.0, 100.0, 200.0, 10.0, 0.6, 0.4
SHORT_STEP = 0.02


def hunting(law: F.FrictionLaw, damping: float, step: float = SHORT_STEP, **stop: float) -> ss.Problem:
    body = ss.PositionLoop(MASS, KP, NORMAL, KI, damping, reference_step=step, **stop)
    return ss.Problem(body, law, pull_rate=0.0, initial_load=0.0)


def test_hunting_ends_where_small_lags_neither_grow_nor_die_out() -> None:
    """By DOP853 lags that go to 0 come back as themselves there, to 1e-6, and grow or die out a percent of the gain beside it."""
    law = F.ExponentialStribeck(STATIC, DYNAMIC, rate=0.1)
    branch = ss.studies.follow(ss.studies.cycle(hunting(law, 10.9), near="3000 s"), "body.derivative_gain", to=11.3, steps=4)
    edge = branch.edges[-1]
    own = CurvedAxis(MASS, KP, KI, edge.value, STATIC * NORMAL, DYNAMIC * NORMAL, rate=0.1)
    assert [one.name for one in branch.edges] == ["end of hunting"]
    one, two = (own.next_onset(lag)[0] / lag for lag in (1e-6, 2e-6))
    assert 2.0 * one - two == pytest.approx(1.0, abs=1e-6)
    sooner, later = (replace(own, kd=share * edge.value).next_onset(1e-6)[0] for share in (0.99, 1.01))
    assert sooner > 1.01e-6 > 0.99e-6 > later
    assert edge.value == pytest.approx(11.0850876564, rel=1e-10)


def test_small_lags_grow_by_the_factor_of_matrix_exponentials() -> None:
    """Friction that falls by 20 N s/m at first is a damping of -20 N s/m: to 1e-9. Where friction drops there is no factor."""
    found = growth_of_small_hunting(hunting(F.HyperbolicRate(STATIC, DYNAMIC, alpha=10.0), 11.0))
    own = Axis(MASS, KP, KI, 11.0 - 2.0 * NORMAL, STATIC * NORMAL, STATIC * NORMAL)
    assert found == pytest.approx(own.next_onset(1e-3)[0] / 1e-3, rel=1e-9)
    assert growth_of_small_hunting(hunting(F.Coulomb(STATIC, DYNAMIC), 12.0)) is None


def test_a_grazed_stop_is_located_and_cycles_on_both_sides_are_joined() -> None:
    """Where the lag at arrest is that of the stop, to 1e-9; beyond it the multiplier is that of the motion with the impact."""
    stop, restitution = 0.0185, 0.5
    problem = hunting(F.Coulomb(STATIC, DYNAMIC), 3.1, stop_ahead=SHORT_STEP + stop, restitution=restitution)
    branch = ss.studies.follow(ss.studies.cycle(problem), "body.derivative_gain", to=2.9, steps=2)
    own = Axis(MASS, KP, KI, 3.0, STATIC * NORMAL, DYNAMIC * NORMAL)
    grazes = brentq(lambda kd: replace(own, kd=kd).cycle(0.01, 0.03)[0] - stop, 2.8, 3.2, xtol=1e-13)
    assert [(edge.name, edge.value) for edge in branch.edges] == [("grazing", pytest.approx(grazes, rel=1e-9))]
    hit = replace(own, kd=2.9, stop=-stop, restitution=restitution).cycle(0.0185, 0.019)
    last = branch.points[-1]
    assert last.value == 2.9
    assert last.measures.period == pytest.approx(hit[1], rel=1e-9)
    assert last.multipliers[0] == pytest.approx(hit[2], abs=1e-8)
    assert branch.points[0].multipliers[0] > 0.2 > 0.0 > last.multipliers[0]


def test_hunting_folds_where_its_return_touches_the_identity(tmp_path: Path) -> None:
    """By DOP853 the lag at the fold comes back to 1e-8 with a derivative of 1 to 1e-4; from a table the branch goes on."""
    law = F.FromExpression("0.4 + 0.2*exp(-(v/v1)**2)", {"v1": "50 mm/s"})
    start = ss.studies.cycle(hunting(law, 16.1, step=0.009))
    branch = ss.studies.follow(start, "body.derivative_gain", to=20.0, steps=20)
    edge = branch.edges[0]
    assert edge.name == "fold of cycles"
    own = CurvedAxis(MASS, KP, KI, edge.value, STATIC * NORMAL, DYNAMIC * NORMAL, rate=0.05, power=2)
    lag = float(edge.orbit.place[0])
    ends = [own.next_onset(lag * (1.0 + 1e-3 * n))[0] for n in (*WIDE, 0.0)]
    assert ends[-1] == pytest.approx(lag, rel=1e-8)
    assert WEIGHTS @ ends[:4] / (1e-3 * lag) == pytest.approx(1.0, abs=1e-4)
    assert branch.points[0].stable
    assert not branch.points[-1].stable
    begun = ss.studies.follow(start, "body.derivative_gain", to=16.12, steps=4)
    begun.to_csv(tmp_path / "branch.csv")
    again = ss.studies.follow(start, "body.derivative_gain", to=20.0, steps=20, resume=tmp_path / "branch.csv")
    assert again.edges[0].value == pytest.approx(edge.value, rel=1e-9)


def test_stick_is_lost_where_the_arrest_meets_the_strength_the_other_way() -> None:
    """By matrix exponentials a slip goes from lag e and strength to -e and minus the strength there: the gain to 1e-8."""
    start = ss.studies.cycle(replace_gain(hunting(F.Coulomb(STATIC, DYNAMIC), 8.0), 1250.0))
    branch = ss.studies.follow(start, "body.integral_gain", to=1400.0, steps=2)

    def missed(tried: np.ndarray[tuple[int], np.dtype[np.float64]]) -> list[float]:
        own = Axis(MASS, KP, 1e3 * float(tried[1]), 8.0, STATIC * NORMAL, DYNAMIC * NORMAL)
        end, _, _ = own.slipped(np.array([tried[0], 0.0, STATIC * NORMAL - KP * tried[0]]), 1)
        return [end[0] + tried[0], KP * end[0] + end[2] + STATIC * NORMAL]

    assert [edge.name for edge in branch.edges] == ["loss of stick"]
    assert branch.edges[0].value == pytest.approx(1e3 * root(missed, [0.078, 1.3], tol=1e-13).x[1], rel=1e-8)


def test_hunting_ends_where_a_bounce_leaves_the_axis_at_its_set_point() -> None:
    """By matrix exponentials: back from the set point at the strength, forth into the stop, and from it to the set point: 1e-6."""
    problem = hunting(F.Coulomb(STATIC, DYNAMIC), 8.0, 0.05, stop_ahead=0.055, restitution=0.5)
    branch = ss.studies.follow(ss.studies.cycle(problem), "body.stop_ahead", to=0.05, steps=6)
    free = Axis(MASS, KP, KI, 8.0, STATIC * NORMAL, DYNAMIC * NORMAL)
    lag = float(free.slipped(np.array([0.0, 0.0, -STATIC * NORMAL]), -1)[0][0])

    def left(stop: float) -> float:
        own = replace(free, stop=-stop)
        met, _, _ = own.slipped(np.array([lag, 0.0, STATIC * NORMAL - KP * lag]), 1)
        return float(own.slipped(met * [1.0, -0.5, 1.0], -1)[0][0])

    assert [edge.name for edge in branch.edges] == ["end of hunting"]
    assert branch.edges[0].value - 0.05 == pytest.approx(brentq(left, 1e-4, 1e-3, xtol=1e-15), abs=0.05e-6)


def replace_gain(problem: ss.Problem, integral_gain: float) -> ss.Problem:
    return problem.parameters["body.integral_gain"].put(integral_gain)


@pytest.mark.parametrize("pull", [0.0, 0.01], ids=["set point", "ramp"])
def test_the_exponent_of_a_loop_is_that_of_its_multiplier(pull: float) -> None:
    """To 1e-6; a rest does not end all disturbances, because the lag outlasts it."""
    problem = replace(hunting(F.Coulomb(STATIC, DYNAMIC), 8.0), pull_rate=pull)
    cycle = ss.studies.cycle(problem)
    found = ss.studies.lyapunov(cycle.problem, 20.0 * cycle.period)
    assert found.exponent == pytest.approx(math.log(abs(cycle.multipliers[0])) / cycle.period, rel=1e-6)
    assert np.isfinite(found.exponent)


def test_along_a_ramp_that_comes_to_steady_sliding_the_exponent_is_the_growth_of_that() -> None:
    """The run swings into it: its own decay is not left out. The leading root is -0.5117543805 1/s, to rounding."""
    body = ss.PositionLoop(MASS, KP, NORMAL, 50.0, 5.0)
    law = F.ExponentialStribeck(static=0.5, dynamic=0.3, rate="50 mm/s")
    problem = ss.Problem(body, law, pull_rate=1.0, initial_rate=1.1, initial_load=3.0)
    found = ss.studies.lyapunov(problem, 80.0, skip=20.0)
    assert found.exponent == pytest.approx(ss.studies.steady(problem).slidings[-1].growth, rel=1e-12)
    assert found.exponent == pytest.approx(-0.5117543805, rel=1e-9)


@pytest.mark.parametrize(("gain", "to"), [(50.0, 0.0), (0.0, 50.0)])
def test_a_branch_along_a_ramp_refuses_to_begin_or_end_without_an_integral_gain(gain: float, to: float) -> None:
    axis = ss.PositionLoop(MASS, KP, NORMAL, gain, 5.0)
    start = ss.studies.cycle(ss.Problem(axis, F.Coulomb(0.4, 0.3), pull_rate=1e-3, initial_load=0.0))
    said = (
        r"^follow: without an integral gain the lag of an axis is no number of its cycles: begin and end with body\.integral_gain"
    )
    with pytest.raises(ss.InputError, match=said):
        ss.studies.follow(start, "integral_gain", to=to, steps=3)


def test_a_branch_refuses_to_begin_or_end_without_a_stop() -> None:
    start = ss.studies.cycle(hunting(F.Coulomb(STATIC, DYNAMIC), 8.0, stop_ahead=0.05))
    with pytest.raises(ss.InputError, match=r"^follow: no branch begins at body.stop_behind = inf m: give a finite one$"):
        ss.studies.follow(start, "body.stop_behind", to=0.1)
    with pytest.raises(ss.InputError, match=r"^follow: no branch ends at body.stop_ahead = inf m: give a finite one$"):
        ss.studies.follow(start, "body.stop_ahead", to=math.inf)
