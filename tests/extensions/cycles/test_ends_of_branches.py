"""Where branches of cycles end and turn: at the ends of their range, next to the loss of stick, and beside steady sliding."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from scipy.optimize import brentq

import stickslip as ss
from stickslip.contact import steady_slidings
from stickslip.extensions.cycles.edges import edges_between
from stickslip.extensions.cycles.hysteresis import Interval, with_stable_sliding
from stickslip.extensions.cycles.path import PlaceOnBranch


def brake(pull: float, damping: float = 2.0) -> ss.Problem:
    """Return a block of 1 kg on 1 kN/m under 10 N and a Stribeck law, which starts without load."""
    block = ss.SpringBlock(1.0, 1e3, 10.0, damping=damping)
    return ss.Problem(block, ss.friction.ExponentialStribeck(0.5, 0.3, 0.05), pull_rate=pull, initial_load=0.0)


def test_hysteresis_begins_at_the_hopf_point_that_the_branch_has_found() -> None:
    """Steady growth vanishes at the damping S dmu/rate exp(-V/rate), where rounding may make it 0; to 1e-9 of that closed form."""
    hopf = 10.0 * 0.2 / 0.05 * math.exp(-0.1 / 0.05)
    branch = ss.studies.follow(ss.studies.cycle(brake(0.1)), "body.damping", to=20.0, steps=5)
    assert [edge.name for edge in branch.edges] == ["loss of stick", "steady sliding"]
    [both] = branch.hysteresis
    assert both == pytest.approx((hopf, branch.edges[0].value), rel=1e-9)


@pytest.mark.parametrize("beside", [0.0, 1.0, -1.0])
def test_hysteresis_does_not_reach_over_an_edge_in_steady_sliding_however_its_growth_is_rounded(beside: float) -> None:
    """Of a closed form: steady sliding is stable where damping is above 40 exp(-V/rate), from each side and through it, to 1e-9."""
    hopf = 40.0 * math.exp(-2.0)
    edge = hopf * (1.0 + beside * 2e-16)

    def problem_at(damping: float) -> ss.Problem:
        return brake(0.1, damping)

    assert abs(steady_slidings(problem_at(edge)).slidings[-1].growth) < 1e-13
    [through] = with_stable_sliding(Interval(2.0, 8.5), [2.0, edge, 8.3], problem_at)
    assert through == pytest.approx((hopf, 8.5), rel=1e-9)
    assert with_stable_sliding(Interval(2.0, edge), [], problem_at) == []
    assert with_stable_sliding(Interval(edge, 8.5), [], problem_at) == [pytest.approx((hopf, 8.5), rel=1e-9)]
    assert with_stable_sliding(Interval(-20.0, -10.0), [], problem_at) == [], "a problem that is refused has no steady sliding"


@pytest.mark.parametrize(("along", "to"), [("body.damping", 0.0), ("pull_rate", 1e-6)])
def test_a_branch_ends_at_the_end_of_its_range_if_no_problem_is_beyond(along: str, to: float) -> None:
    """No edge is there, and the last cycle is the one found alone, to 1e-9."""
    start = ss.studies.cycle(brake(0.1))
    branch = ss.studies.follow(start, along, to=to, steps=4)
    alone = ss.studies.cycle(brake(0.1, 0.0) if to == 0.0 else brake(to))
    assert branch.edges == ()
    last = branch.points[-1]
    assert last.value == to
    assert last.measures.period == pytest.approx(alone.period, rel=1e-9)
    assert last.measures.stick_share == pytest.approx(alone.stick_share, rel=1e-7)
    assert last.stable is True


def test_a_branch_without_rest_ends_at_the_end_of_its_range_if_no_problem_is_beyond() -> None:
    """Under a law that falls and rises again a block swings around its pull rate; without damping it does so, too, to 1e-9."""
    law = ss.friction.FromExpression("0.5 - 0.05*(v/v0 - 1) + 0.2*(v/v0 - 1)**3", {"v0": "1 m/s"})

    def swinging(damping: float) -> ss.Problem:
        block = ss.SpringBlock(1.0, 1e3, 10.0, damping=damping)
        return ss.Problem(block, law, pull_rate=1.0, initial_rate=1.0, initial_load=5.0 + damping + 10.0)

    branch = ss.studies.follow(ss.studies.cycle(swinging(0.1)), "body.damping", to=0.0, steps=2)
    assert branch.edges == ()
    assert branch.points[-1].value == 0.0
    assert branch.points[-1].measures.period == pytest.approx(ss.studies.cycle(swinging(0.0)).period, rel=1e-9)


@pytest.mark.parametrize(
    ("along", "to", "said"),
    [
        ("pull_rate", 0.0, "follow: to: pull_rate must be above 0, got 0 m/s: a little is enough"),
        (
            "pull_rate",
            -0.1,
            "follow: to: pull_rate must be above 0, got -0.1 m/s: to pull backwards count slip the other way, and give 0.1 m/s",
        ),
    ],
)
def test_a_branch_refuses_an_end_where_there_are_no_cycles(along: str, to: float, said: str) -> None:
    with pytest.raises(ss.InputError, match=said):
        ss.studies.follow(ss.studies.cycle(brake(0.1)), along, to=to)


def heavy(pull: float) -> ss.Problem:
    """Return a block of 4 kg under a power law, whose unstable cycles have multipliers from 3 on."""
    block = ss.SpringBlock(4.073857629496691, 412.93489030193155, 18.74944175372767, damping=5.728820567164297)
    law = ss.friction.PowerStribeck(0.5857404140264425, 0.2469319223872843, 0.04079406780257858, 2.0)
    return ss.Problem(block, law, pull_rate=pull, initial_load=0.0)


def test_a_branch_goes_on_without_rest_from_the_loss_of_stick_to_the_hopf_point() -> None:
    """The Hopf point is 0.05 ln(40/3) in closed form, to 1e-9; values and multipliers fall all the way from the loss of stick."""
    branch = ss.studies.follow(ss.studies.cycle(brake(0.02, 3.0)), to=0.5, steps=5)
    assert [edge.name for edge in branch.edges] == ["loss of stick", "steady sliding"]
    assert branch.edges[1].value == pytest.approx(0.05 * math.log(40.0 / 3.0), rel=1e-9)
    back = [one for one in branch.points if not one.sticks and not one.edge]
    assert len(back) > 5
    for numbers in ([one.value for one in back], [one.multipliers[0].real for one in back]):
        assert numbers == sorted(numbers, reverse=True)


@pytest.mark.sampled(every=2)
@pytest.mark.parametrize("pull", [0.3, 0.33])
def test_no_edge_is_told_where_runs_beside_a_cycle_rest(pull: float) -> None:
    """Beyond the loss of stick the branch comes back to where it began, and its multipliers are far from +1."""
    branch = ss.studies.follow(ss.studies.cycle(heavy(pull)), to=pull + 0.5963, steps=10)
    assert [edge.name for edge in branch.edges] == ["loss of stick"]
    back = [one for one in branch.points if not one.sticks]
    assert back[-1].value == pytest.approx(pull, rel=1e-12)
    assert min(one.multipliers[0].real for one in back) > 3.0


class Turning:
    """Stands for a path that turns at a third of a step: through a fold or, if it jumps, at once."""

    same_step = 1e-13

    def __init__(self, cycle: ss.studies.LimitCycle, *, jumps: bool) -> None:
        self.cycle, self.jumps = cycle, jumps

    def step(self, begin: Any, length: float) -> PlaceOnBranch:
        way = math.copysign(0.5, 1.0 / 3.0 - length) if self.jumps else 1.0 / 3.0 - length
        return PlaceOnBranch(length, self.cycle.orbit, np.array([0.8, way]))


def test_a_direction_that_jumps_is_no_fold() -> None:
    """A fold is found at a third of the step to rounding; a jump there is none."""
    law = ss.friction.FromExpression("0.5 - 0.05*(v/v0 - 1) + 0.2*(v/v0 - 1)**3", {"v0": "1 m/s"})
    block = ss.SpringBlock(1.0, 1e3, 10.0)
    cycle = ss.studies.cycle(ss.Problem(block, law, pull_rate=1.0, initial_rate=1.0, initial_load=15.0))
    for jumps in (False, True):
        path: Any = Turning(cycle, jumps=jumps)
        found = edges_between(path, path.step(None, 0.0), path.step(None, 1.0), 1.0)
        assert [edge.name for edge in found] == ([] if jumps else ["fold of cycles"])
        assert [edge.value for edge in found] == pytest.approx([] if jumps else [1.0 / 3.0], rel=1e-12)


def test_every_cycle_of_a_branch_has_one_rest_however_its_period_falls() -> None:
    """Each period is that of one stick-slip, as found alone, to 1e-9, where steps make it three times shorter."""
    block = ss.SpringBlock(4.0, 400.0, 20.0, damping=6.0)
    law = ss.friction.ExponentialStribeck(0.6, 0.25, 0.04)

    def at(pull: float) -> ss.Problem:
        return ss.Problem(block, law, pull_rate=pull, initial_load=0.0)

    branch = ss.studies.follow(ss.studies.cycle(at(0.02)), to=0.3, steps=3)
    assert branch.edges == ()
    for one in branch.points[1::3]:
        assert one.measures.period == pytest.approx(ss.studies.cycle(at(one.value)).period, rel=1e-9)


def test_a_cycle_is_found_once_though_a_run_comes_to_it_from_two_sides_in_turn() -> None:
    """The multiplier is -0.83: the cycle is that at the end of a long run, to 1e-9, and not twice its period."""
    law = ss.friction.TwoStateRateAndState(
        reference=0.6, a=0.01, b=0.01, distance=1e-5, second_b=0.0084, second_distance=1e-5 / 0.048, evolution="slip"
    )
    problem = ss.Problem(ss.SpringBlock(100.0, 0.87 * 802.799465, 10.0), law, pull_rate=1e-6)
    early, late = ss.studies.cycle(problem), ss.studies.cycle(problem, near=15000.0)
    assert early.period == pytest.approx(late.period, rel=1e-9)
    assert early.multipliers[0].real == pytest.approx(-0.8318, abs=1e-3)


def least_of_swing(pull: float) -> float:
    """Return the least slip rate (m/s) after an onset, as if nothing arrested it: 1 kg, 1 kN/m, 2 N s/m, friction falls by 2 N."""
    fades, turns = 1.0, math.sqrt(1e3 - 1.0)
    sine = (2.0 - fades * pull) / turns
    time = (math.atan2(2.0, fades * sine - turns * pull) + math.pi) / turns
    return pull + math.exp(-fades * time) * (sine * math.sin(turns * time) - pull * math.cos(turns * time))


def test_no_branch_begins_in_steady_sliding_where_a_damped_block_loses_stick() -> None:
    """Under Coulomb friction no cycle is without rest. The arrest is grazed where the swing of the oscillator says so, to 1e-9."""

    def coulomb(pull: float) -> ss.Problem:
        block = ss.SpringBlock(1.0, 1e3, 10.0, damping=2.0)
        return ss.Problem(block, ss.friction.Coulomb(0.6, 0.4), pull_rate=pull, initial_load=0.0)

    branch = ss.studies.follow(ss.studies.cycle(coulomb(0.02)), to=0.3, steps=5)
    assert [edge.name for edge in branch.edges] == ["loss of stick"]
    assert branch.edges[0].value == pytest.approx(brentq(least_of_swing, 0.02, 0.3, xtol=1e-15), rel=1e-9)
    assert branch.points[-1].edge == "loss of stick"


def test_a_branch_that_has_come_to_its_end_goes_on_as_it_is() -> None:
    """Its last value is that of the end, to the last digit."""
    block = ss.SpringBlock(1.0, 1.0, 1.0, damping=0.1)
    start = ss.studies.cycle(ss.Problem(block, ss.friction.Coulomb(0.6, 0.4), pull_rate=0.007, initial_load=0.0))
    for to in (0.0248, 0.0276, 0.0283):  # over the range and times it they are larger
        branch = ss.studies.follow(start, to=to, steps=3)
        assert branch.points[-1].value == to
        assert ss.studies.follow(start, to=to, steps=3, resume=branch).table.equals(branch.table)
