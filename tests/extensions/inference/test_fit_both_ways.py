"""Friction that was measured in both directions, or as a force: layouts of rigs, what a fit makes of them, and what is refused."""

from __future__ import annotations

import warnings
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

import stickslip as ss
from stickslip.cli.app import app
from stickslip.extensions.inference.figures.measured import measured_data
from stickslip.extensions.inference.points.fit_both_ways import FitBothWays
from stickslip.foundation.errors import InputWarning
from stickslip.friction import BothWays, ExponentialStribeck, FromTable, Points, fit, smooth

FORWARD = ExponentialStribeck(static=0.7, dynamic=0.3, rate=0.05, exponent=1, viscosity=0.6)
BACKWARD = ExponentialStribeck(static=0.5, dynamic=0.2, rate=0.05, exponent=1, viscosity=0.4)
RATES = np.geomspace(1e-3, 0.5, 60)


def axis_file(path: Path, forward: ExponentialStribeck, backward: ExponentialStribeck, normal: float, noise: float) -> Path:
    """Write a file as of the identification of an axis: velocities of both signs, and the force of friction in N."""
    rng = np.random.default_rng(11)
    with path.open("w") as file:
        file.write("% axis X, constant velocity runs\nAxis velocity (mm/s);Friction force (N)\n")
        for way, law in ((-1, backward), (1, forward)):
            force = way * normal * (law.coefficient(0.0, RATES) + noise * rng.standard_normal(len(RATES)))
            file.writelines(f"{1e3 * way * v:.8g};{f:.8g}\n" for v, f in zip(RATES, force, strict=True))
    return path


@pytest.mark.slow
def test_the_two_laws_of_an_axis_come_back(tmp_path: Path) -> None:
    """Parameters within three standard uncertainties, which are below 5 %; the mean difference of friction within three, too."""
    found = fit(
        Points.read(axis_file(tmp_path / "axis.csv", FORWARD, BACKWARD, 30.0, 0.003), normal_force="30 N"), "exponential-stribeck"
    )
    assert isinstance(found, FitBothWays)
    assert isinstance(found.law, BothWays)
    for way, law in (("forward", FORWARD), ("backward", BACKWARD)):
        for name in ("static", "dynamic", "rate", "viscosity"):
            apart = found.values[f"{way}.{name}"] - getattr(law, name)
            assert abs(apart) < 3.0 * found.uncertainty[f"{way}.{name}"] < 0.2 * getattr(law, name)
    assert "friction forwards is on average 0.17" in found.notes[0]
    low, error = found.band(0.0, [-0.1, 0.1])
    assert low[0] == pytest.approx(-float(BACKWARD.coefficient(0.0, 0.1)), abs=4.0 * error[0], rel=0.0)
    assert low[1] == pytest.approx(float(FORWARD.coefficient(0.0, 0.1)), abs=4.0 * error[1], rel=0.0)
    drawn = measured_data(found)
    assert drawn["friction"].values.min() < -0.4
    assert drawn["friction"].values.max() > 0.6
    assert np.abs(drawn["difference"].values).max() < 0.02
    assert (np.diff(drawn["along"].values) >= 0.0).all()


@pytest.mark.slow
def test_one_law_is_found_where_both_directions_have_the_same(tmp_path: Path) -> None:
    points = Points.read(axis_file(tmp_path / "axis.csv", FORWARD, FORWARD, 30.0, 0.003), normal_force="30 N")
    found = fit(points, "exponential-stribeck")
    assert isinstance(found.law, ExponentialStribeck)
    assert found.law.static == pytest.approx(0.7, abs=0.01, rel=0.0)
    assert len(found.points) == 120
    assert "one law for both directions, 60 points forwards and 60 backwards" in found.notes[-1]


