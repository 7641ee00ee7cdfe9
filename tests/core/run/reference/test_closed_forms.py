"""Each closed form is put back into the equation that it solves; none of it knows the engine."""

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import quad, solve_ivp

import stickslip as ss
from stickslip.run.reference.block import CoulombBlock, LinearBlock
from stickslip.run.reference.folds import HyperbolicFolds
from stickslip.run.reference.slab import CoulombSlab, PulseTrain, StuckSlab, growth_rate

mpmath = pytest.importorskip("mpmath")

SLAB = ss.ElasticSlab(2800.0, 3500.0, 1e4, normal_stress=1e8)
BLOCK = ss.SpringBlock(2.8e12, 3.43e13, normal_force=1e14)


def slope_of(function, t, step=1e-4):
    """Derivative by a fourth-order difference."""
    near, far = function(t + step) - function(t - step), function(t + 2 * step) - function(t - 2 * step)
    return (8 * near - far) / (12 * step)


@pytest.mark.parametrize("pull", [0.0, 1e-9, 0.5])
def test_coulomb_slab_satisfies_the_recursion(pull):
    slab = CoulombSlab(SLAB, 0.8, 0.3, pull)
    start = 0.8e8
    for t in (0.0, 1.3, 5.0):
        load = start + slab.loading_rate * t
        assert 9.8e6 * slab.slip_rate(t) + 0.3e8 == pytest.approx(load, rel=1e-14, abs=0)
    echo = start - 2 * 9.8e6 * slab.slip_rate(0.0) + 2 * 9.8e6 * pull
    assert slab.end_load == pytest.approx(float(echo), rel=1e-13, abs=0)
    assert abs(slab.end_load) < start
    assert slab.total_slip == pytest.approx(quad(slab.slip_rate, 0.0, slab.duration)[0], rel=1e-12, abs=0)
    if pull == 0.0:
        assert slab.total_slip == pytest.approx(2 * 0.5e8 * 1e4 / 3.43e10, rel=1e-14, abs=0)


@pytest.mark.parametrize("pull", [0.0, 1e-9, 0.5, 20.0])
def test_coulomb_block_satisfies_its_equation(pull):
    block = CoulombBlock(BLOCK, 0.8, 0.3, pull)
    for t in np.linspace(0.05, 0.95, 7) * block.duration:
        force = 0.5e14 + 3.43e13 * (pull * t - block.slip(t))
        assert 2.8e12 * slope_of(block.slip_rate, t) == pytest.approx(float(force), rel=1e-9, abs=1e-9 * 0.5e14)
        assert slope_of(block.slip, t) == pytest.approx(float(block.slip_rate(t)), rel=1e-9, abs=0)
    before = block.duration * (1 - 1e-9)
    assert float(block.slip_rate(before)) == pytest.approx(0.0, rel=0, abs=1e-7 * block.peak_rate)
    assert block.slip_rate(block.peak_time) == pytest.approx(block.peak_rate, rel=1e-14, abs=0)
    assert np.all(block.slip_rate(np.linspace(1e-3, 0.999, 500) * block.duration) > 0)


def test_coulomb_block_without_pull_swings_half_a_period():
    block = CoulombBlock(BLOCK, 0.8, 0.3)
    assert block.duration == pytest.approx(math.pi * math.sqrt(2.8e12 / 3.43e13), rel=1e-15, abs=0)
    assert block.total_slip == pytest.approx(1e14 / 3.43e13, rel=1e-15, abs=0)
    assert block.peak_rate == pytest.approx(0.5e14 / math.sqrt(3.43e13 * 2.8e12), rel=1e-15, abs=0)


@pytest.mark.parametrize("start", [0.0, 0.2, -5.0, 1.3, 40.0])
@pytest.mark.parametrize("load", [1.500001e8, 1.6e8, 9e8])
def test_pulse_train_satisfies_its_equation(load, start):
    train = PulseTrain(9.8e6, load, 1e8, 1.0, 0.5, 5.0, start)
    assert train.slip(0.0) == pytest.approx(start, rel=1e-12, abs=1e-10)
    for t in np.array([0.1, 0.37, 0.5, 0.93, 7.2]) * train.period:
        step = 1e-4 * train.period
        assert slope_of(train.slip, t, step) == pytest.approx(float(train.slip_rate(t)), rel=1e-5, abs=1e-9 * train.peak_rate)
    turn = 2 * math.pi / 5.0
    assert train.slip(3 * train.period) - train.slip(0.0) == pytest.approx(3 * turn, rel=1e-12, abs=0)
    assert np.all(np.diff(train.slip(np.linspace(-2, 3, 1001) * train.period)) > 0)


