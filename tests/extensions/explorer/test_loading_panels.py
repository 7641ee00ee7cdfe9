"""What is given over time, such as the motion of the ground, is a curve beside the run in the explorer."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import stickslip as ss
from stickslip.extensions.explorer.model.solve import solve
from stickslip.extensions.explorer.page.page import OF_ONE_PLACE
from stickslip.extensions.explorer.page.panels import view_of
from stickslip.extensions.explorer.page.panels.loading import BINS, thinned


def test_the_ground_record_is_a_curve_with_its_unit() -> None:
    scenario = ss.load_scenario("sliding-block-shaken")
    view = view_of(solve(scenario))
    shown = view.columns["given"]
    ground = scenario.problem.ground_acceleration
    assert 9.80665 * shown["given"] == pytest.approx(ground.at(np.asarray(shown["time"])), rel=1e-12, abs=1e-12)
    assert (shown["time"][0], shown["time"][-1]) == (0.0, scenario.duration)
    assert len(shown["time"]) > 20
    assert view.titles["given"] == "Ground acceleration (g)"
    assert "given" not in view.hidden
    assert "also_given" in view.hidden
    low, high = view.limits["given"]
    assert low < shown["given"].min() < shown["given"].max() < high


def test_two_histories_have_a_panel_each_and_what_shakes_is_first() -> None:
    scenario = ss.load_scenario("sliding-block-shaken")
    pull = ss.loading.Steps([0.0, 1.0], [0.0, 1e-3])
    view = view_of(solve(replace(scenario, problem=replace(scenario.problem, pull_rate=pull))))
    titles = [view.titles[name].partition(" (")[0] for name in ("given", "also_given")]
    assert titles == ["Ground acceleration", "Pull rate"]
    assert view.columns["also_given"]["also_given"][-1] == pytest.approx(1.0)


def test_a_run_without_histories_hides_their_panels() -> None:
    assert {"given", "also_given"} <= view_of(solve(ss.load_scenario("fig6-slab"))).hidden
    assert {"given", "also_given"} <= {name for stack in OF_ONE_PLACE.rows[1] for name in stack}


def test_a_tone_that_swings_too_often_is_its_range() -> None:
    scenario = ss.load_scenario("tides-block")
    view = view_of(solve(scenario))
    shown, tone = view.columns["given"], scenario.problem.pull_rate.tone
    assert view.titles["given"] == "Pull rate (nm/s)"
    assert 0.5e-9 * (shown["high"] - shown["low"]) == pytest.approx(np.full(len(shown["time"]), tone.amplitude), rel=1e-12)
    assert view.keys["given"][0].style == "area"


def test_a_long_record_keeps_its_extremes() -> None:
    time = np.linspace(0.0, 10.0, 50_001)
    values = np.sin(900.0 * time) * np.exp(-0.1 * time)
    at, kept = thinned(time, values)
    assert len(at) <= 2 * BINS + 2
    assert (kept.min(), kept.max(), at[0], at[-1]) == (values.min(), values.max(), 0.0, 10.0)
    assert kept == pytest.approx(np.sin(900.0 * at) * np.exp(-0.1 * at))
    for low in (0.0, 3.0, 9.0):
        inside, near = (time >= low) & (time < low + 0.5), (at >= low) & (at < low + 0.5)
        assert kept[near].max() == pytest.approx(values[inside].max(), abs=1e-3)
