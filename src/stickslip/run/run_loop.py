"""Run a solver: call it for a fraction of a second at a time, and do everything else between these calls."""

from __future__ import annotations

import _signal  # `signal` also looks for members of enums, which takes longer than a short run
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from signal import SIGINT, default_int_handler
from types import FrameType
from typing import Any, Protocol, Self

from stickslip.engine.state.layout import Stop
from stickslip.run.solver import Solver
from stickslip.trajectory.status import FULL_HISTORY, INTERRUPTED

MOMENT = 0.1
"""Wall-clock time that one call of the solver should take, s: short enough for Ctrl-C and for reports of progress."""
FIRST_BUDGET, SMALLEST_BUDGET, LARGEST_BUDGET = 5_000, 100, 20_000
"""Number of steps in the first call, and its bounds in later ones: no call should take seconds when steps suddenly cost more."""
SHARE = 0.1
"""Largest share of the wall-clock time that any periodic task may take."""


@dataclass
class NowAndThen:
    """A timer for a periodic task: due after `every` seconds of wall clock, but never so often that it takes more than SHARE."""

    every: float
    due_at: float = field(default_factory=time.monotonic)

    @classmethod
    def from_now(cls, every: float) -> Self:
        """Return a timer that is due for the first time after one interval."""
        return cls(every, time.monotonic() + every)

    @property
    def is_due(self) -> bool:
        """True if the task is due."""
        return time.monotonic() >= self.due_at

    @contextmanager
    def done(self) -> Iterator[None]:
        """Measure how long the task inside this context takes, and schedule the next one."""
        start = time.monotonic()
        yield
        end = time.monotonic()
        self.due_at = end + max(self.every, (end - start) / SHARE)


class Watch(Protocol):
    """The interface of a monitor, which is called between two calls of the solver, when the state of the run is consistent."""

    def look(self, run: Solver[Any], *, now: bool) -> int | None:
        """Monitor the run after a call of the solver. Returns a code to end the run, or None to continue.

        `now` is True if the call did more than use up its steps (an end, a full history): counting events must not wait then.
        """

    def make_room(self, run: Solver[Any]) -> bool:
        """Make room in a full history. Returns False if that is not allowed."""


def run_loop(run: Solver[Any], watch: Watch, interrupts: Interrupts) -> int:
    """Run to the end, or until Ctrl-C has been noted. Returns the code of what ended the run (see `trajectory.status`)."""
    budget = FIRST_BUDGET
    try:
        while True:
            start = time.perf_counter()
            code = run.advance(budget)
            if code == Stop.NONE:
                budget = next_budget(budget, time.perf_counter() - start)
            end = after_call(run, code, watch)
            if end is not None:
                return end
            if interrupts.noted:
                return interrupts.answer()
    except KeyboardInterrupt:  # from a callback in `look`, from a handler that is not ours, or from a second Ctrl-C
        if interrupts.noted:
            raise
        return INTERRUPTED


def after_call(run: Solver[Any], code: int, watch: Watch) -> int | None:
    """Do what is due after a call of the solver that returned `code`. Returns a code to end the run, or None to continue."""
    stop = watch.look(run, now=code != Stop.NONE)
    if stop is not None:
        return stop
    if code == Stop.FULL:
        return None if watch.make_room(run) else FULL_HISTORY
    return None if code in (Stop.NONE, Stop.END_AHEAD) else code


def repeat(run: Solver[Any], since: Any, length: int) -> None:
    """Go back to an earlier state of a run, and step from there until the history has `length` pieces."""
    run.restore(since)
    while run.length < length:
        run.advance(1)


def next_budget(budget: int, took: float, smallest: int = SMALLEST_BUDGET) -> int:
    """Return the number of steps for the next call from the number in the last one and the time (s) that they took."""
    wanted = budget * min(MOMENT / max(took, 1e-9), 4.0)
    return int(min(max(wanted, smallest), LARGEST_BUDGET))


class Interrupts:
    """Note the first Ctrl-C instead of raising KeyboardInterrupt, so that a run ends between two calls of the engine.

    A run that ends early because of it says so by its status (`answer`). If the run came to another end before it saw the signal,
    or failed, KeyboardInterrupt is raised at the end of the `with` block, when results are safe: whoever does one run after the
    other would otherwise begin the next one.

    A second Ctrl-C raises KeyboardInterrupt at once. A handler that is not Python's default stays in place; so does every handler
    outside the main thread, where none can be set.
    """

    def __init__(self) -> None:
        self.noted = self._is_answered = False
        in_main = threading.current_thread() is threading.main_thread()
        self.ours = in_main and _signal.getsignal(SIGINT) is default_int_handler

    def __enter__(self) -> Self:
        if self.ours:
            _signal.signal(SIGINT, self.note)
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, _: object) -> None:
        if self.ours:
            _signal.signal(SIGINT, default_int_handler)
        is_lost = kind is None or issubclass(kind, Exception)
        if self.noted and not self._is_answered and is_lost:
            raise KeyboardInterrupt from error

    def answer(self) -> int:
        """Return the code of a run that ends because of the signal; it is then not raised."""
        self._is_answered = True
        return INTERRUPTED

    def note(self, _: int, __: FrameType | None) -> None:
        """Note a Ctrl-C; this is the handler."""
        self.noted = True
        _signal.signal(SIGINT, default_int_handler)
