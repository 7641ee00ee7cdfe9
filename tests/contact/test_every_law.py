"""What must hold of the contact equation under any law of the registry, at any slip and load, in both directions."""

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

import stickslip as ss
from stickslip.contact.critical import critical_normal_stress
from stickslip.contact.equation import resistance
from stickslip.contact.rules.selection import selection_table
from stickslip.friction import LAWS
from stickslip.problem.selection_rule import SELECTION_RULES
from tests.friction.drawn import laws

from .laws import S, Z, slab_problem

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


@settings(max_examples=60)
@given(law=KINDS, slip=st.floats(0.0, 3.0), share=st.floats(-1.5, 1.5))
def test_the_admissible_set_contains_every_root_of_a_dense_scan(law, slip, share):
    found = ss.uniqueness(problem_of(law, slip))
    strength = found.resistance.strength
    load = share * max(strength, 0.1 * S)
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


@settings(max_examples=60)
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


@settings(max_examples=40)
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


@settings(max_examples=60)
@given(law=st.sampled_from(["hyperbolic-rate", "exponential-stribeck", "power-stribeck"]).flatmap(laws))
def test_closed_forms_agree_with_the_critical_normal_stress(law):
    """At a critical value of its own number, the law's critical normal stress is the present one."""
    problem = problem_of(law)
    found = ss.uniqueness(problem)
    assume(found.critical_parameter not in (None, "normal_stress"))
    one = problem.parameters[found.critical_parameter]
    assume(1e-9 < found.critical_value < 1e9)
    critical = critical_normal_stress(resistance(one.put(found.critical_value)))
    assert critical == pytest.approx(S, rel=1e-11, abs=0)
