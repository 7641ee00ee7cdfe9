"""The record of an accelerometer in the explorer: its scale and interval are offered, and its samples are kept."""

from __future__ import annotations

import numpy as np

import stickslip as ss
from stickslip.extensions.explorer.model.controls import controls_of
from stickslip.extensions.explorer.model.setting import Setting, parameters_of, setting_of
from stickslip.problem.scenarios.scenario import Scenario


def setting_on_a_record() -> tuple[ss.Problem, Setting]:
    record = ss.loading.Accelerogram(np.sin(0.1 * np.arange(500)), 0.01, origin="made here")
    block = ss.SpringBlock(mass=1.0, stiffness=1e-3, normal_force=9.80665)
    law = ss.friction.Coulomb(static=0.05, dynamic=0.05)
    problem = ss.Problem(block, law, initial_load=0.0, ground_acceleration=record, one_way=True)
    return problem, Setting.of(Scenario(problem, 5.0))


def test_scale_polarity_and_interval_are_offered_and_no_sample_is() -> None:
    _, setting = setting_on_a_record()
    ground = "loading.ground_acceleration."
    offered = [one.path.removeprefix(ground) for group in controls_of(setting) for one in group.controls if ground in one.path]
    assert set(offered) == {"interval", "scale", "polarity", "offset", "origin"}


def test_the_samples_come_through_an_address_and_through_a_change() -> None:
    problem, setting = setting_on_a_record()
    assert setting_of(parameters_of(setting)).read()[0].problem == problem
    changed = setting.with_value("loading.ground_acceleration.scale", 2.0).read()[0].problem.ground_acceleration
    assert isinstance(changed, ss.loading.Accelerogram)
    assert changed.samples.tolist() == (2.0 * problem.ground_acceleration.samples).tolist()  # type: ignore[union-attr]
