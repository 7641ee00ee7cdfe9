"""The strip and the tour on the page: what they show, what a click does, and what is typed wrongly."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from stickslip.extensions.explorer.model.setting import Setting
from stickslip.extensions.explorer.model.solve import solve
from stickslip.extensions.explorer.model.strip import SHOWN, Strip, setting_at, strip_range
from stickslip.extensions.explorer.model.tour import TOUR
from stickslip.extensions.explorer.page.explorer import Explorer
from stickslip.extensions.explorer.page.strip import StripView, place_of, view_of_strip
from stickslip.extensions.explorer.page.words import Tour
from tests.extensions.explorer.desk_at_once import DeskAtOnce

SLAB = Setting.bundled("fig6-slab")


@pytest.fixture
def desk() -> DeskAtOnce:
    return DeskAtOnce()


@pytest.fixture
def explorer(desk: DeskAtOnce) -> Explorer:
    explorer = Explorer(SLAB, desk, solve)
    explorer.change(SLAB)
    return explorer


@pytest.fixture
def view(explorer: Explorer) -> StripView:
    return StripView(explorer)


def test_a_chosen_parameter_brings_a_strip_of_its_usual_range(explorer: Explorer, view: StripView) -> None:
    view.bar._handle_msg({"parameter": "friction.alpha"})
    assert view.strip is not None
    assert view.plots.visible
    assert view.bar.state["chosen"] == {"parameter": "friction.alpha", "low": "0.2", "high": "5", "log": True, "unit": "s/m"}
    view.bar._handle_msg({"parameter": ""})
    assert (explorer.strip, view.plots.visible) == (None, False)


def test_a_range_can_be_typed_with_units_and_a_wrong_one_is_refused_in_the_bar(explorer: Explorer, view: StripView) -> None:
    view.bar._handle_msg({"parameter": "body.thickness", "low": "1 km", "high": "20 km", "log": False})
    good = strip_range("body.thickness", 1e3, 2e4)
    assert explorer.strip == good
    for low, high, message in (
        ("1 km", "2 s", "strip: body.thickness must be"),
        ("20 km", "1 km", "axis: body.thickness must go from a smaller"),
        ("x" * 5000, "1 km", "strip: body.thickness must be"),
    ):
        view.bar._handle_msg({"parameter": "body.thickness", "low": low, "high": high, "log": False})
        assert view.bar.state["said"].startswith(message)
        assert len(view.bar.state["said"]) < 400
        assert explorer.strip == good


@pytest.mark.sampled(every=4)
@pytest.mark.parametrize(
    ("scenario", "parameter", "low", "high", "unit"),
    [
        ("fig6-slab", "body.thickness", "2", "50", "km"),
        ("fig6-slab", "body.normal_stress", "20", "500", "MPa"),
        ("velocity-steps-block", "body.stiffness", "20", "500", "kN/mm"),
        ("fig6-slab", "initial.load", "0", "1", "Pa"),
    ],
)
def test_the_range_of_a_strip_is_shown_and_read_in_the_unit_of_the_slider(
    scenario: str, parameter: str, low: str, high: str, unit: str
) -> None:
    explorer = Explorer(Setting.bundled(scenario), DeskAtOnce(), solve)
    view = StripView(explorer)
    view.bar._handle_msg({"parameter": parameter})
    chosen = view.bar.state["chosen"]
    assert (chosen["low"], chosen["high"], chosen["unit"]) == (low, high, unit)
    before = explorer.strip
    view.bar._handle_msg({"parameter": parameter, "low": low, "high": high, "log": chosen["log"]})
    assert explorer.strip == before


def test_a_typed_number_and_the_axis_of_the_strip_are_in_the_unit_of_the_field(explorer: Explorer, view: StripView) -> None:
    view.bar._handle_msg({"parameter": "body.thickness", "low": "1", "high": "20", "log": False})
    assert explorer.strip == strip_range("body.thickness", 1e3, 2e4)
    assert view._stage.named["axis:strip_x@strip_slip"].axis_label == "body.thickness (km)"
    assert view._stage.named["here:strip_slip"].location == 10.0
    view._tapped(SimpleNamespace(x=5.0))
    assert explorer.setting.scenario().problem.body.thickness == pytest.approx(5e3, rel=0.01)


@pytest.mark.sampled(every=3)
@pytest.mark.parametrize("data", [None, 7, {}, {"parameter": 3}, {"parameter": "no.such"}, {"parameter": "run.selection"}])
def test_a_message_that_makes_no_sense_changes_nothing(explorer: Explorer, view: StripView, data: Any) -> None:
    view.bar._handle_msg(data)
    assert explorer.strip is None


def test_a_click_goes_to_the_nearest_run_of_the_strip(explorer: Explorer, view: StripView, desk: DeskAtOnce) -> None:
    explorer.show_strip(TOUR[5].strip)
    strip, asked = view.strip, desk.asked
    assert strip is not None
    view._tapped(SimpleNamespace(x=50.2))  # MPa
    assert explorer.setting.value("body.normal_stress") == strip.values[strip.nearest(50.2e6)]
    assert explorer.answer is not None
    assert explorer.answer.solution.events.peak_rate[0] == strip.results["peak_rate"][strip.nearest(50.2e6)]
    assert desk.asked == asked + 1  # the strip is still the same, only its mark has moved
    assert view._stage.named["here:strip_slip"].location == pytest.approx(strip.values[strip.nearest(50.2e6)] / 1e6)


def test_a_click_on_a_logarithmic_strip_counts_in_powers_of_ten(explorer: Explorer, view: StripView) -> None:
    explorer.show_strip(strip_range("friction.alpha", 0.1, 10.0, log=True))
    view._tapped(SimpleNamespace(x=0.5))
    assert explorer.setting.value("friction.alpha") == pytest.approx(10**0.5, rel=0.02)


def test_a_strip_whose_parameter_a_new_setting_does_not_have_is_closed(explorer: Explorer, view: StripView) -> None:
    explorer.show_strip(TOUR[5].strip)
    explorer.change(Setting.bundled("fig6-block-reconstructed"))
    assert (explorer.strip, view.strip) == (None, None)


def test_another_parameter_makes_the_strip_anew(explorer: Explorer, view: StripView) -> None:
    explorer.show_strip(TOUR[5].strip)
    before = view.strip
    explorer.change(SLAB.with_value("friction.alpha", 2.0))
    assert before is not None
    assert view.strip is not None
    assert view.strip.results["peak_rate"][-1] > before.results["peak_rate"][-1]


def a_strip(**changes: Any) -> Strip:
    values = np.array([1.0, 2.0, 3.0, 4.0])
    given: dict[str, Any] = {
        "parameter": "p", "meaning": "m", "unit": "Pa", "values": values, "here": 2.0, "log": False, "refused": {},
        "results": dict.fromkeys(SHOWN, values) | {"irregular": np.array([0.0, 1.0, 1.0, 0.0])},
        "units": dict.fromkeys(SHOWN, "m"),
    }  # fmt: skip
    return Strip(**(given | changes))


def test_the_band_of_irregular_runs_ends_halfway_to_its_neighbours() -> None:
    assert view_of_strip(a_strip()).columns["strip_bands"] == {"x0": [1.5], "x1": [3.5]}
    ends = a_strip(results={name: np.ones(4) for name in SHOWN} | {"irregular": np.array([1.0, 0.0, np.nan, 1.0])})
    assert view_of_strip(ends).columns["strip_bands"] == {"x0": [1.0, 3.5], "x1": [1.5, 4.0]}


def test_a_strip_is_shown_in_readable_units() -> None:
    strip = a_strip(values=np.array([1e6, 2e6, 3e6, 4e6]))
    shown = view_of_strip(strip)
    assert shown.columns["strip"]["x"].tolist() == [1, 2, 3, 4]
    assert shown.labels["axis:strip_x@strip_slip"] == "p (MPa)"
    assert place_of(a_strip(log=True), 100.0, 1.0) == 2.0


def test_runs_without_a_number_leave_a_gap_and_no_infinite_axis() -> None:
    empty = a_strip(results={name: np.full(4, np.nan) for name in (*SHOWN, "irregular")})
    assert np.isfinite(view_of_strip(empty).limits["strip_slip_y"]).all()


def test_the_setting_at_a_place_replaces_the_excess_by_a_load_and_keeps_units_of_formulas() -> None:
    loaded = setting_at(SLAB, "initial.load", 7e7)
    assert loaded.scenario().problem.load == 7e7
    formula = setting_at(Setting.bundled("block-or-slab"), "alpha", 0.01)
    assert formula.scenario().problem.parameters["alpha"].value == 0.01
    assert setting_at(SLAB, "run.rtol", 1e-8).scenario().rtol == 1e-8  # an entry that the document leaves out


def test_the_tour_goes_to_a_step_and_shows_it(explorer: Explorer, view: StripView) -> None:
    tour = Tour(explorer)
    tour.card._handle_msg({"step": 6})
    assert (explorer.tour, tour.card.step, explorer.cursor) == (6, 6, TOUR[5].cursor)
    assert explorer.setting == TOUR[5].setting
    assert view.strip is not None
    assert view.strip.values[0] == TOUR[5].strip.low
    for wrong in (None, {}, {"step": 9}, {"step": -1}, {"step": "2"}, {"step": 2.5}):
        tour.card._handle_msg(wrong)
    assert explorer.tour == 6
    tour.card._handle_msg({"step": 0})
    assert (explorer.tour, tour.card.step, explorer.setting) == (0, 0, TOUR[5].setting)
