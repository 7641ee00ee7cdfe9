"""One setting of a drive, a period or matched impedance, gives its three numbers; what it sends back is measured in runs."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import stickslip as ss
from stickslip.problem.bodies.soft_torque import sent_back, tuned_period
from stickslip.problem.scenarios.scenario import read_scenario

STEEL: dict[str, Any] = {"density": 7850.0, "shear_modulus": 79.3e9, "outer_diameter": 0.127, "inner_diameter": 0.10861}
STRING = ss.TorsionalString(1200.0, **STEEL, normal_torque=10e3)
PIPE = 7850.0 * math.pi / 32.0 * (0.127**4 - 0.10861**4) * math.sqrt(79.3e9 / 7850.0)
"""Impedance of the pipe, N m s: rho J c."""
SECTIONS = ss.SectionedString([150.0, 1200.0], [0.165, 0.127], [0.0714, 0.10861], [7850.0] * 2, [79.3e9] * 2, normal_torque=10e3)


@pytest.mark.parametrize("string", [STRING, SECTIONS])
def test_a_period_and_the_inertia_of_the_drive_give_its_gains(string: Any) -> None:
    tuned = string.with_soft_torque("5 s", inertia="2000 kg m^2")
    assert tuned.driver_impedance == pytest.approx(PIPE, rel=1e-12)
    assert tuned.driver_inertia == 2000.0
    assert tuned.driver_integral_gain == pytest.approx(2000.0 * (2.0 * math.pi / 5.0) ** 2, rel=1e-12)
    assert tuned_period(tuned) == pytest.approx(5.0, rel=1e-12)
    assert string.with_soft_torque(4.0).driver_inertia == 2900.0
    assert tuned.with_soft_torque("6 s").driver_inertia == 2000.0
    assert string.with_soft_torque("5 s", gain="1 kN m s").driver_impedance == 1000.0


def test_matched_impedance_has_no_inertia_and_makes_up_slowly_for_what_it_lags_behind() -> None:
    matched = STRING.with_soft_torque("impedance matched")
    way = 2.0 * 1200.0 / math.sqrt(79.3e9 / 7850.0)
    assert (matched.driver_impedance, matched.driver_inertia) == (pytest.approx(PIPE, rel=1e-12), 0.0)
    assert matched.driver_integral_gain == pytest.approx(PIPE / (10.0 * way), rel=1e-12)
    assert all(sent_back(matched, period) < 0.1 for period in np.linspace(0.5, 6.0, 12))
    assert math.isnan(tuned_period(matched))


def sent_back_in_a_run(body: Any, period: float) -> float:
    """Return the size of the share that the drive sends back of a wave with a period (s), as its rate and torque in a run say.

    The weight on a bit that resists like a dashpot besides swings with that period, so that it sends out such a wave.
    """
    time = np.arange(0.0, 18.0 * period, period / 24.0)
    swinging = ss.loading.PiecewiseLinear(time.tolist(), (10e3 * (1.0 + 0.05 * np.sin(2.0 * math.pi * time / period))).tolist())
    law = ss.friction.FromExpression("0.3 + 0.03*v")
    run = ss.simulate(ss.Problem(body, law, pull_rate=8.0, initial_load=0.0, normal_load=swinging), 16.0 * period, rtol=1e-6)
    late = np.linspace(12.0 * period, 16.0 * period, 1600, endpoint=False)
    rate, torque = run.drive_rate(late), run.surface_torque(late)
    turning = np.exp(-2j * math.pi * late / period)
    met, sent = ((body.last_impedance * rate + sign * torque) @ turning for sign in (-1.0, 1.0))
    return float(abs(sent) / abs(met))


@pytest.mark.sampled(every=2)
@pytest.mark.parametrize("period", [1.5, 3.0])
def test_what_a_tuned_drive_sends_back_in_a_run_is_what_the_formula_says(period: float) -> None:
    body = STRING.with_soft_torque("3 s", inertia=500.0)
    assert sent_back_in_a_run(body, period) == pytest.approx(sent_back(body, period), abs=5e-3)
    if period == 3.0:
        assert sent_back(body, period) < 1e-12


def test_a_tuned_drive_lowers_the_speed_below_which_a_string_sticks() -> None:
    problem = replace(ss.load_scenario("drill-string").problem, pull_rate="90 rpm")
    stiff, soft = (
        ss.studies.severity(ss.simulate(replace(problem, body=body), 150.0))
        for body in (problem.body, problem.body.with_soft_torque("5 s"))
    )
    assert stiff > 1.0
    assert soft < 0.3


TEXT = ss.load_scenario("drill-string").to_toml()


def written(*lines: str) -> str:
    """Return the scenario of the drill string with lines in [body] in place of the numbers of its drive."""
    kept = [line for line in TEXT.splitlines() if not line.startswith("driver_")]
    at = next(i for i, line in enumerate(kept) if line.startswith("kind") and "torsional" in line)
    return "\n".join([*kept[: at + 1], *lines, *kept[at + 1 :]])


def test_a_scenario_has_one_key_for_the_drive_and_keeps_its_three_numbers() -> None:
    read = read_scenario(written('soft_torque = "5 s"', 'driver_inertia = "2000 kg m^2"'), "x").problem.body
    assert read == ss.load_scenario("drill-string").problem.body.with_soft_torque(5.0, inertia=2000.0)
    scenario = ss.load_scenario("drill-string")
    kept = replace(scenario, problem=replace(scenario.problem, body=read)).to_toml()
    assert read_scenario(kept, "x").problem.body == read
    gain = read_scenario(written('soft_torque = "5 s"', "driver_impedance = 800.0"), "x").problem.body
    assert gain.driver_impedance == 800.0


@pytest.mark.parametrize(
    ("lines", "message"),
    [
        (['soft_torque = "soft"'], 'x: [body] soft_torque must be a period, as "5 s", or "impedance matched", got \'soft\''),
        (['soft_torque = "5 m"'], "soft_torque"),
        (["soft_torque = -3"], "soft_torque must be greater than 0 s"),
        (['soft_torque = "5 s"', "driver_integral_gain = 5.0"], "soft_torque gives the integral gain of the drive: leave"),
        (['soft_torque = "impedance matched"', "driver_inertia = 2900.0"], "whose controller makes up for its inertia: leave"),
        (['soft_torque = "5 s"', "driver_inertia = 0.0"], "driver_inertia must be greater than 0 kg m^2"),
    ],
)
def test_settings_that_mean_nothing_are_refused_in_one_line(lines: list[str], message: str) -> None:
    with pytest.raises(ss.InputError) as error:
        read_scenario(written(*lines), "x")
    assert message in str(error.value)
    assert "\n" not in str(error.value)


def test_a_slab_has_no_such_key() -> None:
    slab = ss.load_scenario("fig6-slab").to_toml().replace("[body]\n", '[body]\nsoft_torque = "5 s"\n')
    with pytest.raises(ss.InputError, match=r"\[body\] soft_torque is unknown; it is a key of sectioned-string, torsional-string"):
        read_scenario(slab, "x")
