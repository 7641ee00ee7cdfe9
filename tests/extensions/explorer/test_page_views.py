"""What the page shows of an answer: columns that belong together, axes that hold their data, units that fit."""

from __future__ import annotations

import json
from functools import cache
from typing import Any

import numpy as np
import panel as pn
import pytest

from stickslip.extensions.explorer.model.answer import Answer
from stickslip.extensions.explorer.model.setting import Setting
from stickslip.extensions.explorer.model.solve import solve
from stickslip.extensions.explorer.page.explorer import Explorer
from stickslip.extensions.explorer.page.page import Panels, build, build_for_notebook
from stickslip.extensions.explorer.page.panels import view_of
from stickslip.extensions.explorer.page.panels.motion import DRAWN
from stickslip.extensions.explorer.page.view import LegendKey, View, heading, limits, round_step, view_bytes
from stickslip.extensions.explorer.page.words import Words
from tests.extensions.explorer.desk_at_once import DeskAtOnce


@pytest.fixture
def explorer() -> Explorer:
    setting = Setting.bundled("fig5-slab-reconstructed")
    made = Explorer(setting, DeskAtOnce(), solve)
    made.change(setting)
    return made


def test_the_page_has_all_its_parts(explorer: Explorer) -> None:
    document = build(explorer)._init_doc()
    roots = {root.name for root in document.roots} | {root.tags[0] for root in document.roots if root.tags}
    assert {"law", "contact", "shape", "slip", "rate", "traction", "field", "energy", "player", "words", "controls"} <= roots


def test_a_new_answer_is_shown_in_place(explorer: Explorer) -> None:
    panels = Panels(explorer)
    plots, before = dict(panels.plots), panels.player.shown
    explorer.change(explorer.setting.with_value("friction.amplitude", 0.4))
    assert panels.plots == plots
    assert panels.player.shown != before
    assert panels.player.shown == view_bytes(view_of(explorer.answer), panels.headings)


def test_a_fault_leaves_the_last_picture(explorer: Explorer) -> None:
    panels, words = Panels(explorer), Words(explorer)
    before = panels.player.shown
    explorer.change(explorer.setting.with_value("friction.amplitude", "much"))
    assert panels.player.shown == before
    assert "amplitude" in words.view.texts["fault"]
    explorer.change(explorer.setting.with_value("friction.amplitude", 0.4))
    assert words.view.texts["fault"] == ""


def test_a_run_can_be_stopped_from_the_page(explorer: Explorer, monkeypatch: pytest.MonkeyPatch) -> None:
    stopped: list[bool] = []
    monkeypatch.setattr(explorer, "stop", lambda: stopped.append(True))
    view = Words(explorer).view
    view._handle_msg("nonsense")
    view._handle_msg("stop")
    assert stopped == [True]


def test_the_cursor_of_the_browser_is_told(explorer: Explorer) -> None:
    panels, heard = Panels(explorer), []
    explorer.listen("cursor", lambda: heard.append(explorer.cursor))
    panels.player._handle_msg({"cursor": 2.5})
    panels.player._handle_msg({"cursor": "soon"})
    panels.player._handle_msg("nonsense")
    assert heard == [2.5]


def test_a_move_of_the_browser_is_not_sent_back(explorer: Explorer) -> None:
    panels = Panels(explorer)
    panels.player._handle_msg({"cursor": 2.5})
    assert panels.player.cursor["seconds"] == 0.0
    for seconds in (4.0, 4.0):
        before = dict(panels.player.cursor)
        explorer.cursor = seconds
        explorer.tell("cursor")
        assert panels.player.cursor["seconds"] == seconds
        assert panels.player.cursor != before


def test_a_cell_of_a_notebook_hides_what_has_nothing_to_show(explorer: Explorer) -> None:
    cell = build_for_notebook(explorer)
    cell.explorer = explorer
    cards = {card[1].object.name: card for card in cell.select(pn.Column) if len(card) == 2 and isinstance(card[1], pn.pane.Bokeh)}
    assert len(cards) == 16  # twelve panels, and four of the strip
    assert not cards["plot:state"].visible
    assert cards["plot:field"].visible
    explorer.change(Setting.bundled("fig6-block-reconstructed"))
    assert not cards["plot:field"].visible
    assert cards["plot:slip"].visible


