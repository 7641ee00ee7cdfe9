"""The slow method against closed forms, and against numbers worked out outside the package (see the paper's constants)."""

import math
import sys

import numpy as np
import pytest
from scipy.optimize import brentq

import stickslip as ss
from stickslip.reference.block import CoulombBlock, LinearBlock
from stickslip.reference.slab import CoulombSlab, PulseTrain, StuckSlab
from tests.reference.method_of_steps import method_of_steps

V = 0.05 / 31_557_600.0
SLAB = ss.ElasticSlab(2800.0, 3500.0, 1e4, 1e8)
STRONG_BLOCK = ss.SpringBlock(2.8e12, 3.43e14, 1e14)
SOFT_BLOCK = ss.SpringBlock(2.8e12, 3.43e13, 1e14)
ROUND_TRIP = 2e4 / 3500.0


def peak(solution, guess, step=1e-3):
    """Time and height of the largest slip rate near a guess: the zero of a centred difference, extrapolated to step 0."""

    def crest(h):
        return brentq(
            lambda t: float(solution.slip_rate(t + h) - solution.slip_rate(t - h)), guess - 0.01, guess + 0.01, xtol=1e-12
        )

    when = (4 * crest(step) - crest(2 * step)) / 3
    return when, float(solution.slip_rate(when))


def stop_of(solution):
    """When the last sliding piece ends."""
    return [p.end for p in solution.pieces if p.rate(0.5 * (p.start + p.end)) != 0.0][-1]


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


def test_the_printed_slip_law_slab_has_its_verified_numbers():
    law = ss.friction.SinusoidalSlip(1.0, 0.5, 5.0)
    problem = ss.Problem(SLAB, law, pull_rate=V, initial_slip=math.pi / 10 + 1e-3, initial_load=1.5e8)
    found = method_of_steps(problem, 9.0)
    assert float(found.slip_rate(0.0)) == pytest.approx(6.377538e-5, rel=1e-6, abs=0)
    assert float(found.slip(ROUND_TRIP)) - problem.initial_slip == pytest.approx(5.734045e-4, rel=2e-7, abs=0)
    assert stop_of(found) == pytest.approx(7.584372, rel=0, abs=1e-6)
    assert float(found.slip(9.0)) - problem.initial_slip == pytest.approx(6.057137e-4, rel=2e-7, abs=0)


@pytest.mark.parametrize(
    ("pull", "peaks", "slip"),
    [
        (0.0, (0.153986, 2.256706, 4.359426), 0.3761052766),
        (V, (0.1539863, 2.2567043, 4.3594187), 0.376105283),  # 5 cm/yr hastens the pulses by microseconds: the excess is 3430 Pa
    ],
)
def test_the_reconstructed_slip_law_slab_has_its_verified_numbers(pull, peaks, slip):
    law = ss.friction.SinusoidalSlip(1.0, 0.5, 50.0)
    problem = ss.Problem(SLAB, law, pull_rate=pull, initial_slip=math.pi / 100 + 1e-3, initial_load=150_003_430.0)
    found = method_of_steps(problem, 8.0)
    for time in peaks:
        assert peak(found, time) == pytest.approx((time, 10.204432), rel=0, abs=1e-6)
    assert stop_of(found) == pytest.approx(ROUND_TRIP, rel=1e-12, abs=0)
    assert float(found.slip(8.0)) - problem.initial_slip == pytest.approx(slip, rel=0, abs=5e-10)
    if pull == 0.0:
        period = PulseTrain(9.8e6, problem.load, 1e8, 1.0, 0.5, 50.0).period
        assert peak(found, peaks[2])[0] - peak(found, peaks[1])[0] == pytest.approx(period, rel=1e-8, abs=0)


def test_the_slip_law_slab_with_one_pulse_has_its_verified_numbers():
    law = ss.friction.SinusoidalSlip(1.0, 0.5, 5.0)
    problem = ss.Problem(SLAB, law, pull_rate=V, initial_slip=math.pi / 10 + 1e-2, initial_load=1.5e8)
    found = method_of_steps(problem, 9.0)
    assert peak(found, 1.5677)[0] == pytest.approx(1.567673320, rel=0, abs=1e-6)
    assert float(found.slip(9.0)) - problem.initial_slip == pytest.approx(1.2428558, rel=0, abs=2e-7)


@pytest.mark.parametrize(
    ("alpha", "start", "end", "load", "slip"),
    [
        (1.0, 4.10204081633, None, -399_999.969, 23.4402332474),
        (0.196 + 1e-6, 2.60306876818e-5, 1.40832223e-4, 79_999_489.83, 5.65875644e-4),
    ],
)
def test_the_rate_law_slab_has_its_verified_numbers(alpha, start, end, load, slip):
    problem = ss.Problem(SLAB, ss.friction.HyperbolicRate(0.8, 0.3, alpha), pull_rate=V, initial_excess=0.0)
    found = method_of_steps(problem, 9.0)
    assert float(found.slip_rate(0.0)) == pytest.approx(start, rel=1e-8, abs=0)
    if end is not None:
        assert float(found.slip_rate(ROUND_TRIP - 1e-12)) == pytest.approx(end, rel=1e-7, abs=0)
    assert float(found.load(ROUND_TRIP + 1e-12)) == pytest.approx(load, rel=0, abs=6e-3)
    assert float(found.slip(9.0)) == pytest.approx(slip, rel=1e-8, abs=0)


