"""Ctrl-C, sent as a signal at many phases of a run: it is heard in every one, even in the last call of the solver."""

from __future__ import annotations

import signal
import sys
from collections.abc import Callable
from pathlib import Path
from types import FrameType
from typing import Any

import pytest

import stickslip as ss
from stickslip.engine.session import Session
from stickslip.problem.run_codes import Stop
from stickslip.run import run_loop
from stickslip.run.options import RunOptions
from stickslip.run.run_loop import Interrupts
from tests.core.run.long_runs.problems import bundled

PHASES = 12
"""Number of moments of a run at which a signal comes."""


def with_signal_at(call: int, act: Callable[[], Any]) -> tuple[Any, int]:
    """Return what `act` returns, or KeyboardInterrupt if it raises that, with a Ctrl-C at one of its calls of our functions.

    The calls are numbered; at -1 there is none. The second number returned is how many there were. In a library's own functions a
    signal might leave a lock closed, on which other tests would wait for ever.
    """
    seen, ours = 0, str(Path(ss.__file__).parent)

    def count(frame: FrameType, event: str, _: Any) -> None:
        nonlocal seen
        seen += event == "call" and frame.f_code.co_filename.startswith(ours)
        if seen == call:
            signal.raise_signal(signal.SIGINT)

    sys.setprofile(count)
    try:
        return act(), seen
    except KeyboardInterrupt:
        return KeyboardInterrupt, seen
    finally:
        sys.setprofile(None)


def lost(act: Callable[[], Any], is_heard: Callable[[Any], bool]) -> list[int]:
    """Return the phases, of PHASES that are spread over all that `act` does, at which a signal has no consequence."""
    act()  # compiles
    count = with_signal_at(-1, act)[1]
    phases = sorted({1 + i * (count - 1) // PHASES for i in range(PHASES)})
    return [phase for phase in phases if not is_heard(with_signal_at(phase, act)[0])]


def heard(found: Any) -> bool:
    return found is KeyboardInterrupt or found.status.name == "interrupted"


@pytest.mark.parametrize("steps", [5_000, 20], ids=["one call of the solver", "many"])
def test_a_signal_at_any_phase_of_a_run_is_heard(steps: int, monkeypatch: pytest.MonkeyPatch) -> None:
    problem, duration = bundled("cycles-block", 10.0)
    for name in ("FIRST_BUDGET", "SMALLEST_BUDGET", "LARGEST_BUDGET"):
        monkeypatch.setattr(run_loop, name, steps)
    assert not lost(lambda: ss.simulate(problem, duration), heard)


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


def test_a_signal_at_any_phase_of_a_planar_run_is_heard() -> None:
    """In one frame a round trip, so that all but two of its calls of the solver end between frames."""
    pytest.importorskip("jax")
    from tests.extensions.planar.patches import patch

    slab = patch(nodes=32, length=2e4)
    monkeypatch = pytest.MonkeyPatch()
    with monkeypatch.context() as changed:
        changed.setattr("stickslip.run.run_loop.FIRST_BUDGET", 4)
        changed.setattr("stickslip.run.run_loop.next_budget", lambda *_: 4)
        changed.setattr("stickslip.extensions.planar.run.NODES", 32)
        assert not lost(lambda: ss.simulate(slab, 6.0, frames=1), heard)


@pytest.mark.slow
def test_the_budget_of_slow_steps_falls_to_a_single_one() -> None:
    """Under a contact of so many nodes that a step of all of them takes a call."""
    pytest.importorskip("jax")
    from stickslip.extensions.planar.run import PlanarRun
    from stickslip.extensions.planar.solution import Frames
    from stickslip.extensions.planar.solver import PlanarSolver
    from tests.extensions.planar.patches import patch

    assert run_loop.next_budget(8, 8.0) == run_loop.SMALLEST_BUDGET
    slab = patch(nodes=30_000, length=2e7)
    run = PlanarRun(RunOptions(1.0), PlanarSolver(slab, 1e-3), (slice(None),), 0.0, Frames(slab, slab.steps_per_round_trip))
    run.advance(run_loop.SMALLEST_BUDGET)
    assert run.length == 1