NAMES = ("fig5-slab-reconstructed", "fig6-slab", "fig6-block-reconstructed", "rate-and-state-slab")


@cache
def answer(name: str) -> Answer:
    return solve(Setting.bundled(name).scenario())


def test_a_state_is_a_curve_on_a_logarithmic_axis() -> None:
    """A round trip of creep takes theta over decades."""
    found, (view, run) = (
        answer("rate-and-state-slab"),
        (view_of(answer("rate-and-state-slab")), answer("rate-and-state-slab").solution),
    )
    column = view.columns["states"]
    seconds = column["time"] * view.facts["time"]["size"]
    assert np.abs(column["state"] - np.log10(run.state(seconds))).max() < 1e-9
    assert column["state"].max() - column["state"].min() > 2.0
    assert "axis:state@state" in view.hidden
    assert [key.text for key in view.keys["state"]] == [found.motions[0].states[0].meaning]
    assert "state" in view_of(answer("fig6-slab")).hidden


@pytest.fixture(params=NAMES)
def shown(request: pytest.FixtureRequest) -> tuple[Answer, View]:
    return answer(request.param), view_of(answer(request.param))


def test_columns_of_a_source_have_one_length(shown: tuple[Answer, View]) -> None:
    for name, columns in shown[1].columns.items():
        assert len({len(column) for column in columns.values()}) == 1, name


def test_axes_hold_their_data(shown: tuple[Answer, View]) -> None:
    view = shown[1]
    for axis, source, column in (
        *((name, "motion", column) for name, column in DRAWN.items()),
        ("time", "motion", "time"),
        ("law_y", "law", "y"),
        ("law_x", "motion", "law_x"),
        ("contact_rate", "path", "rate"),
        ("contact_load", "path", "load"),
        ("energy", "energy", "total"),
    ):
        values = np.asarray(view.columns[source][column], float)
        values = values[np.isfinite(values)]
        if values.size:
            low, high = view.limits[axis]
            assert low <= values.min(), axis
            assert values.max() <= high, axis


def test_values_times_units_are_those_of_the_answer(shown: tuple[Answer, View]) -> None:
    found, view = shown
    size = view.facts["time"]["size"]
    np.testing.assert_allclose(view.columns["motion"]["time"] * size, found.motions[0].time, rtol=1e-14)
    assert [mark["time"] * size for mark in view.facts["marks"]] == pytest.approx([mark.time for mark in found.marks])


def test_parts_of_the_energy_are_stacked_up_to_their_sum(shown: tuple[Answer, View]) -> None:
    found, view = shown
    parts = sum(
        found.energy.parts[name] for name in ("elastic", "kinetic", "radiated", "damped", "heat") if name in found.energy.parts
    )
    drawn = view.columns["energy"]["heat"]
    np.testing.assert_allclose(drawn * np.max(parts), parts * np.max(drawn), rtol=1e-12)


def test_a_slab_is_an_image_and_a_block_has_none() -> None:
    slab, block = view_of(answer("fig6-slab")), view_of(answer("fig6-block-reconstructed"))
    assert slab.columns["field"]["velocity"][0].dtype == np.float32
    assert slab.fastest == pytest.approx(float(np.abs(slab.columns["field"]["velocity"][0]).max()))
    field, places = slab.columns["field"], len(slab.columns["field"]["velocity"][0])
    middles = field["y"][0] + field["dh"][0] * (np.arange(places) + 0.5) / places
    np.testing.assert_allclose(middles, answer("fig6-slab").slab.place / 1e3, atol=1e-12)
    assert slab.limits["place"] == (0.0, 10.0)
    change = slab.columns["field"]["stress"][0]
    assert not change[:, 0].any()
    assert slab.facts["fields"]["stress"] == {
        "most": pytest.approx(np.abs(change).max()),
        "text": "±80.4 MPa",
    }
    assert "field" in block.hidden
    assert block.facts["shape"]["kind"] == "block"


@pytest.mark.parametrize("low", [0.0, -3.0, 1e-9, 5e6])
@pytest.mark.parametrize("span", [1e-12, 0.3, 7.7, 4e8])
def test_limits_are_round_and_hold_their_values(low: float, span: float) -> None:
    bottom, top = limits([low, low + span])
    assert bottom <= low
    assert top >= low + span
    assert top - bottom <= 1.5 * span or span < 1e-8 * abs(low)


