"""Ctrl-C, sent as a signal at many phases of a run: it is heard in every one, even in the last call of the solver."""

from __future__ import annotations

import signal
from pathlib import Path
from typing import Any

import pytest

import stickslip as ss
from stickslip.engine.session import Session
from stickslip.problem.run_codes import Stop
from stickslip.run import run_loop
from stickslip.run.run_loop import Interrupts
from tests.core.run.long_runs.problems import bundled
from tests.core.run.long_runs.signals import heard, lost


@pytest.mark.parametrize("steps", [5_000, 20], ids=["one call of the solver", "many"])
def test_a_signal_at_any_phase_of_a_run_is_heard(steps: int, monkeypatch: pytest.MonkeyPatch) -> None:
    problem, duration = bundled("cycles-block", 10.0)
    for name in ("FIRST_BUDGET", "SMALLEST_BUDGET", "LARGEST_BUDGET"):
        monkeypatch.setattr(run_loop, name, steps)
    assert not lost(lambda: ss.simulate(problem, duration), heard)


@pytest.mark.slow
def test_a_signal_at_any_phase_of_a_catalogue_is_heard(tmp_path: Path) -> None:
    problem, duration = bundled("cycles-block", 10.0)

    def written() -> Any:
        return ss.catalogue(problem, duration)

    assert not lost(written, lambda found: found is KeyboardInterrupt or found.attrs["status"] == "interrupted")


def test_a_signal_in_the_last_call_is_raised_when_the_file_is_written(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    problem, duration = bundled("fig6-slab", 1.0)
    real = Session.advance

    def advance(run: Session, budget: int) -> int:
        code = real(run, budget)
        if code not in (Stop.NONE, Stop.END_AHEAD):
            signal.raise_signal(signal.SIGINT)
        return code

    monkeypatch.setattr(Session, "advance", advance)
    with pytest.raises(KeyboardInterrupt):
        ss.simulate(problem, duration, checkpoint=tmp_path / "run.nc")
    monkeypatch.undo()
    assert ss.open_solution(tmp_path / "run.nc").status.name == "finished"


def test_a_loop_of_runs_that_fail_ends_too(monkeypatch: pytest.MonkeyPatch) -> None:
    problem, duration = bundled("fig6-slab", 1.0)

    def fails(run: Session, budget: int) -> int:
        signal.raise_signal(signal.SIGINT)
        raise ss.InputError("no")

    monkeypatch.setattr(Session, "advance", fails)
    with pytest.raises(KeyboardInterrupt):
        ss.simulate(problem, duration)


def test_a_run_that_says_that_it_was_interrupted_raises_nothing() -> None:
    with Interrupts() as interrupts:
        signal.raise_signal(signal.SIGINT)
        assert interrupts.noted
        interrupts.answer()
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler


def test_a_second_signal_is_raised_at_once() -> None:
    pressed = 0

    def press_twice() -> None:
        nonlocal pressed
        with Interrupts():
            signal.raise_signal(signal.SIGINT)
            pressed = 1
            signal.raise_signal(signal.SIGINT)
            pressed = 2

    with pytest.raises(KeyboardInterrupt):
        press_twice()
    assert pressed == 1
