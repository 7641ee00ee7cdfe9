"""Exponentials, logarithms and sines of small numbers keep the digits that a difference or a sum loses."""

from __future__ import annotations

import math

import mpmath
import numpy as np
import pytest

import stickslip as ss
from stickslip.engine.formula_code.taylor_series import ORDER
from stickslip.engine.series import sine as sines
from tests.core.engine.compiled import compiled
from tests.core.engine.formulas import enclose, series

sine, versine = compiled(sines.sine), compiled(sines.versine)

ROUNDINGS = 5
"""Of numbers up to 2: what the libraries' functions and a product or two make."""


@pytest.mark.parametrize("size", [1e-9, 1e-3, 1.0, 3.2, 100.0, 1e6, 1e11])
def test_sine_and_versine_agree_with_60_digits(size: float) -> None:
    for e in np.random.default_rng(2).uniform(-size, size, 300).tolist():
        with mpmath.workdps(60):
            angle = mpmath.mpf(e)
            exact, exact_versine = mpmath.sin(angle), 2 * mpmath.sin(angle / 2) ** 2
            assert abs(mpmath.mpf(sine(e)) - exact) <= ROUNDINGS * 2.0**-53 * 2
            assert abs(mpmath.mpf(versine(e)) - exact_versine) <= ROUNDINGS * 2.0**-53 * 2


@pytest.mark.parametrize("size", [1e-150, 1e-9, 1e-3, 0.5])
def test_small_angles_keep_their_digits(size: float) -> None:
    for e in np.random.default_rng(2).uniform(0.5 * size, size, 100).tolist():
        with mpmath.workdps(60):
            angle = mpmath.mpf(e)
            assert sine(e) == pytest.approx(float(mpmath.sin(angle)), rel=1e-15, abs=0.0)
            assert versine(e) == pytest.approx(float(2 * mpmath.sin(angle / 2) ** 2), rel=1e-15, abs=0.0)


@pytest.mark.parametrize("text", ["0.5 + 1e16*expm1(1e-18*v)", "0.5 + 1e16*log1p(1e-18*v)", "0.5 + 1e16*sinh(1e-18*v)"])
def test_digits_of_small_arguments_are_kept(text: str) -> None:
    """0.51 at 1 m/s: exp(1e-18) - 1 and log(1 + 1e-18) would be 0."""
    law = ss.friction.FromExpression(text)
    assert float(law.coefficient(0.0, 1.0)) == pytest.approx(0.51, rel=1e-15, abs=0.0)
    assert law.slopes(0.0, 1.0)[1] == pytest.approx(0.01, rel=1e-14, abs=0.0)
    (value, value_high), (slope, slope_high), _ = (one[:, 0] for one in enclose(law.tree, {}, 0.0, [1.0], [1.0]))
    assert value <= 0.51 <= value_high <= value * (1.0 + 1e-14)
    assert slope <= 0.01 <= slope_high <= slope * (1.0 + 1e-12)


def test_a_quotient_over_expm1_has_its_limit_where_expm1_overflows() -> None:
    """x / (exp(x) - 1) is 0 beside the rest of the law for x of a million, and its series is finite."""
    law = ss.friction.FromExpression("0.6 + 0.1*(v/1e-6 + 1e-3)/expm1(v/1e-6 + 1e-3)")
    found, step = series(law.tree, 0.0, [0.0] * (ORDER + 1), [1.0, *[0.1] * ORDER])
    assert found[0] == pytest.approx(0.6, rel=1e-14)
    assert np.isfinite(found).all()
    assert step == pytest.approx(-0.1 * 1e-3 / math.expm1(1e-3), rel=1e-12)