def test_a_force_and_its_normal_force_make_the_law_of_the_coefficient(tmp_path: Path) -> None:
    """To 1e-7, the digits of the file; a normal force of 1 N makes a law in N."""
    path = axis_file(tmp_path / "axis.csv", FORWARD, BACKWARD, 30.0, 0.0)
    for given, scale in (("30 N", 1.0), ("0.03 kN", 1.0), (1.0, 30.0)):
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # a force in place of the coefficient is questioned
            points = Points.read(path, normal_force=given)
        ahead, behind = points.ways
        assert np.allclose(np.sort(ahead.friction), np.sort(scale * FORWARD.coefficient(0.0, RATES)), rtol=1e-7, atol=0.0)
        assert np.allclose(np.sort(behind.friction), np.sort(scale * BACKWARD.coefficient(0.0, RATES)), rtol=1e-7, atol=0.0)


def test_a_table_of_each_direction_makes_a_law_of_both(tmp_path: Path) -> None:
    points = Points.read({"v": [-0.2, -0.1, 0.0, 0.1, 0.2], "mu": [-0.3, -0.4, 0.6, 0.5, 0.45]})
    law = BothWays(
        *(FromTable({"v": np.sort(one.slip_rate), "mu": one.friction[np.argsort(one.slip_rate)]}) for one in points.ways)
    )
    assert float(law.coefficient(0.0, 0.1)) == 0.5
    assert float(law.ways[1].coefficient(0.0, 0.2)) == 0.3
    for refused in (FromTable, smooth):
        with pytest.raises(ss.InputError, match=r"slip was measured in both directions: .*points\.ways"):
            refused(points)


def test_magnitudes_of_friction_beside_signed_rates_are_taken_and_mixed_signs_are_not() -> None:
    points = Points.read({"v": [-0.2, -0.1, 0.1, 0.2], "mu": [0.3, 0.4, 0.5, 0.45]})
    assert points.backward is not None
    assert points.backward.friction.tolist() == [0.3, 0.4]
    with pytest.raises(
        ss.InputError, match=r"row 1: friction must have the sign of slip_rate, or none in all rows, got 0.4 at -0.1"
    ):
        Points.read({"v": [-0.2, -0.1, 0.1, 0.2], "mu": [-0.3, 0.4, 0.5, 0.45]})
    with pytest.raises(ss.InputError, match=r"row 1: friction must not be negative, got -0\.4"):
        Points.read({"v": [0.1, 0.2], "mu": [0.3, -0.4]})


def test_a_mini_traction_machine_and_a_pin_on_disc_are_read_as_they_write(tmp_path: Path) -> None:
    """Slip rate is SRR times rolling speed, to 1e-15; COF and traction coefficient are friction."""
    ratio = np.arange(1.0, 50.0)
    traction = tmp_path / "mtm.csv"
    traction.write_text(
        "MTM2, ball on disc, 50 N\nSRR (%),Rolling speed (mm/s),Traction coefficient\n"
        + "".join(f"{one},200,{0.02 + 0.03 * np.exp(-one / 20.0):.9f}\n" for one in ratio)
    )
    points = Points.read(traction)
    assert np.allclose(points.places, ratio / 100.0 * 0.2, rtol=1e-15, atol=0.0)
    assert np.allclose(points.friction, 0.02 + 0.03 * np.exp(-ratio / 20.0), rtol=0.0, atol=1e-9)
    bare = Points.read({"SRR": ratio, "Rolling speed (m/s)": np.full(49, 0.2), "Traction coefficient": points.friction})
    assert np.allclose(bare.places, points.places, rtol=1e-15, atol=0.0)
    for heading in ("COF", "CoF", "mu", "friction coeff", "Friction Coefficient", "Traction Coeff"):
        pin = Points.read({"Sliding speed (m/s)": [0.1, 0.2, 0.3], heading: [0.4, 0.35, 0.3]})
        assert pin.friction.tolist() == [0.4, 0.35, 0.3]