@pytest.mark.parametrize("load", [1.51e8, 3e8])
def test_pulse_period_agrees_with_quadrature(load):
    train = PulseTrain(9.8e6, load, 1e8, 1.0, 0.5, 5.0)
    period = quad(
        lambda u: 9.8e6 / (load - 1e8 * (1 + 0.5 * math.sin(5 * u))), 0, 2 * math.pi / 5, epsrel=1e-12, epsabs=0, limit=200
    )
    assert train.period == pytest.approx(period[0], rel=1e-10, abs=0)


def test_pulses_below_the_largest_strength_are_refused():
    with pytest.raises(ss.InputError, match="strength"):
        PulseTrain(9.8e6, 1.5e8, 1e8, 1.0, 0.5, 5.0)


def recursion(slab, t):
    """beta by the recursion itself, one round trip at a time."""
    h_c, reflection = 0.5 * slab.body.two_way_time, -1.0
    if math.isfinite(slab.body.driver_impedance):
        reflection = (slab.body.impedance - slab.body.driver_impedance) / (slab.body.impedance + slab.body.driver_impedance)
    if t < h_c:
        return slab.initial_load + slab.loading_rate * t
    back = t - slab.body.two_way_time
    outgoing = -recursion(slab, back) if back >= 0 else -slab.loading_rate * back - slab.initial_load
    if math.isinf(slab.body.driver_impedance):
        return -outgoing + 2 * slab.body.impedance * slab.pull_rate
    far = slab.body.driver_impedance * slab.pull_rate + slab.far_stress + slab.far_stress_rate * (t - h_c)
    return reflection * outgoing + 2 * slab.body.impedance / (slab.body.impedance + slab.body.driver_impedance) * far


@pytest.mark.parametrize("driver", [0.0, 1e6, 9.8e6, 3e7, 1e10, math.inf])
def test_stuck_slab_sums_the_recursion(driver):
    slab = StuckSlab(replace(SLAB, driver_impedance=driver), 6e7, 0.3, 5e7, 2e4)
    times = np.array([0.0, 1.0, 2.9, 4.0, 5.72, 6.5, 9.1, 11.5, 30.3, 100.4])
    wanted = [recursion(slab, t) for t in times.tolist()]
    np.testing.assert_allclose(slab.load(times), wanted, rtol=1e-10, atol=0)


def test_stuck_slab_under_its_own_far_stress_stays_where_it_is():
    for driver in (0.0, 9.8e6, 5e7):
        slab = StuckSlab(replace(SLAB, driver_impedance=driver), 6e7, 0.0, 6e7)
        np.testing.assert_allclose(slab.load(np.linspace(0, 60, 50)), 6e7, rtol=1e-13, atol=0)


@pytest.mark.parametrize("strength", [1.0000001, 1.001, 1.2, 7.3, 500.0])
def test_growth_rate_solves_its_equation(strength):
    weakening = strength * 3.43e10 / (1e8 * 1e4)
    rate = growth_rate(SLAB, weakening)
    with mpmath.workdps(40):
        target = mpmath.mpf(1e8) * mpmath.mpf(weakening) / mpmath.mpf(3.43e10) * 10**4
        exact = mpmath.findroot(lambda x: x * mpmath.coth(x) - target, max(float(mpmath.sqrt(3 * (target - 1))), strength - 1))
    assert rate * 1e4 / 3500.0 == pytest.approx(float(exact), rel=1e-8 if strength < 1.001 else 1e-12, abs=0)


def test_growth_rate_is_zero_up_to_the_threshold():
    for strength in (-2.0, 0.0, 0.999, 1.0):
        assert growth_rate(SLAB, strength * 3.43e10 / 1e12) == 0.0


