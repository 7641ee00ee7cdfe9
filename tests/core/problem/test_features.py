"""A feature is recognised where a problem has it, and a problem is refused for it in one sentence."""

from __future__ import annotations

from dataclasses import replace

import pytest

import stickslip as ss
from stickslip.problem import driver_of, features

SLAB = ss.ElasticSlab(2800.0, 3500.0, 1e3, 1e8)
STILL = ss.Problem(SLAB, ss.friction.LinearSlipWeakening(0.6, 0.5, 0.1), pull_rate=0.03, initial_load=5e7)
WITH = {
    features.DRIVEN_BY_MACHINE: replace(STILL, body=replace(SLAB, driver_impedance=5e6, driver_inertia=1e6)),
    features.DRIVER_THAT_CHANGES: replace(STILL, far_stress=0.0, driver_reflection=ss.loading.Steps([0.0, 1.0], [-1.0, 1.0])),
    features.NORMAL_LOAD_THAT_VARIES: replace(STILL, normal_load=ss.loading.Steps([0.0, 1.0], [1e8, 9e7])),
    features.MOVING_GROUND: replace(STILL, ground_velocity=ss.loading.Sinusoidal(mean=0.0, amplitude=0.1, period=1.0)),
    features.ONE_WAY: replace(STILL, one_way=True),
}


@pytest.mark.parametrize("feature", WITH, ids=lambda one: one.attribute)
def test_a_problem_with_one_feature_is_refused_for_it_alone(feature: features.Feature) -> None:
    assert not feature.is_in(STILL)
    assert [other for other in WITH if other.is_in(WITH[feature])] == [feature]
    features.refuse("here", STILL, dict.fromkeys(WITH, "is not followed"))
    with pytest.raises(ss.InputError) as refused:
        features.refuse("here", WITH[feature], dict.fromkeys(WITH, "is not followed"))
    assert str(refused.value) == f"here: {feature.words} is not followed: {feature.cure}"


def test_only_a_driver_that_is_rigid_throughout_feels_no_far_stress() -> None:
    unchanged = replace(STILL, far_stress=1.0, driver_reflection=ss.loading.Steps([0.0, 1.0], [-1.0, -1.0]))
    assert "far_stress" in driver_of(STILL).unfelt
    assert "far_stress" in driver_of(unchanged).unfelt
    assert driver_of(WITH[features.DRIVER_THAT_CHANGES]).unfelt == driver_of(WITH[features.DRIVEN_BY_MACHINE]).unfelt == ()
