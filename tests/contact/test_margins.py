"""The margins of many contacts at once against those of one contact after another."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import stickslip as ss
from stickslip.contact.branches import search_grid
from stickslip.contact.critical import margin
from stickslip.contact.equation import resistance
from stickslip.contact.margins import margins
from stickslip.contact.regime_map import Axis, put_both, regime_map
from stickslip.contact.roots import sign_change, sign_changes
from stickslip.friction import LAWS
from tests.friction.drawn import laws

from .laws import SLAB

EPS = np.finfo(float).eps
KINDS = st.sampled_from(sorted(kind for kind, law in LAWS.items() if law.state is None)).flatmap(laws)
"""With a state of its own the slip rate does not follow from the load alone."""


def problem_of(law, stress=1e8, slip=0.0):
    return ss.Problem(replace(SLAB, normal_stress=stress), law, initial_slip=slip, initial_excess=0.0)


def assert_same(found, problems):
    """To the rounding of g' = Z + S dmu/dv, in units of Z."""
    alone = np.array([margin(problem) for problem in problems])
    assert found == pytest.approx(alone, rel=16 * EPS, abs=16 * EPS)


@settings(max_examples=40, deadline=None)
@given(drawn=st.lists(st.tuples(KINDS, st.floats(1e6, 1e9), st.floats(0.0, 3.0)), min_size=1, max_size=6))
def test_contacts_of_all_laws_have_the_margins_that_they_have_alone(drawn):
    problems = [problem_of(*one) for one in drawn]
    assert_same(margins(problems), problems)


@settings(max_examples=25, deadline=None)
@given(law=KINDS, data=st.data())
def test_a_map_over_any_two_numbers_has_the_margins_of_its_points(law, data):
    problem = problem_of(law)
    numbers = [one for one in problem.parameters.values() if not one.declared.whole and 1e-300 < one.value < np.inf]
    one, other = data.draw(st.lists(st.sampled_from(numbers), min_size=2, max_size=2, unique_by=lambda found: found.name))
    axes = [Axis(axis.name, 0.7 * axis.value, 1.4 * axis.value, 3) for axis in (one, other)]
    found = regime_map(problem, *axes)
    for row, y in enumerate(axes[1].values.tolist()):
        for column, x in enumerate(axes[0].values.tolist()):
            known = found.margin[row, column]
            if not np.isnan(known):
                point = put_both((one, other), (x, y))
                assert known == pytest.approx(margin(point), rel=16 * EPS, abs=16 * EPS)


def test_a_dip_that_the_grid_misses_is_found_among_other_contacts():
    """The lowest g' lies in a dip of 1e-5 m/s between two points of the search grid."""
    formula, numbers = "0.6 - 0.01*v - depth*tanh((v - at)/width)", {"at": 3.00123, "width": 1e-5}
    problems = [problem_of(ss.friction.FromExpression(formula, numbers | {"depth": depth})) for depth in (1e-6, 1e-5, 0.0, 1e-4)]
    on_grid = [float(g.slope(search_grid(g)).min() / g.impedance) for g in map(resistance, problems)]
    found = margins(problems)
    assert_same(found, problems)
    assert found == pytest.approx([1.0 - 1e8 * (0.01 + depth / 1e-5) / 9.8e6 for depth in (1e-6, 1e-5, 0.0, 1e-4)], rel=1e-9)
    assert on_grid[0] > found[0] + 0.5


def test_changes_of_sign_found_together_are_those_found_alone():
    cubes = [0.1, 2.0, -0.3, 0.77]
    brackets = [(-3.0, 5.0), (0.0, 2.0), (-1.0, 1.0), (0.0, 1.0)]

    def value(which, place):
        return place**3 - cubes[which] ** 3 if which != 3 else (1.0 if place > cubes[3] else -1.0)

    together = sign_changes(lambda wanted: [value(*one) for one in wanted], brackets)
    assert together == [sign_change(lambda x, k=k: value(k, x), *brackets[k]) for k in range(4)]
    assert together == pytest.approx(cubes, rel=4 * EPS)
