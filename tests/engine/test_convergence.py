"""The error follows the tolerance; Coulomb friction is the limit of the hyperbolic law; a dashpot adds to the impedance."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import trapezoid

import stickslip as ss
from stickslip.reference.slab import PulseTrain
from stickslip.studies.verdict import local_orders
from tests.problems import DENSITY, IMPEDANCE, MODULUS, NORMAL, ROUND, SLAB, THICKNESS, slip_law_block, slip_law_slab

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


ALPHAS = 10.0 ** np.arange(1, 7)
DROP = 0.5
BLOCK = ss.SpringBlock(DENSITY * 1e9, MODULUS * 1e3, 1e14)
SLIP = {SLAB: 2 * DROP * NORMAL * THICKNESS / MODULUS, BLOCK: 2 * DROP * BLOCK.normal_force / BLOCK.stiffness}


def missing(body: ss.ElasticSlab | ss.SpringBlock) -> np.ndarray:
    """Share of Coulomb's slip 2 (muS - muD) S / stiffness that the first event lacks, for each alpha."""
    slips = []
    for alpha in ALPHAS.tolist():
        law = ss.friction.HyperbolicRate(0.8, 0.8 - DROP, alpha)
        problem = ss.Problem(body, law, pull_rate=1e-14, initial_excess=0.0)
        slips.append(float(ss.simulate(problem, 2 * ROUND, rtol=1e-12).slip(2 * ROUND)))
    return 1.0 - np.array(slips) / SLIP[body]


def test_slip_of_a_slab_tends_to_the_coulomb_limit_with_order_one() -> None:
    """It slides at (muS - muD) S / Z - 1 / alpha for one round trip: the share is alpha_c / alpha, exactly."""
    found = missing(SLAB)
    assert found == pytest.approx(IMPEDANCE / (DROP * NORMAL) / ALPHAS, rel=2e-6, abs=0.0)
    assert local_orders(1.0 / ALPHAS, found)[1:] == pytest.approx(1.0, abs=1e-6)


def test_slip_of_a_block_tends_to_the_coulomb_limit_with_order_one() -> None:
    """The work that friction does beyond Coulomb's falls as 1 / alpha, but for a share in 1 / alpha^2 ln(alpha)."""
    orders = local_orders(1.0 / ALPHAS, missing(BLOCK))[1:]
    assert (np.diff(orders) > 0.0).all()
    assert orders[-1] == pytest.approx(1.0, abs=1e-4)


CASES = {
    "slab": (slip_law_slab(50.0, 1e-3, extra_load=3430.0, pull=0.0), 9.0),
    "block": (slip_law_block(5.0, MODULUS * 1e3), 3.0),
}


def error(problem: ss.Problem, duration: float, rtol: float, truth: ss.Solution) -> float:
    times = np.linspace(0.0, duration, 400)
    slip = truth.slip(times) - problem.initial_slip
    return float(np.max(np.abs(ss.simulate(problem, duration, rtol=rtol).slip(times) - problem.initial_slip - slip)) / np.ptp(slip))


@pytest.mark.parametrize("name", CASES)
def test_error_follows_tolerance(name: str) -> None:
    problem, duration = CASES[name]
    truth = ss.simulate(problem, duration, rtol=1e-15)
    tolerances = 10.0 ** np.arange(-5, -12, -1)
    errors = np.array([error(problem, duration, rtol, truth) for rtol in tolerances])
    slope = np.polyfit(np.log10(tolerances), np.log10(errors), 1)[0]
    assert 0.8 < slope < 1.3
    # the pulses amplify an error of the start by the ratio of their rates, here about 100
    assert np.all(errors < 100 * tolerances)


def test_a_loose_tolerance_is_worse() -> None:
    problem, duration = CASES["slab"]
    truth = ss.simulate(problem, duration, rtol=1e-15)
    assert error(problem, duration, 1e-4, truth) > 1e3 * error(problem, duration, 1e-9, truth)


def test_pulses_under_constant_load_have_their_closed_form() -> None:
    """tan(theta / 2) moves uniformly under constant load: the slip is closed-form up to the first echo."""
    problem = slip_law_slab(50.0, 1e-3, extra_load=3430.0, pull=0.0)
    body = problem.body
    assert isinstance(body, ss.ElasticSlab)
    exact = PulseTrain(body.impedance, problem.load, 1e8, 1.0, 0.5, 50.0, problem.initial_slip)
    times = np.linspace(0.0, body.two_way_time, 300)
    run = ss.simulate(problem, body.two_way_time, rtol=1e-13)
    assert run.slip(times) == pytest.approx(exact.slip(times), rel=0.0, abs=2e-10 * 0.376)
    assert run.slip_rate(times) == pytest.approx(exact.slip_rate(times), rel=0.0, abs=2e-9 * exact.peak_rate)
