"""The loop that a rule walks: its area against the closed form of law (15), against scipy, and against an actual run."""

import math

import numpy as np
import pytest

import stickslip as ss
from stickslip.contact.branches import rate_on
from stickslip.problem.selection_rule import SELECTION_RULES

from .laws import SLAB, S, Wavy, Z, hyperbolic, q_of, slab_problem

MEMORYLESS = SELECTION_RULES[1:]


def potential(rate, alpha):
    """Integral of g from 0 to a slip rate under law (15)."""
    return 0.5 * Z * rate**2 + 0.3 * S * rate + 0.5 * S / alpha * math.log1p(alpha * rate)


@pytest.mark.parametrize("alpha", [0.3, 1.0, 100.0, 1e6])
def test_the_loop_of_the_hyperbolic_law_has_the_area_of_the_closed_form(alpha):
    """Perfect delay jumps at muS S from 0 to vB and at the lower fold from v1 to 0."""
    q = q_of(alpha)
    v_b, v_1 = (q**2 - 1) / alpha, (q - 1) / alpha
    fold = 0.3 * S + Z / alpha * (2 * q - 1)
    exact = (0.8 * S * v_b - potential(v_b, alpha)) + (potential(v_1, alpha) - fold * v_1)
    loop = ss.uniqueness(slab_problem(hyperbolic(alpha))).loop
    assert loop.area == pytest.approx(exact, rel=1e-10, abs=0)
    assert loop.branches == (-1, 0, -1)
    assert [jump.direction for jump in loop.jumps] == ["up", "down"]
    assert loop.area > 0.0


@pytest.mark.parametrize("alpha", [0.3, 1.0, 100.0])
def test_the_area_is_the_integral_of_the_rate_difference_over_the_load(alpha):
    """Integral over the load of the slip rate on the way down minus that on the way up, by scipy."""
    integrate = pytest.importorskip("scipy.integrate")
    found = ss.uniqueness(slab_problem(hyperbolic(alpha)))
    (branch,) = found.branches
    area, error = integrate.quad(lambda excess: rate_on(found.resistance, branch, excess), branch.excess_from, 0.0, epsrel=1e-11)
    assert found.loop_area == pytest.approx(area, rel=1e-9, abs=error)


@pytest.mark.parametrize("rule", MEMORYLESS)
def test_a_rule_without_memory_retraces_its_way(rule):
    for law in (hyperbolic(1.0), Wavy(mean=0.7, amplitude=0.25, beat=2.0, fade=5.0, turn=1.3)):
        found = ss.uniqueness(slab_problem(law, rule))
        assert found.jumps
        assert found.loop_area == 0.0
        assert found.loop.branches == found.loop.branches[::-1]


def test_a_loop_over_several_branches_has_the_area_between_its_jumps():
    integrate = pytest.importorskip("scipy.integrate")
    found = ss.uniqueness(slab_problem(Wavy(mean=0.7, amplitude=0.25, beat=2.0, fade=5.0, turn=1.3)), 1.0)
    assert len(found.branches) >= 3
    g, total = found.resistance, 0.0
    for jump in found.loop.jumps:
        rest = integrate.quad(lambda v, load=jump.load: load - float(found.g(v)), jump.rate_before, jump.rate_after, limit=200)[0]
        assert rest > 0.0  # each jump goes where the load exceeds the resistance, or back where it falls short of it
        total += rest
    assert found.loop_area == pytest.approx(total, rel=1e-7, abs=0)
    assert {jump.load for jump in found.loop.jumps} <= {jump.load for jump in found.jumps}
    assert g.strength > 0.0


def test_a_unique_rate_has_no_loop():
    found = ss.uniqueness(slab_problem(hyperbolic(0.1)))
    assert (found.loop_area, found.loop.jumps, found.loop.branches) == (0.0, (), (-1, 0, -1))
    block = ss.Problem(ss.SpringBlock(2.8e12, 3.43e13, 1e14), hyperbolic(1.0), initial_excess=0.0)
    assert (ss.uniqueness(block).loop, ss.uniqueness(block).loop_area) == (None, 0.0)


def test_a_run_encloses_the_area_of_the_loop():
    solution = ss.simulate("fig4-loop")
    (time, rate), (_, load) = solution.curve("slip_rate", points=20_001), solution.curve("load", points=20_001)
    area = float(np.sum(0.5 * (load[1:] + load[:-1]) * np.diff(rate)))
    assert time[-1] > 5.3
    assert area == pytest.approx(ss.uniqueness(solution.problem).loop_area, rel=1e-6, abs=0)


def test_jumps_have_the_tractions_of_the_law():
    up, down = ss.uniqueness(slab_problem(hyperbolic(1.0))).jumps
    assert (up.traction_before, up.traction_after) == pytest.approx((8e7, 39_800_000.0), rel=1e-14, abs=0)
    assert down.traction_after == down.load == pytest.approx(64_471_887.242, rel=0, abs=5e-4)
    assert down.traction_before == pytest.approx(S * (0.3 + 0.5 / (1 + down.rate_before)), rel=1e-14, abs=0)
    assert SLAB.impedance == Z
