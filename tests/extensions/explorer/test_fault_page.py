"""The page of a fault in 2D: what it shows is the run; its controls, link, files, pin and tour are those of every page."""

from __future__ import annotations

import asyncio
import json
import re
from dataclasses import replace
from types import SimpleNamespace
from typing import Any
from urllib.parse import unquote

import numpy as np
import panel as pn
import pytest
from bokeh.models import Plot

import stickslip as ss
from stickslip.extensions.explorer.model import fault
from stickslip.extensions.explorer.model.controls import controls_of
from stickslip.extensions.explorer.model.difference import difference
from stickslip.extensions.explorer.model.fault import FaultAnswer, _marks, solve_fault
from stickslip.extensions.explorer.model.setting import Setting, parameters_of, setting_of
from stickslip.extensions.explorer.model.tour import TOUR_OF_A_FAULT
from stickslip.extensions.explorer.page.controls import Controls
from stickslip.extensions.explorer.page.explorer import Explorer
from stickslip.extensions.explorer.page.files import OF_A_FAULT, export
from stickslip.extensions.explorer.page.page import build
from stickslip.extensions.explorer.page.panels import view_of
from stickslip.extensions.explorer.page.tools import begin, query_of
from stickslip.extensions.explorer.page.view import headings_of, view_bytes
from tests.extensions.explorer.desk_at_once import DeskAtOnce

SETTING = Setting.bundled("planar-patch").with_value("contact.nodes", 32).with_value("run.duration", "0.5 s")
LOAD = "contact.patches[0].initial.load"


def silent(_: str) -> None:
    pass


@pytest.fixture(scope="module")
def answer() -> FaultAnswer:
    return solve_fault(SETTING.scenario(), silent)


@pytest.fixture
def explorer(answer: FaultAnswer) -> Explorer:
    """An explorer whose every answer is that of the first setting, and which notes what it is asked for."""

    def solve(scenario: Any, told: Any) -> FaultAnswer:
        _ = scenario.to_solve
        return replace(answer, scenario=scenario)

    return Explorer(SETTING, DeskAtOnce(), solve)


def test_the_view_shows_the_run(answer: FaultAnswer) -> None:
    view, run = view_of(answer), answer.run
    picture = view.columns["field"]
    even = np.linspace(run.times[0], run.times[-1], len(run.times))
    nearest = [int(np.abs(run.times - time).argmin()) for time in even]
    assert np.array_equal(picture["velocity"][0], run.slip_rate[nearest].T.astype(np.float32))
    assert np.array_equal(picture["displacement"][0], (run.slip[nearest].T / 1e-3).astype(np.float32))
    assert np.array_equal(view.columns["motion"]["slip"], run.slip[:, 16] / 1e-3)
    assert view.limits["along"] == pytest.approx((-20.625, 19.375), abs=1e-12)
    assert view.titles["slip"] == "Slip in the middle u (mm)"
    assert answer.sentence == " ".join(run.sentences[:3])
    parts = answer.energy.parts if answer.energy else {}
    share = (parts["total"] - parts["elastic"] - parts["kinetic"] - parts["heat"]) / parts["heat"][-1]
    assert np.abs(share).max() == pytest.approx(float(np.abs(run.energy().balance).max()) / parts["heat"][-1], rel=1e-9)
    assert view_bytes(view, headings_of(view, {}))


def test_a_pinned_run_stays_beside_the_next_one(answer: FaultAnswer) -> None:
    other = solve_fault(SETTING.with_value(LOAD, "75 MPa").scenario(), silent)
    view = view_of(other, answer)
    assert np.array_equal(
        view.columns["pinned"]["slip"] / view.columns["motion"]["slip"][-1], answer.run.slip[:, 16] / other.run.slip[-1, 16]
    )
    changed = difference((SETTING, answer), (SETTING.with_value(LOAD, "75 MPa"), other))
    assert [str(one) for one in changed.changes] == [f"{LOAD}: 71 MPa → 75 MPa"]
    assert "largest slip" in {one.name for one in changed.moved}


def test_each_number_has_a_name_a_unit_and_a_slider() -> None:
    found = {one.path: (group.title, one.label, one.shown, one.unit) for group in controls_of(SETTING) for one in group.controls}
    assert found[LOAD] == ("Patch 1", "initial load", "71", "MPa")
    assert found["contact.patches[1].y[0]"] == ("Patch 2", "from y", "-18", "km")
    assert found["contact.nodes"] == ("Contact", "nodes", "32", "")
    assert found["friction.distance"] == ("Friction", "distance", "40", "cm")
    assert not {"contact.width", "body.contact_mass", "run.rtol"} & set(found), "what a fault in 2D cannot have"
    numbers = [one for group in controls_of(SETTING) for one in group.controls if isinstance(one.value, float) and one.value]
    without = {one.path for one in numbers if one.slider is None}
    assert not without
    assert all(one.slider is None or one.slider.low <= one.value <= one.slider.high for one in numbers if np.isfinite(one.value))


def test_what_is_entered_changes_the_setting_and_a_fault_keeps_the_picture(explorer: Explorer) -> None:
    controls = Controls(explorer)
    explorer.change(SETTING)
    controls._enter({"path": LOAD, "text": "75"})
    assert explorer.setting.value(LOAD) == "75.0 MPa"
    controls._enter({"path": "contact.nodes", "value": 40.9})
    assert explorer.setting.value("contact.nodes") == 40
    controls._enter({"path": "contact.replicas", "text": "true"})
    assert explorer.setting.value("contact.replicas") is True
    shown = explorer.answer
    for entered, word in (
        ({"path": "contact.courant", "text": "3"}, "courant must be at most"),
        ({"path": LOAD, "value": float("nan")}, "nan"),
        ({"path": LOAD, "value": float("inf")}, "inf"),
        ({"path": "contact.nodes", "text": "4096"}, "4096 nodes, 1024 are the most that can be used here"),
        ({"path": "scenario", "text": "fig6-slab"}, "have pages of their own"),
    ):
        controls._enter(entered)
        assert word in explorer.fault, entered
        assert explorer.answer is shown