def test_rate_law_walks_the_loop_of_figure_4():
    slab = ss.ElasticSlab(2800.0, 3500.0, 1e4, 1e8, driver_impedance=0.0)
    problem = ss.Problem(slab, ss.friction.HyperbolicRate(0.8, 0.3, 1.0), pull_rate=2.6, initial_load=6e7)
    found = method_of_steps(problem, ROUND_TRIP)
    assert [p.start for p in found.pieces[1:] if p.start != 0.5 * ROUND_TRIP] == pytest.approx([2.243, 5.213], rel=0, abs=6e-4)
    assert float(found.load(0.5 * ROUND_TRIP)) == pytest.approx(85.5e6, rel=0, abs=1e5)


@pytest.mark.parametrize(
    ("block", "law", "u0", "rate", "peak_time", "stop", "slip"),
    [
        (SOFT_BLOCK, ss.friction.SinusoidalSlip(1.0, 0.5, 5.0), 0.3416860906, 5.538637, 2.579243, 3.029102456, 2.721335481),
        (STRONG_BLOCK, ss.friction.SinusoidalSlip(1.0, 0.5, 50.0), 0.0341686091, 1.757632, 0.442580, 0.586014899, 0.273505101),
        (SOFT_BLOCK, ss.friction.HyperbolicRate(0.8, 0.3, 1.0), None, 3.511221, 1.839772, 2.226453818, 2.061159848),
    ],
)
def test_blocks_have_their_verified_numbers(block, law, u0, rate, peak_time, stop, slip):
    start, excess = 0.0, 0.0
    if u0 is not None:  # S mu'(u0) + K = 0, and D0 is 1e-3 m further than equilibrium asks
        start = math.acos(-block.stiffness / (block.normal_force * law.amplitude * law.wavenumber)) / law.wavenumber
        assert start == pytest.approx(u0, rel=0, abs=6e-11)
        excess = 1e-3 * block.stiffness
    problem = ss.Problem(block, law, pull_rate=V, initial_slip=start, initial_excess=excess)
    found = method_of_steps(problem, stop + 0.3)
    assert peak(found, peak_time) == pytest.approx((peak_time, rate), rel=0, abs=1e-6)
    assert stop_of(found) == pytest.approx(stop, rel=0, abs=1e-6)
    assert float(found.slip(stop + 0.3)) - start == pytest.approx(slip, rel=0, abs=1e-6)


def test_contact_mass_tends_to_perfect_delay():
    """The lighter the contact, the closer the slip after a round trip to that of the massless one."""
    law = ss.friction.HyperbolicRate(0.8, 0.3, 1.0)
    massless = method_of_steps(ss.Problem(SLAB, law, pull_rate=V, initial_excess=1e4), 5.0)
    miss = []
    for mass in (4e5, 1e5):
        slab = ss.ElasticSlab(2800.0, 3500.0, 1e4, 1e8, contact_mass=mass)
        found = method_of_steps(ss.Problem(slab, law, pull_rate=V, initial_excess=1e4), 5.0)
        force = found.load(3.0) - 9.8e6 * found.slip_rate(3.0) - 1e8 * law.coefficient(0.0, found.slip_rate(3.0))
        slope = (found.slip_rate(3.0 + 1e-4) - found.slip_rate(3.0 - 1e-4)) / 2e-4
        assert mass * float(slope) == pytest.approx(float(force), rel=1e-4, abs=1.0)
        miss.append(abs(float(found.slip(5.0) - massless.slip(5.0))))
    assert miss[1] < 0.4 * miss[0]


def test_backward_slip_mirrors_forward_slip():
    law = ss.friction.HyperbolicRate(0.8, 0.3, 1.0)
    forth = method_of_steps(ss.Problem(SLAB, law, initial_load=8.4e7), 9.0)
    back = method_of_steps(ss.Problem(SLAB, law, initial_load=-8.4e7), 9.0)
    t = np.linspace(0.0, 9.0, 31)
    np.testing.assert_allclose(back.slip(t), -forth.slip(t), rtol=1e-8, atol=1e-12)
    np.testing.assert_allclose(back.load(t), -forth.load(t), rtol=1e-8, atol=1e-2)


def test_other_selection_rules_are_refused():
    law = ss.friction.HyperbolicRate(0.8, 0.3, 1.0)
    with pytest.raises(ss.InputError, match="perfect-delay"):
        method_of_steps(ss.Problem(SLAB, law, initial_load=0.0, selection="maxwell"), 1.0)


def test_without_scipy_it_says_what_to_install(monkeypatch):
    monkeypatch.setitem(sys.modules, "scipy.integrate", None)
    with pytest.raises(ss.InputError, match="pip install scipy"):
        method_of_steps(ss.Problem(SLAB, ss.friction.Coulomb(0.8, 0.3), initial_load=0.0), 1.0)
