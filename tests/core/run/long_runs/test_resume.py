"""A run that was stopped and taken up is the run that was not, bit for bit."""

from __future__ import annotations

import os
import signal
from dataclasses import replace
from pathlib import Path

import h5py
import numpy as np
import pandas as pd
import pytest

import stickslip as ss
from stickslip.engine.history.status import Checkpoint
from stickslip.problem.run_codes import UNDER_WAY, Stop
from stickslip.run.exact_run import ExactRun
from stickslip.run.options import CallOptions
from stickslip.run.progress import Report
from stickslip.solution.files.netcdf import save_checkpoint
from tests.core.run.long_runs.problems import RUNS, continued, differences, differences_of_files, killed


def steps_of(problem: ss.Problem, duration: float) -> int:
    """Steps (calls of the engine with a budget of one) that a run takes, to 1000 at least."""
    run = ExactRun.begin(problem, CallOptions(duration))
    for steps in range(100_000):
        code = run.advance(1)
        if code == Stop.FULL:
            run.grow()
        elif code != Stop.NONE:
            return steps
    raise AssertionError("too long for a test")


def stopped(problem: ss.Problem, duration: float, steps: int, path: Path) -> Checkpoint:
    """Write the checkpoint of a run that was stopped after so many steps, counted from the first piece of its history."""
    run = ExactRun.begin(problem, CallOptions(duration))
    for step in range(100_000):
        if step >= steps and run.length > 0:
            break
        if run.advance(1) == Stop.FULL:
            run.grow()
    save_checkpoint(run.solution(UNDER_WAY), path)
    return run.snapshot()


@pytest.mark.sampled(every=18)
@pytest.mark.parametrize("name", RUNS)
def test_a_run_stopped_anywhere_resumes_bit_for_bit(name: str, tmp_path: Path) -> None:
    problem, duration = RUNS[name]
    whole, path = ss.simulate(problem, duration), tmp_path / "run.nc"
    file_of_whole = whole.to_netcdf(tmp_path / "whole.nc")
    assert differences(ss.open_solution(file_of_whole), whole) == []
    rng, steps = np.random.default_rng(len(name)), steps_of(problem, duration)
    anywhere = [int(stop) for stop in rng.integers(1, steps + 1, 3)]
    for stop in {1, 2, *anywhere, steps}:
        stopped(problem, duration, stop, path)
        assert differences(continued(path), whole) == [], f"after {stop} of {steps} steps"
    stopped(problem, duration, anywhere[0], path)
    with h5py.File(path) as file:
        assert file.attrs["status"] == "under way"
    assert differences(ss.resume(path), whole) == []
    assert differences_of_files(path, file_of_whole) == []


def test_those_stops_meet_the_engine_in_every_state(tmp_path: Path) -> None:
    """At rest, in slip both explicit and implicit, on the way to a fold, within a piece."""
    met = set()
    for problem, duration in RUNS.values():
        run = ExactRun.begin(problem, CallOptions(duration))
        for _ in range(3000):
            if run.advance(1) not in (Stop.NONE, Stop.FULL) or run.length > 400:
                break
            count, state = run.count, run.state
            met |= {"stick" if count.mode == 0 else "slip", f"at fold {count.at_fold}"}
            met |= {"stiff"} if count.stiff else set()
            met |= {"state"} if count.states else set()
            met |= {"leap"} if run.length and count.trip > run.store.trip[run.length - 1] + 1 else set()
            met |= {"inside"} if 0.0 < state.xi < 1.0 else set()
            met |= {"leaving"} if count.branch_ended else set()
    expected = {"stick", "slip", "at fold 0", "at fold 1", "stiff", "state", "leap", "inside", "leaving"}
    assert expected <= met, expected - met