def test_limits_stay_while_a_value_changes_a_little() -> None:
    assert limits([0.0, 7.12]) == limits([0.0, 7.15])


@pytest.mark.parametrize("values", [[], [np.nan], [0.0, 0.0], [5.0]])
def test_limits_of_hardly_anything_are_an_interval(values: list[float]) -> None:
    low, high = limits(values)
    assert low < high


@pytest.mark.parametrize(("size", "step"), [(1.0, 1.0), (4.99, 2.0), (5.0, 5.0), (0.0123, 0.01), (2e9, 2e9)])
def test_steps_are_one_two_or_five(size: float, step: float) -> None:
    assert round_step(size) == pytest.approx(step, rel=1e-12)


def test_headings_are_escaped() -> None:
    assert "<b>" not in heading("<b>", [LegendKey("<b>", "slip")])


def test_a_kept_run_is_shown_in_the_units_of_both() -> None:
    slab, block = answer("fig6-slab"), answer("fig6-block-reconstructed")
    view = view_of(slab, slab)
    np.testing.assert_array_equal(view.columns["pinned"]["slip"], view.columns["motion"]["slip"])
    np.testing.assert_array_equal(view.columns["pinned_law"]["x"], view.columns["law"]["x"])
    assert all(LegendKey("pinned", "pin") in view.keys[name] for name in ("slip", "rate", "traction", "law", "contact"))
    other = view_of(block, slab)
    assert np.isnan(other.columns["pinned"]["traction"]).all()  # Pa beside N
    for name in ("slip", "rate"):
        low, high = other.limits[name]
        assert low <= np.min(other.columns["pinned"][name])
        assert np.max(other.columns["pinned"][name]) <= high


def test_an_event_of_a_long_run_has_a_time_of_its_own() -> None:
    found = answer("cycles-slab")
    view = view_of(found)
    near, time = view.facts["near"], view.columns["field"]
    assert not near["whole"]
    assert view.limits["near"] == (near["from"], near["to"])
    assert view.columns["energy"]["time"][-1] * near["size"] + near["begin"] == pytest.approx(found.energy.time[-1])
    assert near["from"] - time["dw"][0] <= time["x"][0] <= time["x"][0] + time["dw"][0] <= near["to"] + time["dw"][0]
    assert view_of(answer("fig6-slab")).limits["near"] == view_of(answer("fig6-slab")).limits["time"]


@pytest.mark.parametrize("name", ["velocity-steps-block", "rate-and-state-slab"])
def test_under_a_law_with_a_state_the_panel_of_the_law_shows_the_path_of_the_run_beside_the_steady_state(name: str) -> None:
    view, solution = view_of(answer(name)), answer(name).solution
    law, path = solution.problem.friction, view.columns["visited"]
    assert [key.text for key in view.keys["law"]] == ["steady state", "path of the run"]
    time = answer(name).motions[0].time[1::20]
    rate, state = solution.slip_rate(time), solution.state(time)
    expected = law.reference + law.a * np.log(rate / law.rate) + law.b * np.log(law.rate * state / law.distance)
    points = np.column_stack([path["x"], path["y"]])
    points = points[np.isfinite(points).all(axis=1)]
    away = np.abs(points - np.column_stack([np.log10(rate), expected])[:, None, :]) / np.ptp(points, axis=0)
    assert away.max(axis=2).min(axis=1).max() < 0.02
    steady = np.interp(points[:, 0], view.columns["law"]["x"], view.columns["law"]["y"])
    assert np.abs(points[:, 1] - steady).max() > 0.02
    assert (points >= [view.limits["law_x"][0], view.limits["law_y"][0]]).all()
    assert (points <= [view.limits["law_x"][1], view.limits["law_y"][1]]).all()


