"""Loading that varies in scenario files: every kind read and written, data files, and one line for every mistake."""

from __future__ import annotations

from pathlib import Path

import pytest

from stickslip import InputError
from stickslip.problem.loading import HISTORIES, PiecewiseLinear, Steps
from stickslip.problem.scenarios.scenario import load_scenario, read_scenario
from stickslip.problem.scenarios.templates import template
from stickslip.run.check.examine import examine
from tests.core.problem.scenarios.texts import GOOD

RATE = 'a number in m/s or a text with a unit such as "10 m/s"'
TABLE = (
    "what varies in time is a table [loading.pull_rate] of a kind: piecewise-linear, sinusoidal, steps, waypoints, hold-and-slide"
)
SORTED = "hold-and-slide, piecewise-linear, sinusoidal, steps, waypoints"
FAR = "[loading] far_stress and far_stress_rate need a slab with a finite driver_impedance"
STEPS = '[loading.{}]\nkind = "steps"\ntimes = [0, 1]\nvalues = [1, 2]\n'
PULL = STEPS.format("pull_rate")
LINEAR = '[loading.pull_rate]\nkind = "piecewise-linear"\n'
TONE = '[loading.pull_rate]\nkind = "sinusoidal"\nmean = "1 m/s"\namplitude = 1\nperiod = "1 s"\n'
HOLDS = '[loading.pull_rate]\nkind = "hold-and-slide"\nslide = 1\nslide_time = 1\nhold_times = [1]\n'


def document(loading: str, driver: str = "", run: str = "") -> str:
    text = GOOD.replace('[loading]\npull_rate = "0.05 m/year"\n', loading)
    assert text != GOOD
    return text.replace("density = 2800", f"density = 2800\n{driver}") + run


@pytest.mark.parametrize("kind", HISTORIES)
@pytest.mark.parametrize("body", ["slab", "block"])
def test_every_kind_is_read_and_written(kind: str, body: str) -> None:
    scenario = read_scenario(template(body, pull=kind), "starter")
    assert type(scenario.problem.pull_rate) is HISTORIES[kind]
    again = read_scenario(scenario.to_toml(), "again")
    assert again == scenario
    assert again.to_toml() == scenario.to_toml()


def test_positions_are_no_far_stress() -> None:
    ways = '[loading.far_stress]\nkind = "waypoints"\ntimes = [0, 1]\npositions = [0, 1]\n'
    with pytest.raises(InputError, match="far_stress must be in Pa, got a history of values in m/s or rad/s"):
        read_scenario(document(ways, driver="driver_impedance = 1e6"), "far")


