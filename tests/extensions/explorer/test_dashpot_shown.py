"""The explorer offers a dashpot at the contact, shows what it takes, and does not offer it on a fault."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest

import stickslip as ss
from stickslip.extensions.explorer.model.controls import Control, controls_of
from stickslip.extensions.explorer.model.setting import Setting
from stickslip.extensions.explorer.model.solve import solve
from stickslip.problem.scenarios import Scenario

NAMES = ("fig5-slab-reconstructed", "low-velocity-zone", "steel-on-granite", "drill-string", "pipe-and-collar")


def offered(scenario: Scenario) -> list[Control]:
    """Return the controls for a dashpot."""
    controls = [one for group in controls_of(Setting.of(scenario)) for one in group.controls]
    return [one for one in controls if one.path == "body.contact_damping"]


@pytest.mark.parametrize("name", NAMES)
def test_a_body_with_waves_has_a_slider_from_0_to_twice_its_impedance(name: str) -> None:
    """The ends of sliders have two digits."""
    scenario = ss.load_scenario(name)
    (control,) = offered(scenario)
    assert control.slider is not None
    assert control.slider.low == 0.0
    assert control.slider.high == pytest.approx(2.0 * scenario.problem.body.impedance, rel=0.05)


@pytest.mark.parametrize("name", ["planar-patch", "fig5-block-printed"])
def test_a_fault_and_a_block_have_none(name: str) -> None:
    assert offered(ss.load_scenario(name)) == []


@pytest.mark.sampled(every=2)
@pytest.mark.parametrize("name", NAMES[:2])
def test_what_the_dashpot_takes_is_a_part_of_the_energy_picture(name: str) -> None:
    """Parts add up to the total within 3e-4, as without a dashpot, and what is damped is what `energy` says within 1e-9."""
    scenario = ss.load_scenario(name)
    body: Any = scenario.problem.body
    given = replace(scenario, problem=replace(scenario.problem, body=replace(body, contact_damping=0.5 * body.impedance)))
    picture = solve(given).energy
    parts, total = {one: values for one, values in picture.parts.items() if one != "total"}, picture.parts["total"]
    assert "damped" in parts
    assert sum(parts.values()) == pytest.approx(total, rel=3e-4)
    exact = ss.simulate(given).energy(picture.time[[0, -1]])
    assert parts["damped"][-1] - parts["damped"][0] == pytest.approx(float(exact.damped[1] - exact.damped[0]), rel=1e-9)
