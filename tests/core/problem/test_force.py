"""A force that is given in time, and bodies without a spring: what is said of them, what is refused, and where they come from."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

import stickslip as ss
from stickslip.loading import Sinusoidal, Steps
from stickslip.problem.scenarios import Scenario, read_scenario
from stickslip.run.check.examine import examine
from stickslip.run.reference.rate_and_state import SteadySliding

DRY = ss.friction.Coulomb(0.6, 0.4)
FREE = ss.SpringBlock(2.0, 0.0, 20.0)
SPRUNG = ss.SpringBlock(2.0, 30.0, 20.0)
SLAB = ss.ElasticSlab(2800.0, 3500.0, 1e4, 1e8)
SWING = Sinusoidal(0.0, 16.0, 1.7)
TEXT = """
[body]
kind = "KIND"
MASS = 2.0
stiffness = 0
NORMAL = 20.0
[friction]
kind = "coulomb"
static = 0.6
dynamic = 0.4
[loading]
force = "13 UNIT"
[run]
duration = "5 s"
"""
SLIDES = TEXT.replace("KIND", "spring-block").replace("MASS", "mass").replace("NORMAL", "normal_force").replace("UNIT", "N")
TURNS = TEXT.replace("KIND", "rotating-block").replace("MASS", "inertia").replace("NORMAL", "normal_torque").replace("UNIT", "N m")
FROM_FILE = '[loading.force]\nkind = "piecewise-linear"\nfile = "push.csv"'


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"pull_rate": 1.0}, "pull_rate has nothing to pull: a SpringBlock of stiffness 0 has no spring: leave it out, give"),
        ({"body": SLAB, "force": 1.0, "initial_load": 0.0}, "force acts on a rigid body, which ElasticSlab is not: far_stress"),
        (
            {"body": SPRUNG, "force": SWING, "pull_rate": SWING, "initial_load": 0.0},
            "only one of force and pull_rate may have a sin",
        ),
        ({"force": SWING, "ground_acceleration": SWING}, "only one of force and the ground may have a sinusoid"),
        ({"force": "3 kPa"}, "force must be a number in N or a text with a unit"),
        ({"force": Steps([0.0, 1.0], ["1 Pa", "2 Pa"])}, "force must be in N, got a history of values in Pa"),
        ({"body": SPRUNG, "force": 1.0}, "needs either initial_load or initial_excess"),
        ({"force": math.inf}, "force must be finite, got inf"),
    ],
)
def test_what_cannot_be_is_refused_in_one_line(given: dict[str, object], message: str) -> None:
    with pytest.raises(ss.InputError) as error:
        ss.Problem(**{"body": FREE, "friction": DRY, **given})  # type: ignore[arg-type] # wrong ones, too
    assert str(error.value).startswith(f"Problem: {message}")
    assert "\n" not in str(error.value)


def test_a_stiffness_below_0_is_no_spring() -> None:
    with pytest.raises(ss.InputError, match="stiffness must be at least 0"):
        ss.SpringBlock(1.0, -30.0, 20.0)


@pytest.mark.sampled(every=2)
@pytest.mark.parametrize("text", [SLIDES, TURNS])
def test_a_scenario_pushes_as_python_does(text: str, tmp_path: Path) -> None:
    file = tmp_path / "pushed.toml"
    file.write_text(text)
    scenario = ss.load_scenario(file)
    run = ss.simulate(scenario)
    assert float(run.slip(5.0)) == pytest.approx(0.5 * (13.0 - 8.0) / 2.0 * 25.0, rel=1e-13)
    assert scenario.problem.parameters["loading.force"].value == 13.0
    assert scenario.problem.parameters["force"].put(14.0).force == 14.0
    again = ss.open_solution(run.to_netcdf(tmp_path / "run.nc")).problem
    assert again == scenario.problem


@pytest.mark.parametrize(("text", "heading"), [(SLIDES, "force (kN)"), (SLIDES, "shear_force (kN)"), (TURNS, "torque (kN m)")])
def test_a_column_of_a_file_pushes(text: str, heading: str, tmp_path: Path) -> None:
    unit = text.split('force = "13 ')[1].split('"')[0]
    (tmp_path / "push.csv").write_text(f"time (ms),{heading}\n0,0\n2000,0.03\n")
    file = tmp_path / "pushed.toml"
    file.write_text(text.replace(f'force = "13 {unit}"', FROM_FILE))
    force = ss.load_scenario(file).problem.force
    assert isinstance(force, ss.loading.LoadingHistory)
    assert force.at([0.0, 1.0, 2.0, 5.0]) == pytest.approx([0.0, 15.0, 30.0, 30.0])


def test_a_file_without_the_column_asks_for_a_force(tmp_path: Path) -> None:
    (tmp_path / "push.csv").write_text("time (s),load (N)\n0,0\n2,30\n")
    file = tmp_path / "pushed.toml"
    file.write_text(SLIDES.replace('force = "13 N"', FROM_FILE))
    with pytest.raises(ss.InputError, match=r"no column 'force' in the header; write it as force \(N\)$"):
        ss.load_scenario(file)


def test_a_file_in_place_of_a_number_hears_where_a_file_is_named() -> None:
    said = r"got 'push.csv'; a file is named in the scenario: \[loading.force\] kind = \"piecewise-linear\", file = \"push.csv\"$"
    with pytest.raises(ss.InputError, match=said):
        read_scenario(SLIDES, "pushed").with_values({"loading.force": "push.csv"})


def findings(problem: ss.Problem) -> str:
    return "\n".join(f"{name}: {text}" for name, text in examine(Scenario(problem, 5.0)).findings())


def numbers(problem: ss.Problem) -> dict[str, object]:
    return {one.name: one.value for one in examine(Scenario(problem, 5.0)).derived}


def test_check_knows_the_force_and_that_there_is_no_spring() -> None:
    found = numbers(ss.Problem(FREE, DRY, force=SWING))
    assert (found["largest force"], found["least force"]) == (16.0, -16.0)
    assert "period" not in found
    assert "sqrt(K m)" not in found
    assert "slips at once: the load, with the force, exceeds the static strength by 1 N" in findings(
        ss.Problem(FREE, DRY, force=13.0)
    )
    assert "stuck: the load, with the force, is 1 N below" in findings(ss.Problem(FREE, DRY, force=11.0))
    assert "slips backwards at once" in findings(ss.Problem(FREE, DRY, force=-13.0))
    assert "before the start no force acts" in findings(ss.Problem(FREE, DRY, force=SWING))


def test_check_warns_of_a_force_that_moves_nothing_and_only_of_that() -> None:
    weak = "the force never reaches the static strength: nothing will slip"
    assert weak in findings(ss.Problem(FREE, DRY, force=Sinusoidal(0.0, 11.0, 1.0)))
    assert weak not in findings(ss.Problem(FREE, DRY, force=Sinusoidal(0.0, 13.0, 1.0)))
    assert weak in findings(ss.Problem(FREE, DRY, force=Steps([0.0, 1.0], [0.0, -13.0]), one_way=True))
    assert weak not in findings(ss.Problem(FREE, DRY, force=Steps([0.0, 1.0], [0.0, -13.0])))
    assert ss.simulate(ss.Problem(FREE, DRY, force=Sinusoidal(0.0, 11.0, 1.0)), 5.0).events.empty


def test_check_says_how_far_a_mass_changes_slow_sliding() -> None:
    law = ss.friction.RateAndState(0.6, rate=1e-6, a=0.01, b=0.015, distance=1e-5)
    body = ss.SpringBlock(1e3, 1e6, 5e5)
    sliding = SteadySliding(5e5, 0.01, 0.015, 1e-5, 1e-6)
    share = numbers(ss.Problem(body, law, pull_rate=1e-6, initial_rate="steady"))["inertia"]
    assert share == pytest.approx(sliding.critical_stiffness(1e3) / sliding.critical_stiffness() - 1.0, rel=1e-6)


def test_pressed_harder_a_pushed_contact_is_as_near_to_slip() -> None:
    problem = ss.Problem(FREE, DRY, force=SWING)
    pressed = problem.parameters["pressing"].put(40.0)
    assert isinstance(pressed.force, Sinusoidal)
    assert pressed.force.amplitude == 32.0


def test_the_round_trip_of_a_free_body_follows_what_happens_to_it() -> None:
    assert ss.Problem(FREE, DRY, force=SWING).round_trip_time == 1.7
    assert ss.Problem(FREE, DRY, force=Steps([0.0, 1e-3, 1e6], [1.0, 2.0, 3.0])).round_trip_time == pytest.approx(0.016)
    assert ss.Problem(FREE, DRY, initial_rate=3.0).round_trip_time == pytest.approx(2.0 * 2.0 * 3.0 / 20.0)
    fast = Sinusoidal(0.0, 16.0, 1e-5)
    slow = ss.simulate(ss.Problem(FREE, ss.friction.FromExpression("0.4 + 0.1/(1 + v)"), ground_acceleration=fast), 1e-3)
    assert slow.duration == 1e-3