@pytest.mark.parametrize("kind", [kind for kind in HISTORIES if kind != "waypoints"])
def test_every_kind_can_be_a_far_stress(kind: str) -> None:
    plain = read_scenario(template("slab", pull=kind), "starter").to_toml()
    text = plain.replace("loading.pull_rate", "loading.far_stress").replace("driver_impedance = inf", "driver_impedance = 1e6")
    scenario = read_scenario(text.replace("pull_rate = 0.0", ""), "far")
    assert type(scenario.problem.far_stress) is HISTORIES[kind]
    assert read_scenario(scenario.to_toml(), "again") == scenario


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (
            document('[loading]\npull_rate = "steps"\n'),
            f"[loading] pull_rate must be {RATE}, got 'steps'; {TABLE}",
        ),
        (
            document("[loading]\npull_rate = [1, 2]\n"),
            f"[loading] pull_rate must be {RATE}, got [1, 2]; {TABLE}",
        ),
        (
            document('[loading]\nfar_stress_rate = {kind = "steps"}\n'),
            '[loading] far_stress_rate must be a number in Pa/s or a text with a unit such as "10 Pa/s", '
            "got {'kind': 'steps'}; only pull_rate or far_stress or force or normal_load or ground_velocity or ground_acceleration"
            " or driver_reflection may vary"
            " in time",
        ),
        (document(STEPS.format("pull_rat")), "[loading] pull_rat is unknown; did you mean 'pull_rate'?"),
        (document(PULL.replace('"steps"', '"step"')), "[loading.pull_rate] kind 'step' is unknown; did you mean 'steps'?"),
        (document(PULL.replace('kind = "steps"\n', "")), f"[loading.pull_rate] kind is missing; allowed: {SORTED}"),
        (document(PULL.replace("values = [1, 2]\n", "")), "[loading.pull_rate] values is missing: the values, in m/s, a list"),
        (document(PULL.replace("[1, 2]", "[1, 2, 3]")), "[loading.pull_rate] 2 times but 3 values"),
        (
            document(PULL.replace("[0, 1]", "[1, 0]")),
            "[loading.pull_rate] times must ascend, but [1] = 0 follows 1; sort the points",
        ),
        (
            document(PULL.replace("[0, 1]", "[1, 2]")),
            "[loading.pull_rate] times must begin with 0, from which the first value holds, got 1",
        ),
        (
            document(PULL.replace("[1, 2]", '[1, "2 Pa"]')),
            f"[loading.pull_rate] values[1] must be {RATE}, got '2 Pa': 'Pa' does not convert to m/s",
        ),
        (document(HOLDS.replace("[1]", "[]")), "[loading.pull_rate] hold_times must have 1 to 10000 numbers, got 0"),
        (document(STEPS.format("far_stress")), FAR),
        (
            document(PULL + STEPS.format("far_stress"), driver="driver_impedance = 1e6"),
            "[loading] only one of pull_rate and far_stress may vary in time",
        ),
        (
            document(PULL, run="shortest_event = 1e-6\n"),
            "[run] shortest_event must be 0 here: events are lumped under a constant pull and normal load only",
        ),
        (
            document(PULL, run="creep_rtol = 1e-6\n").replace(
                '"hyperbolic-rate"\nstatic = 0.8\ndynamic = 0.3\nalpha = 1.0',
                '"linear-slip-weakening"\nstatic = 0.8\ndynamic = 0.3\ndistance = 1.0',
            ),
            "[run] creep_rtol must be 0 here: leaps over creep need a constant pull rate and normal load",
        ),
        (document(LINEAR + 'file = "pull.csv"\n'), None),
    ],
)
def test_mistakes_in_a_table_are_refused_in_one_line(text: str, message: str | None) -> None:
    with pytest.raises(InputError) as caught:
        read_scenario(text, "my.toml")
    said = "[loading.pull_rate] file 'pull.csv': only a scenario in a file can name another file; write the points as lists"
    assert str(caught.value) == f"my.toml: {message or said}"


def test_a_block_has_no_far_stress() -> None:
    text = template("block", pull="steps").replace("loading.pull_rate", "loading.far_stress")
    with pytest.raises(InputError) as caught:
        read_scenario(text, "b")
    assert str(caught.value) == f"b: {FAR}"


def read_csv(folder: Path, csv: str, loading: str = LINEAR, **more: str) -> object:
    (folder / "pull.csv").write_text(csv, encoding="utf-8")
    (folder / "my.toml").write_text(document(loading + 'file = "pull.csv"\n', **more), encoding="utf-8")
    return load_scenario(folder / "my.toml").problem


def test_a_data_file_is_read(tmp_path: Path) -> None:
    csv = "# measured\ntime (s), ignored,pull_rate (m/s)\n0,9,-1e-6\n\n2,9,3e-6\n"
    problem = read_csv(tmp_path, csv.replace(", ", ","))
    assert problem.pull_rate == PiecewiseLinear((0.0, 2.0), (-1e-6, 3e-6))  # type: ignore[attr-defined]
    far = "[loading.far_stress]\nkind = 'steps'\n"
    problem = read_csv(tmp_path, "far_stress (Pa),time (s)\n5e6,0\n6e6,1\n", far, driver="driver_impedance = 1e6")
    assert problem.far_stress == Steps((0.0, 1.0), (5e6, 6e6))  # type: ignore[attr-defined]


