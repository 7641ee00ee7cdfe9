"""Margins of contacts over two numbers and along slip, and friction that falls exactly as fast as Z v rises."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import stickslip as ss
from stickslip.contact.critical import margin
from stickslip.contact.regime_map import put_both, regime_map, regimes_along_slip, slip_reach
from stickslip.contact.roots import sign_change, sign_changes
from stickslip.foundation.axis import Axis
from stickslip.friction import LAWS
from stickslip.problem.selection_rule import SELECTION_RULES
from tests.core.friction.drawn import laws
from tests.limits import examples

from .laws import SLAB, S, Z, hyperbolic, slab_problem

F = ss.friction


def test_the_curve_is_where_the_formula_says():
    """alpha S (muS - muD) = Z."""
    found = regime_map(slab_problem(hyperbolic(1.0)), Axis("alpha", 0.01, 10.0, 9, log=True), Axis("normal_stress", 1e7, 5e8, 7))
    assert found.boundary.shape[1:] == (2, 2)
    assert len(found.boundary) >= 6
    assert found.boundary[..., 0] * found.boundary[..., 1] * 0.5 == pytest.approx(np.full(found.boundary.shape[:2], Z), rel=1e-14)
    assert found.present == (1.0, 1e8)
    alpha, stress = np.meshgrid(found.x.values, found.y.values)
    assert np.array_equal(found.margin < 0.0, alpha * stress * 0.5 > Z)
    assert found.margin == pytest.approx(1.0 - alpha * stress * 0.5 / Z, rel=1e-12, abs=1e-12)


def test_the_map_is_empty_where_the_problem_is_refused():
    problem = slab_problem(F.Coulomb(0.6, 0.5))
    found = regime_map(problem, Axis("static", 0.1, 0.9, 5), Axis("dynamic", 0.2, 0.8, 4))
    static, dynamic = np.meshgrid(found.x.values, found.y.values)
    assert np.array_equal(np.isnan(found.margin), static < dynamic)
    assert np.array_equal(found.margin < 0.0, static > dynamic)


@pytest.mark.parametrize(
    ("x", "y", "message"),
    [
        (("alpha", 1.0, 1.0), ("static", 0.1, 1.0), "must go from a smaller to a larger number"),
        (("alpha", 0.0, 1.0, 5, True), ("static", 0.1, 1.0), "must begin above 0"),
        (("alpha", 0.0, 1.0, 1), ("static", 0.1, 1.0), "must have 2 to 1000 points, got 1"),
        (("alpha", 0.0, 1.0), ("friction.alpha", 0.1, 1.0), "two different parameters"),
        (("alpha", 0.0, 1.0), ("beta", 0.1, 1.0), "parameter 'beta' is unknown"),
    ],
)
def test_bad_axes_are_refused(x, y, message):
    with pytest.raises(ss.InputError, match=message):
        regime_map(slab_problem(hyperbolic(1.0)), Axis(*x), Axis(*y))


def test_along_slip_an_oscillating_factor_comes_and_goes():
    """S (1 + sin(5 u) / 2) 0.15 = Z: twice a period."""
    law = F.SlipTimesRate(F.SinusoidalSlip(1.0, 0.5, 5.0), F.HyperbolicRate(0.6, 0.52, 1.0))
    found = regimes_along_slip(slab_problem(law))
    assert [one.regime for one in found] == ["regular", "irregular"] * 2 + ["regular"]
    for one in found[:-1]:
        assert S * (1 + 0.5 * np.sin(5 * one.slip_to)) * 0.08 == pytest.approx(Z, rel=1e-13, abs=0)


def test_a_law_of_slip_or_rate_alone_has_one_regime_along_slip():
    for law, regime in ((hyperbolic(1.0), "irregular"), (F.SinusoidalSlip(1.0, 0.5, 5.0), "regular")):
        (one,) = regimes_along_slip(slab_problem(law))
        assert one.regime == regime


@pytest.mark.parametrize(
    ("law", "reach"),
    [
        (F.SinusoidalSlip(1.0, 0.5, 5.0), 4 * np.pi / 5),
        (F.PiecewiseLinearSlip((0.0, 0.1, 3.0), (0.6, 0.5, 0.4)), 6.0),
        (F.FromExpression("0.6 - 0.1*tanh(u / d)", {"d": "0.2 m"}), 0.4),
        (hyperbolic(1.0), 20.0),
    ],
)
def test_slip_reach_covers_the_scales_of_the_law(law, reach):
    assert slip_reach(law) == pytest.approx(reach, rel=1e-14, abs=0)


EPS = np.finfo(float).eps
KINDS = st.sampled_from(sorted(kind for kind, law in LAWS.items() if law.state is None)).flatmap(laws)
"""With a state of its own the slip rate does not follow from the load alone."""


def problem_of(law, stress=1e8, slip=0.0):
    return ss.Problem(replace(SLAB, normal_stress=stress), law, initial_slip=slip, initial_excess=0.0)


@settings(max_examples=examples(25), deadline=None)
@given(law=KINDS, data=st.data())
def test_a_map_over_any_two_numbers_has_the_margins_of_its_points(law, data):
    problem = problem_of(law)
    numbers = [one for one in problem.parameters.values() if not one.declared.whole and 1e-300 < one.value < np.inf]
    one, other = data.draw(st.lists(st.sampled_from(numbers), min_size=2, max_size=2, unique_by=lambda found: found.name))
    axes = [Axis(axis.name, 0.7 * axis.value, 1.4 * axis.value, 3) for axis in (one, other)]
    found = regime_map(problem, *axes)
    for row, y in enumerate(axes[1].values.tolist()):
        for column, x in enumerate(axes[0].values.tolist()):
            known = found.margin[row, column]
            if not np.isnan(known):
                point = put_both((one, other), (x, y))
                assert known == pytest.approx(margin(point), rel=16 * EPS, abs=16 * EPS)


@pytest.mark.parametrize("depth", [1e-6, 1e-5, 0.0, 1e-4])
def test_a_dip_of_any_depth_is_found(depth):
    """The lowest g' lies in a dip of 1e-5 m/s."""
    law = ss.friction.FromExpression("0.6 - 0.01*v - depth*tanh((v - at)/width)", {"at": 3.00123, "width": 1e-5, "depth": depth})
    assert margin(problem_of(law)) == pytest.approx(1.0 - 1e8 * (0.01 + depth / 1e-5) / 9.8e6, rel=1e-9, abs=0.0)


def test_changes_of_sign_found_together_are_those_found_alone():
    cubes = [0.1, 2.0, -0.3, 0.77]
    brackets = [(-3.0, 5.0), (0.0, 2.0), (-1.0, 1.0), (0.0, 1.0)]

    def value(which, place):
        return place**3 - cubes[which] ** 3 if which != 3 else (1.0 if place > cubes[3] else -1.0)

    together = sign_changes(lambda wanted: [value(*one) for one in wanted], brackets)
    assert together == [sign_change(lambda x, k=k: value(k, x), *brackets[k]) for k in range(4)]
    assert together == pytest.approx(cubes, rel=4 * EPS)


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
