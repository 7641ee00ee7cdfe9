"""Laws found along measured motion have the numbers with which the records were made, within the stated errors."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
from scipy.integrate import cumulative_trapezoid, solve_ivp

import stickslip as ss
from tests.extensions.given_motion.running import stickslip

STRIBECK = {"static": 0.15, "dynamic": 0.1, "rate": 1e-3}
"""What records are made with; the searches begin elsewhere."""


def swung(count: int, lasting: float) -> tuple[Any, Any]:
    """Return times (s) and a slip rate (m/s) to and fro that fades."""
    time = np.linspace(0.0, lasting, count)
    return time, 2e-3 * np.sin(2.0 * np.pi * time) * np.exp(-0.2 * time)


def bristles(time: Any, rate: Any) -> Any:
    """Integrate LuGre's equation with scipy along straight lines between samples; return friction under 100 N."""

    def steady(v: Any) -> Any:
        return 0.1 + 0.05 * np.exp(-((v / 1e-3) ** 2))

    def bend(t: float, z: Any) -> Any:
        v = np.interp(t, time, rate)
        return v - 2e3 * abs(v) * z / steady(v)

    step = time[1] - time[0]
    z = solve_ivp(bend, (time[0], time[-1]), [0.0], "LSODA", time, rtol=1e-9, atol=1e-14, max_step=step).y[0]
    return 100.0 * (2e3 * z + 1.5 * (rate - 2e3 * abs(rate) * z / steady(rate)) + 2.0 * rate)


@pytest.mark.slow
def test_lugre_is_found_again_with_the_offset_of_the_sensor() -> None:
    time, rate = swung(1501, 1.5)
    force = bristles(time, rate) + 0.4 + 0.02 * np.random.default_rng(5).standard_normal(len(time))
    start = ss.friction.LuGre(static=0.2, dynamic=0.12, rate=2e-3, stiffness=1e3, damping=0.5, viscosity=1.0)
    free = "static,dynamic,rate,stiffness,friction.damping,viscosity,record.offset"
    record = {"time (s)": time, "slip_rate (m/s)": rate, "shear_force (N)": force}
    found = ss.studies.identify(start, record, free, normal_load="100 N", initial_state=0.0)
    truth = [0.15, 0.1, 1e-3, 2e3, 1.5, 2.0, 0.4]
    assert np.all(abs(found.table.value - truth) < 4.0 * found.table.deviation)
    assert np.all(found.table.deviation < [2e-3, 2e-3, 2e-5, 50.0, 0.2, 1.0, 0.02])
    assert found.sensor == pytest.approx(0.02, rel=0.1)
    assert found.determined
    run = ss.simulate(found.moved, 1.5)
    assert np.sqrt(np.mean((run.traction(time) + found.values["record.offset"] - force) ** 2)) < 0.025


