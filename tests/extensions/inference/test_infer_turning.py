"""Records of contacts that turn: torque in N m, angles in deg, rates in rpm."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import stickslip as ss
from stickslip.extensions.inference.beside import RecordBeside
from stickslip.extensions.inference.record.record import Record

RPM = math.pi / 30.0
LAW = ss.friction.ExponentialStribeck(static=0.8, dynamic=0.5, rate="5 rpm", exponent=1, viscosity="0.002 s/rad")
DISC = ss.RotatingBlock(inertia=2.0, stiffness=400.0, normal_torque=60.0, damping=3.0)
TRUE = ss.Problem(DISC, LAW, pull_rate="20 rpm", initial_load="40 N m")
TIME = np.linspace(0.0, 1.2, 241)
NOISE = 0.3
"""Noise of torque (N m) and of rates (rpm)."""


def record(problem: ss.Problem, **columns: Any) -> dict[str, Any]:
    """Return what is measured in a run of a problem, with noise, and a drive at a steady rate."""
    run, random = ss.simulate(problem, TIME[-1]), np.random.default_rng(1)
    torque = run.traction(TIME) + random.normal(0.0, NOISE, TIME.size)
    bit = run.slip_rate(TIME) / RPM + random.normal(0.0, NOISE, TIME.size)
    drive = np.full(TIME.size, problem.first_pull_rate / RPM)
    return {"time (s)": TIME, "torque (N m)": torque, "bit speed (rpm)": bit, "drive speed (rpm)": drive} | columns


@pytest.mark.slow
def test_a_law_is_found_in_a_record_of_torque_and_rpm() -> None:
    begun = replace(TRUE, friction=replace(LAW, static=0.77, dynamic=0.46), pull_rate=1.0)
    found = ss.studies.infer(begun, record(TRUE), free=["static", "dynamic"], start="problem", observe=["torque", "slip_rate"])
    for name, true in (("friction.static", 0.8), ("friction.dynamic", 0.5)):
        row = found.table.loc[name]
        assert abs(row.value - true) < 4.0 * row.uncertainty < 8e-3
    text = str(found)
    assert "torque 0." in text
    assert "N m, slip_rate 0." in text
    assert "rpm" in text
    assert "m/s" not in text
    assert found.model.parts[0].loading == pytest.approx(20.0 * RPM, rel=1e-9)


def test_angles_are_read_with_their_units_and_torque_over_torque_is_friction() -> None:
    read = Record.read(record(TRUE) | {"slip (deg)": TIME, "normal torque (kN m)": np.full(TIME.size, 0.06)})
    assert (read.slips_in, sorted(read.measured)) == ("rad", ["friction", "slip", "slip_rate"])
    assert read.measured["slip"] == pytest.approx(np.radians(TIME))
    assert read.load_rate == pytest.approx(20.0 * RPM)
    assert np.median(read.measured["friction"]) == pytest.approx(0.5, abs=0.1)


def test_a_record_is_put_beside_a_contact_that_turns() -> None:
    run = ss.simulate(TRUE, TIME[-1])
    behind = RecordBeside.of(Record.read(record(TRUE)), "contact", TRUE, "explore").beside(run)
    assert {name: unit for name, (_, unit) in behind.misfits.items()} == {"torque": "N m", "slip_rate": "rad/s"}
    assert [size for size, _ in behind.misfits.values()] == pytest.approx([NOISE, NOISE * RPM], rel=0.2)


SLIDES = ss.Problem(ss.SpringBlock(2.0, 400.0, 60.0), ss.friction.Coulomb(0.8, 0.5), pull_rate=1.0, initial_load=0.0)
TURNED = record(TRUE)
TORQUE = {name: TURNED[name] for name in ("time (s)", "torque (N m)", "drive speed (rpm)")}


@pytest.mark.parametrize(
    ("problem", "given", "message"),
    [
        (SLIDES, TURNED, "record: slip_rate in rad, where slip of a contact of SpringBlock is in m"),
        (SLIDES, TORQUE, "record: the loads of a block are in N, and torque in N m: give normal_torque beside it, .*"),
        (TRUE, {"time (s)": TIME, "slip (mm)": TIME}, "record: slip in m, where slip of a contact of RotatingBlock is in rad"),
        (
            TRUE,
            {"time (s)": TIME, "tau (Pa)": TIME},
            "record: the loads of a block are in N m, and shear_stress in Pa: .*",
        ),
        (TRUE, TORQUE | {"torque (N m)": 1e3 * TURNED["torque (N m)"]}, "record: torque is .* normal torque of 60 N m.*"),
        (TRUE, TURNED | {"slip (mm)": TIME}, "record: slip is a length, and slip_rate an angle: a contact slides, or it turns"),
    ],
)
def test_records_of_another_kind_of_motion_are_refused_in_one_line(problem: ss.Problem, given: Any, message: str) -> None:
    with pytest.raises(ss.InputError, match=rf"^{message}$") as error:
        ss.studies.infer(problem, given, free=["static"])
    assert "\n" not in str(error.value)
