"""Regimes, folds, jumps and admissible rates; backward symmetry; what the text says."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import stickslip as ss
from stickslip.contact.branches import branches
from stickslip.contact.regime_map import regime_map
from stickslip.contact.uniqueness import uniqueness_of
from stickslip.foundation.axis import Axis
from stickslip.problem.selection_rule import SELECTION_RULES
from tests.limits import examples

from .laws import S, Wavy, Z, hyperbolic, slab_problem


def test_the_fold_and_the_window_of_loads_have_their_closed_form():
    found = uniqueness_of(slab_problem(hyperbolic(1.0)))
    (fold,) = found.folds
    assert fold.load == pytest.approx(64_471_887.242, rel=0, abs=5e-4)
    assert found.window == pytest.approx((fold.load - 0.8 * S, 0.0), rel=1e-12, abs=0)


@pytest.mark.parametrize(
    ("rule", "up", "down"),
    [
        ("perfect-delay", (0.0, 4.10204081633, 8e7), (1.25876975726, 0.0, 64_471_887.242)),
        ("maxwell", (0.0, 2.20613081, 67_215_203.566), (2.20613081, 0.0, 67_215_203.566)),
        ("minimal", (0.0, 4.10204081633, 8e7), (4.10204081633, 0.0, 8e7)),
        ("maximal", (0.0, 1.25876975726, 64_471_887.242), (1.25876975726, 0.0, 64_471_887.242)),
    ],
)
def test_each_rule_jumps_where_the_closed_form_says(rule, up, down):
    found = uniqueness_of(slab_problem(hyperbolic(1.0), rule))
    assert [jump.direction for jump in found.jumps] == ["up", "down"]
    for jump, wanted in zip(found.jumps, (up, down), strict=True):
        assert (jump.rate_before, jump.rate_after) == pytest.approx(wanted[:2], rel=5e-9, abs=0)
        assert jump.load == pytest.approx(wanted[2], rel=1e-11, abs=0)
    assert f"'{rule}' jumps up" in found.summary


def test_there_are_two_admissible_rates_at_the_folds():
    found = uniqueness_of(slab_problem(hyperbolic(1.0)))
    assert found.admissible(found.folds[0].load)[0] == 0.0
    at_rest = found.admissible(0.8 * S)  # the upper end of the window: stick and the fast branch
    assert at_rest == pytest.approx([0.0, 4.10204081633], rel=1e-11, abs=0)
    (slow, fast) = uniqueness_of(slab_problem(Wavy(0.5, 0.0, 1.0, 1.0, step=0.1))).admissible(0.55 * S)
    assert slow == 0.0
    assert fast == pytest.approx(0.05 * S / Z, rel=1e-13, abs=0)


@settings(max_examples=examples(25))
@given(load=st.floats(-2e8, 2e8), alpha=st.floats(0.01, 1e5), slip=st.floats(-3.0, 3.0))
def test_backward_slip_mirrors_forward_slip(load, alpha, slip):
    for law in (hyperbolic(alpha), ss.friction.SinusoidalSlip(0.6, 0.2, 5.0), ss.friction.Coulomb(0.6, 0.2)):
        found = uniqueness_of(slab_problem(law), slip)
        assert found.admissible(-load).tolist() == (-found.admissible(load)[::-1]).tolist()
        assert found.stability(-load).tolist() == found.stability(load)[::-1].tolist()
        assert np.all(np.diff(found.admissible(load)) > 0)


@settings(max_examples=examples(25))
@given(load=st.floats(0.0, 2e8), alpha=st.floats(0.01, 1e5))
def test_admissible_rates_solve_the_quadratic(load, alpha):
    """alpha Z v^2 + (Z + alpha (S muD - load)) v + S muS - load = 0, with stick below the static strength."""
    roots = np.roots([alpha * Z, Z + alpha * (0.3 * S - load), 0.8 * S - load])
    wanted = sorted({0.0} if load <= 0.8 * S else set())
    wanted += sorted(float(r.real) for r in roots if abs(r.imag) < 1e-9 * abs(r) and r.real > 1e-7)
    found = [rate for rate in uniqueness_of(slab_problem(hyperbolic(alpha))).admissible(load).tolist() if not 0 < rate <= 1e-7]
    assert found == pytest.approx(wanted, rel=1e-5, abs=0)


@pytest.mark.parametrize("rule", SELECTION_RULES)
def test_the_summary_says_why_the_rule_has_no_effect(rule):
    block = ss.Problem(ss.SpringBlock(2.8e12, 3.43e13, 1e14), hyperbolic(1.0), initial_excess=0.0, selection=rule)
    cases = {
        "The block has inertia": uniqueness_of(block),
        "The contact mass has inertia": uniqueness_of(slab_problem(hyperbolic(1.0), rule, contact_mass=10.0)),
        "friction does not depend on the slip rate": uniqueness_of(slab_problem(ss.friction.SinusoidalSlip(1.0, 0.5, 5.0), rule)),
        "rises with the slip rate everywhere": uniqueness_of(slab_problem(hyperbolic(0.1), rule)),
    }
    for words, found in cases.items():
        assert words in found.summary
        assert f"({rule}) has no effect" in found.summary
        assert (found.regime, found.jumps, found.folds, found.window) == ("regular", (), (), None)


NEEDS_A_CONTACT_EQUATION = {
    "admissible": (lambda problem: uniqueness_of(problem).admissible(7e7), "inertia or a state"),
    "branches": (branches, "block|contact mass"),
    "critical value": (lambda problem: ss.studies.critical_value(problem, "alpha"), "block|contact mass"),
    "map": (lambda problem: regime_map(problem, Axis("alpha", 0.1, 1.0, 2), Axis("static", 0.1, 1.0, 2)), "block|contact mass"),
}


@pytest.mark.parametrize("name", NEEDS_A_CONTACT_EQUATION)
def test_where_inertia_decides_the_slip_rate_there_is_no_contact_equation(name):
    ask, message = NEEDS_A_CONTACT_EQUATION[name]
    block = ss.Problem(ss.SpringBlock(2.8e12, 3.43e13, 1e14), hyperbolic(1.0), initial_excess=0.0)
    for problem in (block, slab_problem(hyperbolic(1.0), contact_mass=10.0)):
        if name == "branches" and problem is not block:
            continue  # those of the contact without its mass
        with pytest.raises(ss.InputError, match=message):
            ask(problem)
