"""Runs with leaps over creep: stopped and taken up, stopped by events, streamed, in local time."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

import stickslip as ss
from stickslip.problem.run_codes import UNDER_WAY, Stop
from stickslip.run import catalogue as module
from stickslip.run.exact_run import ExactRun
from stickslip.run.options import CallOptions
from stickslip.run.progress import Report
from stickslip.solution.files.netcdf import save_checkpoint
from tests.core.engine.creep_truth import ROUND, printed
from tests.core.run.long_runs.problems import continued
from tests.core.run.long_runs.problems import differences as differences_of_runs
from tests.problems import SLAB

STABLE = ss.friction.ExponentialSlipWeakening(static=0.8, dynamic=0.3, distance=30.0)
RUNS: dict[str, tuple[ss.Problem, float, float]] = {
    "up to a pulse": (printed(100), 2420.0, 1e-4),
    "several leaps": (printed(100), 2420.0, 5e-5),
    "stable": (ss.Problem(SLAB, STABLE, pull_rate=2e-6, initial_excess=1e4), 420 * ROUND, 1e-4),
    "backwards": (ss.Problem(SLAB, STABLE, pull_rate=-2e-6, initial_load=-80_010_000.0), 420 * ROUND, 1e-4),
}
"""Problem, duration (s), tolerance of the leaps."""


@cache
def whole_run(name: str) -> ss.Solution:
    problem, duration, rtol = RUNS[name]
    return ss.simulate(problem, duration, creep_rtol=rtol)


def differences(one: ss.Solution, other: ss.Solution) -> list[str]:
    """What is not the same in two solutions, bit for bit."""
    found = [] if np.array_equal(one.history.creep, other.history.creep) else ["leaps"]
    return found + ([] if one.creep_rtol == other.creep_rtol else ["creep_rtol"]) + differences_of_runs(one, other)


def begun(name: str) -> ExactRun:
    problem, duration, rtol = RUNS[name]
    return ExactRun.begin(problem, CallOptions(duration, creep_rtol=rtol))


def step(run: ExactRun) -> bool:
    """One step of the engine, or one leap; False at the end."""
    code = run.advance(1)
    if code == Stop.FULL:
        run.grow()
    return code in (Stop.NONE, Stop.FULL)


def around_leaps(name: str) -> list[int]:
    """Steps just before leaps, at them, and just behind."""
    run = begun(name)
    stops, steps, leaps = set[int](), 0, 0
    while step(run):
        steps += 1
        if run.length > 0 and not stops:
            stops.add(steps)  # the first step with a history to store
        if len(run.creep) > leaps:
            leaps = len(run.creep)
            stops |= {steps - 1, steps, steps + 1}
    return sorted(stops | {steps})


@pytest.mark.sampled(every=4)
@pytest.mark.parametrize("name", RUNS)
def test_a_run_stopped_around_leaps_resumes_bit_for_bit(name: str, tmp_path: Path) -> None:
    whole, path, duration = whole_run(name), tmp_path / "run.nc", RUNS[name][1]
    assert len(whole.creep) > 0
    for stop in around_leaps(name):
        run = begun(name)
        for _ in range(stop):
            step(run)
        save_checkpoint(run.solution(UNDER_WAY), path)
        assert differences(continued(path, duration), whole) == [], f"after {stop} steps"


@pytest.mark.slow
@pytest.mark.sampled(every=4)
@pytest.mark.parametrize("name", RUNS)
def test_a_run_that_ended_within_a_leap_continues_as_if_it_had_not(name: str, tmp_path: Path) -> None:
    """The end of the first run cuts a leap, or allows none: a longer one takes it whole."""
    problem, duration, rtol = RUNS[name]
    whole, path = whole_run(name), tmp_path / "run.nc"
    first, last = whole.creep.iloc[0], whole.creep.iloc[-1]
    for end in (first.start + 10 * ROUND, 0.5 * (first.start + first.end), last.end - ROUND, last.end + 2.5 * ROUND):
        save_checkpoint(ss.simulate(problem, float(end), creep_rtol=rtol), path)
        assert differences(continued(path, duration), whole) == [], f"from {end}"


@pytest.mark.slow
@pytest.mark.sampled(every=2)
@pytest.mark.parametrize("events", [1, 2])
def test_a_number_of_events_stops_a_creeping_run(events: int, tmp_path: Path) -> None:
    """However often the run is looked at; and it says that it creeps."""
    problem, duration, rtol = RUNS["up to a pulse"]
    path, seen = tmp_path / "run.nc", list[Report]()
    short = ss.simulate(problem, 2 * duration, creep_rtol=rtol, max_events=events, checkpoint=path)
    assert short.status.name == "enough events"
    assert short.events.end.notna().sum() == events
    again = ss.simulate(problem, 2 * duration, creep_rtol=rtol, max_events=events, progress=seen.append, checkpoint_every=0.0)
    assert differences(again, short) == []
    assert differences(ss.resume(path, duration), replace(whole_run("up to a pulse"), max_events=None)) == []
    assert "creeping" in {report.doing for report in seen} or events == 1


@pytest.mark.sampled(every=4)
@pytest.mark.parametrize("name", RUNS)
def test_a_catalogue_is_the_table_of_the_whole_run(name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "CAPACITY", 64)
    monkeypatch.setattr("stickslip.engine.session.FIRST_CAPACITY", 64)
    problem, duration, rtol = RUNS[name]
    for rate in (None, 0.0):
        table = ss.catalogue(problem, duration, creep_rtol=rtol, event_rate=rate)
        pd.testing.assert_frame_equal(table, whole_run(name).catalogue(rate), check_exact=True)
        assert table.attrs["creep"] == whole_run(name).creep_note
    path, short = tmp_path / "events.csv", float(whole_run(name).creep.end.iloc[-1]) - ROUND
    ss.catalogue(problem, short, path, creep_rtol=rtol)
    resumed = ss.resume(tmp_path / "events.checkpoint.nc", duration)
    pd.testing.assert_frame_equal(resumed, whole_run(name).catalogue(), check_exact=True)
    assert resumed.attrs["creep"] == whole_run(name).creep_note
