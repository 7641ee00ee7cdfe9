"""Friction differences against mpmath: value and slope, for every operation of a formula."""

import numpy as np
import pytest

from stickslip.friction import LAWS
from stickslip.friction.formula import functions
from stickslip.friction.formula.differences import difference, value_and_slopes
from stickslip.friction.formula.expression import RATE, SLIP, Parameter, as_expression


@pytest.mark.parametrize("alpha", [1.0, 1e6])
def test_hyperbolic_slope_keeps_its_digits_at_high_rates(alpha):
    law = LAWS["hyperbolic-rate"](0.8, 0.3, alpha)
    parameters = {name: getattr(law, name) for name in law.parameters()}
    rate = np.geomspace(1e-12, 1e6, 60)
    value, slope = difference(law.trees()[0], parameters, 0.0, 0.0, rate)
    fall = law.static - law.dynamic
    np.testing.assert_allclose(value, -fall * alpha * rate / (1 + alpha * rate), rtol=1e-14, atol=0)
    np.testing.assert_allclose(slope, -fall * alpha / (1 + alpha * rate) ** 2, rtol=1e-14, atol=0)


@pytest.mark.parametrize("law", [LAWS["sinusoidal-slip"](1.0, 0.5, 5.0), LAWS["coulomb"](0.8, 0.3)])
def test_laws_without_rate_have_no_slope(law):
    parameters = {name: getattr(law, name) for name in law.parameters()}
    for tree in law.trees():
        value, slope = difference(tree, parameters, 0.3, np.zeros(3), np.array([0.0, 1.0, 1e9]))
        assert value.tolist() == slope.tolist() == [0.0, 0.0, 0.0]


def test_roots_have_an_infinite_slope_at_zero():
    value, slope = difference(functions.sqrt(RATE) + RATE**0.5 + functions.sqrt(SLIP), {}, 0.0, 0.0, [0.0, 4.0])
    assert value.tolist() == [0.0, 4.0]
    assert slope.tolist() == [np.inf, 0.5]


def test_arcsinh_is_exact_where_squares_overflow():
    value, _ = difference(functions.arcsinh(1e200 * RATE) + functions.arcsinh(-1e300 * SLIP), {}, 1.0, 1.0, [0.0, 1.0])
    np.testing.assert_allclose(value, [-np.log(2.0), np.log(2e200) - np.log(2.0)], rtol=1e-12)


def test_an_unknown_parameter_is_an_error():
    with pytest.raises(KeyError, match="slope"):
        difference(as_expression(1.0) + Parameter("slope") * RATE, {}, 0.0, 0.0, 1.0)


def test_a_product_and_a_sum_are_rounded_one_by_one():
    """A processor that fuses them gives another last digit in a third of all places; bounds and folds count on numpy's."""
    slip, rate = np.random.default_rng(5).uniform(0.1, 3.0, (2, 1000))
    _, slopes = value_and_slopes((SLIP * RATE) * (RATE * RATE), {}, slip, rate)
    assert (slopes[1] == slip * (rate * rate) + (slip * rate) * (rate + rate)).all()
