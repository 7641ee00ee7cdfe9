"""Scenarios and command lines of others: one line, bounded time and memory, and no look at other files."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
import pytest

import stickslip as ss
from stickslip.cli.main import main
from stickslip.problem.scenarios.scenario import load_scenario, read_scenario
from tests.core.problem.scenarios.texts import GOOD
from tests.limits import processor_time

TABLE = GOOD.replace(
    GOOD[GOOD.index("[friction]") : GOOD.index("[loading]")],
    '[friction]\nkind = "table"\nfile = "FILE"\n\n',
)
QUOTED = '"a" . '
POINTS = "slip (m),friction\n0,0.7\n1,0.5\n"


def refusal(text: str) -> str:
    """What is said about a scenario, in one line and at once."""
    with processor_time(5.0), pytest.raises(ss.InputError) as caught:
        read_scenario(text, "my.toml")
    assert "\n" not in str(caught.value)
    assert str(caught.value).startswith("my.toml: ")
    return str(caught.value)


@pytest.mark.parametrize(
    ("expression", "parameters", "message"),
    [
        ("b/b", {"b": 0}, "the part 'b / b' is not a finite number: it is nan"),
        ("0.5 + b/b", {"b": 0.0}, "the part 'b / b' is not a finite number: it is nan"),
        ("a**b + 0.5", {"a": -1, "b": 0.5}, r"the part 'a\*\*b' is not a finite number: it is nan"),
        ("0.5 + 0*a**b", {"a": 1e50, "b": 99}, r"the part 'a\*\*b' is not a finite number: it is inf"),
        ("0.5 + v/1e300**2", {}, r"the part '1e\+300\*\*2' is not a finite number: it is inf"),
        ("0.5 + exp(-a*a*v)", {"a": 1e300}, r"a' must lie within 1e\+50 \(a pure number\), got 1e\+300"),
        ("0.5 + exp(-a*v)", {"a": 10**400}, "a' must be a number, got a whole number beyond 1e300"),
    ],
)
def test_an_expression_without_a_value_is_refused_with_its_part(
    expression: str, parameters: dict[str, float], message: str
) -> None:
    with pytest.raises(ss.InputError, match=message):
        ss.friction.FromExpression(expression, parameters)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ('"10 km"', "1e300", "my.toml: [body] thickness must lie within 1e+50 m, got 1e+300"),
        ('"10 km"', "1e-300", "my.toml: [body] thickness must be at least 1e-50 m, got 1e-300"),
        ('"12 s"', "1e300", "my.toml: [run] duration must lie within 1e+50 s, got 1e+300"),
        ("alpha = 1.0", "alpha = 1e200", "my.toml: [friction] alpha must lie within 1e+50 s/m, got 1e+200"),
        ('"12 s"', f'"12 s"\n{"a." * 20_000}b = 1', "my.toml: a key has more than 20 parts: not a scenario"),
        ("[run]", f"[{'a.' * 20_000}b]\n[run]", "my.toml: a key has more than 20 parts: not a scenario"),
        ("[run]", f"[{QUOTED * 20_000}b]\n[run]", "my.toml: a key has more than 20 parts: not a scenario"),
        ("[run]", f"x = {'[' * 20_000}\n[run]", "my.toml: not a scenario: nested too deeply"),
        ("[run]", f"{'[[a.b]]' + chr(10)}" * 16_000 + "[run]", "my.toml: has more than 100 tables: not a scenario"),
        ("[run]", f"x = '{'a' * 5_500_000}'\n[run]", "my.toml: longer than 4000000 characters: not a scenario"),
    ],
)
def test_a_scenario_beyond_all_measure_is_refused_at_once(old: str, new: str, message: str) -> None:
    assert refusal(GOOD.replace(old, new)) == message


def test_a_long_text_without_dots_is_no_long_key() -> None:
    text = f'description = """{"word " * 50_000}{"a" * 300_000} ..... """\n{GOOD}'
    with processor_time(5.0):
        read_scenario(text, "my.toml")


def test_a_whole_number_beyond_all_floats_is_refused() -> None:
    problem = read_scenario(GOOD, "my.toml").problem
    with pytest.raises(ss.InputError, match=r"thickness must be a number in m .*, got a whole number beyond 1e300"):
        ss.ElasticSlab(2800, 3500, 10**400, 1e8)
    with pytest.raises(ss.InputError, match=r"duration must be a number in s .*, got a whole number beyond 1e300"):
        ss.simulate(problem, 10**400)
    with pytest.raises(ss.InputError, match=r"friction\[1\] must be a number, got a whole number beyond 1e300"):
        ss.friction.FromTable(slip=[0, 1], friction=[0.7, 10**400])


def test_a_dataset_larger_than_memory_is_refused() -> None:
    solution = ss.simulate("fig6-slab")
    with pytest.raises(ss.InputError, match=r"dataset: 2e\+08 values are too many"):
        solution.to_dataset(np.broadcast_to(1.0, 200_000_000))
    with pytest.raises(ss.InputError, match="times must be finite numbers"):
        solution.slip(10**400)


def test_a_run_of_too_many_round_trips_is_refused() -> None:
    scenario = read_scenario(GOOD.replace('"10 km"', "4e-24"), "my.toml")
    with pytest.raises(ss.InputError, match=r"duration must be at most 2.06e-11 s, 2\^53 round trips of 2.29e-27 s, got 12 s"):
        ss.simulate(scenario)
    with pytest.raises(ss.InputError, match=r"duration must be at most 5.15e\+16 s"):
        ss.simulate(read_scenario(GOOD, "my.toml").problem, 1e30)


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A folder with a scenario that takes its points from a file, and a secret beside it."""
    found = tmp_path / "scenario"
    found.mkdir()
    (tmp_path / "secret.csv").write_text("password hunter2\n")
    (found / "points.csv").write_text(POINTS)
    return found