def test_a_link_leads_to_the_same_run(explorer: Explorer) -> None:
    setting = SETTING.with_value(LOAD, "75 MPa")
    assert setting_of(parameters_of(setting)).scenario() == setting.scenario()
    explorer.change(SETTING)
    explorer.pin()
    explorer.change(setting)
    query = dict(one.split("=", 1) for one in query_of(explorer).split("&"))
    again = Explorer(SETTING, DeskAtOnce(), lambda scenario, told: explorer.answer)
    begin(again, {name: unquote(value) for name, value in query.items()})
    assert again.setting.scenario() == setting.scenario()
    assert again.pinned is not None
    assert again.pinned[0].scenario() == SETTING.scenario()


def test_a_link_to_more_nodes_than_a_page_shows_is_refused_before_they_are_made(explorer: Explorer, monkeypatch: Any) -> None:
    monkeypatch.setattr("stickslip.extensions.planar.nodes.node_values", lambda *_: pytest.fail("they were made"))
    begin(explorer, {"scenario": "planar-plane", "contact.nodes": "2048", "contact.width_nodes": "2048"})
    with pytest.raises(ss.InputError, match="4194304 nodes, 1024 are the most that can be used here"):
        setting_of({"scenario": "planar-plane", "contact.nodes": "2048", "contact.width_nodes": "2048"})


def test_a_run_that_needs_more_memory_than_a_page_has_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(fault, "MOST_MEMORY", 1e6)
    with pytest.raises(ss.InputError, match=r"planar-patch: this run needs [\d.]+ GB, and a page has 0.001 GB: take fewer nodes"):
        solve_fault(SETTING.scenario(), silent)


def test_a_fault_on_which_nothing_slips_is_shown() -> None:
    answer = solve_fault(SETTING.with_value(LOAD, "65 MPa").scenario(), silent)
    assert answer.sentence.startswith("No node slips faster than")
    assert view_of(answer).fastest == 1.0
    assert [mark.kind for mark in answer.marks] == []


@pytest.mark.sampled(every=5)
@pytest.mark.parametrize("kind", OF_A_FAULT)
def test_each_kind_of_file_can_be_saved(answer: FaultAnswer, kind: str) -> None:
    name, _, content = export(kind, SETTING, answer)
    assert name.startswith("planar-patch-changed")
    assert len(content) > 500
    if kind == "toml":
        assert ss.scenarios is not None
        assert b"planar-patch with contact.nodes = 32, run.duration = 0.5 s" in content


def test_the_page_has_all_its_panels_without_an_answer(explorer: Explorer) -> None:
    document = build(explorer)._init_doc()
    plots = {model.name for model in document.select({"type": Plot})}
    assert {f"plot:{name}" for name in ("profile_rate", "profile_slip", "slip", "rate", "traction", "field", "energy")} <= plots


def test_the_numbers_in_the_tour_are_those_of_its_runs() -> None:
    texts = " ".join(step.text for step in TOUR_OF_A_FAULT)
    problem, contact = TOUR_OF_A_FAULT[0].setting.scenario().problem, TOUR_OF_A_FAULT[0].setting.scenario().table("contact")
    assert contact is not None
    law: Any = problem.friction
    assert (law.static, law.dynamic, law.distance) == (0.7, 0.5, 0.4)
    assert (contact.length, contact.patches[0].y, contact.patches[1].y) == (40e3, (-4e3, 4e3), (-18e3, 18e3))
    assert f"{problem.round_trip_time:.4g} s" in texts
    assert TOUR_OF_A_FAULT[2].setting.value("friction.dynamic") == 0.45
    assert all(40 <= len(re.findall(r"\w+", step.text)) <= 90 for step in TOUR_OF_A_FAULT)
    assert json.dumps([step.title for step in TOUR_OF_A_FAULT])


def test_a_fault_is_shown_in_a_notebook_and_answers() -> None:
    async def cells() -> None:
        page = ss.explore(SETTING.scenario())
        assert page.explorer.answer.sentence.startswith("22% of the contact slips")
        assert len([one for one in page.select(pn.pane.Bokeh) if one.object.name.startswith("plot:profile")]) == 2

    asyncio.run(cells())
    with pytest.raises(ss.InputError, match="a record is not drawn behind a fault"):
        ss.explore(SETTING.scenario(), record={"time (s)": [0.0, 1.0], "mu": [0.6, 0.6]})


@pytest.mark.parametrize(("moves", "rest"), [([1.0, 1.0, 0.0], 2.0), ([1.0, 0.0, 0.0], 1.0), ([1.0, 1.0, 1.0], None)])
def test_arrest_is_the_first_frame_at_rest(moves: list[float], rest: float | None) -> None:
    slab = SimpleNamespace(body=SimpleNamespace(two_way_time=9.0))
    rates, times = np.array(moves)[:, None], np.arange(3.0)
    run = SimpleNamespace(has_slipped=np.array([True]), rupture_times=np.array([0.5]), slab=slab, times=times, slip_rate=rates)
    marks = {mark.kind: mark.time for mark in _marks(run)}
    assert marks.get("arrest") == rest
