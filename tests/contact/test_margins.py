"""Margins of contacts, one by one and in maps."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import stickslip as ss
from stickslip.contact.critical import margin
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


@pytest.mark.parametrize("depth", [1e-6, 1e-5, 0.0, 1e-4])
def test_a_dip_of_any_depth_is_found(depth):
    """The lowest g' lies in a dip of 1e-5 m/s."""
    law = ss.friction.FromExpression("0.6 - 0.01*v - depth*tanh((v - at)/width)", {"at": 3.00123, "width": 1e-5, "depth": depth})
    assert margin(problem_of(law)) == pytest.approx(1.0 - 1e8 * (0.01 + depth / 1e-5) / 9.8e6, rel=1e-9, abs=0.0)


def test_changes_of_sign_found_together_are_those_found_alone():
    cubes = [0.1, 2.0, -0.3, 0.77]
    brackets = [(-3.0, 5.0), (0.0, 2.0), (-1.0, 1.0), (0.0, 1.0)]

    def value(which, place):
        return place**3 - cubes[which] ** 3 if which != 3 else (1.0 if place > cubes[3] else -1.0)

    together = sign_changes(lambda wanted: [value(*one) for one in wanted], brackets)
    assert together == [sign_change(lambda x, k=k: value(k, x), *brackets[k]) for k in range(4)]
    assert together == pytest.approx(cubes, rel=4 * EPS)
