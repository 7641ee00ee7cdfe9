"""Bodies of layers in scenarios: what the bundled ones do, what `check` says, and which doors are open."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import stickslip as ss
from stickslip.run.check.examine import examine
from tests.messages import refused

NAMES = ("bowed-string-tenth", "low-velocity-zone", "steel-on-granite")
STRING = "pipe-and-collar"


def facts(name: str) -> dict[str, float | str]:
    return {one.name: one.value for one in examine(ss.load_scenario(name)).derived}


def test_the_fault_with_a_soft_layer_slips_twice() -> None:
    run = ss.simulate("low-velocity-zone")
    np.testing.assert_allclose(run.events.start, [0.0, 18 * TIME], rtol=1e-12, atol=1e-12)
    np.testing.assert_allclose(run.events.end, [2 * TIME, 20 * TIME], rtol=1e-12)
    np.testing.assert_allclose(run.events.peak_rate, [9.204081633, 13.965527813], rtol=1e-9)
    np.testing.assert_allclose(run.slip(35.0), 26.479553652, rtol=1e-10)


TIME = 1000.0 / 1750.0
"""The time (s) that a wave takes to cross the soft layer of low-velocity-zone, that of a cell."""


def test_the_string_slips_for_a_tenth_of_a_period() -> None:
    events = ss.simulate("bowed-string-tenth").events
    period = 2 * 0.69 / 202.6
    np.testing.assert_allclose(events.duration, 0.1 * period, rtol=1e-6)
    apart = np.diff(events.start) / period
    assert np.count_nonzero(np.abs(apart - 1.0) < 1e-6) == len(apart) - 2  # two slips are missing
    assert events.peak_rate.between(0.51, 0.61).all()


def test_plates_of_steel_and_granite_slip_within_two_round_trips() -> None:
    events = ss.simulate("steel-on-granite").events
    assert len(events) == 12
    assert (events.duration < 61e-6).all()
    np.testing.assert_allclose(events.recurrence[1:].mean(), 2.618e-3, rtol=1e-3)


def test_check_shows_layers_and_cells() -> None:
    found = facts("low-velocity-zone")
    assert (found["cells"], found["error"], found["r"]) == (5.0, 0.0, -1.0)
    assert found["Z of layer 1"] == pytest.approx(4.9e6)
    assert found["r of 1, 2"] == pytest.approx(-1 / 3)
    assert found["R"] == pytest.approx(10 * TIME)
    assert found["G/h"] == pytest.approx(1 / (1e3 / (2800 * 1750**2) + 8e3 / (2800 * 3500**2)))
    string = {one.name: one for one in examine(ss.load_scenario("pipe-and-collar")).derived}
    assert [string[name].unit for name in ("Z of section 2", "GJ/h", "GJ V/h")] == ["N m s", "N m/rad", "N m/s"]
    assert "where section 1 meets section 2" in string["r of 1, 2"].meaning
    other = facts("steel-on-granite")
    assert other["Z"] == pytest.approx(1 / (1 / (7850 * 3200) + 1 / (2650 * 3000)))
    assert other["Z of other layer 1"] == pytest.approx(2650 * 3000)


def test_check_warns_of_rest_that_is_walked_through() -> None:
    long = ss.load_scenario("low-velocity-zone").with_values({"duration": "1 year"})
    (warning,) = examine(long).warnings
    assert "at least 2.8e+07 pieces, each of 5 cells; under long loading give drag, or a driver of finite impedance" in warning
    assert not examine(long.with_values({"driver_impedance": 2e8})).warnings
    heavy = {"driver_impedance": 2e8, "driver_inertia": 1e8, "driver_integral_gain": 1e6}
    (warning,) = examine(long.with_values(heavy)).warnings
    assert warning.startswith("a driver with a mass sends sharp waves back whole")
    assert warning.endswith("under long loading set driver_inertia to 0")
    assert "the run ends before the first echo returns at R = 1.14286 s" in examine(long.with_values({"duration": 1.0})).warnings


@pytest.mark.sampled(every=5)
@pytest.mark.parametrize("name", [*NAMES, STRING])
def test_a_run_that_is_saved_goes_on_to_the_bit(name: str, tmp_path: Path) -> None:
    scenario = ss.load_scenario(name)
    whole, half = ss.simulate(scenario), ss.simulate(scenario, 0.4 * scenario.duration)
    half.to_netcdf(tmp_path / "half.nc")
    on = ss.resume(tmp_path / "half.nc", scenario.duration)
    times = np.linspace(0.0, scenario.duration, 501)
    np.testing.assert_array_equal(on.slip_rate(times), whole.slip_rate(times))
    assert on.events.equals(whole.events)


def test_numbers_of_layers_are_parameters() -> None:
    scenario = ss.load_scenario("low-velocity-zone").with_values({"body.wave_speed[0]": "2000 m/s", "thickness[1]": 7e3})
    assert tuple(scenario.problem.body.wave_speed) == (2000.0, 3500.0)
    assert tuple(scenario.problem.body.thickness) == (1000.0, 7000.0)


@pytest.mark.parametrize("name", ["low-velocity-zone", "steel-on-granite", STRING])
def test_leaps_that_bodies_of_layers_do_not_have_are_refused_in_one_line(name: str) -> None:
    with refused(begins="simulate: creep_rtol"):
        ss.simulate(name, creep_rtol=1e-6)


@pytest.mark.parametrize("name", ["body.thickness", "thickness"])
def test_a_list_without_an_index_is_told_how_to_name_an_entry(name: str) -> None:
    with refused("it is a list: name one of its entries, such as body.thickness[0]"):
        ss.load_scenario("low-velocity-zone").with_values({name: 2e3})
