"""The explorer offers the numbers of layers and sections, and other bodies in their place."""

from __future__ import annotations

import pytest

import stickslip as ss
from stickslip.extensions.explorer.model.controls import controls_of
from stickslip.extensions.explorer.model.exchange import with_kind
from stickslip.extensions.explorer.model.setting import Setting
from stickslip.extensions.explorer.model.solve import companion_of, motion

NAMES = ("bowed-string-tenth", "low-velocity-zone", "steel-on-granite")


STRING = "pipe-and-collar"


@pytest.mark.parametrize("name", NAMES)
def test_the_explorer_shows_a_body_of_layers(name: str) -> None:
    setting = Setting.bundled(name)
    body = controls_of(setting)[0]
    assert [one.kind for one in body.controls if one.path in ("body.thickness", "body.density", "body.wave_speed")] == [
        "points"
    ] * 3
    scenario = setting.scenario()
    assert motion(ss.simulate(scenario, max_pieces=100_000)).name == "slab"
    companion = companion_of(scenario)
    assert (companion is None) == (name == "bowed-string-tenth")  # whose drivers are not rigid
    block = with_kind(setting, "body", "spring-block").scenario().problem.body
    assert block.stiffness == pytest.approx(scenario.problem.body.stiffness)
    for kind in ("layered-slab", "two-slabs"):
        assert with_kind(Setting.bundled("fig6-slab"), "body", kind).scenario().problem.body.kind == kind


def test_the_explorer_shows_a_string_of_sections() -> None:
    setting = Setting.bundled(STRING)
    lists = ("length", "outer_diameter", "inner_diameter", "density", "shear_modulus")
    body = controls_of(setting)[0]
    assert [one.kind for one in body.controls if one.path.removeprefix("body.") in lists] == ["points"] * len(lists)
    assert motion(ss.simulate(setting.scenario())).name == "string"
    block = with_kind(setting, "body", "rotating-block").scenario().problem.body
    assert block.stiffness == pytest.approx(setting.scenario().problem.body.stiffness)
    assert with_kind(setting, "body", "torsional-string").scenario().problem.body.kind == "torsional-string"
    assert with_kind(Setting.bundled("drill-string"), "body", "sectioned-string").scenario().problem.body.kind == "sectioned-string"
