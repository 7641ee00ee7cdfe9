"""Friction that falls exactly as fast as Z v rises: a continuum of slip rates at one load."""

from dataclasses import replace

import pytest

import stickslip as ss
from stickslip.problem.selection_rule import SELECTION_RULES

from .laws import S, Z, slab_problem

FALL = Z / S
PLATEAU = ss.friction.PiecewiseLinearRate((0.0, 1.0, 2.0, 6.0), (0.6, 0.65, 0.65 - FALL, 0.5))
AT_REST = ss.friction.PiecewiseLinearRate((0.0, 1.0, 2.0, 6.0), (0.6, 0.6 - FALL, 0.6 - 2 * FALL, 0.3))
LEVEL = 0.65 * S + Z


@pytest.mark.parametrize("rule", SELECTION_RULES)
def test_a_plateau_between_two_branches_is_a_continuum(rule):
    found = ss.uniqueness(slab_problem(PLATEAU, rule))
    assert found.regime == "continuum"
    assert [(p.rate_from, p.rate_to) for p in found.plateaus] == [(1.0, 2.0)]
    assert [(b.rate_from, b.rate_to) for b in found.branches] == [(0.0, 1.0), (2.0, float("inf"))]
    assert found.branches[0].excess_to == found.branches[1].excess_from == found.plateaus[0].excess
    assert found.continuum(LEVEL) == (1.0, 2.0)
    assert found.admissible(LEVEL).tolist() == [1.0, 2.0]
    assert found.stability(LEVEL).tolist() == [False, False]
    assert found.admissible(-LEVEL).tolist() == [-2.0, -1.0]
    assert found.continuum(-LEVEL) == (-2.0, -1.0)
    assert found.loop_area == 0.0
    assert [(j.rate_before, j.rate_after) for j in found.jumps] == [(1.0, 2.0), (2.0, 1.0)]
    assert "continuum of slip rates, 1 to 2 m/s" in found.summary
    assert "where no rule picks one" in found.summary


@pytest.mark.parametrize("load", [0.0, 0.3 * S, LEVEL - 1.0, LEVEL + 1.0, 2 * LEVEL])
def test_beside_the_plateau_there_is_one_slip_rate(load):
    found = ss.uniqueness(slab_problem(PLATEAU))
    assert found.continuum(load) is None
    assert found.admissible(load).size == 1
    assert found.stability(load).all()


def test_a_plateau_from_rest_is_a_continuum():
    found = ss.uniqueness(slab_problem(AT_REST))
    assert found.regime == "continuum"
    assert found.window == (0.0, 0.0)
    assert [(p.rate_from, p.rate_to) for p in found.plateaus] == [(0.0, 2.0)]
    assert found.admissible(0.6 * S).tolist() == [0.0, 2.0]
    assert found.stability(0.6 * S).tolist() == [True, False]
    assert found.g([0.0, 0.7, 1.0, 1.9, 2.0]).tolist() == pytest.approx([0.6 * S] * 5, rel=4e-16, abs=0)


@pytest.mark.parametrize("step", [-1e-12, 1e-12])
def test_a_slope_that_is_not_exact_makes_no_continuum(step):
    """Off by 1e-4 Pa over the stretch, which is beyond the rounding of 7.5e7 Pa: regular, or a window of that width."""
    found = ss.uniqueness(slab_problem(replace(PLATEAU, coefficients=(0.6, 0.65, 0.65 - FALL + step, 0.5))))
    assert found.regime == ("irregular" if step < 0 else "regular")
    if step < 0:
        assert found.window[1] - found.window[0] == pytest.approx(-step * S, rel=1e-3, abs=0)


def test_a_law_can_have_a_continuum_and_folds():
    law = ss.friction.PiecewiseLinearRate((0.0, 1.0, 2.0, 4.0, 6.0), (0.6, 0.65, 0.65 - FALL, 0.2, 0.2))
    found = ss.uniqueness(slab_problem(law))
    assert found.regime == "continuum"
    assert found.window[1] - found.window[0] > 1e6
    assert {"1 to 2 m/s", "a window of"} <= {text for text in ("1 to 2 m/s", "a window of") if text in found.summary}
    assert found.continuum(found.resistance.strength + found.plateaus[0].excess) == (1.0, 2.0)
    assert len(found.admissible(LEVEL)) == 3
