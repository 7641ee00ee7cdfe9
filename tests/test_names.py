"""Names, symbols and units stand in one table: a body that turns is spoken of rightly everywhere by its row of it."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
import xarray as xr
from matplotlib import pyplot

import stickslip as ss
from stickslip.cli.output.summary import show_solution
from stickslip.extensions.explorer.model.solve import solve
from stickslip.extensions.explorer.page.panels import view_of
from stickslip.foundation.names import (
    QUANTITIES,
    for_readers,
    in_files,
    name_of,
    plain_symbol,
    readable_unit,
    si_unit,
)
from stickslip.foundation.show import brief, with_unit
from stickslip.problem.bodies import as_block
from stickslip.problem.scenarios.scenario import Scenario


def turning(problem: ss.Problem) -> ss.Problem:
    """Return the problem of a block with a disc in its place, which slips by an angle under torques."""
    block = as_block(problem.body)
    return replace(problem, body=ss.RotatingBlock(block.mass, block.stiffness, block.normal_force))


@pytest.fixture
def rotor() -> Scenario:
    """A scenario of a body that turns."""
    scenario = ss.load_scenario("fig5-block-reconstructed-k")
    return replace(scenario, problem=turning(scenario.problem))


def test_units_of_a_new_kind_follow_from_its_row(rotor: Scenario) -> None:
    assert rotor.problem.load_unit == "N m"
    words = ("slip", "event_slip", "slip_rate", "peak_rate", "load", "traction", "energy", "heat", "friction", "time", "kg")
    assert [si_unit(word, "N m") for word in words] == ["rad", "rad", "rad/s", "rad/s", "N m", "N m", "J", "J", "1", "s", "kg"]
    assert (si_unit("slip"), si_unit("load"), si_unit("energy")) == ("m or rad", "Pa or N or N m", "J/m^2 or J")
    assert (name_of("traction", "N m"), name_of("slip_rate", "N m")) == ("friction torque", "rotation rate")
    assert readable_unit("N m", 2.5e4) == ("kN m", 1e3)
    assert (with_unit(2.5e4, "N m"), brief(2.5e4, "N m"), with_unit(1e-6, "rad/s")) == (
        *("25 kN m", "25 kN m"),
        "1e-06 rad/s (31.5576 rad/year)",
    )


def test_files_have_the_units_of_a_new_kind(rotor: Scenario, tmp_path: Path) -> None:
    path = ss.simulate(rotor).to_netcdf(tmp_path / "rotor.nc")
    with xr.open_dataset(path, engine="h5netcdf", decode_times=False) as file:
        found = {str(name): one.attrs.get("units", "") for name, one in file.variables.items()}
    expected = {
        **dict.fromkeys(("slip", "history_slip", "history_law_slip", "event_slip"), "rad"),
        **dict.fromkeys(("slip_rate", "history_rate", "event_peak_rate"), "rad s-1"),
        **dict.fromkeys(("traction", "load", "history_load", "ramp", "event_static_drop", "event_traction_before"), "N m"),
        **{"time": "s", "event_duration": "s", "event_pulses": "1"},
    }
    assert {name: found[name] for name in expected} == expected
    assert not [name for name, unit in found.items() if unit.split()[:1] in (["m"], ["Pa"], ["N"]) and unit != "N m"]
    run = ss.open_solution(path)
    assert isinstance(run, ss.Solution)
    assert run.problem.load_unit == "N m"
    assert {one.attrs["units"] for one in run.energy([0.0]).values()} == {"J"}


def test_a_catalogue_has_the_units_of_a_new_kind(rotor: Scenario, tmp_path: Path) -> None:
    path = tmp_path / "events.nc"
    ss.catalogue(rotor, path=path)
    with xr.open_dataset(path, engine="h5netcdf", decode_times=False) as file:
        assert [file[name].attrs["units"] for name in ("slip", "peak_rate", "traction_drop")] == ["rad", "rad s-1", "N m"]


@pytest.fixture(autouse=True)
def _close_figures() -> Iterator[None]:
    pyplot.close("all")  # tests of other files may have left some
    yield
    pyplot.close("all")


def test_figures_name_the_quantities_of_a_new_kind(rotor: Scenario) -> None:
    plot = ss.simulate(rotor).plot
    drawn: Any = {name: getattr(plot, name)().axes[0].get_ylabel() for name in ("slip", "slip_rate", "traction", "load", "energy")}
    assert drawn == {
        "slip": "angle $u$ (rad)",
        "slip_rate": "rotation rate $v$ (rad/s)",
        "traction": r"friction torque $\tau$ (TN m)",
        "load": r"load torque $\beta$ (TN m)",
        "energy": "energy (TJ)",
    }
    assert "friction and\nload torque (TN m)" in [axes.get_ylabel() for axes in plot().axes]
    assert {"angle (rad)", "angle $u$ (rad)"} <= {axes.get_ylabel() for axes in plot.catalogue().axes}
    assert plot.friction(against="slip").axes[0].get_xlabel() == "angle $u$ (rad)"


def test_steady_sliding_of_a_new_kind_has_its_units(rotor: Scenario) -> None:
    axes = ss.studies.steady(turning(ss.load_scenario("rate-and-state-block").problem)).plot().axes[0]
    assert [text.partition(" (")[2] for text in (axes.get_xlabel(), axes.get_ylabel())] == ["rad/s)", "MN m)"]


def test_tables_and_sentences_have_the_units_of_a_new_kind(rotor: Scenario, capsys: pytest.CaptureFixture[str]) -> None:
    run = ss.simulate(rotor)
    show_solution(rotor, run)
    text = capsys.readouterr().out
    assert text.count("TN m") == 2
    assert {"rad", "rad/s"} <= set(text.split())
    assert "of the normal torque" in text
    assert re.search(r" of [\d.]+ rad in .*at up to [\d.]+ rpm", repr(run))
    assert {"slip (rad)", "static_drop (N m)"} <= set(ss.studies.compare(run, run)._shown_table().index)


def test_the_explorer_names_the_quantities_of_a_new_kind(rotor: Scenario) -> None:
    view = view_of(solve(rotor))
    assert [view.titles[name] for name in ("slip", "rate", "traction")] == [
        "Angle u (rad)",
        "Rotation rate v (rad/s)",
        "Friction torque τ (TN m)",
    ]
    assert [(one["symbol"], one["unit"]) for one in view.facts["read"]] == [("u", "rad"), ("v", "rad/s"), ("τ", "TN m")]
    numbers = {one.name: one.unit for one in solve(rotor).numbers}
    assert (numbers["slip in all"], numbers["largest slip rate"], numbers["drop of the traction"]) == ("rad", "rad/s", "N m")


@pytest.mark.parametrize(
    ("unit", "file", "readers"),
    [("m/s", "m s-1", "m/s"), ("J/m^2", "J m-2", "J/m²"), ("rad/s", "rad s-1", "rad/s"), ("N m", "N m", "N m"), ("1", "1", "1")],
)
def test_files_and_readers_have_spellings_of_their_own(unit: str, file: str, readers: str) -> None:
    assert in_files(unit) == file
    assert for_readers(file) == for_readers(unit) == readers


@pytest.mark.parametrize(("unit", "readers"), [("m^-1 s", "s/m"), ("1/m", "m⁻¹"), ("kg/m^3", "kg/m³"), ("m s^-1", "m/s"), ("", "")])
def test_declared_units_are_spelled_for_readers(unit: str, readers: str) -> None:
    assert for_readers(unit) == readers


def test_symbols_are_plain_where_no_mathtext_is_drawn() -> None:
    assert [plain_symbol(name) for name in ("slip", "slip_rate", "traction", "load", "friction")] == ["u", "v", "τ", "β", "μ"]


@pytest.mark.parametrize(
    ("unit", "value", "name"),
    [("Pa", 2.5e7, "MPa"), ("Pa", 0.2, "Pa"), ("m", 1e-5, "m"), ("s", 1e9, "s"), ("J", 3e9, "GJ"), ("Pa", float("nan"), "Pa")],
)
def test_plain_text_takes_prefixes_for_large_numbers_only(unit: str, value: float, name: str) -> None:
    assert readable_unit(unit, value, plain=True)[0] == name


def test_every_unit_is_one_that_is_understood() -> None:
    for name, one in QUANTITIES.items():
        assert si_unit(name, "Pa") in ("m", "m/s", "Pa", "N", "N m", "J/m^2", "1", "s"), one
