"""A force in time, and a block without a spring, in the explorer."""

from __future__ import annotations

import pytest

import stickslip as ss
from stickslip.extensions.explorer.model.controls import controls_of
from stickslip.extensions.explorer.model.ranges import range_of
from stickslip.extensions.explorer.model.setting import Setting
from stickslip.extensions.explorer.model.solve import answer_of
from stickslip.foundation.quantities import quantities_of
from stickslip.loading import Sinusoidal
from stickslip.problem.scenarios import Scenario

FREE = ss.SpringBlock(2.0, 0.0, 20.0)
DRY = ss.friction.Coulomb(0.6, 0.4)


@pytest.mark.parametrize(
    ("force", "offered"),
    [(13.0, "loading.force"), (Sinusoidal(0.0, 16.0, 1.7), "loading.force.amplitude")],
    ids=["number", "swing"],
)
def test_the_explorer_offers_the_force_and_runs_a_block_without_a_spring(force: float | Sinusoidal, offered: str) -> None:
    setting = Setting.of(Scenario(ss.Problem(FREE, DRY, force=force), 4.0))
    paths = [control.path for group in controls_of(setting) for control in group.controls]
    assert offered in paths
    assert "body.stiffness" in paths
    scenario = setting.scenario()
    answer = answer_of(scenario, ss.simulate(scenario), None, ss.uniqueness(scenario.problem))
    assert answer.scenario.problem.force == force


def test_the_slider_of_a_stiffness_does_not_reach_0() -> None:
    body = ss.SpringBlock(2.0, 30.0, 20.0)
    found = range_of("body.stiffness", quantities_of(type(body))["stiffness"], 30.0, ss.Problem(body, DRY, initial_load=1.0))
    assert found is not None
    assert found.log
    assert 0.0 < found.low < 30.0
