"""A dashpot at the contact of a slab is one property: the damping of the contact equation is not the impedance of the waves."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import trapezoid

import stickslip as ss

D = 4e6
"""Damping at the contact, Pa s/m, beside an impedance of 9.8e6 Pa s/m."""


class WithDashpot(ss.ElasticSlab):
    """A slab whose contact has a dashpot beside friction."""

    @property
    def damping(self) -> float:
        """Z + D, Pa s/m."""
        return self.impedance + D


def test_under_coulomb_friction_it_slips_at_the_stress_drop_over_z_and_d() -> None:
    slab = WithDashpot(2800, 3500, 1e4, 1e8)
    run = ss.simulate(ss.Problem(slab, ss.friction.Coulomb(0.8, 0.6), pull_rate=0.0, initial_excess=1e6), 5.0)
    assert float(run.slip_rate(1.0)) == pytest.approx((0.2 * 1e8 + 1e6) / (slab.impedance + D), rel=1e-14)


@pytest.mark.parametrize("law", [ss.friction.HyperbolicRate(0.8, 0.6, 0.2), ss.friction.LinearSlipWeakening(0.8, 0.6, 2.0)])
@pytest.mark.parametrize("share", [0.0, 0.4, np.inf], ids=["dead load", "leaky", "rigid"])
def test_waves_keep_the_impedance_and_the_contact_equation_has_both(law: ss.friction.FrictionLaw, share: float) -> None:
    """(Z + D) v + S mu = load within 1e-9 of the load in slip, and the balance lacks D times the integral of v^2.

    The trapezoidal rule with 40 001 points makes an error of 1e-6 of that integral.
    """
    slab = WithDashpot(2800, 3500, 1e4, 1e8, driver_impedance=share * 9.8e6)
    run = ss.simulate(ss.Problem(slab, law, pull_rate=0.0, initial_excess=2e6), 30.0)
    times = np.linspace(0.0, run.duration, 40_001)
    rate, at = run.slip_rate(times), run.history.find(times, "right")
    moving = rate > 0.0
    assert moving.sum() > 1000
    load = run.history.excess(at) + run.problem.strength
    friction = slab.normal_stress * law.coefficient(run.slip(times), rate)
    assert (slab.damping * rate + friction)[moving] == pytest.approx(load[moving], rel=1e-9)
    energy = run.energy(times[-1:])
    assert float(energy.balance[0]) == pytest.approx(D * trapezoid(rate**2, times), rel=1e-4)
