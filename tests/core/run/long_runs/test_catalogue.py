"""A catalogue that is told while its history is forgotten is that of the whole history."""

from __future__ import annotations

import importlib.util
import os
import signal
import sys
from itertools import pairwise
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import xarray as xr

import stickslip as ss
from stickslip.engine.input.limits import split_time
from stickslip.engine.state.layout import Floats
from stickslip.run import catalogue as module
from stickslip.run.catalogue import EventRows
from stickslip.run.exact_run import ExactRun
from stickslip.run.options import CallOptions
from stickslip.run.progress import Report
from stickslip.run.resume import PausedCatalogue
from stickslip.run.run_loop import Interrupts, Monitor, run_loop
from stickslip.solution.files.catalogue_rows import RowsInMemory
from stickslip.solution.observables.energy.pulses import Pulses
from stickslip.solution.observables.event_table import ENERGY_COLUMNS, EVENT_COLUMNS, Column, FoundEvents
from tests.core.run.long_runs.problems import RUNS, bundled, killed

NEEDS_PYARROW = pytest.mark.skipif(importlib.util.find_spec("pyarrow") is None, reason="needs pyarrow")
SUFFIXES = ["csv", "nc", pytest.param("parquet", marks=NEEDS_PYARROW)]


def same(one: pd.DataFrame, other: pd.DataFrame) -> None:
    """Every number of two tables is the same, to the last digit, and so are their types."""
    pd.testing.assert_frame_equal(one, other, check_exact=True)


def last_fracture(found: FoundEvents) -> Floats:
    """Return the fracture energy of the last pulse of each event: a column as somebody might add it."""
    pulses = Pulses.of(found.history, found.events)
    of_event = np.full(len(found.events.pulses), np.nan)
    of_event[pulses.event] = pulses.fracture(found.history)
    return of_event


