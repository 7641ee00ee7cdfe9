"""`stickslip run` stopped, taken up, and kept as a catalogue."""

from __future__ import annotations

import re
import shutil
import signal
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path

import pandas as pd
import pytest

import stickslip as ss
from stickslip.cli.output.files import file_size
from stickslip.problem.scenarios.scenario import Scenario
from stickslip.run.progress import Progress, Report
from stickslip.solution.files.catalogue_rows import read_table
from tests.core.run.long_runs.problems import differences


def test_a_run_continues(command, tmp_path: Path):
    assert command("run", "cycles-block", "--duration", "20 years", "--out", "run.nc").code == 0
    shown = command("run", "--resume", "run.nc", "--duration", "50 years")
    assert shown.code == 0
    assert "11 slip events" in shown.out
    assert "written: run.nc" in shown.out
    problem = ss.load_scenario("cycles-block").problem
    assert differences(ss.open_solution(tmp_path / "run.nc"), ss.simulate(problem, 50 * ss.YEAR)) == []
    assert command("run", "cycles-block", "--resume", "run.nc", "--duration", "60 years", "--out", "longer.nc").code == 0
    assert ss.open_solution(tmp_path / "run.nc").duration == 50 * ss.YEAR
    assert ss.open_solution(tmp_path / "longer.nc").duration == 60 * ss.YEAR


@pytest.mark.parametrize(("events", "said"), [("1", "\n1 slip event\n"), ("2", "\n2 slip events\n")])
def test_the_summary_of_a_catalogue_counts_its_events(command, events: str, said: str):
    assert said in command("run", "cycles-block", "--events", events, "--catalogue", "events.csv").out


def test_a_catalogue_continues(command, tmp_path: Path):
    shown = command("run", "cycles-block", "--duration", "100 years", "--catalogue", "events.csv")
    assert shown.code == 0
    for text in ("finished: the run reached its duration", "22 slip events", "written: events.csv", "events.checkpoint.nc"):
        assert text in shown.out
    assert command("run", "--resume", "events.checkpoint.nc", "--duration", "200 years").code == 0
    whole = ss.simulate(ss.load_scenario("cycles-block").problem, 200 * ss.YEAR).events
    pd.testing.assert_frame_equal(read_table(Path("events.csv")), whole, check_exact=True)


def test_a_run_stops_after_the_requested_events(command, tmp_path: Path):
    shown = command("run", "cycles-block", "--duration", "10000 years", "--events", "3", "--out", "run.nc")
    assert "enough events: the run reached the requested number of slip events" in shown.out
    assert "3 slip events" in shown.out
    (tmp_path / "mine.toml").write_text(command("new", "cycles-block").out.replace("[run]\n", "[run]\nevents = 4\n"))
    assert "4 slip events" in command("run", "mine.toml", "--duration", "10000 years").out
    scenario = ss.load_scenario(tmp_path / "mine.toml")
    assert scenario.max_events == 4
    (tmp_path / "again.toml").write_text(scenario.to_toml())
    assert ss.load_scenario(tmp_path / "again.toml") == scenario


REFUSED = [
    (["run", "cycles-block", "--events", "0"], "run: --events must be a whole number above 0, got 0"),
    (["run", "cycles-block", "--catalogue", "events.txt"], "--catalogue events.txt: the name must end in .csv or .parquet or .nc"),
    (
        ["run", "cycles-block", "--catalogue", "a.csv", "--out", "a.nc"],
        "run: a catalogue keeps slip events only, no history: leave",
    ),
    (["run", "--resume", "run.nc", "--rtol", "1e-8"], "run: --resume goes on as the run began: leave out --set, --rtol,"),
    (["run", "--resume", "run.nc", "--set", "distance=1"], "run: --resume goes on as the run began: leave out --set, --rtol,"),
    (["run", "--resume", "none.nc"], "none.nc: no such file"),
    (["run", "--resume", "bad.nc"], "bad.nc: not a netCDF file that can be read"),
    (["run", "--resume", "run.nc", "--duration", "1 s"], "run.nc: the run has already reached"),
    (["run", "fig6-slab", "--resume", "run.nc"], "run.nc: is a run of another problem than fig6-slab: its body is SpringBlock("),
]


