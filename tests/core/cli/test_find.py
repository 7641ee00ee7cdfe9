"""`stickslip find`, and what `check` says about steady sliding."""

from pathlib import Path

import pytest

from tests.command_line import Command

AXIS = """
title = "A damped axis"
[body]
kind = "spring-block"
mass = 1.0
stiffness = 1e3
normal_force = 10.0
damping = 5.0
[friction]
kind = "expression"
expression = "0.3 + 0.2*exp(-v/v1)"
[friction.parameters]
v1 = "50 mm/s"
[loading]
pull_rate = "50 mm/s"
[initial]
load = 0.0
[run]
duration = "5 s"
"""


@pytest.fixture
def axis(tmp_path: Path) -> str:
    (tmp_path / "axis.toml").write_text(AXIS)
    return "axis.toml"


def test_find_prints_the_bracket_and_writes_the_runs(command: Command, axis: str, tmp_path: Path):
    shown = command("find", axis, "--along", "pull_rate=50 mm/s..1 m/s", "--within", "0.1", "--out", "runs.csv")
    assert shown.code == 0, shown.err
    assert "Between loading.pull_rate = " in shown.out
    assert "sticking: yes below, no above" in " ".join(shown.out.split())
    assert "\n# between loading.pull_rate" in (tmp_path / "runs.csv").read_text()


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--along", "pull_rate=1"], "--along must be NAME or NAME=LOW..HIGH"),
        (["--along", "pull_rate=1..2:0"], "--along must be NAME or NAME=LOW..HIGH"),
        (["--along", "pull_rate=0.4..0.5"], "give ends that differ"),
        (["--what", "event"], "did you mean 'events'?"),
    ],
)
def test_find_refuses_in_one_line(command: Command, axis: str, arguments: list[str], message: str):
    assert message in command("find", axis, *arguments).refusal


def test_check_answers_at_which_speed_stick_slip_vanishes(command: Command, axis: str):
    said = " ".join(command("check", axis).out.split())
    assert "steady sliding at 50 mm/s, traction 3.73576 N: unstable: a small disturbance grows at 4.85759 /s" in said
    assert "unstable below a pull rate of 0.103972077 m/s, stable above (proven by interval arithmetic)" in said
    assert "from rest it sticks up to 15" in said
    said = " ".join(command("check", axis, "--no-runs").out.split())
    assert "from rest it may stick at a higher rate all the same: stickslip find" in said


@pytest.mark.drawn
def test_check_and_find_draw_what_they_found(command: Command, axis: str, tmp_path: Path):
    assert command("check", axis, "--no-runs", "--steady-figure", "steady.png").code == 0
    assert command("find", axis, "--along", "pull_rate=0.1..0.4", "--within", "0.5", "-f", "edge.svg").code == 0
    assert (tmp_path / "steady.png").stat().st_size > 10_000
    assert "exact runs" in (tmp_path / "edge.svg").read_text()
    refused = command("check", axis, "--set", "pull_rate=0", "--steady-figure", "none.png").refusal
    assert refused.startswith("check: --steady-figure: no steady sliding: nothing pulls")


def test_steady_sliding_can_be_set_from_the_command_line(command: Command, axis: str):
    said = command("run", axis, "--set", "initial.rate=steady", "--set", "pull_rate=0.2")
    assert said.code == 0, said.err
    assert "1 slip event" in said.out
