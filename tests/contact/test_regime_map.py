"""The regime over two numbers: its curve against the formula, its points against `uniqueness`."""

import numpy as np
import pytest

import stickslip as ss
from stickslip.contact.regime_map import Axis, regime_map, regimes_along_slip, slip_reach

from .laws import S, Z, hyperbolic, slab_problem

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


def test_the_curve_does_not_care_which_axis_is_which():
    axes = Axis("static", 0.1, 1.0, 7), Axis("dynamic", 0.05, 1.0, 8)
    one, other = (regime_map(slab_problem(hyperbolic(1.0)), *pair) for pair in (axes, axes[::-1]))
    assert np.array_equal(one.margin, other.margin.T)
    for found in (one, other):
        difference = found.boundary[..., 0] - found.boundary[..., 1]
        assert np.abs(difference) == pytest.approx(np.full(difference.shape, Z / S), rel=1e-13)


def test_an_axis_without_effect_does_not_move_the_boundary():
    found = regime_map(slab_problem(hyperbolic(1.0)), Axis("alpha", 0.1, 1.0, 5), Axis("thickness", 1e3, 1e4, 4))
    assert len(found.boundary) == 3
    assert found.boundary[..., 0] == pytest.approx(np.full((3, 2), 0.196), rel=1e-14)


def test_the_map_is_empty_where_the_problem_is_refused():
    problem = slab_problem(F.Coulomb(0.6, 0.5))
    found = regime_map(problem, Axis("static", 0.1, 0.9, 5), Axis("dynamic", 0.2, 0.8, 4))
    static, dynamic = np.meshgrid(found.x.values, found.y.values)
    assert np.array_equal(np.isnan(found.margin), static < dynamic)
    assert np.array_equal(found.margin < 0.0, static > dynamic)


@pytest.mark.parametrize(
    ("x", "y", "message"),
    [
        (("alpha", 1.0, 1.0), ("static", 0.1, 1.0), "must go from a smaller to a larger value"),
        (("alpha", 0.0, 1.0, 5, True), ("static", 0.1, 1.0), "must begin above 0"),
        (("alpha", 0.0, 1.0, 1), ("static", 0.1, 1.0), "must have 2 to 1000 points, got 1"),
        (("alpha", 0.0, 1.0), ("friction.alpha", 0.1, 1.0), "two different parameters"),
        (("alpha", 0.0, 1.0), ("beta", 0.1, 1.0), "parameter 'beta' is unknown"),
    ],
)
def test_bad_axes_are_refused(x, y, message):
    with pytest.raises(ss.InputError, match=message):
        regime_map(slab_problem(hyperbolic(1.0)), Axis(*x), Axis(*y))


def test_inertia_has_no_map():
    axes = Axis("alpha", 0.1, 1.0, 2), Axis("static", 0.1, 1.0, 2)
    block = ss.Problem(ss.SpringBlock(2.8e12, 3.43e13, 1e14), hyperbolic(1.0), initial_excess=0.0)
    for problem in (block, slab_problem(hyperbolic(1.0), contact_mass=1.0)):
        with pytest.raises(ss.InputError):
            regime_map(problem, *axes)


def test_along_slip_a_product_leaves_the_irregular_regime():
    law = F.SlipTimesRate(F.LinearSlipWeakening(0.7, 0.05, 0.4), F.HyperbolicRate(1.0, 0.5, 1.0))
    first, second = regimes_along_slip(slab_problem(law))
    edge = (0.7 - 0.196) * 0.4 / 0.65
    assert (first.regime, second.regime) == ("irregular", "regular")
    assert first.slip_to == second.slip_from == pytest.approx(edge, rel=1e-13, abs=0)
    assert (first.slip_from, second.slip_to) == (0.0, 0.8)


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
