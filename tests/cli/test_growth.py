"""Runs with long histories say so in time, with the size of their file."""

import re
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import stickslip as ss
from stickslip.cli.long_run import Growth
from stickslip.cli.output.files import file_size
from stickslip.io.netcdf import history_variables, piece_size
from stickslip.run.progress import LONG_RUN, Report
from tests.cli.conftest import Outcome

Command = Callable[..., Outcome]

PROBLEM = ss.load_scenario("fig5-slab-printed").problem


def report(pieces: int, time: float) -> Report:
    """A report of a run of 1000 s."""
    return Report(time, 1000.0, 0, None, pieces, "creeping", 1.0, 1.0)


def test_the_size_of_a_piece_is_that_in_files(tmp_path: Path):
    """From two runs of different lengths, because curves and tables have nearly the same size in both. To 2 %."""
    short, long = (ss.simulate(PROBLEM, length, creep_rtol=0.0) for length in (600.0, 1200.0))
    less, more = (run.to_netcdf(tmp_path / "run.nc").stat().st_size for run in (short, long))
    pieces = len(long.history) - len(short.history)
    assert (more - less) / pieces == pytest.approx(piece_size(PROBLEM), rel=0.02, abs=0.0)


def test_a_law_with_a_state_adds_its_series_to_a_piece():
    run = ss.simulate(ss.load_scenario("rate-and-state-block").problem, 2e5)
    stored = sum(np.asarray(one.values).nbytes for one in history_variables(run).values() if "piece" in one.dims)
    assert stored == piece_size(run.problem) * len(run.history) > piece_size(PROBLEM) * len(run.history)


def test_growth_is_told_once_and_at_every_doubling(capsys: pytest.CaptureFixture[str]):
    growth = Growth(PROBLEM, Path("run.nc"), 10 * LONG_RUN, is_given=True)
    told = []
    for pieces in (LONG_RUN - 1, LONG_RUN, LONG_RUN + 1, 2 * LONG_RUN - 1, 2 * LONG_RUN, 3 * LONG_RUN, 4 * LONG_RUN):
        growth.look(report(pieces, 500.0))
        told.append(bool(capsys.readouterr().err))
    assert told == [False, True, False, False, True, False, True]


@pytest.mark.parametrize(
    ("most", "is_given", "time", "message"),
    [
        (10 * LONG_RUN, True, 500.0, "at this rate {whole} at the end of the run; --catalogue FILE instead keeps slip events only"),
        (
            3 * LONG_RUN,
            False,
            100.0,
            "at this rate the run ends too early, at 0.6 million pieces and is not written, unless",
        ),
        (3 * LONG_RUN, True, 100.0, "at this rate the run ends too early, at 0.6 million pieces, unless --max-pieces allows more"),
        (3 * LONG_RUN, True, 0.0, "at this rate the run ends too early, at 0.6 million pieces, unless --max-pieces allows more"),
    ],
)
def test_what_a_long_run_will_need_is_told(
    capsys: pytest.CaptureFixture[str], most: int, is_given: bool, time: float, message: str
):
    Growth(PROBLEM, Path("run.nc"), most, is_given).look(report(LONG_RUN, time))
    shown = capsys.readouterr()
    now, whole = (file_size(pieces * piece_size(PROBLEM)) for pieces in (LONG_RUN, 2 * LONG_RUN))
    assert shown.out == ""
    assert shown.err.startswith(f"run.nc grows large: {now} so far, 0.2 million pieces; ")
    assert message.format(whole=whole) in shown.err
    assert shown.err.count("\n") == 1


def test_a_large_limit_is_told_before_the_run(capsys: pytest.CaptureFixture[str]):
    Growth(PROBLEM, Path("run.nc"), 4_000_000, is_given=True).tell_limit()
    assert capsys.readouterr().err.startswith("run.nc: up to 1.7 GB, 4 million pieces; --catalogue FILE instead")
    for growth in (Growth(PROBLEM, None, 4_000_000, True), Growth(PROBLEM, Path("a.nc"), 4_000_000, False)):
        growth.tell_limit()
    assert capsys.readouterr().err == ""


def test_a_long_run_says_how_large_its_file_becomes_before_it_is_written(
    command: Command, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    told, look = [], Growth.look

    def soon(self: Growth, about: Report) -> None:
        self.next_at = min(self.next_at, 1000)
        look(self, about)
        if self.next_at > 1000:
            told.append((tmp_path / "run.nc").exists())

    monkeypatch.setattr(Growth, "look", soon)
    monkeypatch.setattr("stickslip.cli.output.files.LARGE", 1000)
    shown = command("run", "fig5-slab-printed", "--duration", "10 minutes", "--creep-rtol", "0", "--out", "run.nc")
    assert shown.code == 0
    assert told
    assert not any(told)
    assert shown.err.startswith("run.nc grows large: ")
    assert re.search(r"\nwritten: run\.nc \(5\.\d+ MB\)\n$", shown.out)


def test_progress_counts_pieces_when_they_are_many():
    assert "million" not in str(report(LONG_RUN - 1, 1.0))
    assert "1.5 million pieces" in str(report(1_500_000, 1.0))


def test_sizes_are_short():
    assert [file_size(size) for size in (12, 1.5e3, 2.34e7, 1.668e9)] == ["12 bytes", "1.5 kB", "23.4 MB", "1.67 GB"]
