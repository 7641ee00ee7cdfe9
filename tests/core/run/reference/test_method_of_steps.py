"""The slow method against closed forms; the engine, which is compared with it everywhere, has the verified numbers."""

import math

import numpy as np
import pytest

import stickslip as ss
from stickslip.run.reference.block import CoulombBlock, LinearBlock
from stickslip.run.reference.slab import CoulombSlab, PulseTrain, StuckSlab
from tests.core.run.reference.method_of_steps import method_of_steps

SLAB = ss.ElasticSlab(2800.0, 3500.0, 1e4, 1e8)
SOFT_BLOCK = ss.SpringBlock(2.8e12, 3.43e13, 1e14)
ROUND_TRIP = 2e4 / 3500.0


def stop_of(solution):
    """When the last sliding piece ends."""
    return [p.end for p in solution.pieces if p.rate(0.5 * (p.start + p.end)) != 0.0][-1]


@pytest.mark.sampled(every=2)
@pytest.mark.parametrize("pull", [1e-9, 0.4])
def test_a_coulomb_slab_has_its_closed_form(pull):
    exact = CoulombSlab(SLAB, 0.8, 0.3, pull)
    found = method_of_steps(ss.Problem(SLAB, ss.friction.Coulomb(0.8, 0.3), pull_rate=pull, initial_excess=0.0), 9.0)
    t = np.array([0.0, 0.5, 3.0, 5.7, 5.8, 9.0])
    np.testing.assert_allclose(found.slip(t), exact.slip(t), rtol=1e-12, atol=0)
    np.testing.assert_allclose(found.slip_rate(t), exact.slip_rate(t), rtol=1e-12, atol=0)
    assert float(found.load(ROUND_TRIP + 1e-9)) == pytest.approx(exact.end_load, rel=1e-8, abs=0)


def test_a_coulomb_block_has_its_closed_form():
    exact = CoulombBlock(SOFT_BLOCK, 0.8, 0.3, 0.3)
    found = method_of_steps(ss.Problem(SOFT_BLOCK, ss.friction.Coulomb(0.8, 0.3), pull_rate=0.3, initial_excess=0.0), 1.2)
    t = np.linspace(0.0, 1.2, 13)
    np.testing.assert_allclose(found.slip(t), exact.slip(t), rtol=1e-9, atol=0)
    np.testing.assert_allclose(found.slip_rate(t), exact.slip_rate(t), rtol=1e-8, atol=1e-10)
    assert stop_of(found) == pytest.approx(exact.duration, rel=1e-9, abs=0)


def test_linear_slip_weakening_block_meets_its_knot():
    exact = LinearBlock(SOFT_BLOCK, 0.8, 0.3, 0.4, pull_rate=0.1)
    law = ss.friction.LinearSlipWeakening(0.8, 0.3, 0.4)
    found = method_of_steps(ss.Problem(SOFT_BLOCK, law, pull_rate=0.1, initial_excess=0.0), exact.duration)
    assert exact.knot_time == pytest.approx(found.pieces[0].end, rel=1e-9, abs=0)
    t = np.linspace(0.05, 1.0, 12) * exact.duration
    np.testing.assert_allclose(found.slip(t), exact.slip(t), rtol=1e-8, atol=0)


def test_pulses_under_constant_load_have_their_closed_form():
    """A matched half-space sends nothing back: the load is constant, and slip comes in pulses."""
    slab = ss.ElasticSlab(2800.0, 3500.0, 1e4, 1e8, driver_impedance=9.8e6)
    law = ss.friction.SinusoidalSlip(1.0, 0.5, 5.0)
    found = method_of_steps(ss.Problem(slab, law, initial_load=1.6e8, initial_slip=0.1), 5.0)
    exact = PulseTrain(9.8e6, 1.6e8, 1e8, 1.0, 0.5, 5.0, 0.1)
    t = np.linspace(0.0, 5.0, 21)
    np.testing.assert_allclose(found.slip(t), exact.slip(t), rtol=1e-8, atol=0)
    np.testing.assert_allclose(found.slip_rate(t), exact.slip_rate(t), rtol=1e-7, atol=0)


@pytest.mark.sampled(every=5)
@pytest.mark.parametrize("driver", [0.0, 3e6, 9.8e6, 1e8, math.inf])
def test_the_load_of_a_stuck_slab_has_its_closed_form(driver):
    slab = ss.ElasticSlab(2800.0, 3500.0, 1e4, 1e8, driver_impedance=driver)
    far = {} if math.isinf(driver) else {"far_stress": 5e7, "far_stress_rate": 1e4}
    problem = ss.Problem(slab, ss.friction.Coulomb(0.8, 0.3), pull_rate=0.01, initial_load=6e7, **far)
    found = method_of_steps(problem, 30.0)
    exact = StuckSlab(slab, 6e7, 0.01, *far.values())
    t = np.linspace(0.0, 29.9, 40)
    np.testing.assert_allclose(found.load(t), exact.load(t), rtol=1e-12, atol=0)
    assert np.all(found.slip_rate(t) == 0.0)
