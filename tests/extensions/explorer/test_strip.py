"""A strip holds the numbers of single runs, and says what is wrong with a range or a parameter."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

import stickslip as ss
from stickslip.extensions.explorer.model.setting import Setting
from stickslip.extensions.explorer.model.solve import Stopped
from stickslip.extensions.explorer.model.strip import KEPT, MEMBERS, Strip, present, strip_of, strip_range, strip_text, usual_range
from stickslip.extensions.sweeps.design.quantities import QUANTITIES
from stickslip.foundation.axis import Axis
from stickslip.foundation.errors import InputError
from stickslip.problem.scenarios.parameter_paths import find_parameter
from tests.messages import refused

ALPHA = strip_range("friction.alpha", 0.05, 2.0)
SLAB = Setting.bundled("fig6-slab")

CASES = {
    "fig6-slab": ALPHA,
    "cycles-block": strip_range("friction.distance", 0.01, 0.02),  # friction that heals is not for the batch
}


@pytest.mark.parametrize("name", CASES)
def test_each_run_of_a_strip_is_the_single_run_at_its_value(name: str) -> None:
    setting = Setting.bundled(name)
    strip = strip_of(setting.scenario(), replace(CASES[name], points=5))
    for i, value in enumerate(strip.values.tolist()):
        scenario = setting.with_value(strip.parameter, value).scenario()
        solution = ss.simulate(scenario)
        for quantity in KEPT:
            expected, found = QUANTITIES[quantity].value(solution), strip.results[quantity][i]
            # the last digits of slip may differ: a batch adds up the pieces in another order
            assert found == pytest.approx(expected, rel=2e-14, abs=1e-300, nan_ok=True), (quantity, value)
            if quantity in ("pulses", "peak_rate", "irregular"):
                np.testing.assert_array_equal(found, expected)


def test_a_strip_has_two_hundred_runs_with_their_units() -> None:
    strip = strip_of(SLAB.scenario(), ALPHA)
    assert (len(strip.values), strip.unit, strip.here, strip.refused) == (MEMBERS, "s/m", 1.0, {})
    assert {name: strip.units[name] for name in ("slip", "first_end", "peak_rate")} == {
        "slip": "m",
        "first_end": "s",
        "peak_rate": "m/s",
    }
    critical = ss.uniqueness(SLAB.scenario().problem).critical_value
    assert critical is not None
    np.testing.assert_array_equal(strip.results["irregular"], strip.values > critical)
    assert strip_text(strip) == strip.meaning


@pytest.mark.parametrize(
    ("where", "message"),
    [
        (strip_range("friction.alfa", 0.0, 1.0), "strip: 'friction.alfa' is not a parameter of this scenario; did you mean"),
        (strip_range("run.selection", 0.0, 1.0), "strip: run.selection is a word; a strip needs a parameter that varies"),
        (strip_range("run.events", 1.0, 9.0), "strip: run.events is a whole number; a strip needs"),
    ],
)
def test_a_strip_that_cannot_be_made_is_refused_in_one_line(where: Axis, message: str) -> None:
    with refused(begins=message):
        strip_of(SLAB.scenario(), where)


@pytest.mark.parametrize(
    ("low", "high", "log", "message"),
    [
        (1.0, 1.0, False, "axis: friction.alpha must go from a smaller to a larger number, got 1 to 1"),
        (0.0, math.inf, False, "axis: friction.alpha must go from a smaller"),
        (math.nan, 1.0, False, "axis: friction.alpha must go from a smaller"),
        (0.0, 1.0, True, "axis: friction.alpha must begin above 0"),
    ],
)
def test_ends_that_make_no_range_are_refused(low: float, high: float, log: bool, message: str) -> None:
    with pytest.raises(InputError, match=message):
        strip_range("friction.alpha", low, high, log=log)


def test_runs_with_values_that_are_not_allowed_have_a_reason_and_do_not_stop_the_others() -> None:
    strip = strip_of(SLAB.scenario(), Axis("friction.alpha", -0.5, 1.5, 9))
    bad = strip.values < 0.0
    np.testing.assert_array_equal(np.isnan(strip.results["slip"]), bad)
    assert sorted(strip.refused) == np.flatnonzero(bad).tolist()
    assert strip.refused[0] == "member: [friction] alpha must be at least 0 s/m, got -0.5"
    assert strip_text(strip) == f"{strip.meaning}; 2 runs failed: {strip.refused[0]}"


def test_progress_is_told_where_runs_are_made_one_after_the_other_and_can_end_the_strip() -> None:
    class StopError(Exception):
        pass

    said: list[str] = []

    def told(text: str) -> None:
        said.append(text)
        if len(said) == 2:
            raise StopError

    with pytest.raises(StopError):
        strip_of(Setting.bundled("cycles-block").scenario(), Axis("friction.distance", 0.01, 0.02, 30), told)
    assert said == ["strip: 0 of 30 runs", "strip: 1 of 30 runs"]


def test_a_strip_that_is_stopped_shows_the_runs_so_far() -> None:
    def told(text: str) -> None:
        if text.startswith("strip: 3 "):
            raise Stopped

    where = Axis("friction.distance", 0.01, 0.02, 5)
    strip = strip_of(Setting.bundled("cycles-block").scenario(), where, told)
    assert np.isfinite(strip.results["slip"]).tolist() == [True] * 3 + [False] * 2
    assert strip_text(strip) == f"{strip.meaning}; 2 runs failed: it was stopped"


@pytest.mark.parametrize(
    ("name", "parameter", "expected"),
    [
        ("fig6-slab", "friction.alpha", strip_range("friction.alpha", 0.2, 5.0, log=True)),
        ("fig6-slab", "initial.slip", strip_range("initial.slip", 0.0, 1.0)),
        ("fig6-slab", "initial.load", strip_range("initial.load", 0.0, 1.0)),  # the scenario gives the excess in its place
        ("block-or-slab", "drop", strip_range("friction.parameters.drop", 0.05, 1.25, log=True)),
    ],
)
def test_the_usual_range_lies_about_the_present_value(name: str, parameter: str, expected: Axis) -> None:
    assert usual_range(Setting.bundled(name).scenario(), parameter) == expected


def test_the_usual_range_of_a_negative_number_ends_at_zero() -> None:
    scenario = SLAB.with_value("initial.slip", -0.5).scenario()
    assert usual_range(scenario, "initial.slip") == strip_range("initial.slip", -1.0, 0.0)


@pytest.mark.parametrize(
    ("name", "parameter", "value"),
    [("block-or-slab", "wavelength", 41.6), ("fig6-slab", "thickness", 1e4), ("tides-block", "run.duration", None)],
)
def test_the_present_value_is_read_in_si(name: str, parameter: str, value: float | None) -> None:
    scenario = Setting.bundled(name).scenario()
    assert present(scenario, find_parameter(scenario, parameter, "test")) == (scenario.duration if value is None else value)


def strip_with(values: list[float], log: bool) -> Strip:
    return Strip("friction.alpha", "", "s/m", np.array(values), 1.0, log, {}, {}, {})


def test_a_click_finds_the_nearest_run_on_the_scale_that_is_shown() -> None:
    assert strip_with([1.0, 2.0, 4.0], log=False).nearest(2.9) == 1
    assert strip_with([1.0, 2.0, 4.0], log=True).nearest(2.9) == 2
    assert strip_with([1.0, 2.0, 4.0], log=True).nearest(-1.0) == 0
