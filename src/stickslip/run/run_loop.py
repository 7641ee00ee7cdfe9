"""Run a solver to its end: call it for a fraction of a second at a time, and do everything else between these calls.

`simulate` and `catalogue` run in the same way, `run_to_end`, and differ in the sink that takes the result: `WholeHistory` keeps
everything, `EventRows` (`run/catalogue.py`) keeps one row for each slip event.
"""

from __future__ import annotations

import _signal  # `signal` also looks for members of enums, which takes longer than a short run
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from signal import SIGINT, default_int_handler
from types import FrameType
from typing import Any, Generic, Protocol, Self, TypeVar

from stickslip.foundation.errors import InputError
from stickslip.problem import ENOUGH_EVENTS, FULL_HISTORY, INTERRUPTED, STATUSES, Stop
from stickslip.run.progress import Pace
from stickslip.run.solver import NewEvents, Solver

MOMENT = 0.1
"""Wall-clock time that one call of the solver should take, s: short enough for Ctrl-C and for reports of progress."""
FIRST_BUDGET, SMALLEST_BUDGET, LARGEST_BUDGET = 5_000, 100, 20_000
"""Number of steps in the first call, and its bounds in later ones: no call should take seconds when steps suddenly cost more."""
SHARE_OF_TASKS = 0.1
"""Largest share of the wall-clock time that any periodic task may take."""

New = TypeVar("New", bound=NewEvents)
New_contra = TypeVar("New_contra", bound=NewEvents, contravariant=True)
Result = TypeVar("Result")
Result_co = TypeVar("Result_co", covariant=True)


@dataclass
class NowAndThen:
    """A timer for a periodic task: due after `every` seconds of wall clock, but so rarely that it takes at most SHARE_OF_TASKS."""

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
        self.due_at = end + max(self.every, (end - start) / SHARE_OF_TASKS)


class Sink(Protocol[New_contra, Result_co]):
    """The receiver of the results of a run."""

    who: str
    """Name of the public function, for messages."""
    wants_events: bool
    """True if `record` must be called for each event also when nothing else counts them."""

    def record(self, new: New_contra) -> None:
        """Take new events, before they count as reported, and report them."""

    def make_room(self) -> bool:
        """Make room in a full history. Returns False if that is not allowed."""

    def save(self) -> None:
        """Write a checkpoint."""

    def finish(self, code: int) -> Result_co:
        """Store the end of a run that ended with this code, and return the result."""


@dataclass
class WholeHistory(Generic[Result]):
    """The sink of a run that keeps its whole history and becomes a solution."""

    run: Solver[NewEvents, Result]
    who = "simulate"
    wants_events = False

    def record(self, new: NewEvents) -> None:
        """Report the events: the history holds them."""
        new.tell()

    def make_room(self) -> bool:
        """Have the run make room, up to the largest number of pieces allowed."""
        return self.run.grow()

    def save(self) -> None:
        """Have the run renew its checkpoint."""
        self.run.save()

    def finish(self, code: int) -> Result:
        """Return the solution, which the run writes if a file for it was given."""
        return self.run.finish(code)


class Watch(Protocol):
    """The work between two calls of the solver, when the state of the run is consistent."""

    def look(self, *, now: bool) -> int | None:
        """Monitor the run after a call of the solver. Returns a code to end the run, or None to continue.

        `now` is True if the call did more than use up its steps (an end, a full history): counting events must not wait then.
        """

    def make_room(self) -> bool:
        """Make room in a full history. Returns False if that is not allowed."""


@dataclass
class Monitor(Generic[New]):
    """The watch of a run whose results go to a sink: count its events, report its progress, have it stored."""

    run: Solver[New, Any]
    sink: Sink[New, object]
    counting: NowAndThen = field(default_factory=lambda: NowAndThen(0.0))
    pace: Pace = field(default_factory=Pace)

    def __post_init__(self) -> None:
        self.options = self.run.options
        self.saving = NowAndThen.from_now(self.options.checkpoint_every)
        self.counts = self.sink.wants_events or self.options.progress is not None or self.options.max_events is not None

    def look(self, *, now: bool) -> int | None:
        """Count events, report progress and write a checkpoint where each is due: see `Watch`."""
        run, tell = self.run, self.options.progress
        if self.counts and run.length > 0 and (now or self.counting.is_due):
            with self.counting.done():
                self.count()
        if run.can_be_saved and not run.has_enough and self.saving.is_due:
            with self.saving.done():
                self.sink.save()
        if tell is not None:
            tell(run.report(self.pace))
        return ENOUGH_EVENTS if run.has_enough else None

    def count(self) -> None:
        """Hand new events to the sink."""
        if (new := self.run.new_events()) is not None:
            self.sink.record(new)

    def make_room(self) -> bool:
        """Have the sink make room in the full history: see `Watch`."""
        return self.sink.make_room()


def run_to_end(run: Solver[New, Any], sink: Sink[New, Result]) -> Result:
    """Run a solver to the end and return the result of the sink.

    Raises InputError if the run ends where it starts, and KeyboardInterrupt if Ctrl-C stopped it there or came too late to stop it.
    """
    monitor = Monitor(run, sink)
    with Interrupts() as interrupts:
        code = run_loop(run, monitor, interrupts)
        if run.length == 0:
            if code == INTERRUPTED:
                raise KeyboardInterrupt
            raise InputError(f"{sink.who}: the run ends where it starts: {STATUSES[code].message}")
        if sink.wants_events and code != ENOUGH_EVENTS:
            monitor.count()
        return sink.finish(code)


def run_loop(run: Solver[Any, Any], watch: Watch, interrupts: Interrupts) -> int:
    """Run to the end, or until Ctrl-C has been noted. Returns the code of the run's end (see `problem.run_codes`)."""
    budget = FIRST_BUDGET
    try:
        while True:
            start = time.perf_counter()
            code = run.advance(budget)
            if code == Stop.NONE:
                budget = next_budget(budget, time.perf_counter() - start)
            stop = watch.look(now=code != Stop.NONE)
            if stop is not None:
                return stop
            if code == Stop.FULL and not watch.make_room():
                return FULL_HISTORY
            if code not in (Stop.NONE, Stop.END_AHEAD, Stop.FULL):
                return code
            if interrupts.noted:
                return interrupts.answer()
    except KeyboardInterrupt:  # from a callback in `look`, from a handler that is not ours, or from a second Ctrl-C
        if interrupts.noted:
            raise
        return INTERRUPTED


def next_budget(budget: int, took: float) -> int:
    """Return the number of steps for the next call from the number in the last one and the time (s) that they took."""
    wanted = budget * min(MOMENT / max(took, 1e-9), 4.0)
    return int(min(max(wanted, SMALLEST_BUDGET), LARGEST_BUDGET))


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
