"""Where branches of cycles end and turn: at the ends of their range, next to the loss of stick, and beside steady sliding."""

from __future__ import annotations

import math

import pytest

import stickslip as ss
from stickslip.contact import steady_slidings
from stickslip.extensions.cycles.hysteresis import Interval, with_stable_sliding


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
