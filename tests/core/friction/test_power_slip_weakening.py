"""Friction that falls as a power of slip, against closed forms: its curve, its slopes, and where a block stops under it."""

from __future__ import annotations

import numpy as np
import pytest

from stickslip.friction import PowerSlipWeakening

STATIC, DYNAMIC = 0.6, 0.2
EXPONENTS = pytest.mark.parametrize("exponent", [1.0 / 3.0, 0.4, 1.0, 2.0])


@EXPONENTS
def test_friction_its_slope_and_its_halving_are_those_of_the_power(exponent: float) -> None:
    """With y = 1 + d / L the slope is -exponent (static - dynamic) / L y^(-exponent - 1)."""
    distance = 0.1
    law = PowerSlipWeakening(STATIC, DYNAMIC, distance, exponent)
    slip = np.array([0.0, 1e-6, 0.03, 0.7, 40.0])
    fall, y = STATIC - DYNAMIC, 1.0 + slip / distance
    assert law.coefficient(slip) == pytest.approx(DYNAMIC + fall * np.exp(-exponent * np.log(y)), rel=4e-15)
    slope = -exponent * fall / distance * np.exp(-(exponent + 1.0) * np.log(y))
    assert law.slopes(slip, 1.0)[0] == pytest.approx(slope, rel=1e-13)
    half = distance * (2.0 ** (1.0 / exponent) - 1.0)
    assert float(law.coefficient(half)) == pytest.approx(DYNAMIC + 0.5 * fall, rel=1e-14)


def test_the_form_with_an_initial_slope_is_the_law_over_exponent_times_its_distance() -> None:
    """Chambon et al.: the curve begins as linear weakening over Dc does, and has lost about half of its fall at 2 Dc."""
    dc, exponent = 1e-4, 0.4
    law = PowerSlipWeakening(STATIC, DYNAMIC, exponent * dc, exponent)
    assert float(law.slopes(0.0, 1.0)[0]) == pytest.approx(-(STATIC - DYNAMIC) / dc, rel=1e-14)
    lost = (STATIC - float(law.coefficient(2.0 * dc))) / (STATIC - DYNAMIC)
    assert lost == pytest.approx(1.0 - 6.0**-0.4, rel=1e-14)
    assert 0.45 < lost < 0.55
