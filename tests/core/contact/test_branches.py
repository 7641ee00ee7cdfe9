"""Branches, folds and roots against closed forms, mpmath and a dense scan."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

import stickslip as ss
from stickslip.contact.branches import branches, branches_of, rate_on, rates_at, resistance
from stickslip.contact.rules.selection import selection_table
from stickslip.friction import LAWS
from stickslip.problem.selection_rule import SELECTION_RULES
from tests.core.friction.drawn import laws
from tests.limits import examples

from .laws import ALPHA_C, SLAB, S, Wavy, Z, hyperbolic, q_of, slab_problem, wavy_laws

SCAN = np.concatenate(([0.0], np.geomspace(1e-6, 2e2, 40_001)))
KINDS = st.sampled_from(sorted(kind for kind, law in LAWS.items() if law.state is None)).flatmap(laws)
"""With a state of its own the slip rate does not follow from the load alone."""


def problem_of(law, slip=0.0, rule="perfect-delay"):
    return ss.Problem(slab_problem(law).body, law, initial_slip=slip, initial_excess=0.0, selection=rule)


def scanned(found, load):
    """Brackets of slip rates above 0 in which g - |load| changes sign, and whether it rises there."""
    level = found.g(SCAN) - abs(load)
    crossed = np.flatnonzero((level[1:] > 0.0) != (level[:-1] > 0.0))
    return SCAN[crossed], SCAN[crossed + 1], level[crossed + 1] > 0.0


@settings(max_examples=examples(80))
@given(law=st.one_of(KINDS, KINDS, wavy_laws), slip=st.floats(0.0, 3.0), share=st.floats(-1.5, 1.5))
def test_the_admissible_set_contains_every_root_of_a_dense_scan(law, slip, share):
    found = ss.uniqueness(problem_of(law, slip))
    strength = found.resistance.strength
    load = (share if law.ways[0] is law.ways[1] else abs(share)) * max(strength, 0.1 * S)  # `resistance` is that forward
    edges = [*(fold.load for fold in found.folds), strength, strength + found.resistance.start]
    assume(all(abs(abs(load) - edge) > 1e-6 * S for edge in edges))
    rates, stable = found.admissible(load), found.stability(load)
    moving = rates != 0.0
    assert (0.0 in rates) == (abs(load) <= strength)
    assert np.all(np.sign(rates[moving]) == np.sign(load))
    assert found.g(rates[moving]) == pytest.approx(np.full(moving.sum(), load), rel=1e-12, abs=1e-6)
    seen = np.abs(rates[moving])[:: int(np.sign(load)) or 1]
    kinds = stable[moving][:: int(np.sign(load)) or 1]
    within = seen > SCAN[1]
    low, high, rises = scanned(found, load)
    inside = low >= SCAN[1]
    assert np.count_nonzero(within) == np.count_nonzero(inside)
    assert np.all((low[inside] * (1 - 1e-9) <= seen[within]) & (seen[within] <= high[inside] * (1 + 1e-9)))
    assert kinds[within].tolist() == rises[inside].tolist()


@settings(max_examples=examples(30))
@given(law=KINDS, slip=st.floats(0.0, 3.0), rule=st.sampled_from(SELECTION_RULES))
def test_jumps_land_on_stable_admissible_rates(law, slip, rule):
    problem = problem_of(law, slip, rule)
    found = ss.uniqueness(problem)
    g = found.resistance
    for jump in found.jumps:
        for rate in (jump.rate_before, jump.rate_after):
            if rate > 0.0:
                assert float(found.g(rate)) == pytest.approx(jump.load, rel=1e-9, abs=1e-3)
        landed = jump.rate_after
        if landed == 0.0:
            assert jump.load <= g.strength * (1 + 1e-15)
        else:
            assert any(b.rate_from <= landed <= b.rate_to for b in found.branches)
        assert jump.traction_after - jump.traction_before == pytest.approx(-Z * (landed - jump.rate_before), rel=1e-9, abs=1e-6)
    assert bool(found.jumps) <= (found.regime != "regular")


@settings(max_examples=examples(20))
@given(law=KINDS, slip=st.floats(0.0, 3.0))
def test_every_rule_can_be_followed_and_only_delay_has_a_loop(law, slip):
    areas = {}
    for rule in SELECTION_RULES:
        problem = problem_of(law, slip, rule)
        selection_table(problem)  # raises where it cannot be followed
        areas[rule] = ss.uniqueness(problem).loop_area
    found = ss.uniqueness(problem_of(law, slip))
    size = S * (found.jumps[0].rate_after + 1.0 if found.jumps else 1.0)
    assert all(abs(areas[rule]) <= 1e-9 * size for rule in SELECTION_RULES[1:])
    assert areas["perfect-delay"] >= -1e-9 * size
    assert (areas["perfect-delay"] > 1e-9 * size) <= (found.regime != "regular")


EVERY_ALPHA = [0.2, 37.0, 1e9]


@pytest.mark.parametrize("alpha", EVERY_ALPHA)
def test_folds_of_the_hyperbolic_law_have_their_closed_form(alpha):
    q = q_of(alpha)
    (branch,) = branches(slab_problem(hyperbolic(alpha)))
    assert branch.rate_from == pytest.approx((q - 1) / alpha, rel=1e-13, abs=0)
    assert branch.excess_from == pytest.approx(Z / alpha * (2 * q - 1) - 0.5 * S, rel=1e-12, abs=0)
    assert (branch.rate_to, branch.excess_to) == (math.inf, math.inf)


def test_the_fold_just_above_the_critical_value_agrees_with_40_digits():
    mpmath = pytest.importorskip("mpmath")
    law = hyperbolic(ALPHA_C + 1e-6)
    with mpmath.workdps(40):
        fall, alpha = S * (mpmath.mpf(law.static) - mpmath.mpf(law.dynamic)), mpmath.mpf(law.alpha)
        q = mpmath.sqrt(alpha * fall / Z)
        rate, excess = float((q - 1) / alpha), float(Z / alpha * (2 * q - 1) - fall)
    (branch,) = branches(slab_problem(law))
    # muS - muD is off by half an ulp of 0.8, which the 5e-6 between alpha and alpha_c magnifies to 1e-11
    assert branch.rate_from == pytest.approx(rate, rel=1e-10, abs=0)
    assert branch.excess_from == pytest.approx(excess, rel=2e-10, abs=0)
    assert branch.rate_from == pytest.approx(1.3015327e-5, rel=1e-7, abs=0)


@pytest.mark.parametrize("alpha", [0.0, 1e-6, 0.1, ALPHA_C])
def test_up_to_the_critical_value_there_is_one_branch_from_rest(alpha):
    (branch,) = branches(slab_problem(hyperbolic(alpha)))
    assert (branch.rate_from, branch.excess_from, branch.rate_to) == (0.0, 0.0, math.inf)


@pytest.mark.parametrize("alpha", EVERY_ALPHA)
def test_the_upward_jump_of_the_hyperbolic_law_has_its_closed_form(alpha):
    problem = slab_problem(hyperbolic(alpha))
    (branch,) = branches(problem)
    assert rate_on(resistance(problem), branch, 0.0) == pytest.approx((q_of(alpha) ** 2 - 1) / alpha, rel=1e-13, abs=0)


@pytest.mark.parametrize(
    ("law", "start"),
    [
        (ss.friction.Coulomb(0.8, 0.3), -0.5 * S),
        (ss.friction.Coulomb(0.4, 0.4), 0.0),
        (ss.friction.SinusoidalSlip(1.0, 0.5, 5.0), 0.0),
        (ss.friction.LinearSlipWeakening(0.8, 0.3, 0.1), 0.0),
        (ss.friction.HyperbolicRate(0.3, 0.8, 2.0), 0.0),
    ],
)
def test_laws_that_do_not_weaken_with_rate_have_one_branch_from_rest(law, start):
    (branch,) = branches(slab_problem(law))
    assert (branch.rate_from, branch.rate_to, branch.excess_to) == (0.0, math.inf, math.inf)
    assert branch.excess_from == pytest.approx(start, rel=1e-15, abs=0)


def test_a_branch_has_no_rate_below_its_loads():
    problem = slab_problem(hyperbolic(1.0))
    (branch,) = branches(problem)
    with pytest.raises(ValueError, match="no slip rate"):
        rate_on(resistance(problem), branch, branch.excess_from - 1.0)


@dataclass(frozen=True)
class Endless(ss.friction.FrictionLaw):
    """A law that hides its slip-rate scale and is wrong about its range: nothing tells the search how far to go."""

    kind = "endless-test"
    source = "made up"

    @staticmethod
    def formula(law, u, v):
        return 0.5 / (1.0 + 1e-12 * v)

    def range(self):
        return 0.5, 0.5


def test_friction_that_never_stops_falling_is_refused():
    problem = ss.Problem(ss.ElasticSlab(1e-25, 1e-25, 1.0, 1e8), Endless(), pull_rate=1e-9, initial_excess=0.0)
    with pytest.raises(ss.InputError, match=r"Endless: friction still falls at least as fast as Z v rises at 1e\+30 m/s"):
        branches(problem)


def test_friction_without_a_scale_is_searched_at_one_metre_per_second():
    g = resistance(ss.Problem(SLAB, ss.friction.Coulomb(0.5, 0.5), initial_load=0.0))
    assert g.scales == (1.0,)


def test_the_step_from_static_to_sliding_friction_holds_no_unstable_rate():
    law = Wavy(mean=0.7, amplitude=0.25, beat=2.0, fade=5.0, turn=1.3, step=0.05)
    g = resistance(slab_problem(law), 1.0)
    stable = branches_of(g)
    assert stable[0].rate_from > 0.0
    below, kinds = rates_at(g, stable, 1.01 * g.start)  # g falls from `start`: once through it on the way down, once on the way up
    inside, _ = rates_at(g, stable, 0.5 * g.start)
    assert kinds.tolist()[:3] == [True, False, True]
    assert below.size == inside.size + 1
