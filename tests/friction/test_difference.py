"""Friction differences against mpmath: value and slope, for every operation of a formula."""

import numpy as np
import pytest

from stickslip.friction import LAWS
from stickslip.friction.formula import functions
from stickslip.friction.formula.differences import difference
from stickslip.friction.formula.expression import RATE, SLIP, Parameter, as_expression

mpmath = pytest.importorskip("mpmath")

FORMULAS = {
    "quotient": lambda u, v, f: 0.3 + 0.5 / (1.0 + 7.0 * v) - 0.1 * u * v,
    "sin": lambda u, v, f: f.sin(3.0 * u + v),
    "cos": lambda u, v, f: f.cos(3.0 * u - 2.0 * v) * v,
    "exp": lambda u, v, f: f.exp(-2.0 * v + u),
    "log": lambda u, v, f: f.log(1.0 + 0.01 * v + u * u),
    "sqrt": lambda u, v, f: f.sqrt(2.0 + v + u),
    "tanh": lambda u, v, f: f.tanh(v - u),
    "arcsinh": lambda u, v, f: f.arcsinh(100.0 * v + u) + f.arcsinh(u - 3.0 * v),
    "expm1": lambda u, v, f: f.expm1(-2.0 * v - 0.1 * u) + f.expm1(1e-18 * v) * 1e16,
    "log1p": lambda u, v, f: f.log1p(30.0 * v + u) + f.log1p(1e-18 * v) * 1e16,
    "power": lambda u, v, f: (1.0 + 2.0 * v + u) ** 2.7 - (-v) ** 2,
}


class _Exact:
    sin, cos, exp, log, sqrt, tanh, arcsinh, expm1, log1p = map(
        staticmethod,
        (
            *(mpmath.sin, mpmath.cos, mpmath.exp, mpmath.log, mpmath.sqrt, mpmath.tanh, mpmath.asinh),
            *(mpmath.expm1, mpmath.log1p),
        ),
    )


@pytest.mark.parametrize("name", FORMULAS)
@pytest.mark.parametrize("slip", [0.0, 0.7, 30.0])
@pytest.mark.parametrize(("step", "rate"), [(0.0, 1e-14), (1e-13, 0.0), (1e-9, 1e-7), (0.02, 0.3), (-1e-3, 2.0)])
def test_differences_and_slopes_agree_with_mpmath(name, slip, step, rate):
    formula = FORMULAS[name]
    value, slope = difference(formula(SLIP, RATE, functions), {}, slip, step, rate)
    with mpmath.workdps(60):
        u, du, v = mpmath.mpf(slip), mpmath.mpf(step), mpmath.mpf(rate)
        exact = formula(u + du, v, _Exact) - formula(u, mpmath.mpf(0), _Exact)
        parts = [formula(u + du, mpmath.mpf(0), _Exact) - formula(u, mpmath.mpf(0), _Exact)]
        exact_slope = mpmath.diff(lambda s: formula(u + du, s, _Exact), v)
    size = abs(float(exact)) + abs(float(parts[0]))
    assert float(value) == pytest.approx(float(exact), rel=0, abs=2e-13 * size)
    assert float(slope) == pytest.approx(float(exact_slope), rel=2e-13, abs=1e-14)


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