@pytest.mark.slow
def test_rate_and_state_is_found_from_velocity_steps_and_a_typed_law_alike() -> None:
    time = np.arange(0.0, 100.0, 0.1)
    rate = np.where((time // 25.0) % 2 == 0.0, 1e-6, 1e-5)

    def heal(t: float, theta: Any) -> Any:
        return 1.0 - np.interp(t, time, rate) * theta / 1e-5

    theta = solve_ivp(heal, (0.0, time[-1]), [10.0], "LSODA", time, rtol=1e-10, atol=1e-12, max_step=0.1).y[0]
    mu = 0.01 * np.arcsinh(rate / 2e-6 * np.exp((0.6 + 0.015 * np.log(theta * 0.1)) / 0.01))
    mu = mu + 2e-4 * np.random.default_rng(2).standard_normal(len(time))
    record = {"time": time, "slip_rate": rate, "friction": mu}
    start = ss.friction.RateAndState(reference=0.6, a=0.02, b=0.02, distance=2e-5)
    found = ss.studies.identify(start, record, ["reference", "a", "b", "distance"])
    np.testing.assert_allclose(found.table.value, [0.6, 0.01, 0.015, 1e-5], rtol=0.05, atol=0.0)
    typed = ss.friction.FromExpression(
        "a*arcsinh(v/(2*v_0)*exp((f + b*z)/a))",
        {"f": 0.6, "a": 0.02, "b": 0.02, "d": 2e-5, "v_0": 1e-6},
        evolution="dz/dt = (v_0*exp(-z) - v)/d",
    )
    again = ss.studies.identify(typed, record, ["f", "a", "b", "d"], initial_state=0.0)
    np.testing.assert_allclose(again.table.value, found.table.value, rtol=1e-3, atol=0.0)
    np.testing.assert_allclose(again.table.deviation, found.table.deviation, rtol=2e-2, atol=0.0)


@pytest.mark.parametrize(("way", "noise"), [("slip_rate", 3e-5), ("smooth", 1e-4)])
@pytest.mark.slow
def test_most_stated_intervals_hold_the_truth_where_the_rate_is_noisy(way: str, noise: float) -> None:
    """Records of an encoder's rate with white noise of 3 % and 10 % of the Stribeck rate, 12 and 6 of them.

    Of 36 intervals 34 should hold the truth; those of one record are correlated, so that fewer than 80 % are unlikely.
    """
    held, scores, many = 0, [], 12 if way == "slip_rate" else 6
    for seed in range(many):
        draw = np.random.default_rng(seed)
        time = np.linspace(0.0, 4.0, 201)
        rate = 1e-3 + 5e-4 * time + 5e-4 * np.sin(2.0 * np.pi * time)
        force = 100.0 * (0.1 + 0.05 * np.exp(-((rate / 1e-3) ** 2))) + 0.05 * draw.standard_normal(len(time))
        record = {"time": time, "slip_rate": rate + noise * draw.standard_normal(len(time)), "shear_force": force}
        start = ss.friction.ExponentialStribeck(static=0.2, dynamic=0.12, rate=2e-3, exponent=2, viscosity=0.0)
        free = ["static", "dynamic", "rate"]
        found = ss.studies.identify(start, record, free, normal_load=100.0, smooth=way == "smooth", motion_deviation=noise).table
        truth = np.array([STRIBECK[name] for name in free])
        held += int(np.sum((found.low < truth) & (truth < found.high)))
        scores.append((found.value - truth) / found.deviation)
    assert held >= 0.8 * 3 * many
    assert 0.6 < float(np.sqrt(np.mean(np.square(scores)))) < 1.5


@pytest.mark.slow
def test_positions_of_an_encoder_are_differentiated_smoothly() -> None:
    """Positions rounded to 1 um, as an encoder counts, whose differences are steps of 0.5 mm/s."""
    time, rate = swung(501, 1.0)
    slip = np.round(cumulative_trapezoid(rate, time, initial=0.0) / 1e-6) * 1e-6
    start = ss.friction.LuGre(static=0.2, dynamic=0.12, rate=2e-3, stiffness=1e3, damping=1.5, viscosity=2.0)
    record = {
        "time": time,
        "slip": slip,
        "shear_force": bristles(time, rate) + 0.05 * np.random.default_rng(1).standard_normal(501),
    }
    found = ss.studies.identify(start, record, "static,dynamic,rate,stiffness", normal_load=100.0, initial_state=0.0)
    assert np.all(abs(found.table.value - [0.15, 0.1, 1e-3, 2e3]) < 4.0 * found.table.deviation)
    assert np.all(found.table.deviation < [5e-3, 3e-3, 1e-4, 60.0])
    assert "noise of slip: 2.9" in found.notes[0] or "noise of slip: 3" in found.notes[0]


def test_a_record_that_does_not_tell_says_so() -> None:
    time = np.linspace(0.0, 1.0, 101)
    record = {"time": time, "slip_rate": np.full(101, 1e-3), "shear_force": 10.0 + 0.01 * np.sin(50.0 * time)}
    law = ss.friction.ExponentialStribeck(static=0.15, dynamic=0.1, rate=1e-3, exponent=2, viscosity=0.0)
    found = ss.studies.identify(law, record, ["static", "dynamic"], normal_load=100.0)
    assert not found.determined
    assert any("does not determine all of these numbers" in note for note in found.notes)


def test_the_command_finds_a_law_and_writes_it(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    time, rate = swung(400, 2.0)
    force = 100.0 * np.sign(rate) * (0.1 + 0.05 * np.exp(-((rate / 1e-3) ** 2)))
    file, scenario = tmp_path / "axis.csv", tmp_path / "axis.toml"
    pd.DataFrame({"time (s)": time, "velocity (mm/s)": 1e3 * rate, "force (N)": force}).to_csv(file, index=False)
    scenario.write_text(
        '[friction]\nkind = "exponential-stribeck"\nstatic = 0.2\ndynamic = 0.12\nrate = "2 mm/s"\nexponent = 2\n'
        '[motion]\nslip_rate = "1 mm/s"\nnormal_load = "100 N"\n[run]\nduration = "1 s"\n'
    )
    out, figure = tmp_path / "found.json", tmp_path / "found.png"
    stickslip("identify", scenario, file, "--free", "static,dynamic,rate", "--out", out, "--figure", figure)
    assert "3 numbers of ExponentialStribeck from" in capsys.readouterr().out
    numbers = json.loads(out.read_text())["numbers"]
    assert numbers["friction.static"]["value"] == pytest.approx(0.15, rel=1e-3)
    assert numbers["friction.rate"]["value"] == pytest.approx(1e-3, rel=1e-2)
    assert figure.stat().st_size > 10_000


def test_infer_points_to_it_where_a_record_has_motion_and_no_load_point(monkeypatch: pytest.MonkeyPatch) -> None:
    def fails(*_: Any) -> None:
        raise ss.InputError("infer: the problem cannot begin")

    monkeypatch.setattr("stickslip.extensions.inference.infer._inferred", fails)
    time, rate = swung(200, 1.0)
    body = ss.SpringBlock(mass=1.0, stiffness=1e4, normal_force=100.0)
    problem = ss.Problem(body, ss.friction.LuGre(static=0.15, dynamic=0.1, rate=1e-3, stiffness=1e4), pull_rate=1e-3)
    with pytest.raises(ss.InputError, match=r"cannot begin; .* is found by `stickslip identify`"):
        ss.studies.infer(problem, {"time": time, "slip_rate": rate, "shear_force": 10.0 * np.sign(rate)}, "body.mass")


REFUSED = [
    ({"slip_rate": None}, {}, "no column of motion: slip_rate, or slip"),
    ({"shear_force": None}, {}, "no column of friction: shear_force"),
    ({}, {"normal_load": None}, "no column of the normal load (normal_force): give normal_load"),
    ({}, {"free": "statick"}, "'statick' is no number of this law or record; did you mean 'static'?"),
    ({}, {"bounds": {"static": (0.5, 0.9)}}, "bounds of friction.static must lie around its start 0.2, got 0.5 to 0.9"),
    ({"time": np.ones(50)}, {}, "time must ascend, but 1 s follows 1 s"),
]


@pytest.mark.parametrize(("columns", "options", "message"), REFUSED)
def test_what_cannot_be_identified_is_refused_in_one_line(columns: dict[str, Any], options: dict[str, Any], message: str) -> None:
    record = {
        "time": np.linspace(0.0, 1.0, 50),
        "slip_rate": np.linspace(1e-4, 1e-3, 50),
        "shear_force": np.full(50, 10.0),
    } | columns
    given = {"free": "static", "normal_load": 100.0} | options
    law = ss.friction.ExponentialStribeck(static=0.2, dynamic=0.12, rate=2e-3, exponent=2, viscosity=0.0)
    with pytest.raises(ss.InputError) as caught:
        ss.studies.identify(law, {name: one for name, one in record.items() if one is not None}, **given)
    assert message in str(caught.value)
    assert "\n" not in str(caught.value)