def of_file(folder: Path, name: str) -> Path:
    path = folder / "my.toml"
    path.write_text(TABLE.replace("FILE", name))
    return path


def test_points_may_be_in_the_folder_of_the_scenario(folder: Path) -> None:
    assert load_scenario(of_file(folder, "points.csv")).problem.friction.kind == "table"
    (folder / "link.csv").symlink_to("points.csv")
    assert load_scenario(of_file(folder, "link.csv")).problem.friction.kind == "table"


@pytest.mark.parametrize("name", ["../secret.csv", "out.csv", "up/secret.csv", "/etc/passwd"])
def test_points_outside_the_folder_of_the_scenario_are_not_read(folder: Path, name: str) -> None:
    (folder / "out.csv").symlink_to("../secret.csv")
    (folder / "up").symlink_to("..")
    with pytest.raises(ss.InputError, match=r"the file must be in the folder|the path must be relative") as caught:
        load_scenario(of_file(folder, name))
    assert "hunter2" not in str(caught.value)


def test_points_may_lie_anywhere_for_a_reader_who_says_so(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The environment says it, which a scenario cannot; anything but 1 does not."""
    outside = folder.parent / "outside.csv"
    outside.write_text((folder / "points.csv").read_text())
    for said in ("0", "yes"):
        monkeypatch.setenv("STICKSLIP_FILES_ANYWHERE", said)
        with pytest.raises(ss.InputError, match="STICKSLIP_FILES_ANYWHERE=1 in the environment allows others"):
            load_scenario(of_file(folder, "../outside.csv"))
    monkeypatch.setenv("STICKSLIP_FILES_ANYWHERE", "1")
    for name in ("../outside.csv", str(outside)):
        assert load_scenario(of_file(folder, name)).problem.friction.kind == "table"


@pytest.mark.parametrize("content", ["password hunter2\n", "slip (m),friction\n0,hunter2\n", "slip (m),friction,hunter2\n0,1,2\n"])
def test_no_message_shows_what_a_file_holds(folder: Path, content: str) -> None:
    (folder / "points.csv").write_text(content)
    with pytest.raises(ss.InputError) as caught:
        load_scenario(of_file(folder, "points.csv"))
    assert "hunter2" not in str(caught.value)


def test_a_line_beyond_all_measure_is_refused_at_once(folder: Path) -> None:
    (folder / "points.csv").write_text(f"slip,friction,{'x,' * 500_000}\n0,1\n")
    with processor_time(1.0), pytest.raises(ss.InputError, match="line 1: longer than 50000 characters: not a table of points"):
        load_scenario(of_file(folder, "points.csv"))


def test_what_a_message_repeats_of_a_file_stays_on_its_line_and_is_escaped(capsys: pytest.CaptureFixture[str]) -> None:
    error = ss.InputError("events.csv: the row 'a\n\x1b[31mb\u2028'")
    assert str(error) == r"events.csv: the row 'a\n\x1b[31mb\u2028'"
    assert str(type(error)(str(error))) == str(error)
    assert "\x1b" not in said(capsys, "show", "a\x1b[31m\r.csv")


def test_a_pipe_is_not_waited_for(folder: Path, tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe")
    os.mkfifo(folder / "pipe")
    with pytest.raises(ss.InputError, match="pipe: not an ordinary file: not a scenario"):
        load_scenario(tmp_path / "pipe")
    with pytest.raises(ss.InputError, match="no such file beside the scenario"):
        load_scenario(of_file(folder, "pipe"))


def said(capsys: pytest.CaptureFixture[str], *arguments: str) -> str:
    """What the command says of what cannot be used."""
    with pytest.raises(SystemExit) as ended:
        main(arguments)
    shown = capsys.readouterr()
    assert ended.value.code == 2
    assert shown.err.count("\n") == 1
    return shown.err


@pytest.mark.parametrize("pieces", [10**15, 10**30, 1e15])
def test_a_history_that_no_machine_can_hold_is_refused(pieces: int) -> None:
    with pytest.raises(ss.InputError, match=r"simulate: max_pieces must be (a whole number above 0|below 1e\+09), got 1"):
        ss.simulate("fig6-slab", max_pieces=pieces)


def test_a_run_ends_in_order_where_memory_is_short(monkeypatch: pytest.MonkeyPatch) -> None:
    from stickslip.engine.state import layout

    def short(*_: object) -> None:
        raise MemoryError

    scenario = ss.load_scenario("cycles-block")
    whole = ss.simulate(scenario, 2000 * ss.YEAR)
    monkeypatch.setattr(layout, "resized", short)
    cut = ss.simulate(scenario, 2000 * ss.YEAR)
    assert cut.status.name == "too many pieces"
    assert 0 < len(cut.history) < len(whole.history)
