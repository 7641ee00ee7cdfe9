"""Laws in which something overflows, or is inf, where it does no harm: 1/inf is 0."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import mpmath
import numpy as np
import pytest

import stickslip as ss
from stickslip.friction.formula.differences import difference
from tests.problems import SLAB

RATES = np.append(0.0, 10.0 ** np.arange(-12, 13))
"""Slip rates, m/s."""
LAWS: dict[str, Callable[[Any, Any], Any]] = {
    "sech": lambda v, f: 0.6 + 0.2 / f.cosh(v / 0.1),
    "sech squared": lambda v, f: 0.6 + 0.2 / f.cosh(v / 1e-3) ** 2,
    "falls": lambda v, f: 0.6 + 0.2 * f.exp(-v / 1e-6),
    "logistic": lambda v, f: 0.6 + 0.2 / (1 + f.exp(v / 0.1)),
    "logistic, squared": lambda v, f: 0.6 + 0.2 / (1 + f.exp(v / 0.1)) ** 2,
    "over an exponential": lambda v, f: 0.6 + 0.2 / f.exp(v / 0.05),
    "over a root": lambda v, f: 0.6 + 0.2 / f.sqrt(1 + f.exp(v / 0.01)),
    "twice exponential": lambda v, f: 0.6 + 0.2 / (1 + f.exp(f.exp(v))),
    "power": lambda v, f: 0.6 + 0.2 / (1 + (v / 1e-3) ** 8),
    "bump": lambda v, f: 0.6 + 0.2 * (v / 0.01) ** 2 / f.cosh(v / 0.01),
    "bell": lambda v, f: 0.6 + 0.2 * f.exp(-((v / 0.1) ** 2)),
    "tanh": lambda v, f: 0.6 - 0.1 * f.tanh(v / 1e-4),
    "softplus": lambda v, f: 0.6 + 0.01 * f.log(1 + f.exp(-v / 0.01)),
    "log1p": lambda v, f: 0.6 + 0.01 * f.log1p(v / 1e-6),
    "root": lambda v, f: 0.6 + 0.05 * f.sqrt(v + 1e-6),
    "smooth kink": lambda v, f: 0.6 - 0.1 * f.sqrt((v - 0.5) ** 2 + 1e-4) / (1 + v),
    "arcsinh": lambda v, f: 0.6 - 0.1 * f.arcsinh(v / 1e-3) / (1 + v),
}


class Exact:
    """The functions of a law, with 60 digits."""

    exp, cosh, tanh, log, log1p, sqrt, arcsinh = map(
        staticmethod, (mpmath.exp, mpmath.cosh, mpmath.tanh, mpmath.log, mpmath.log1p, mpmath.sqrt, mpmath.asinh)
    )


@pytest.mark.sampled(every=5)
@pytest.mark.parametrize("name", LAWS)
def test_a_law_that_overflows_harmlessly_has_its_value_and_slope_at_every_rate(name: str) -> None:
    law = ss.friction.FromFunction(lambda v: LAWS[name](v, np))
    step, slope = difference(law.tree, law.numbers(), 0.0, np.zeros_like(RATES), RATES)
    with mpmath.workdps(60):
        rest = LAWS[name](mpmath.mpf(0), Exact)
        for i, rate in enumerate(RATES.tolist()):
            if rate / 1e-3 > 1e7 and "exponential" in name:
                continue  # a number that no computer holds: exp(exp(1e4))
            value = LAWS[name](mpmath.mpf(rate), Exact)
            rise = mpmath.diff(lambda v: LAWS[name](v, Exact), mpmath.mpf(rate), h=mpmath.mpf(10) ** -30)
            assert law.coefficient(0.0, rate) == pytest.approx(float(value), rel=1e-14, abs=0.0)
            assert step[i] == pytest.approx(float(value - rest), rel=1e-11, abs=1e-16 * min(1e4 * rate, 1.0) + 1e-50)
            assert slope[i] == pytest.approx(float(rise), rel=1e-9, abs=1e-12)


@pytest.mark.sampled(every=2)
@pytest.mark.parametrize("text", ["0.6 + 0.2/cosh(v/1e-6)", "0.6 + 0.2/(1 + 2*expm1(v/1e-6) + (v/1e-6)**8)"])
def test_a_run_whose_law_overflows_at_each_event_is_that_of_the_law_with_a_step(text: str) -> None:
    """Friction falls from 0.8 to 0.6 within some um/s; above 0.7 mm/s the exponential overflows."""
    found, step = (
        ss.simulate(ss.Problem(SLAB, law, pull_rate=0.05, initial_excess=1e6), 20.0)
        for law in (text, ss.friction.Coulomb(0.8, 0.6))
    )
    assert found.status.name == "finished"
    assert found.events.slip.sum() == pytest.approx(step.events.slip.sum(), rel=1e-5, abs=0.0)