@pytest.mark.sampled(every=28)
@pytest.mark.parametrize("name", list(RUNS))
def test_a_finished_run_continues_as_if_it_had_not_ended(name: str, tmp_path: Path) -> None:
    problem, duration = RUNS[name]
    whole, path = ss.simulate(problem, duration), tmp_path / "run.nc"
    for share in np.random.default_rng(len(name)).uniform(0.02, 0.98, 2):
        save_checkpoint(ss.simulate(problem, share * duration), path)
        assert differences(continued(path, duration), whole) == [], f"from {share} of the way"
    assert differences(ss.resume(path, duration), whole) == []
    assert differences(ss.resume(path), whole) == []  # and a run taken up at its end is at its end


@pytest.mark.sampled(every=3)
@pytest.mark.parametrize(("events", "times"), [(1, 2), (7, 4), (30, 10)])
def test_events_stop_a_run_where_the_last_one_is_known(events: int, times: int, tmp_path: Path) -> None:
    problem, duration = RUNS["slab that heals"]
    path, long = tmp_path / "run.nc", times * duration
    whole = ss.simulate(problem, long)
    short = ss.simulate(problem, long, max_events=events, checkpoint=path)
    assert short.status.name == "enough events"
    assert short.status.ok
    assert short.events.end.notna().sum() == events
    assert short.events.iloc[:events].equals(whole.events.iloc[:events])
    seen: list[Report] = []
    again = ss.simulate(problem, long, max_events=events, progress=seen.append, checkpoint_every=0.0)
    assert differences(again, short) == []
    more = ss.resume(path, max_events=events + 5)
    assert differences(more, ss.simulate(problem, long, max_events=events + 5)) == []
    assert differences(ss.resume(path, long), replace(whole, options=replace(whole.options, max_events=None))) == []


def test_fewer_events_than_there_were_are_refused(tmp_path: Path) -> None:
    problem, duration = RUNS["slab that heals"]
    ss.simulate(problem, duration, max_events=5, checkpoint=tmp_path / "run.nc")
    with pytest.raises(ss.InputError, match=r"run\.nc: the run has had 5 events already: it cannot stop after 3"):
        ss.resume(tmp_path / "run.nc", max_events=3)


def test_an_earlier_end_is_refused(tmp_path: Path) -> None:
    problem, duration = RUNS["slip law, slab"]
    ss.simulate(problem, duration, checkpoint=tmp_path / "run.nc")
    with pytest.raises(ss.InputError, match=r"run\.nc: the run has already reached .* s: a duration of 1 s lies before that"):
        ss.resume(tmp_path / "run.nc", 1.0)


@pytest.mark.slow
@pytest.mark.skipif(os.name != "posix", reason="needs locks")
def test_a_second_run_does_not_write_into_the_file_of_one_that_goes_on(tmp_path: Path) -> None:
    """Whether it begins anew or takes the file up; another file, and the same one afterwards, may be written."""
    problem, duration = RUNS["slip law, slab"]
    path = ss.simulate(problem, 0.5 * duration).to_netcdf(tmp_path / "run.nc")
    said: list[str] = []

    def disturb(_: Report) -> None:
        for second in (lambda: ss.simulate(problem, duration, checkpoint=path), lambda: ss.resume(path, 2.0 * duration)):
            with pytest.raises(ss.InputError) as told:
                second()
            said.append(str(told.value))
        ss.resume(path, 2.0 * duration, checkpoint=tmp_path / "other.nc")

    for first in (
        lambda: ss.simulate(problem, duration, checkpoint=path, progress=disturb),
        lambda: ss.resume(path, 1.5 * duration, progress=disturb),
    ):
        first()
        assert set(said) == {f"{path}: another run is writing into it: choose another name"}
        said.clear()
    assert {one.name for one in tmp_path.iterdir()} == {"run.nc", "other.nc"}
    assert differences(ss.open_solution(path), ss.simulate(problem, 1.5 * duration)) == []


