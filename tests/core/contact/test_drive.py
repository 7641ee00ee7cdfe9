"""How drivers resist: against the waves that they send back, and at a steady rate."""

from __future__ import annotations

import math

import numpy as np
import pytest

import stickslip as ss
from stickslip.problem import driver_impedance

Z, KP, M, KI = 9.8e6, 3e6, 2e7, 4e5


def slab(**driver: float) -> ss.ElasticSlab:
    return ss.ElasticSlab(2800.0, 3500.0, 1e4, 1e8, **driver)


@pytest.mark.parametrize("driver", [math.inf, 0.0, KP, Z, 1e17 * Z])
def test_a_driver_without_motion_has_one_impedance_and_sends_back_what_it_says(driver: float):
    """(Z - x) / (Z + x) with x = n/d is the reflection of the body, that of a rigid driver too, where d is 0."""
    body = slab(driver_impedance=driver)
    found = driver_impedance(body)
    (resists,), (one,) = found
    assert found.is_constant
    assert (Z * one - resists) / (Z * one + resists) == pytest.approx(body.reflection, rel=1e-15)
    assert found.steady == (math.inf if body.is_driven_rigidly else driver)


@pytest.mark.parametrize(("mass", "gain"), [(M, 0.0), (0.0, KI), (M, KI)])
def test_a_machine_resists_by_mass_and_gains_and_holds_its_rate_if_a_gain_integrates(mass: float, gain: float):
    found = driver_impedance(slab(driver_impedance=KP, driver_inertia=mass, driver_integral_gain=gain))
    s = 0.3 + 2.0j
    resists, one = (np.polynomial.polynomial.polyval(s, part) for part in found)
    assert not found.is_constant
    assert resists / one == pytest.approx(mass * s + KP + gain / s, rel=1e-14)
    assert found.steady == (math.inf if gain else KP)
