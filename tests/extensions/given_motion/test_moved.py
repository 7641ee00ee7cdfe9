"""What a given motion says at rest, at turns and of counted slip; scenarios with a [motion], their files, and what is refused."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import xarray as xr

import stickslip as ss
from stickslip.problem.scenarios import read_scenario
from tests.extensions.given_motion.running import stickslip

COULOMB = ss.friction.Coulomb(static=0.6, dynamic=0.5)
THERE_AND_BACK = ss.loading.Steps([0.0, 1.0, 2.0, 3.0], [1e-3, 0.0, -1e-3, 1e-3])
TEXT = """
title = "A velocity-step test"
[friction]
kind = "rate-and-state"
reference = 0.6
a = 0.01
b = 0.015
distance = "10 um"
[motion]
normal_load = "5 MPa"
[motion.slip_rate]
kind = "steps"
times = [0.0, "20 s"]
values = ["1 um/s", "10 um/s"]
[run]
duration = "60 s"
"""


def test_at_rest_a_law_that_sticks_leaves_the_traction_open_between_its_bounds() -> None:
    run = ss.simulate(ss.MovedContact(COULOMB, THERE_AND_BACK, "100 N"), 4.0)
    np.testing.assert_array_equal(run.traction([0.5, 1.5, 2.5, 3.5]), [50.0, np.nan, -50.0, 50.0])
    lowest, highest = run.bounds([0.5, 1.5, 2.5])
    np.testing.assert_array_equal(lowest, [50.0, -60.0, -50.0])
    np.testing.assert_array_equal(highest, [50.0, 60.0, -50.0])
    assert "any traction up to static friction is possible" in str(run)


def test_backward_slip_has_the_friction_of_its_own_direction() -> None:
    law = ss.friction.BothWays(COULOMB, ss.friction.Coulomb(static=0.3, dynamic=0.2))
    run = ss.simulate(ss.MovedContact(law, THERE_AND_BACK, "100 N"), 4.0)
    np.testing.assert_allclose(run.traction([0.5, 1.5, 2.5, 3.5]), [50.0, np.nan, -20.0, 50.0], rtol=1e-15, atol=0.0)
    np.testing.assert_allclose(run.coefficient([0.5, 2.5]), [0.5, -0.2], rtol=1e-15, atol=0.0)
    np.testing.assert_allclose(run.bounds([1.5, 2.5]), [[-30.0, -20.0], [60.0, -20.0]], rtol=1e-15, atol=0.0)


def test_friction_that_presses_its_contact_is_smaller_backwards() -> None:
    """tau = S mu / (1 - gain mu) forwards, S mu / (1 + gain mu) backwards: 100, 0.5 and a gain of 0.8 make 83.3 and 35.7."""
    run = ss.simulate(ss.MovedContact(ss.friction.SelfEnergising(COULOMB, gain=0.8), THERE_AND_BACK, "100 N"), 4.0)
    np.testing.assert_allclose(run.traction([0.5, 2.5]), [50.0 / 0.6, -50.0 / 1.4], rtol=1e-14, atol=0.0)
    np.testing.assert_allclose(run.bounds(1.5), [-60.0 / 1.48, 60.0 / 0.52], rtol=1e-14, atol=0.0)


def test_backward_friction_of_slip_and_rate_is_that_of_the_backward_law() -> None:
    backward = ss.friction.ExponentialStribeck(static=0.5, dynamic=0.1, rate=1e-3)
    run = ss.simulate(ss.MovedContact(ss.friction.BothWays(COULOMB, backward), ss.loading.Sinusoidal(0.0, 2e-3, 2.0), 10.0), 2.0)
    t = np.linspace(1.01, 1.99, 20)
    expected = -10.0 * np.array([float(backward.coefficient(0.0, abs(v))) for v in run.slip_rate(t)])
    np.testing.assert_allclose(run.traction(t), expected, rtol=1e-13, atol=0.0)


@pytest.mark.parametrize(("memory", "at_end"), [("all", 3e-3), ("since-arrest", 2e-3)])
def test_slip_is_counted_as_the_law_says(memory: str, at_end: float) -> None:
    """The path is 3 mm after the motion to and fro, 2 mm of it since the arrest."""
    law = ss.friction.ExponentialSlipWeakening(static=0.8, dynamic=0.3, distance=2e-3, memory=memory)
    run = ss.simulate(ss.MovedContact(law, THERE_AND_BACK, "100 N"), 4.0)
    assert float(run.traction(4.0)) == pytest.approx(100.0 * float(law.coefficient(at_end)), rel=1e-12)
    assert float(run.traction(2.5)) < 0.0
    np.testing.assert_allclose(run.slip([1.5, 3.0, 4.0]), [1e-3, 0.0, 1e-3], rtol=0.0, atol=1e-17)


def test_net_slip_has_a_sign() -> None:
    law = ss.friction.FromExpression("0.5 + k*u", {"k": 100.0})
    run = ss.simulate(ss.MovedContact(law, ss.loading.Sinusoidal(0.0, 1e-3, 2.0 * np.pi), 1.0, initial_slip=1e-3), 6.0)
    t = np.linspace(0.1, 6.0, 50)
    slip = 1e-3 + 1e-3 * (1.0 - np.cos(t))
    np.testing.assert_allclose(run.traction(t), np.sign(np.sin(t)) * (0.5 + 100.0 * slip), rtol=1e-12, atol=0.0)


def test_a_jump_of_the_normal_load_changes_the_state_as_linker_and_dieterich_say() -> None:
    law = ss.friction.RateAndState(reference=0.6, a=0.01, b=0.02, distance=1e-5, normal_stress_coupling=0.2)
    load = ss.loading.Steps([0.0, 5.0], ["1 MPa", "3 MPa"])
    run = ss.simulate(ss.MovedContact(law, 1e-6, load), 10.0)
    assert float(run.state(5.0)) == pytest.approx(10.0 * (1.0 / 3.0) ** 10.0, rel=1e-9)
    assert run.at(5.0).normal_load[0] == 3e6


def test_bristles_turn_with_slip_and_traction_does_not_jump() -> None:
    law = ss.friction.Dahl(sliding=0.1, stiffness=1e4)
    run = ss.simulate(ss.MovedContact(law, ss.loading.Steps([0.0, 1.0], [1e-4, -1e-4]), 1.0, initial_state=0.0), 1.01)
    assert float(run.traction(1.0)) == pytest.approx(0.1 * (1.0 - np.exp(-10.0)), rel=1e-9)
    assert float(run.traction(1.0)) == pytest.approx(float(run.traction(1.0 - 1e-9)), rel=1e-4)
    assert float(run.state(1.0)) > 0.0 > float(run.slip_rate(1.0))


def test_a_torque_takes_a_rotation_rate() -> None:
    run = ss.simulate(ss.MovedContact(COULOMB, "30 rpm", "20 N m"), 1.0)
    assert run.units["slip_rate"] == "rad/s"
    assert float(run.traction(0.5)) == 10.0
    assert float(run.slip(1.0)) == pytest.approx(np.pi, rel=1e-12)


def test_measured_displacements_give_the_slip_rate_between_them() -> None:
    rate = ss.MovedContact.rate_of([0.0, 1.0, 3.0], [0.0, 1e-3, 0.0])
    np.testing.assert_allclose(rate.at([0.5, 2.0]), [1e-3, -5e-4], rtol=1e-15, atol=0.0)
    labelled = ss.MovedContact.rate_of(xr.DataArray([0.0, 1.0, 3.0]), ["0 mm", "1 mm", "0 mm"])  # type: ignore[list-item]
    assert labelled == rate


REFUSED_DISPLACEMENTS = {
    "no number": ([0.0, 1.0, 2.0], [0.0, 1.0, np.nan], r"displacements\[2\] must be finite, got nan"),
    "one time twice": ([0.0, 1.0, 1.0], [0.0, 1.0, 2.0], r"times must ascend, but \[2\] = 1 follows 1; keep one point of each"),
    "a later start": ([1.0, 2.0], [0.0, 1.0], "times must begin with 0, got 1: take the first time off all of them"),
    "one too few": ([0.0, 1.0, 2.0], [0.0, 1.0], "needs as many displacements as times, got 2 and 3"),
    "a word": ([0.0, "soon"], [0.0, 1.0], r"times\[1\] must be a number in s .*, got 'soon'"),
}


@pytest.mark.parametrize(("times", "places", "said"), REFUSED_DISPLACEMENTS.values(), ids=REFUSED_DISPLACEMENTS)
def test_displacements_that_cannot_be_used_are_named(times: list[float], places: list[float], said: str) -> None:
    for numbers in (list, lambda given: pd.Series(given)):
        with pytest.raises(ss.InputError, match=f"^MovedContact.rate_of: {said}"):
            ss.MovedContact.rate_of(numbers(times), numbers(places))


def test_a_normal_load_takes_no_positions_of_an_axis() -> None:
    ways = ss.loading.Waypoints([0.0, 1.0], [1.0, 2.0])
    with pytest.raises(
        ss.InputError, match=r"^MovedContact: normal_load must be in N or Pa or N m, got a history in m/s or rad/s$"
    ):
        ss.MovedContact(COULOMB, 1e-3, ways)
    assert float(ss.simulate(ss.MovedContact(COULOMB, ways, 10.0), 1.0).traction(0.5)) == 5.0


def test_a_missing_normal_load_is_named() -> None:
    with pytest.raises(ss.InputError, match=r"^MovedContact: normal_load must be given$"):
        ss.MovedContact(COULOMB, "1 um/s")  # type: ignore[call-arg]


def test_studies_of_bodies_refuse_a_given_motion() -> None:
    scenario = read_scenario(TEXT, "axis")
    with pytest.raises(ss.InputError, match=r"^sweep: axis has a given \[motion\], for which there are"):
        ss.sweep(scenario, {"friction.a": [0.01, 0.02]}, quantities=["slip"])


def test_a_stiff_spring_in_its_place_comes_near_it_with_many_more_pieces() -> None:
    """The way around it until now: a block on a spring of 1e9 N/m."""
    law = ss.friction.LuGre(static=0.15, dynamic=0.1, rate=1e-3, stiffness=1e4, damping=3.0, viscosity=0.04)
    pulled = ss.loading.Sinusoidal(2e-3, 1e-3, 0.5)
    body = ss.SpringBlock(mass=1.0, stiffness=1e9, normal_force=100.0)
    around = ss.simulate(ss.Problem(body, law, pull_rate=pulled, initial_load=0.0, initial_state=0.0, initial_rate=2e-3), 0.2)
    run = ss.simulate(ss.MovedContact(law, pulled, 100.0, initial_state=0.0), 0.2)
    t = np.linspace(0.05, 0.2, 100)
    off = abs(around.traction(t) - run.traction(t)).max() / 15.0
    assert 0.0 < off < 1e-3
    assert 10 * len(run.steps.length) < len(around.history)


def test_a_scenario_with_a_motion_needs_no_body_and_reads_back(tmp_path: Path) -> None:
    scenario = read_scenario(TEXT, "test")
    run, again = ss.simulate(scenario), ss.simulate(read_scenario(scenario.to_toml(), "again"))
    np.testing.assert_array_equal(run.traction(run.times), again.traction(again.times))
    assert run.moved.load_unit == "Pa"
    other = ss.simulate(scenario.with_values({"motion.normal_load": "10 MPa", "friction.a": 0.02}))
    assert float(other.traction(60.0)) == pytest.approx(1e7 * (0.6 + 0.005 * np.log(10.0)), rel=1e-6)
    table = pd.read_csv(run.to_csv(tmp_path / "run.csv"))
    assert "traction (Pa)" in table.columns
    assert float(table["traction (Pa)"].iloc[-1]) == float(run.traction(60.0))


def test_the_command_line_checks_and_runs_it(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "steps.toml"
    file.write_text(TEXT)
    stickslip("check", file)
    said = " ".join(capsys.readouterr().out.split())
    assert "in the state of steady sliding at 1 um/s" in said
    assert "settle within about 1 s" in said
    figure, csv = tmp_path / "steps.png", tmp_path / "steps.csv"
    stickslip("run", file, "--figure", figure, "--csv", csv, "--set", "motion.initial_slip=1 mm")
    assert "along a given motion of 60 s" in capsys.readouterr().out
    assert figure.stat().st_size > 10_000
    assert csv.stat().st_size > 10_000


RATE_AND_STATE = ss.friction.RateAndState(reference=0.6, a=0.01, b=0.015, distance="10 um")
REFUSED = [
    ({"friction": 0.5}, "friction must be a law of ss.friction, got 0.5"),
    ({"slip_rate": "5 N"}, "slip_rate must be a number in m/s, or a history of ss.loading, got '5 N'"),
    ({"normal_load": "5 m"}, "normal_load must be a number in N or Pa or N m"),
    ({"normal_load": -1.0}, "normal_load must stay above 0 N, but may fall to -1"),
    ({"normal_load": "1 N m", "slip_rate": "1 mm/s"}, "slip_rate must be a number in rad/s"),
    ({"initial_state": "1 m"}, "initial_state must be a number in s or 'steady'"),
    ({"initial_state": -1.0}, "initial_state must be a number of at least 0 s"),
    ({"initial_second_state": 1.0}, "initial_second_state: RateAndState has 1 states: leave it out"),
    ({"slip_rate": 0.0}, "initial_state is needed: RateAndState has no steady state at a first slip rate of 0 m/s"),
]


@pytest.mark.parametrize(("changed", "message"), REFUSED)
def test_what_cannot_be_followed_is_refused_in_one_line(changed: dict[str, object], message: str) -> None:
    given: dict[str, object] = {"friction": RATE_AND_STATE, "slip_rate": 1e-6, "normal_load": 1e6} | changed
    with pytest.raises(ss.InputError) as caught:
        ss.MovedContact(**given)  # type: ignore[arg-type]
    assert message in str(caught.value)
    assert "\n" not in str(caught.value)


IN_FILES = [
    ('normal_load = "5 MPa"', "", "[motion] normal_load is missing"),
    ("[motion]", "[loading]\npull_rate = 1.0\n[motion]", "[motion] gives slip rate and normal load: leave [loading] out"),
    ("[motion]", "[initial]\nstate = 1.0\n[motion]", "[motion] has initial_slip and initial_state: leave [initial] out"),
    ("[motion]", "[loading]\npull_rate = 0.0\n[motion]", "[motion] gives slip rate and normal load: leave [loading] out"),
    ("[motion]", "[initial]\nload = 0.0\n[motion]", "[motion] has initial_slip and initial_state: leave [initial] out"),
    ('"1 um/s", "10 um/s"', '"1 um/s", 0.0, 0.0', "[motion.slip_rate] 2 times but 3 values"),
    ('"5 MPa"', "true", "[motion] normal_load must be a number, or a table [motion.normal_load], got True"),
    ("[run]", "[run]\nevents = 3", "[run] events has no effect with a [motion], which says how the contact moves: leave it out"),
]


@pytest.mark.parametrize(("old", "new", "message"), IN_FILES)
def test_a_file_that_cannot_be_used_is_refused_with_its_place(old: str, new: str, message: str) -> None:
    with pytest.raises(ss.InputError) as caught:
        read_scenario(TEXT.replace(old, new), "mine.toml")
    assert str(caught.value).startswith("mine.toml: ")
    assert message in str(caught.value)


def test_a_run_refuses_options_without_meaning_and_times_outside() -> None:
    contact = ss.MovedContact(COULOMB, 1e-3, 100.0)
    with pytest.raises(ss.InputError, match="a MovedContact has no max_events: leave it out"):
        ss.simulate(contact, 1.0, max_events=3)
    with pytest.raises(ss.InputError, match="a MovedContact needs a duration"):
        ss.simulate(contact)
    with pytest.raises(ss.InputError, match="times must be from 0 to 1 s"):
        ss.simulate(contact, 1.0).traction(2.0)