def test_a_force_without_a_normal_force_is_questioned_in_one_line(tmp_path: Path) -> None:
    path = axis_file(tmp_path / "axis.csv", FORWARD, BACKWARD, 30.0, 0.0)
    with pytest.raises(
        ss.InputError, match="no column 'friction'; with shear_force give its normal force, `--normal-force '100 N'`"
    ):
        Points.read(path)
    with pytest.raises(ss.InputError, match="with torque give its normal torque, `--normal-force '100 N m'`"):
        Points.read({"v (rpm)": [1, 2], "torque (N m)": [4, 3]})
    with pytest.raises(ss.InputError, match="a force is shear_force and needs --normal-force"):
        Points.read(path, columns={"friction": "Friction force"})
    with pytest.warns(InputWarning, match=r"friction reaches 41: .* give its normal force: `--normal-force '100 N'`"):
        Points.read({"v (m/s)": [0.1, 0.2, 0.3], "Reibung": [17.0, 29.0, 41.0]}, columns={"friction": "Reibung"})
    with pytest.raises(ss.InputError, match="normal_force: there is a column of friction, which needs none"):
        Points.read({"v (m/s)": [0.1, 0.2], "mu": [0.5, 0.4]}, normal_force="10 N")
    with pytest.raises(ss.InputError, match="normal_force must be"):
        Points.read(path, normal_force="-3 N")


def test_the_command_fits_both_directions_of_a_force_and_writes_a_scenario(tmp_path: Path) -> None:
    path, out = axis_file(tmp_path / "axis.csv", FORWARD, BACKWARD, 30.0, 0.003), tmp_path / "mine.toml"
    typed = ["fit", str(path), "--law", "exponential-stribeck", "--normal-force", "30 N", "--out", str(out), "--body", "block"]
    done = CliRunner().invoke(app, typed)
    assert done.exit_code == 0, done.output
    assert "exponential-stribeck, both ways fitted to 120 points" in done.output
    law = ss.load_scenario(out).problem.friction
    assert isinstance(law, BothWays)
    assert law.forward.static == pytest.approx(0.7, abs=0.02, rel=0.0)
    assert law.backward.static == pytest.approx(0.5, abs=0.02, rel=0.0)


def test_what_a_typed_fit_lacks_is_said_as_it_is_typed(tmp_path: Path) -> None:
    """A normal force without a unit, points of one direction that are too few, and what smooths both."""
    path = axis_file(tmp_path / "axis.csv", FORWARD, BACKWARD, 30.0, 0.003)
    few = tmp_path / "few.csv"
    few.write_text("v (mm/s),mu\n" + "".join(f"{v},0.4\n" for v in (1, 2, 3, 4, 5, 6, -1, -2, -3, -4, -5)))
    for typed, said in (
        ([str(path), "--normal-force", "100"], 'no unit, got 100: write --normal-force "100 N", of torques in N m'),
        ([str(few), "--law", "exponential-stribeck"], "5 points backwards cannot determine 5 parameters"),
        ([str(few), "--smooth", "auto"], "fit a law (--law), or in Python smooth each of points.ways"),
    ):
        assert said in str(CliRunner().invoke(app, ["fit", *typed]).exception)


def test_a_torque_and_the_torque_of_its_normal_load_make_the_coefficient(tmp_path: Path) -> None:
    path = tmp_path / "turning.csv"
    path.write_text("v (rpm),torque (N m)\n1,4\n2,3\n3,2\n")
    assert Points.read(path, normal_force="5 N m").friction.tolist() == [0.8, 0.6, 0.4]
    with pytest.raises(ss.InputError, match="'N' does not convert to N m"):
        Points.read(path, normal_force="5 N")


@pytest.mark.parametrize("first", ["1.000", "0.5"])
def test_decimal_commas_beside_points_in_one_column_are_refused(tmp_path: Path, first: str) -> None:
    """There "1.000" may be a thousand; columns that differ from each other are taken."""
    path = tmp_path / "mixed.csv"
    path.write_text(f"v (mm/s);mu\n1;{first}\n2;0,4\n3;0,3\n")
    with pytest.raises(
        ss.InputError, match=rf"line 3, column 2: numbers with decimal commas and with points are mixed, '{first}' and '0,4'"
    ):
        Points.read(path)
    path.write_text("v (mm/s);mu\n1;0,5\n2;0.4\n3;0,3\n")
    with pytest.raises(ss.InputError, match="line 3, column 2"):
        Points.read(path)
    path.write_text("v (mm/s);mu\n1;0,5\n2.5;0,4\n3;0,3\n")
    assert Points.read(path).friction.tolist() == [0.5, 0.4, 0.3]