@pytest.mark.parametrize(
    ("csv", "message"),
    [
        ("time (s),rate\n0,1\n1,2\n", ": 'pull.csv', line 1: no column 'pull_rate' in the header; rename 'rate'?"),
        ("time (s),pull_rate (m/s)\n1,1\n0,2\n", ": 'pull.csv', line 3: time must ascend, but 0 follows 1; sort the rows"),
        (
            "time (s),pull_rate (m/s)\n-1,1\n0,2\n",
            ": 'pull.csv', line 2: time must not be negative, got -1; subtract the first time from all of them",
        ),
        (
            "time (s),pull_rate (m/s)\n0,nan\n1,2\n",
            ": 'pull.csv', line 2: pull_rate must be finite, got 'nan'; leave out such rows",
        ),
        (
            "time (s),pull_rate (m/s)\n0,1 m/s\n",
            ": 'pull.csv', line 2: pull_rate must be a number, got text; a unit belongs in the heading, as in pull_rate (m/s)",
        ),
        ("time (s),pull_rate (m/s)\n0,1\n", ": 'pull.csv', line 2: at least two rows of numbers are needed, got 1"),
    ],
)
def test_mistakes_in_a_data_file_are_refused_in_one_line(
    csv: str, message: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    with pytest.raises(InputError) as caught:
        read_csv(Path(), csv)
    assert str(caught.value) == f"my.toml: [loading.pull_rate] file{message}"


@pytest.mark.parametrize(
    ("loading", "message"),
    [
        (LINEAR + 'file = "pul.csv"\n', "file 'pul.csv': no such file beside the scenario"),
        (
            LINEAR + 'file = "/etc/hosts"\n',
            "file '/etc/hosts': the path must be relative to the scenario; "
            "STICKSLIP_FILES_ANYWHERE=1 in the environment allows others",
        ),
        (LINEAR + "file = 3\n", "file must be text in quotes, got 3"),
        (LINEAR + 'file = "pull.csv"\ntimes = [0, 1]\n', "file and times exclude each other"),
        (TONE + 'file = "pull.csv"\n', "file is unknown; allowed: amplitude, kind, mean, period, phase"),
    ],
)
def test_mistakes_in_naming_a_data_file_are_refused_in_one_line(
    loading: str, message: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("pull.csv").write_text("time (s),pull_rate (m/s)\n0,1\n1,2\n", encoding="utf-8")
    Path("my.toml").write_text(document(loading), encoding="utf-8")
    with pytest.raises(InputError) as caught:
        load_scenario("my.toml")
    assert str(caught.value) == f"my.toml: [loading.pull_rate] {message}"


def test_check_does_not_take_the_first_pull_rate_for_all_of_it() -> None:
    """No warning that nothing will slip, which a constant pull at the first rate would get; and it says which rate it means."""
    tides = load_scenario("tides-block")
    assert examine(tides).warnings == []
    steps = examine(load_scenario("velocity-steps-block"))
    assert steps.stability.endswith("of steady sliding at the first pull rate")
    assert steps.steady.lines()[0].startswith("at the first pull rate, 1 um/s, traction 30 kN: stable")
    meanings = {fact.name: fact.meaning for fact in steps.derived}
    assert {fact.name: fact.value for fact in steps.derived}["steady friction"] == pytest.approx(30e3, rel=1e-9)
    assert meanings["K V"] == "rate of loading while stuck, at first"
    assert meanings["steady friction"].endswith("at the first pull rate")


def test_check_knows_that_a_load_at_the_strength_may_grow_later() -> None:
    ramp = document('[loading.pull_rate]\nkind = "piecewise-linear"\ntimes = [0, 1]\nvalues = [0, 1]\n')
    assert examine(read_scenario(ramp, "ramp")).start == "stuck until the load grows: the load is the static strength"
