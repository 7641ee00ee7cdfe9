"""`stickslip show` tells what is in a file of results, as the run that made it did."""

import re
import shutil
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

import stickslip as ss
from stickslip import __version__
from stickslip.cli.options import complete_result, complete_scenario, complete_source
from stickslip.cli.output.summary import statistics
from stickslip.problem.scenarios.scenario import load_scenario
from tests.command_line import Command


@pytest.fixture(scope="module")
def results(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with a run, a catalogue, a sweep, and two files that hold no results."""
    folder, problem = tmp_path_factory.mktemp("results"), load_scenario("cycles-block").problem
    ss.simulate(problem, 20 * ss.YEAR, checkpoint=folder / "run.nc")
    ss.catalogue(problem, 20 * ss.YEAR, folder / "events.csv")
    (folder / "bad.nc").write_text("no")
    (folder / "bad.csv").write_text("a,b\n1,2\n")
    return folder


def after_title(text: str) -> str:
    """Return a summary without its first line."""
    return text.partition("\n")[2]


def test_show_repeats_the_summary_of_the_run_and_says_what_made_it(command: Command):
    ran = after_title(command("run", "fig5-slab-printed", "--duration", "5 minutes", "--out", "run.nc").out)
    shown = command("show", "run.nc")
    assert (shown.code, shown.err) == (0, "")
    summary, _, made = after_title(shown.out).partition("made by ")
    assert summary == ran.partition("written: ")[0]
    assert made == f"stickslip {__version__}; `stickslip show run.nc --scenario` prints its scenario\n"


def test_the_scenario_of_a_run_can_be_run_again(command: Command, tmp_path: Path):
    command("run", "fig6-slab", "--duration", "3 s", "--rtol", "1e-8", "--out", "run.nc")
    (tmp_path / "again.toml").write_text(command("show", "run.nc", "--scenario").out)
    again = load_scenario(tmp_path / "again.toml")
    assert again.description == load_scenario("fig6-slab").description
    assert (again.problem, again.duration, again.rtol) == (load_scenario("fig6-slab").problem, 3.0, 1e-8)


def test_figures_are_drawn_from_the_file(command: Command, results: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    shutil.copy(results / "run.nc", tmp_path)
    monkeypatch.setattr("stickslip.run.simulate.simulate", lambda *_, **__: pytest.fail("ran"))
    shown = command("show", "run.nc", "--figure", "a.svg", "--energy-figure", "b.svg")
    assert shown.code == 0
    assert {line for line in shown.out.splitlines() if "written" in line} == {f"written: {name}.svg" for name in "ab"}
    assert {path.name for path in tmp_path.iterdir()} == {"run.nc", "a.svg", "b.svg"}


@pytest.mark.slow
@pytest.mark.drawn
def test_the_figure_of_a_catalogue_in_one_column_says_nothing_else(command: Command, results: Path):
    drawn = command("show", str(results / "events.csv"), "--catalogue-figure", "events.png", "--size", "single column")
    assert (drawn.code, drawn.err) == (0, "")
    assert "written: events.png" in drawn.out


@pytest.mark.drawn
def test_a_figure_that_is_too_small_for_its_panels_is_told_in_one_line(command: Command):
    for option in ("--catalogue-figure", "--figure"):
        drawn = command("run", "cycles-block", option, "a.png", "--size", "2.1 x 2.1 cm")
        assert drawn.code == 0
        assert drawn.err == (
            "stickslip: note: a.png: the panels and labels of this figure do not fit into its size: give a larger --size\n"
        )


def test_without_slip_events_the_missing_figure_of_the_catalogue_is_explained(command: Command, tmp_path: Path):
    still = ["fig6-slab", "--set", "initial.excess=-1e6", "--duration", "2 s", "--catalogue-figure", "events.png"]
    for arguments in (["run", *still, "--out", "run.nc"], ["run", *still, "--catalogue", "events.csv"]):
        ran = command(*arguments)
        assert (ran.code, ran.err) == (0, "")
        assert "not written: events.png (there is no slip event)" in ran.out
    for name in ("run.nc", "events.csv"):
        shown = command("show", name, "--catalogue-figure", "events.png")
        assert (shown.code, shown.err) == (0, "")
        assert "not written: events.png (there is no slip event)" in shown.out
    assert not (tmp_path / "events.png").exists()


@pytest.mark.parametrize("suffix", [".csv", pytest.param(".nc", marks=pytest.mark.slow), ".parquet"])
def test_show_lists_the_events_of_a_catalogue(command: Command, suffix: str):
    if suffix == ".parquet":
        pytest.importorskip("pyarrow")
    assert command("run", "cycles-block", "--duration", "50 years", "--catalogue", f"events{suffix}").code == 0
    for name in (f"events{suffix}", "events.checkpoint.nc"):
        shown = command("show", name)
        assert (shown.code, shown.err) == (0, "")
        assert "finished: the run reached its duration" in shown.out
        assert "11 slip events" in shown.out
        assert f"made by stickslip {__version__}" in shown.out
    whole = command("run", "cycles-block", "--duration", "50 years").out
    rows = [line for line in whole.partition("11 slip events")[2].partition("no shock")[0].splitlines() if "e" not in line[:1]]
    assert rows[5] in command("show", "events.checkpoint.nc").out


def test_a_table_without_its_checkpoint_is_shown_without_its_origin(command: Command, tmp_path: Path):
    command("run", "cycles-block", "--duration", "50 years", "--catalogue", "events.csv")
    (tmp_path / "events.checkpoint.nc").unlink()
    shown = command("show", "events.csv").out
    assert "11 slip events" in shown
    assert "made by" not in shown
    assert command("show", "events.csv", "--scenario").refusal.startswith("events.csv: does not hold its scenario")


def test_a_catalogue_of_another_version_may_lack_columns(command: Command, results: Path) -> None:
    table = pd.read_csv(results / "events.csv").drop(columns=["pulses", "amplification", "static_drop"])
    table.to_csv(results / "older.csv", index=False)
    shown = command("show", str(results / "older.csv"))
    assert (shown.code, shown.err) == (0, "")
    assert "traction" in shown.out
    assert "pulses" not in shown.out


@pytest.mark.parametrize(("slips", "percent"), [([1.0, 2.0, 3.0], "50"), ([2.0, 2.0, 5.0], "58")])
def test_the_scatter_of_slips_is_a_share_of_their_mean(slips: list[float], percent: str) -> None:
    (line,) = statistics({"recurrence": [np.nan] * 3, "slip": slips, "start": [1.0, 2.0, 3.0], "end": [1.5, 2.5, 3.5]})
    assert re.fullmatch(rf"slip: mean [23] m, standard deviation {percent} % of it\n", line)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["no.nc"], "no.nc: no such file"),
        (["fig6-slab"], "fig6-slab: not a file of results, whose names end in .nc, .csv, .parquet"),
        (["bad.nc"], "bad.nc: not a netCDF file that can be read"),
        (["bad.csv"], "bad.csv: not a catalogue of slip events: there is no column start"),
        (["."], ".: is a folder that holds no results of stickslip"),
        (["run.nc", "--space-time", "a.png"], "show: --space-time needs a slab or a string: a block is rigid"),
        (["events.csv", "--figure", "a.png"], "events.csv: a catalogue keeps slip events only, no history: leave out --figure"),
    ],
)
def test_what_cannot_be_shown_is_told_in_one_line(
    command: Command, tmp_path: Path, results: Path, arguments: list[str], message: str
):
    shutil.copytree(results, tmp_path, dirs_exist_ok=True)
    before = sorted(tmp_path.iterdir())
    assert command("show", *arguments).refusal.startswith(message)
    assert sorted(tmp_path.iterdir()) == before


@pytest.mark.parametrize("command_line", [["show"], ["run", "--resume"]])
@pytest.mark.parametrize(
    ("metadata", "message"),
    [
        (
            '{"attributes": {"title": "a", "stickslip_spectra": 1}}',
            "holds results of an extension that is not installed",
        ),
        ('{"attributes": {"title": "of another program"}}', "is a folder that holds no results of stickslip"),
        ('{"attributes": 3}', "is a folder that holds no results of stickslip"),
        ("[" * 100_000, "is a folder that holds no results of stickslip"),
        ("", "is a folder that holds no results of stickslip"),
    ],
)
def test_a_folder_that_nobody_reads_is_told_apart_from_that_of_an_extension_that_is_missing(
    command: Command, tmp_path: Path, command_line: list[str], metadata: str, message: str
):
    (tmp_path / "kept.zarr").mkdir()
    (tmp_path / "kept.zarr" / "zarr.json").write_text(metadata, encoding="utf-8")
    with pytest.raises(ss.InputError, match=message):
        ss.open_solution(tmp_path / "kept.zarr")
    assert command(*command_line, "kept.zarr").refusal.startswith(f"kept.zarr: {message}")


def test_results_are_completed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    for name in ("a.nc", "a.csv", "a.toml"):
        (tmp_path / name).touch()
    (tmp_path / "a.zarr").mkdir()
    (tmp_path / "deeper").mkdir()
    monkeypatch.chdir(tmp_path)
    assert complete_result("a") == ["a.csv", "a.nc", "a.zarr"]
    assert complete_result("") == ["a.csv", "a.nc", "a.zarr", "deeper/"]
    assert complete_source("a.") == ["a.nc", "a.toml", "a.zarr/"]
    assert complete_scenario("a.") == ["a.toml", "a.zarr/"]