def test_another_engine_is_refused(tmp_path: Path) -> None:
    problem, duration = RUNS["slip law, slab"]
    run = ss.simulate(problem, duration)
    assert run.checkpoint is not None
    other = replace(run, checkpoint=replace(run.checkpoint, engine="0123456789abcdef"))
    other.to_netcdf(tmp_path / "run.nc")
    with pytest.raises(ss.InputError, match=r"run\.nc: cannot be resumed: another version of stickslip's engine made it") as said:
        ss.resume(tmp_path / "run.nc", 2 * duration)
    assert "\n" not in str(said.value)
    replace(run, checkpoint=None).to_netcdf(tmp_path / "bare.nc")
    with pytest.raises(ss.InputError, match=r"bare\.nc: cannot be resumed: it does not hold the state of the engine"):
        ss.resume(tmp_path / "bare.nc")
    with pytest.raises(ss.InputError, match=r"none\.nc: no such file"):
        ss.resume(tmp_path / "none.nc")


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"max_events": 0}, "max_events must be a whole number above 0, got 0"),
        ({"max_events": 2.5}, "max_events must be a whole number above 0, got 2.5"),
        ({"checkpoint_every": -1.0}, "checkpoint_every must be at least 0 s, got -1"),
        ({"checkpoint": "nowhere/run.nc"}, "nowhere/run.nc: cannot be written"),
    ],
)
def test_bad_arguments_are_refused(
    arguments: dict[str, float], message: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    with pytest.raises(ss.InputError, match=message):
        ss.simulate(*RUNS["slip law, slab"], **arguments)  # type: ignore[arg-type] # that is the point


LONG = """
problem = ss.load_scenario("rate-and-state-block").problem
ss.simulate(problem, 1e5 * ss.YEAR, checkpoint="run.nc", checkpoint_every=0.0, progress=lambda _: time.sleep(0.01))
"""


@pytest.mark.slow
@pytest.mark.skipif(os.name != "posix", reason="needs SIGKILL")
def test_kill_leaves_a_checkpoint_that_continues(tmp_path: Path) -> None:
    killed(LONG, tmp_path, "run.nc", signal.SIGKILL, times=3)
    begun = ss.open_solution(tmp_path / "run.nc")
    assert begun.status.name == "under way"
    end = begun.history.duration * 1.1
    assert differences(ss.resume(tmp_path / "run.nc", end), ss.simulate(begun.problem, end)) == []


@pytest.mark.slow
@pytest.mark.skipif(os.name != "posix", reason="needs SIGINT")
def test_ctrl_c_leaves_a_solution_that_continues(tmp_path: Path) -> None:
    done = killed(LONG, tmp_path, "run.nc", signal.SIGINT)
    assert (done.returncode, done.stderr) == (0, "")
    begun = ss.open_solution(tmp_path / "run.nc")
    assert begun.status.name == "interrupted"
    end = begun.history.duration * 1.1
    assert differences(ss.resume(tmp_path / "run.nc", end), ss.simulate(begun.problem, end)) == []


@pytest.mark.slow
@pytest.mark.sampled(every=2)
@pytest.mark.parametrize("events", [1, 2])
def test_an_event_that_begins_as_the_last_one_ends_is_not_counted(events: int, tmp_path: Path) -> None:
    """Undamped, an oscillating block turns round without rest: each swing begins in the instant in which the one before ends."""
    block = ss.SpringBlock(2.0, 50.0, 10.0)
    problem = ss.Problem(block, ss.friction.LinearSlipWeakening(0.3, 0.1, 2.0), initial_load=20.0)
    path = tmp_path / "run.nc"
    run, whole = ss.simulate(problem, 10.0, max_events=events, checkpoint=path), ss.simulate(problem, 10.0)
    assert len(whole.events) > events + 1
    wanted = whole.events.iloc[:events]
    for found in (run.events, run.catalogue(0.01), run.energetics(), run.pulses(), ss.open_solution(path).events):
        assert len(found) == events
    pd.testing.assert_frame_equal(run.events, wanted)
    pd.testing.assert_frame_equal(ss.catalogue(problem, 10.0, max_events=events), wanted)
    ss.catalogue(problem, 10.0, tmp_path / "events.csv", max_events=events)
    assert len(ss.resume(tmp_path / "events.checkpoint.nc", max_events=events + 1)) == events + 1
    pd.testing.assert_frame_equal(ss.resume(path, 10.0).events, whole.events)
