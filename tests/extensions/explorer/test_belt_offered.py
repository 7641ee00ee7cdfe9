"""The explorer puts a block on a belt and takes it off, and offers the numbers of the belt."""

from __future__ import annotations

import pytest

from stickslip.extensions.explorer.model.controls import controls_of
from stickslip.extensions.explorer.model.exchange import with_kind
from stickslip.extensions.explorer.model.setting import Setting


def test_a_block_goes_on_a_belt_and_off_it_with_its_numbers() -> None:
    on_spring = Setting.bundled("tides-block")
    on_belt = with_kind(on_spring, "body", "block-on-belt")
    assert on_belt.scenario().problem.body == on_spring.scenario().problem.body.on_belt()  # type: ignore[attr-defined] # a block
    assert on_belt.scenario().problem.ground is not None
    assert with_kind(on_belt, "body", "spring-block").scenario().problem.body == on_spring.scenario().problem.body
    names = {control.path for group in controls_of(on_belt) for control in group.controls}
    assert {"loading.pull_rate.mean", "loading.pull_rate.amplitude", "loading.pull_rate.period", "body.stiffness"} <= names


@pytest.mark.parametrize(("name", "kind"), [("fig6-slab", "block-on-belt"), ("steel-on-granite", "block-on-belt")])
def test_a_slab_is_exchanged_for_its_equivalent_block_on_a_belt(name: str, kind: str) -> None:
    changed = with_kind(Setting.bundled(name), "body", kind).scenario().problem
    assert changed.body == Setting.bundled(name).scenario().problem.body.equivalent_block().on_belt()  # type: ignore[attr-defined]
