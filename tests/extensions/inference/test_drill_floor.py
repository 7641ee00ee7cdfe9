"""Logs of a drill floor: mnemonics and units of the trade, and torque and speed that are measured at the drive."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import stickslip as ss
from stickslip.extensions.inference.beside import RecordBeside
from stickslip.extensions.inference.record.record import Record

RPM = math.pi / 30.0
KFT_LBF = 1000.0 * 0.3048 * 4.4482216152605  # N m
KLBF = 4448.2216152605  # N
PIPE: dict[str, Any] = {"density": 7850.0, "shear_modulus": 61e9, "outer_diameter": 0.146529, "inner_diameter": 0.123024}
ON_BIT: dict[str, Any] = {"weight_on_bit": 97e3, "bit_radius": 0.155}
SOFT: dict[str, Any] = {"driver_impedance": 1e3, "driver_inertia": 2900.0, "driver_integral_gain": 500.0}
STRING = ss.TorsionalString(1200.0, **PIPE, **ON_BIT, **SOFT, inertia=300.0)
BIT = ss.friction.ExponentialStribeck(static=0.8, dynamic=0.5, rate=1.1, exponent=1, viscosity=0.0033)
TRUE = ss.Problem(STRING, BIT, pull_rate="60 rpm", initial_load=0.0)
TIME = np.linspace(0.0, 14.0, 141)
ELSEWHERE = replace(TRUE, friction=replace(BIT, static=0.76, dynamic=0.47))
NOISE = 60.0
"""Noise of the torque, N m."""


def log(problem: ss.Problem = TRUE) -> dict[str, Any]:
    """Return what a drill floor logs of a run, with noise."""
    run, random = ss.simulate(problem, TIME[-1]), np.random.default_rng(1)
    torque = run.surface_torque(TIME) + random.normal(0.0, NOISE, TIME.size)
    speed = run.drive_rate(TIME) / RPM + random.normal(0.0, 0.2, TIME.size)
    return {
        "TIME (s)": TIME,
        "STOR (kft.lbf)": torque / KFT_LBF,
        "RPM": speed,
        "SWOB (klbf)": np.full(TIME.size, 97e3 / KLBF),
        "HKLD (klbf)": np.full(TIME.size, 210.0),
        "DBTM (m)": np.full(TIME.size, 1400.0),
    }


LOG = log()


@pytest.mark.parametrize("heading", ["STOR (kft.lbf)", "TQA (kft.lbf)", "Surface Torque (kft-lb)", "surface_torque (kft.lbf)"])
def test_the_torque_of_a_drill_floor_is_read_as_that_at_the_drive(heading: str) -> None:
    read = Record.read({"time (s)": TIME, heading: LOG["STOR (kft.lbf)"]})
    assert list(read.measured) == ["surface_torque"]
    assert read.measured["surface_torque"] == pytest.approx(LOG["STOR (kft.lbf)"] * KFT_LBF, rel=1e-12)


@pytest.mark.parametrize(
    "heading", ["RPM", "SRPM", "RPMA", "Surface RPM", "drive rpm", "top drive RPM", "Rotary Speed (rpm)", "rpm"]
)
def test_a_speed_called_rpm_is_in_rpm_without_saying_so(heading: str) -> None:
    read = Record.read({"time (s)": TIME, "STOR (N m)": TIME, heading: LOG["RPM"]})
    assert read.load_rate == pytest.approx(LOG["RPM"] * RPM, rel=1e-12)


def test_columns_of_a_drill_floor_that_no_fit_needs_are_named_by_what_they_are() -> None:
    read = Record.read(LOG | {"XYZ": TIME})
    text = "; ".join(read.notes)
    assert "'HKLD (klbf)' (hook load), 'DBTM (m)' (depth of the bit)" in text
    assert "columns that were not understood: 'XYZ'" in text
    assert read.normal_name == "weight_on_bit"
    assert read.normal == pytest.approx(np.full(TIME.size, 97e3), rel=1e-12)


@pytest.mark.parametrize("speed", ["rpm", "RPM", "rev/min"])
def test_units_in_a_row_below_the_mnemonics_are_read(speed: str, tmp_path: Path) -> None:
    rows = [f"{t:.7g},{torque:.9g},{turn:.9g}" for t, torque, turn in zip(TIME, LOG["STOR (kft.lbf)"], LOG["RPM"], strict=True)]
    (tmp_path / "floor.csv").write_text("\n".join(["TIME,STOR,RPM", f"s,kft.lbf,{speed}", *rows]))
    read = Record.read(tmp_path / "floor.csv")
    assert read.measured["surface_torque"] == pytest.approx(LOG["STOR (kft.lbf)"] * KFT_LBF, rel=1e-8)
    assert read.load_rate == pytest.approx(LOG["RPM"] * RPM, rel=1e-8)


def within(found: Any, name: str, true: float, widest: float) -> None:
    """Assert that a number is found to within four of its standard errors, which are small."""
    row = found.table.loc[name]
    assert abs(row.value - true) < 4.0 * row.uncertainty < widest


def test_a_law_at_the_bit_is_found_from_torque_and_speed_at_a_drive_that_gives_way() -> None:
    found = ss.studies.infer(ELSEWHERE, LOG, ["static", "dynamic"], observe="surface_torque,drive_rate", starts=1)
    within(found, "friction.static", 0.8, 4e-3)
    within(found, "friction.dynamic", 0.5, 4e-3)
    assert found.model.sizes["surface_torque"] == pytest.approx(NOISE, rel=0.3)
    assert found.model.sizes["drive_rate"] == pytest.approx(0.2 * RPM, rel=0.3)
    assert "the torque is that at the drive, which waves from the bit reach later" in found.about


@pytest.mark.slow
def test_a_torque_without_a_place_is_at_the_drive_if_the_sensor_is_said_to_be_there() -> None:
    stiff = replace(TRUE, body=replace(STRING, driver_impedance=math.inf, driver_inertia=0.0, driver_integral_gain=0.0))
    given = log(stiff)
    plain = {"time (s)": TIME, "torque (kft.lbf)": given["STOR (kft.lbf)"], "RPM": np.full(TIME.size, 60.0)}
    begun = replace(stiff, friction=replace(BIT, static=0.78))
    found = ss.studies.infer(begun, plain, ["static"], sensor="drive", starts=1)
    within(found, "friction.static", 0.8, 4e-3)
    wrong = ss.studies.infer(begun, plain, ["static"], start="problem", starts=1)
    assert wrong.model.sizes["torque"] > 10.0 * found.model.sizes["torque"]
    assert any("sensor='drive' takes it as that at the drive" in note for note in wrong.about)


def test_a_speed_at_a_drive_that_gives_way_is_told_to_be_what_it_is_asked_for() -> None:
    found = ss.studies.infer(TRUE, {**LOG, "RPM": np.full(TIME.size, 60.0)}, ["static"], starts=1)
    assert any(note.startswith("the speed of the drive is taken as what it is asked for: observe=") for note in found.about)


def test_a_speed_that_swings_moves_a_rigid_drive_along_straight_lines() -> None:
    stiff = replace(TRUE, body=replace(STRING, driver_impedance=math.inf, driver_inertia=0.0, driver_integral_gain=0.0))
    found = ss.studies.infer(stiff, LOG, ["static"], starts=1)
    loading = found.model.parts[0].loading
    assert isinstance(loading, ss.loading.PiecewiseLinear)
    assert not isinstance(loading, ss.loading.Steps)
    true = ss.simulate(TRUE, TIME[-1]).drive_rate(TIME)
    assert np.std(loading.at(TIME) - true) < 0.4 * RPM  # twice the noise
    assert found.table.loc["friction.static"].value == pytest.approx(0.8, abs=0.01)
    assert any("the error with which it was measured is not in the intervals" in note for note in found.about)


@pytest.mark.slow
def test_the_weight_on_the_bit_presses_the_bit_as_it_was_measured() -> None:
    weight = 97e3 * np.where(TIME < 7.0, 1.0, 1.1)
    pressed = ss.loading.PiecewiseLinear([0.0, 6.99, 7.01], [97e3 * 0.155, 97e3 * 0.155, 1.1 * 97e3 * 0.155])
    given = log(replace(TRUE, normal_load=pressed)) | {"SWOB (klbf)": weight / KLBF}
    found = ss.studies.infer(ELSEWHERE, given, ["static"], observe="surface_torque,drive_rate", normal="record", starts=1)
    assert found.model.parts[0].pressing.at([1.0, 13.0]) == pytest.approx([97e3 * 0.155, 1.1 * 97e3 * 0.155], rel=1e-6)


@pytest.mark.slow
def test_a_weight_other_than_that_of_the_problem_is_told() -> None:
    given = LOG | {"SWOB (klbf)": np.full(TIME.size, 60e3 / KLBF)}
    found = ss.studies.infer(TRUE, given, ["static"], observe="surface_torque,drive_rate", starts=1)
    assert "the weight on the bit is 60 kN in the median of the record, and 97 kN in the problem" in found.about


SLAB = ss.Problem(ss.ElasticSlab(2700.0, 3000.0, 3000.0, 50e6), ss.friction.Coulomb(0.8, 0.5), pull_rate=1e-9, initial_load=1e6)


@pytest.mark.parametrize(
    ("problem", "options", "message"),
    [
        (SLAB, {}, r"the loads of a slab are in Pa, and surface_torque in N m"),
        (SLAB, {"observe": "drive_rate"}, r"drive_rate in rad, where slip of a contact of ElasticSlab is in m"),
        (TRUE, {"parts": "rests"}, r"parts='rests' begins each run with the load at the contact, which a sensor at the drive does"),
        (TRUE, {"by": "features"}, r"features are those of slip events, and waves from many of them are in the torque at a drive"),
        (TRUE, {"sensor": "top"}, r"infer: sensor 'top' is unknown; allowed: contact, drive, spring"),
        (
            TRUE,
            {"sensor": "spring"},
            r"infer: sensor 'spring' is the load cell .* of a block: a string has none; sensor 'drive' is one at its driver",
        ),
        (TRUE, {"observe": "torque"}, r"infer: observe: the record has no 'torque'; did you mean 'surface_torque'"),
    ],
)
def test_what_a_log_cannot_be_used_for_is_refused_in_one_line(problem: ss.Problem, options: Any, message: str) -> None:
    given = LOG if problem is TRUE else {"time (s)": TIME, "STOR (kft.lbf)": TIME}
    given = given | ({"drive_rate (rpm)": TIME} if options.get("observe") == "drive_rate" else {})
    with pytest.raises(ss.InputError, match=message) as error:
        ss.studies.infer(problem, given, ["static"], **options)
    assert "\n" not in str(error.value)


def test_a_log_behind_a_run_in_the_explorer_is_compared_with_the_torque_at_the_drive(tmp_path: Path) -> None:
    lines = [",".join(LOG), *(",".join(f"{value:.7g}" for value in row) for row in zip(*LOG.values(), strict=True))]
    (tmp_path / "floor.csv").write_text("\n".join(lines))
    behind = RecordBeside.of(Record.read(tmp_path / "floor.csv"), "contact", TRUE, "explore").beside(ss.simulate(TRUE, TIME[-1]))
    assert list(behind.misfits) == ["surface_torque"]
    assert behind.misfits["surface_torque"][0] == pytest.approx(NOISE, rel=0.2)


@pytest.mark.slow
def test_a_law_is_found_from_the_log_of_a_string_of_two_sections() -> None:
    steel = {"density": [7850.0] * 2, "shear_modulus": [79.3e9] * 2}
    body = ss.SectionedString([180.0, 1200.0], [0.165, 0.127], [0.0714, 0.10861], **steel, **ON_BIT, **SOFT, inertia=300.0)
    true = ss.Problem(body, BIT, pull_rate="60 rpm", initial_load=0.0)
    begun = replace(true, friction=replace(BIT, dynamic=0.48))
    found = ss.studies.infer(begun, log(true), ["dynamic"], observe="surface_torque,drive_rate", starts=1)
    within(found, "friction.dynamic", 0.5, 4e-3)
