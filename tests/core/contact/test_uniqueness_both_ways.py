"""Uniqueness and steady sliding where friction differs with the direction of slip."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import stickslip as ss
from stickslip.contact import steady_slidings
from stickslip.friction import BothWays, Coulomb, HyperbolicRate, SelfEnergising

SLAB = ss.ElasticSlab(thickness="5 m", density=2700, wave_speed="1 km/s", normal_stress="5 MPa")
BLOCK = ss.SpringBlock(mass=1.0, stiffness=100.0, normal_force=10.0)
FALLS = HyperbolicRate(static=0.6, dynamic=0.4, alpha=8.0)
FLAT = HyperbolicRate(static=0.4, dynamic=0.35, alpha=3.0)
BOTH = ss.Problem(SLAB, BothWays(forward=FALLS, backward=FLAT), pull_rate=-0.1, initial_load=0.0)


def test_each_direction_has_the_answer_of_its_own_law() -> None:
    """Folds, strengths and admissible rates are those of the two laws alone, to their bits; backward ones with their sign."""
    both = ss.uniqueness(BOTH)
    ahead, behind = (ss.uniqueness(replace(BOTH, friction=law)) for law in (FALLS, FLAT))
    assert (both.regime, ahead.regime, behind.regime) == ("irregular", "irregular", "regular")
    assert ss.uniqueness(replace(BOTH, friction=BothWays(forward=FLAT, backward=FALLS))).regime == "irregular"
    turned = ss.uniqueness(replace(BOTH, friction=BothWays(forward=FLAT, backward=FALLS)))
    assert (turned.critical_parameter, turned.critical_value) == ("backward.alpha", ahead.critical_value)
    assert turned.folds == ()
    assert turned.backward is not None
    assert turned.backward.folds == ahead.folds != ()
    assert turned.fold_lines()[0][0] == "backward fold"
    assert ("backward fold", ahead.fold_lines()[0][1]) in turned._lines()
    assert both.folds == ahead.folds
    assert both.critical_parameter == "forward.alpha"
    assert both.critical_value == ahead.critical_value
    assert "Forward slip: HyperbolicRate: irregular" in both.summary
    assert "Backward slip: HyperbolicRate: regular" in both.summary
    for load in (2.9e6, 3.5e6):
        assert np.array_equal(both.admissible(load), ahead.admissible(load))
        assert np.array_equal(both.admissible(-load), behind.admissible(-load))
    assert both.admissible(-1.9e6).tolist() == [0.0]
    assert both.admissible(-2.1e6).max() < 0.0
    assert np.array_equal(both.g([-0.1, 0.2]), [behind.g(-0.1), ahead.g(0.2)])


@pytest.mark.parametrize("pull_rate", [0.1, -0.1])
def test_steady_sliding_is_that_of_the_law_in_the_direction_of_the_pull(pull_rate: float) -> None:
    law = FALLS if pull_rate > 0.0 else FLAT
    for body in (SLAB, BLOCK):
        found = steady_slidings(replace(BOTH, body=body, pull_rate=pull_rate))
        alone = steady_slidings(replace(BOTH, body=body, pull_rate=pull_rate, friction=law))
        assert found.slidings == alone.slidings
        assert found.changes == alone.changes
        assert found.slidings[0].traction == np.sign(pull_rate) * body.normal_load * float(law.coefficient(0.0, 0.1))


def test_an_irregular_contact_jumps_in_one_direction_only_and_its_mirror_image_in_the_other() -> None:
    """The mirrored run agrees to 1e-9 m/s; a rule decides only where slip goes the way of the law with folds."""
    times, jumps = np.linspace(0.0, 0.4, 801), []
    for law, way in ((BothWays(forward=FALLS, backward=FLAT), 1), (BothWays(forward=FLAT, backward=FALLS), -1)):
        pulled = ss.loading.Sinusoidal(mean=0.0, amplitude=2.0 * way, period=0.15)
        run = ss.simulate(ss.Problem(SLAB, law, pull_rate=pulled, initial_load=0.0), 0.4)
        assert run.proven.unproven == 0
        assert run.rule_influence.since is not None
        jumps.append((way * run.slip_rate(times), way * run.shocks.rate_after[run.shocks.cause == "fold"]))
    assert np.abs(jumps[0][0] - jumps[1][0]).max() < 1e-9
    assert len(jumps[0][1]) > 0
    assert jumps[0][0].min() < -0.1
    assert np.allclose(jumps[0][1], jumps[1][1], rtol=1e-9, atol=0.0)


def test_a_brake_that_would_jam_is_refused_and_the_answer_says_how_far_it_is() -> None:
    for gain, edge, way in ((2.5, "is 1.125, and from 1 on", "forwards"), (-2.5, "is -1.125, and from -1 down", "backwards")):
        with pytest.raises(ss.InputError, match=rf"{edge} the contact jams: no finite force slides it {way} \(self-locking\)"):
            SelfEnergising(law=Coulomb(static=0.45, dynamic=0.4), gain=gain)
    said = ss.uniqueness(
        ss.Problem(BLOCK, SelfEnergising(law=Coulomb(static=0.5, dynamic=0.4), gain=1.0), initial_load=0.0)
    ).summary
    assert "at gains of 2 and more the contact jams (self-locking): no finite force slides it; here gain = 1." in said
    behind = SelfEnergising(law=Coulomb(static=0.5, dynamic=0.4), gain=-1.0).said_of_uniqueness
    assert "at gains of -2 and less the contact jams (self-locking): no finite force slides it backwards; here gain = -1." in behind


def test_friction_that_presses_its_contact_makes_several_rates_of_one() -> None:
    """The fall of mu / (1 - k mu) is that of mu times 1 / (1 - k mu)^2: the critical stress is less by 0.36 at rest, to 1e-12."""
    plain = replace(BOTH, friction=FLAT, pull_rate=0.1)
    pressed = replace(plain, friction=SelfEnergising(law=FLAT, gain=1.0))
    alone, found = ss.uniqueness(plain), ss.uniqueness(pressed)
    assert found.critical_parameter == "normal_stress"
    steepest = 0.05 * 3.0  # at rest: (static - dynamic) alpha
    assert found.critical_value == pytest.approx(SLAB.impedance / steepest * 0.6**2, rel=1e-12, abs=0.0)
    assert alone.critical_value is not None


def test_what_is_not_followed_both_ways_is_refused_in_one_line() -> None:
    two = BothWays(forward=Coulomb(static=0.6, dynamic=0.5), backward=Coulomb(static=0.4, dynamic=0.3))
    stepped = ss.loading.PiecewiseLinear((0.0, 1.0), (10.0, 12.0))
    with pytest.raises(ss.InputError, match="normal_load varies, which is not followed under BothWays: leave it out"):
        ss.Problem(BLOCK, two, initial_load=0.0, normal_load=stepped)
    slips = ss.friction.LinearSlipWeakening(static=0.6, dynamic=0.5, distance=0.1)
    with pytest.raises(ss.InputError, match=r"BothWays depends on slip and slip rate: .* give the contact a mass"):
        ss.Problem(SLAB, BothWays(forward=slips, backward=Coulomb(static=0.4, dynamic=0.3)), initial_load=0.0)
    state = ss.friction.LuGre(static=0.6, dynamic=0.5, rate=0.1, stiffness=1e4)
    with pytest.raises(ss.InputError, match="forward must be a law that sticks and has no state of its own, lugre is none"):
        BothWays(forward=state, backward=state)
    with pytest.raises(ss.InputError, match="backward must be the same in both directions of slip, both-ways is not"):
        BothWays(forward=slips, backward=two)


def test_steady_sliding_says_the_direction_it_is_for() -> None:
    """Backwards Coulomb friction never makes a loop unstable; forwards the law falls, and sliding is unstable below some rate."""
    loop = ss.PositionLoop(mass=1.0, proportional_gain=100.0, normal_force=10.0, integral_gain=50.0, derivative_gain=10.0)
    falls = ss.friction.ExponentialStribeck(static=0.4, dynamic=0.2, rate="10 mm/s")
    law = BothWays(forward=falls, backward=Coulomb(static=0.3, dynamic=0.3))
    behind = ss.Problem(loop, law, pull_rate="-5 mm/s", initial_load=0.0)
    assert "stable at any other slip rate backwards, too (proven)" in steady_slidings(behind).lines()
    assert any(line.startswith("forwards: unstable below") for line in steady_slidings(replace(behind, pull_rate=0.005)).lines())
    alone = steady_slidings(replace(behind, friction=law.backward))
    assert "stable at any other slip rate, too (proven)" in alone.lines()


def test_a_loop_that_gathers_the_lag_of_a_rest_is_not_said_to_have_no_event() -> None:
    """An exact run rests again after it has slipped; without the integral it slides on."""
    law = Coulomb(static=0.3, dynamic=0.3)
    for gain, comes in ((500.0, True), (0.0, False)):
        loop = ss.PositionLoop(mass=1.0, proportional_gain=100.0, normal_force=10.0, integral_gain=gain, derivative_gain=10.0)
        problem = ss.Problem(loop, law, pull_rate="5 mm/s", initial_load=0.0)
        assert ss.simulate(problem, 20.0).events.end.notna().any() == comes
        assert any("no event will come" in line for line in steady_slidings(problem).lines()) is not comes