@pytest.mark.parametrize("alpha", [0.197, 0.25, 1.0, 40.0, 1e6])
def test_hyperbolic_folds_solve_their_equations(alpha):
    folds = HyperbolicFolds(9.8e6, 1e8, 0.8, 0.3, alpha)
    with mpmath.workdps(40):
        a, drop, low = mpmath.mpf(alpha), mpmath.mpf(folds.drop), mpmath.mpf(0.3) * 10**8

        def resistance(v):
            return 9.8e6 * v + low + drop / (1 + a * v)

        v1 = mpmath.findroot(lambda v: mpmath.diff(resistance, v), folds.fold_rate)
        v_b = mpmath.findroot(lambda v: (resistance(v) - resistance(0)) / v, folds.jump_rate)
        v_m = mpmath.findroot(
            lambda v: (9.8e6 * v**2 / 2 + drop * mpmath.log(1 + a * v) / a - (resistance(v) - low) * v) / v**3, folds.maxwell_rate
        )
    for found, exact in [(folds.fold_rate, v1), (folds.jump_rate, v_b), (folds.maxwell_rate, v_m)]:
        assert found == pytest.approx(float(exact), rel=1e-12, abs=0)
    assert folds.fold_load == pytest.approx(float(resistance(v1)), rel=1e-13, abs=0)
    assert folds.maxwell_load == pytest.approx(float(resistance(v_m)), rel=1e-13, abs=0)


def test_hyperbolic_folds_have_the_numbers_of_the_paper():
    folds = HyperbolicFolds(9.8e6, 1e8, 0.8, 0.3, 1.0)
    assert folds.fold_load == pytest.approx(64_471_887.242, rel=0, abs=5e-4)
    assert folds.maxwell_load == pytest.approx(67_215_203.566, rel=0, abs=5e-4)
    assert folds.maxwell_rate == pytest.approx(2.20613081, rel=0, abs=5e-9)
    assert folds.jump_rate == pytest.approx(4.10204081633, rel=0, abs=5e-12)
    with pytest.raises(ss.InputError, match="regular"):
        HyperbolicFolds(9.8e6, 1e8, 0.8, 0.3, 0.19)


@pytest.mark.parametrize(("pull", "excess"), [(1e-9, 0.0), (0.0, 1e8), (0.2, 1e11), (6.0, 0.0)])
def test_linear_block_agrees_with_quadrature_of_its_equation(pull, excess):
    block = LinearBlock(BLOCK, 0.8, 0.3, 0.4, pull, excess)

    def motion(t, y):
        friction = 0.5e14 * min(y[0] / 0.4, 1.0)
        return [y[1], (excess + 3.43e13 * (pull * t - y[0]) + friction) / 2.8e12]

    early = solve_ivp(motion, (0.0, block.knot_time), [0.0, 0.0], method="DOP853", rtol=1e-12, atol=1e-24)
    assert early.y[0, -1] == pytest.approx(0.4, rel=1e-9, abs=0)
    late = solve_ivp(
        motion, (block.knot_time, block.duration), early.y[:, -1], method="DOP853", rtol=1e-12, atol=1e-14, dense_output=True
    )
    times = np.linspace(block.knot_time, block.duration, 9)[:-1]
    np.testing.assert_allclose(block.slip(times), late.sol(times)[0], rtol=1e-9, atol=0)
    np.testing.assert_allclose(block.slip_rate(times), late.sol(times)[1], rtol=1e-8, atol=1e-9)
    assert late.y[1, -1] == pytest.approx(0.0, rel=0, abs=1e-8)
    assert np.all(block.slip_rate(np.linspace(0.01, 0.999, 300) * block.duration) > 0)
    assert block.total_slip == pytest.approx(float(late.y[0, -1]), rel=1e-9, abs=0)


def test_linear_block_without_an_event_is_refused():
    with pytest.raises(ss.InputError, match="stiffness"):
        LinearBlock(BLOCK, 0.8, 0.3, 4.0, 1e-9)
    with pytest.raises(ss.InputError, match="excess"):
        LinearBlock(BLOCK, 0.8, 0.3, 0.4)