@pytest.mark.sampled(every=2)
@pytest.mark.parametrize("name", ["rate law, fragments", "slab that heals"])
def test_a_column_on_pulses_is_that_of_the_whole_run(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """The pulses are those of the events that are asked for, not those with which the history that is left begins."""
    monkeypatch.setattr(module, "CAPACITY", 64)
    monkeypatch.setattr("stickslip.engine.session.FIRST_CAPACITY", 64)
    monkeypatch.setitem(EVENT_COLUMNS, "last_fracture", Column("energy", "fracture energy of the last pulse", last_fracture))
    table = ss.catalogue(*RUNS[name])
    assert len(table) > 5
    same(table, ss.simulate(*RUNS[name]).catalogue())


@pytest.mark.sampled(every=19)
@pytest.mark.parametrize("name", RUNS)
@pytest.mark.parametrize("capacity", [64, 512])
def test_the_catalogue_is_the_table_of_the_whole_run(name: str, capacity: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "CAPACITY", capacity)
    monkeypatch.setattr("stickslip.engine.session.FIRST_CAPACITY", capacity)
    problem, duration = RUNS[name]
    for rate in (None, 0.0):
        table = ss.catalogue(problem, duration, event_rate=rate)
        same(table, ss.simulate(problem, duration).catalogue(rate))
        assert table.attrs["status"] == ss.simulate(problem, duration).status.name


@pytest.mark.sampled(every=3)
@pytest.mark.parametrize("suffix", SUFFIXES)
def test_files_hold_every_digit(suffix: str, tmp_path: Path) -> None:
    problem, duration = RUNS["slab that heals"]
    path = tmp_path / f"events.{suffix}"
    table = ss.catalogue(problem, duration, path)
    same(table, ss.simulate(problem, duration).catalogue())
    assert sorted(file.name for file in tmp_path.iterdir()) == ["events.checkpoint.nc", path.name]


def test_netcdf_holds_scenario_status_and_units(tmp_path: Path) -> None:
    ss.catalogue(*RUNS["slab that heals"], tmp_path / "events.nc")
    with xr.open_dataset(tmp_path / "events.nc", engine="h5netcdf", decode_times=False) as file:
        assert file.attrs["status"] == "finished"
        assert 'kind = "linear-slip-weakening"' in file.attrs["scenario"]
        assert [file[name].attrs["units"] for name in ("start", "slip", "peak_rate", "traction_drop")] == ["s", "m", "m s-1", "Pa"]


@pytest.mark.sampled(every=2)
@pytest.mark.parametrize(("name", "unit"), [("slab that heals", "J m-2"), ("block that heals", "J")])
def test_netcdf_names_the_units_of_energies(name: str, unit: str, tmp_path: Path) -> None:
    problem, duration = RUNS[name]
    table = ss.catalogue(problem, duration, tmp_path / "events.nc", energy=True)
    same(table, ss.catalogue(problem, duration, energy=True))
    with xr.open_dataset(tmp_path / "events.nc", engine="h5netcdf", decode_times=False) as file:
        assert {file[name].attrs["units"] for name in ENERGY_COLUMNS} == {unit}


@pytest.mark.sampled(every=3)
@pytest.mark.parametrize("suffix", SUFFIXES)
def test_a_finished_catalogue_continues(suffix: str, tmp_path: Path) -> None:
    """Also where the end of the first run cut an event, whose row is made again."""
    problem, duration = RUNS["slab that heals"]
    whole = ss.simulate(problem, duration).catalogue()
    for end in (0.5 * (whole.start[4] + whole.end[4]), 0.6 * duration):
        path = tmp_path / f"events.{suffix}"
        first = ss.catalogue(problem, float(end), path)
        assert len(first) < len(whole)
        same(ss.resume(tmp_path / "events.checkpoint.nc", duration), whole)
        same(ss.resume(tmp_path / "events.checkpoint.nc"), whole)


@pytest.mark.slow
@pytest.mark.sampled(every=3)
@pytest.mark.parametrize("name", ["rate law, fragments", "slab that heals", "block that heals"])
def test_energies_survive_a_forgotten_history(name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """As those of the whole run, and taken up too: relative 1e-12 of the largest, for sums run over other pieces."""
    monkeypatch.setattr(module, "CAPACITY", 64)
    problem, duration = RUNS[name]
    run = ss.simulate(problem, duration)
    whole = run.catalogue(energy=True)
    ss.catalogue(problem, 0.7 * duration, tmp_path / "events.csv", energy=True)
    found = ss.resume(tmp_path / "events.checkpoint.nc", duration)
    assert list(found.columns) == list(whole.columns)
    for energy in ENERGY_COLUMNS:
        np.testing.assert_allclose(found[energy], whole[energy], rtol=0.0, atol=1e-12 * whole.released.abs().max(), err_msg=energy)
    if isinstance(problem.body, ss.ElasticSlab):
        assert found.attrs["trapped"] == run.trapped_note
    finished = found[found.end.notna()]
    assert (finished.balance.abs() < 1e-9 * finished.released.abs().max()).all()


@pytest.mark.sampled(every=2)
@pytest.mark.parametrize("events", [1, 5])
def test_a_number_of_events_stops_a_catalogue_as_it_stops_a_run(events: int, tmp_path: Path) -> None:
    problem, duration = RUNS["slab that heals"]
    short = ss.catalogue(problem, duration, tmp_path / "events.csv", max_events=events)
    same(short, ss.simulate(problem, duration, max_events=events).catalogue())
    assert short.attrs["status"] == "enough events"
    longer = ss.resume(tmp_path / "events.checkpoint.nc", max_events=events + 2)
    same(longer, ss.simulate(problem, duration, max_events=events + 2).catalogue())
    same(ss.resume(tmp_path / "events.checkpoint.nc", duration), ss.simulate(problem, duration).catalogue())


@pytest.mark.slow
def test_memory_does_not_grow_with_the_number_of_events(monkeypatch: pytest.MonkeyPatch) -> None:
    """Ten thousand cycles, of which the history would be two hundred thousand pieces."""
    problem, duration = bundled("cycles-block", 1500.0)
    run = ExactRun.begin(problem, CallOptions(duration))
    monkeypatch.setattr(EventRows, "record", lambda self, new: (new.tell(), self._remember()))
    monitor = Monitor(run, EventRows(run, RowsInMemory()))
    capacities = {len(run.store.pieces)}
    for share in (0.01, 0.1, 1.0):
        run.last = split_time(share * duration, problem.round_trip_time)
        run_loop(run, monitor, Interrupts())
        run.count.to_the_end, run.before_end = 0, None
        capacities.add(len(run.store.pieces))
    assert run.stream.reported > 9_000
    assert run.forgotten > 150_000
    assert capacities == {256}


def test_an_event_that_does_not_end_fills_the_memory_and_says_so() -> None:
    """A contact that creeps for ever above the event rate is one event, and its history has to be kept."""
    problem = ss.Problem(ss.SpringBlock(1.0, 1.0, 10.0), ss.friction.SinusoidalSlip(0.5, 0.01, 1.0), 0.1, initial_excess=1e-3)
    table = ss.catalogue(problem, 1e6, event_rate=1e-9, max_pieces=20_000)
    assert table.attrs["status"] == "too many pieces"


def test_progress_counts_what_was_forgotten(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "CAPACITY", 64)
    problem, duration = RUNS["slab that heals"]
    seen: list[Report] = []
    table = ss.catalogue(problem, duration, progress=seen.append)
    assert seen[-1].events == table.end.notna().sum()
    assert seen[-1].pieces == len(ss.simulate(problem, duration).history)
    assert {report.doing for report in seen} <= {"stuck", "creeping", "slipping"}
    assert all(later.time >= earlier.time for earlier, later in pairwise(seen))


LONG = """
problem = ss.load_scenario("cycles-slab").problem
ss.catalogue(problem, 1e9, "events.{suffix}", checkpoint_every=0.0, progress=lambda _: time.sleep(0.01))
"""


@pytest.mark.slow
@pytest.mark.sampled(every=4)
@pytest.mark.skipif(os.name != "posix", reason="needs SIGKILL")
@pytest.mark.parametrize(("suffix", "with_signal"), [("csv", "SIGKILL"), ("nc", "SIGKILL"), ("csv", "SIGINT"), ("nc", "SIGINT")])
def test_a_killed_or_interrupted_catalogue_ends_with_the_same_rows(suffix: str, with_signal: str, tmp_path: Path) -> None:
    done = killed(LONG.format(suffix=suffix), tmp_path, "events.checkpoint.nc", signal.Signals[with_signal], times=3)
    assert done.returncode == (0 if with_signal == "SIGINT" else -signal.SIGKILL)
    checkpoint = tmp_path / "events.checkpoint.nc"
    paused = PausedCatalogue.read(checkpoint)
    assert paused.stopped.status.name == ("interrupted" if with_signal == "SIGINT" else "under way")
    end = paused.stopped.history.duration * 1.2
    growing = paused.rows.growing
    if with_signal == "SIGKILL":
        with growing.open("a") as file:
            file.write("1.5,2.5,half a row")  # what a process that dies while it writes leaves behind
    same(ss.resume(checkpoint, end), ss.simulate(paused.stopped.problem, end).catalogue())
    assert not (tmp_path / "events.rows.csv").exists()


def test_a_run_that_begins_anew_forgets_the_old_one(tmp_path: Path) -> None:
    problem, duration = RUNS["slab that heals"]
    for _ in range(2):
        table = ss.catalogue(problem, duration, tmp_path / "events.csv")
    same(table, ss.simulate(problem, duration).catalogue())


def test_lost_rows_are_noticed(tmp_path: Path) -> None:
    problem, duration = RUNS["slab that heals"]
    ss.catalogue(problem, duration, tmp_path / "events.csv")
    header = (tmp_path / "events.csv").read_text().splitlines()[0]
    (tmp_path / "events.csv").write_text(f"{header}\n")
    with pytest.raises(ss.InputError, match=r"events\.csv: has lost rows that the checkpoint counts on"):
        ss.resume(tmp_path / "events.checkpoint.nc", 2 * duration)


def test_solution_and_checkpoint_are_not_taken_for_each_other(tmp_path: Path) -> None:
    problem, duration = RUNS["slab that heals"]
    ss.catalogue(problem, duration, tmp_path / "events.csv")
    ss.simulate(problem, duration).to_netcdf(tmp_path / "run.nc")
    with pytest.raises(ss.InputError, match=r"events\.checkpoint\.nc: not a solution .*stickslip\.resume\)"):
        ss.open_solution(tmp_path / "events.checkpoint.nc")
    with pytest.raises(ss.InputError, match=r"run\.nc: not a catalogue's checkpoint .*stickslip\.resume\)"):
        PausedCatalogue.read(tmp_path / "run.nc")
    with pytest.raises(ss.InputError, match=r"events\.checkpoint\.nc: a catalogue is resumed in its own file"):
        ss.resume(tmp_path / "events.checkpoint.nc", checkpoint=tmp_path / "other.nc")


def test_bad_arguments_are_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    problem, duration = RUNS["slab that heals"]
    for arguments, message in (
        ({"path": tmp_path / "events.txt"}, r"events\.txt: the name must end in \.csv, \.parquet or \.nc"),
        ({"event_rate": -1.0}, "event_rate must be at least 0 m/s, got -1"),
        ({"event_rate": np.nan}, "event_rate must be finite, got nan"),
        ({"max_events": -1}, "catalogue: max_events must be a whole number above 0, got -1"),
    ):
        with pytest.raises(ss.InputError, match=message):
            ss.catalogue(problem, duration, **arguments)
    monkeypatch.setitem(sys.modules, "pyarrow", None)
    monkeypatch.setattr("importlib.util.find_spec", lambda name: None)
    with pytest.raises(ss.InputError, match=r"events\.parquet: Parquet needs pyarrow \(pip install 'stickslip\[parquet\]'\)"):
        ss.catalogue(problem, duration, tmp_path / "events.parquet")
    assert list(tmp_path.iterdir()) == []