def test_the_path_of_a_run_that_reverses_passes_through_a_slip_rate_of_zero_on_a_linear_axis() -> None:
    view, motion = view_of(answer("reversing-axis")), answer("reversing-axis").motions[0]
    path, now = view.columns["visited"], view.columns["motion"]
    assert "axis:law_powers" in view.hidden
    at = np.column_stack([now["law_x"], motion.traction / motion.normal_load])[::20]
    points = np.column_stack([path["x"], path["y"]])
    points = points[np.isfinite(points).all(axis=1)]
    assert points[:, 0].min() < -0.9 * points[:, 0].max() < 0.0
    away = np.abs(points - at[:, None, :]) / np.ptp(points, axis=0)
    assert away.max(axis=2).min(axis=1).max() < 0.02
    steps = np.abs(np.diff(np.column_stack([path["x"], path["y"]]), axis=0)) / np.ptp(points, axis=0)
    assert np.nanmax(steps) < 0.1, "no line across the panel"
    law = view.columns["law"]
    np.testing.assert_allclose(np.interp(-law["x"], law["x"], law["y"]), -law["y"], rtol=0.0, atol=1e-12)


@pytest.mark.parametrize("name", ["velocity-steps-block", "slide-hold-slide-block"])
def test_slip_rates_under_a_law_that_never_sticks_have_a_logarithmic_axis_and_friction_is_framed(name: str) -> None:
    view, motion = view_of(answer(name)), answer(name).motions[0]
    assert [axis in view.hidden for axis in ("axis:rate@rate", "axis:rate_powers")] == [True, False]
    np.testing.assert_allclose(10.0 ** view.columns["motion"]["rate_at"], view.columns["motion"]["rate"], rtol=1e-12)
    for axis, values in (("rate", np.log10(motion.slip_rate)), ("traction", view.columns["motion"]["traction"])):
        assert np.ptp(view.limits[axis]) < 1.5 * np.ptp(values)


def test_slip_rates_under_a_law_that_sticks_have_a_linear_axis() -> None:
    view = view_of(answer("fig6-slab"))
    assert [axis in view.hidden for axis in ("axis:rate@rate", "axis:rate_powers")] == [False, True]
    np.testing.assert_array_equal(view.columns["motion"]["rate_at"], view.columns["motion"]["rate"])


def test_a_companion_that_moves_much_further_does_not_flatten_the_body() -> None:
    found = answer("fig5-slab-reconstructed")
    slab, block = found.motions
    assert np.ptp(block.slip) > 4.0 * np.ptp(slab.slip)
    view = view_of(found)
    low, high = view.limits["slip"]
    assert high - low < 2.0 * np.ptp(view.columns["motion"]["slip"])
    assert view.keys["slip"][1].text.startswith("equivalent block, to ")
    assert view.keys["rate"][1].text == "equivalent block"
    assert view.limits["rate"][1] >= np.max(view.columns["companion"]["rate"])


def test_a_block_of_bytes_holds_all_numbers_of_a_view(shown: tuple[Answer, View]) -> None:
    view = shown[1]
    block = view_bytes(view, {"law": "<h2>é</h2>"})
    begin = 8 + int.from_bytes(block[:8], "little")
    content = json.loads(block[8:begin])
    assert (begin % 8, len(block) % 8) == (0, 0)
    assert content["headings"] == {"law": "<h2>é</h2>"}
    assert content["facts"] == json.loads(json.dumps(view.facts))

    def read(place: Any) -> Any:
        if isinstance(place, list):
            return [read(one) for one in place]
        kind, count = ("<f4", int(np.prod(place["shape"]))) if "shape" in place else ("<f8", place["length"])
        return np.frombuffer(block, kind, count, begin + place["at"]).reshape(place.get("shape", -1))

    for source, columns in view.columns.items():
        for name, values in columns.items():
            found = read(content["columns"][source][name])
            if isinstance(values, list) and any(np.ndim(one) for one in values):
                for one, other in zip(found, values, strict=True):
                    np.testing.assert_array_equal(one, other)
            else:
                np.testing.assert_array_equal(found, np.asarray(values, float))


@pytest.mark.parametrize(("name", "law", "contact"), [("fig5-slab-reconstructed", False, True), ("fig6-slab", False, False)])
def test_panels_of_a_law_that_changes_with_slip_say_at_which_slip_they_are(name: str, law: bool, contact: bool) -> None:
    titles = view_of(answer(name)).titles
    assert [panel in titles and titles[panel].endswith("at the slip of the start") for panel in ("law", "contact")] == [
        law,
        contact,
    ]
