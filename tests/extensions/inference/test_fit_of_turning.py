"""Points of a contact that turns: read in rpm, degrees and N m, fitted, smoothed, drawn, and written for a body that turns."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import stickslip as ss
from stickslip.extensions.inference.figures.measured import measured_data
from stickslip.friction import FromTable, Points, fit, smooth

RPM = 2.0 * np.pi / 60.0
SPEEDS = np.linspace(0.0, 120.0, 41)
LAW = ss.friction.ExponentialStribeck(static=0.8, dynamic=0.5, rate=10.0 * RPM)
TABLE = {
    "bit speed (rpm)": SPEEDS,
    "torque (kN m)": 15.0 * LAW.coefficient(0.0, SPEEDS * RPM),
    "normal torque (kN m)": 15.0 + 0.0 * SPEEDS,
}
STRING = ss.load_scenario("drill-string").problem
SLAB = ss.load_scenario("fig6-slab").problem


def test_points_in_rpm_and_newton_metres_are_those_in_rad_per_second() -> None:
    points = Points.read(TABLE)
    assert (points.slips_in, points.has) == ("rad", ("slip_rate",))
    np.testing.assert_allclose(points.places, SPEEDS * RPM, rtol=1e-14)
    assert "slip_rate 0 to 12.6 rad/s" in repr(points)
    turned = Points.read({"angle": [0, 1], "slip (deg)": [0.0, 180.0], "friction": [0.6, 0.5]})
    np.testing.assert_allclose(turned.places, [0.0, np.pi])
    assert Points.read({"v (mm/s)": [0, 1], "mu": [0.6, 0.5]}).slips_in == ""


def test_a_fitted_law_knows_that_its_numbers_are_angles() -> None:
    found = fit(Points.read(TABLE), "exponential-stribeck", fixed={"viscosity": 0.0}, start={"rate": "20 rpm"})
    assert found.law.rate == pytest.approx(LAW.rate, rel=1e-6)  # type: ignore[attr-defined] # of the law that was asked for
    units = {name: unit for name, _, unit in found.rows}
    assert units["rate"] == "rad/s"
    assert found.law.slips_in == "rad"
    assert ss.Problem(STRING.body, found.law, initial_excess=0.0).friction == found.law
    with pytest.raises(ss.InputError, match=r"has numbers in rad or rad/s, but a contact of ElasticSlab slides"):
        ss.Problem(SLAB.body, found.law, initial_excess=0.0)
    drawn = measured_data(found)["place"].attrs
    assert drawn["units"] == "rad/s"
    with pytest.raises(ss.InputError, match=r"^fit: start rate must be a number in rad/s or a text"):
        fit(Points.read(TABLE), "exponential-stribeck", start={"rate": "1 mm/s"})


def test_smooth_and_joined_points_know_it_too() -> None:
    points = Points.read(TABLE)
    for law in (smooth(points).law, FromTable(points), FromTable(TABLE)):
        assert law.slips_in == "rad"
        with pytest.raises(ss.InputError, match=r"slides: give them in m and m/s"):
            ss.Problem(SLAB.body, law, initial_excess=0.0)


def test_a_length_beside_an_angle_is_refused() -> None:
    with pytest.raises(ss.InputError, match=r"slip is a length, and slip_rate an angle: a contact slides, or it turns$"):
        Points.read({"slip (mm)": [0, 1], "v (rpm)": [0, 1], "mu": [0.6, 0.5]})


def test_fit_takes_a_string_by_itself_and_refuses_a_slab(tmp_path: Path) -> None:
    from stickslip.problem.scenarios.templates import with_law

    found = fit(Points.read(TABLE), "exponential-stribeck", fixed={"viscosity": 0.0})
    (tmp_path / "string.toml").write_text(with_law("string", found.law, ["from points"]), encoding="utf-8")
    made = ss.load_scenario(tmp_path / "string.toml").problem
    assert made.body.kind == "torsional-string"
    assert made.friction.rate == found.law.rate  # type: ignore[attr-defined] # as above
    with pytest.raises(ss.InputError, match=r"^slab: the points are in rad, but its contact slides: name another scenario$"):
        with_law("slab", found.law, ["from points"])
