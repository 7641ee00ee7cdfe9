"""Rate-and-state friction with a small direct effect a, against numbers of 60 digits."""

from __future__ import annotations

from itertools import product
from typing import Any

import mpmath
import numpy as np
import pytest
from mpmath import mpf

import stickslip as ss
from stickslip.friction.laws.rate_and_state import DirectEffect

F = ss.friction
RATES = (1e-80, 1e-30, 1e-25, 1e-12, 1e-6, 1e-3, 1.0, 100.0)
ULP = 2.0**-52


def exact(law: Any, v: float, x: mpmath.mpf) -> tuple[mpmath.mpf, mpmath.mpf, mpmath.mpf]:
    """Friction, and its slopes by the slip rate and by x a, for the exponent x."""
    z = mpf(v) / (2 * mpf(law.rate)) * mpmath.exp(x)
    share = z / mpmath.sqrt(1 + z * z)
    return mpf(law.a) * mpmath.asinh(z), mpf(law.a) * share / mpf(v), share


@pytest.mark.parametrize("a", [1e-4, 5e-4, 1e-3, 3e-3])
def test_friction_and_its_slopes_are_those_of_the_arcsinh(a: float) -> None:
    """Friction to 20 ulp of 0.05 at least, slopes to 1e-12: x itself is rounded by some ulp of its terms, which are up to 1e4."""
    law = F.RateAndState(0.6, a, 0.03, 1e-3)
    with mpmath.workdps(60):
        for w, v in product((-15.0, -10.0, -5.0, 0.0, 3.0, 20.0, 50.0), RATES):
            mu, by_rate, by_state = exact(law, v, (mpf(law.reference) + mpf(law.b) * mpf(w)) / mpf(a))
            if mu < 50 * a and v < 1e-26:
                continue  # below what this form resolves
            slopes = law.slopes(0.0, v, w)
            assert abs(float(law.coefficient(0.0, v, w)) - mu) <= 20 * ULP * max(mu, 0.05)
            assert float(slopes[1]) == pytest.approx(float(by_rate), rel=1e-12)
            assert float(slopes[2]) == pytest.approx(float(by_state) * law.b, rel=1e-12)


def test_the_two_forms_of_a_law_agree_where_both_are_finite() -> None:
    rates = np.geomspace(1e-20, 10.0, 40)
    law, states = F.RateAndState(0.6, 4e-3, 0.03, 1e-3), np.linspace(-18.0, 20.0, 30)[:, None]
    assert not law.overflows

    class Logarithmic(F.RateAndState):
        overflows = True  # type: ignore[assignment] # a property in the base

    other = Logarithmic(0.6, 4e-3, 0.03, 1e-3)
    assert other.coefficient(0.0, rates, states) == pytest.approx(law.coefficient(0.0, rates, states), abs=1e-15)


LAWS: dict[str, DirectEffect] = {
    "one state": F.RateAndState(0.6, 1e-4, 0.03, 1e-3),
    "two states": F.TwoStateRateAndState(0.6, 1e-4, 0.03, 1e-3, 0.006, 2e-2),
    "flash heating": F.FlashHeating(0.6, 1e-4, 0.014, 0.4, 0.2, 0.1),
}


@pytest.mark.parametrize("name", LAWS)
def test_it_is_zero_at_rest_odd_and_rises_with_the_slip_rate(name: str) -> None:
    law = LAWS[name]
    states: Any = [0.0] * len(law.states) if len(law.states) > 1 else 0.6 if name == "flash heating" else 0.0
    rates = np.concatenate(([0.0], np.geomspace(1e-110, 10.0, 400)))
    mu = law.coefficient(0.0, rates, states)
    assert mu[0] == 0.0
    assert np.all(np.diff(mu) >= 0.0)
    assert np.all(np.isfinite(law.slopes(0.0, rates, states)[1]))


def test_steady_friction_of_flash_heating_approaches_its_closed_form() -> None:
    """mu_low = reference - (b - a) ln(v / rate), and weakened + (mu_low - weakened) / (1 + (v / weakening_rate)^8)^(1/8)."""
    law = LAWS["flash heating"]
    rates = np.array([1e-12, 1e-6, 1e-3, 0.05, 1.0, 100.0])
    low = 0.6 - (0.014 - 1e-4) * np.log(rates / 1e-6)
    steady = 0.2 + (low - 0.2) / (1.0 + (rates / 0.1) ** 8) ** 0.125
    assert law.steady_coefficient(rates) == pytest.approx(steady, rel=1e-13)  # type: ignore[attr-defined]
    states = law.steady_state(rates)
    assert law.coefficient(0.0, rates, states) == pytest.approx(steady, rel=1e-13)


def test_flash_heating_that_would_lose_its_friction_at_high_rates_is_refused() -> None:
    with pytest.raises(
        ss.InputError, match=r"^FlashHeating: a must be at least 0\.00015 with this reference, b and rate, got 0\.0001$"
    ):
        F.FlashHeating(0.2, 1e-4, 0.03, 0.4, 0.1, 0.1)