@pytest.fixture(scope="module")
def begun(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A file of a run."""
    path = tmp_path_factory.mktemp("begun") / "run.nc"
    ss.simulate(ss.load_scenario("cycles-block").problem, 20 * ss.YEAR, checkpoint=path)
    return path


@pytest.mark.sampled(every=3)
@pytest.mark.parametrize(("arguments", "message"), REFUSED)
def test_bad_input_gives_one_line_and_changes_nothing(command, tmp_path: Path, begun: Path, arguments: list[str], message: str):
    (tmp_path / "bad.nc").write_text("no")
    shutil.copy(begun, tmp_path)
    before = begun.read_bytes()
    assert command(*arguments).refusal.startswith(message)
    assert (tmp_path / "run.nc").read_bytes() == before
    assert sorted(path.name for path in tmp_path.iterdir()) == ["bad.nc", "run.nc"]


def test_leaps_over_creep_are_told(command):
    shown = command("run", "fig5-slab-printed", "--duration", "25 minutes").out
    assert re.search(r"creep_rtol 1e-06 \(automatic; 0 runs every round trip\): 1 leap over", shown)
    assert "automatic: leaps over creep after 200" in re.sub(r"\s+", " ", command("check", "fig5-slab-printed").out)


@pytest.mark.parametrize("options", [{}, {"creep_rtol": 1e-5}, {"creep_rtol": 0.0, "shortest_event": 0.0}])
def test_tolerances_of_leaps_stay_what_they_are_when_a_scenario_is_written(tmp_path: Path, options: dict[str, float]):
    """0 is another scenario than none."""
    scenario = replace(ss.load_scenario("fig5-slab-printed"), **options)
    (tmp_path / "mine.toml").write_text(scenario.to_toml())
    assert ss.load_scenario(tmp_path / "mine.toml") == scenario
    assert scenario.creep_rtol == options.get("creep_rtol")


@pytest.mark.sampled(every=2)
@pytest.mark.parametrize("option", [["--out", "run.nc"], ["--catalogue", "run.csv"]])
def test_ctrl_c_leaves_a_file_that_continues(command, monkeypatch: pytest.MonkeyPatch, option: list[str]):
    @contextmanager
    def interrupting(_: str) -> Iterator[Progress]:
        yield lambda report: signal.raise_signal(signal.SIGINT) if report.events >= 2 else None

    monkeypatch.setattr("stickslip.run.run_loop.LARGEST_BUDGET", 100)  # so that it does not end before anybody can interrupt
    monkeypatch.setattr("stickslip.run.run_loop.FIRST_BUDGET", 100)
    with monkeypatch.context() as patch:
        patch.setattr("stickslip.cli.kinds.progress_line", interrupting)
        shown = command("run", "cycles-block", *option)
    assert (shown.code, shown.err) == (130, "stickslip: interrupted\n")
    assert "interrupted: stopped by the user" in shown.out
    whole = ss.simulate("cycles-block")
    if option[0] == "--out":
        assert 2 <= len(ss.open_solution("run.nc").events) < len(whole.events)
        assert command("run", "--resume", "run.nc").code == 0
        assert differences(ss.open_solution("run.nc"), whole) == []
    else:
        assert 2 <= len(read_table(Path("run.csv"))) < len(whole.events)
        assert command("run", "--resume", "run.checkpoint.nc").code == 0
        pd.testing.assert_frame_equal(read_table(Path("run.csv")), whole.events, check_exact=True)


def test_progress_is_shown_in_sensible_units():
    report = Report(150 * ss.YEAR, 10_000 * ss.YEAR, 31, None, 5000, "stuck", 120.3 * ss.YEAR, 81.9)
    assert str(report) == "150 of 10000 years, 31 slip events, stuck, 120 years a second, 1.4 min left"
    start = Report(0.0, 12.0, 1, 4, 0, "slipping", float("nan"), float("nan"))
    assert str(start) == "0 of 12 s, 1 of 4 slip events, slipping"


def typed_in(line: str) -> list[str]:
    """Return the words of the command that a line of output names."""
    return line.partition("stickslip ")[2].partition(" goes on")[0].split()


@pytest.mark.parametrize("limit", [(), pytest.param(("--max-pieces", "600"), marks=pytest.mark.slow)], ids=["default", "asked for"])
def test_a_full_history_is_written_and_the_line_that_says_how_goes_on(
    command, limit: tuple[str, ...], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    monkeypatch.setattr("stickslip.problem.run_options.MAX_PIECES", 500)
    shown = command("run", "fig5-slab-printed", "--duration", "3 minutes", "--out", "run.nc", *limit)
    assert (shown.code, shown.err) == (1, "")
    assert "\ntoo many pieces" in shown.out
    assert "\nwritten: run.nc" in shown.out
    lines = [line for line in shown.out.splitlines() if line.startswith("nothing is lost")]
    pieces = len(ss.open_solution(tmp_path / "run.nc").history)
    assert pieces > (600 if limit else 500)
    assert lines == [f"nothing is lost: stickslip run --resume run.nc --max-pieces {2 * pieces} goes on from there"]
    again = command(*typed_in(lines[0]))
    assert len(ss.open_solution(tmp_path / "run.nc").history) > 1.5 * pieces
    assert again.code == (0 if "\nfinished" in again.out else 1)
    assert command("run", "--resume", "run.nc", "--max-pieces", "20000").code == 0
    whole = ss.simulate("fig5-slab-printed", "3 minutes", max_pieces=20_000)
    assert differences(ss.open_solution(tmp_path / "run.nc"), whole) == []


def test_a_history_for_which_memory_is_short_is_written(command, tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setenv("STICKSLIP_MEMORY", "3 MB")
    shown = command("run", "fig5-slab-printed", "--duration", "3 minutes", "--out", "run.nc", "--max-pieces", "100000000")
    assert (shown.code, shown.err) == (1, "")
    assert "\ntoo many pieces: memory is short: " in shown.out
    lines = [line for line in shown.out.splitlines() if line.startswith("nothing is lost")]
    assert lines == ["nothing is lost: stickslip run --resume run.nc goes on from there once more memory is free"]
    monkeypatch.delenv("STICKSLIP_MEMORY")
    assert command(*typed_in(lines[0])).code == 0
    assert ss.open_solution(tmp_path / "run.nc").status.name == "finished"


def test_a_size_of_memory_that_is_none_is_refused_in_one_line(command, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setenv("STICKSLIP_MEMORY", "much")
    said = "STICKSLIP_MEMORY: 'much' is not a size of memory; write it like 8 GB\n"
    assert command("run", "fig5-slab-printed").refusal == said


@pytest.mark.slow
def test_a_catalogue_whose_history_is_full_says_how_it_goes_on(command, tmp_path: Path):
    """A block that always slides has one event, whose history is kept."""
    pull = ss.loading.Sinusoidal(1.0, 0.5, 1.0)
    block = ss.Problem(ss.SpringBlock(1.0, 1.0, 1.0), "0.5 + 0.01*v", pull_rate=pull, initial_rate=1.0, initial_load=0.5)
    Path("slides.toml").write_text(Scenario(block, 3000.0).to_toml())
    shown = command("run", "slides.toml", "--catalogue", "events.csv", "--max-pieces", "300")
    assert shown.code == 1
    lines = [line for line in shown.out.splitlines() if line.startswith("nothing is lost")]
    assert lines == ["nothing is lost: stickslip run --resume events.checkpoint.nc --max-pieces 32768 goes on from there"]
    assert command(*typed_in(lines[0])).code == 0


def test_a_large_file_is_named_with_its_size(command, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr("stickslip.cli.output.files.LARGE_FILE", 1000)
    shown = command("run", "fig6-slab", "--out", "run.nc")
    assert shown.out.endswith(f"written: run.nc ({file_size(Path('run.nc').stat().st_size)})\n")


def test_sizes_are_short():
    assert [file_size(size) for size in (12, 1.5e3, 2.34e7, 1.668e9)] == ["12 bytes", "1.5 kB", "23.4 MB", "1.67 GB"]
