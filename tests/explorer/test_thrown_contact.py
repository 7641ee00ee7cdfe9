"""A contact that can stick and starts at a rate of its own, in the explorer: its field, and what becomes of it in exchanges."""

import pytest

from stickslip.explorer.model.controls import Control, controls_of
from stickslip.explorer.model.exchange import with_kind
from stickslip.explorer.model.setting import Setting


def start_of(setting: Setting) -> dict[str, Control]:
    """Return the controls of the start by their paths."""
    return next({one.path: one for one in group.controls} for group in controls_of(setting) if group.table == "initial")


def test_a_contact_with_inertia_that_sticks_has_a_field_for_its_rate_and_a_contact_without_has_none() -> None:
    slab = Setting.bundled("fig6-slab")
    assert "initial.rate" not in start_of(slab)
    heavy = slab.with_value("body.contact_mass", 1e5)
    assert (start_of(heavy)["initial.rate"].value, start_of(heavy)["initial.rate"].empty) == (None, "rest")
    thrown = heavy.with_value("initial.rate", "2 m/s")
    assert thrown.scenario().problem.rate == 2.0
    slider = start_of(thrown)["initial.rate"].slider
    assert slider is not None
    assert slider.low < 2.0 < slider.high


def test_the_rate_stays_when_the_load_is_given_in_another_way() -> None:
    thrown = with_kind(Setting.bundled("fig6-slab"), "body", "spring-block").with_value("initial.rate", "2 m/s")
    loaded = with_kind(thrown, "initial", "load")
    assert loaded.value("initial") == {"slip": 0.0, "rate": "2 m/s", "load": thrown.scenario().problem.load}
    back = with_kind(loaded, "initial", "excess")
    assert back.value("initial") == {"slip": 0.0, "rate": "2 m/s", "excess": 0.0}


@pytest.mark.parametrize("kind", ["load", "excess"])
def test_steady_sliding_of_a_contact_that_sticks_becomes_its_load_and_its_rate(kind: str) -> None:
    heavy = Setting.bundled("fig6-slab").with_value("body.contact_mass", 1e5).with_value("loading.pull_rate", 10.0)
    steady = heavy.with_value("initial", {"rate": "steady"})
    found, before = with_kind(steady, "initial", kind).scenario().problem, steady.scenario().problem
    assert (found.rate, found.load) == (10.0, pytest.approx(before.load, rel=1e-15))
