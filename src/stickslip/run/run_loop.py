"""Drives a run: calls the engine for a moment at a time, and sees to everything else in between."""

from __future__ import annotations

import math
import signal
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from types import FrameType
from typing import Protocol, Self

from stickslip.engine.state import layout as at
from stickslip.engine_input.branch_table import OUT_OF_BUDGET
from stickslip.engine_input.forcing import row_time
from stickslip.foundation.errors import InputError
from stickslip.run.session import RunInProgress
from stickslip.trajectory.checkpoint import Checkpoint
from stickslip.trajectory.status import FULL_HISTORY, INTERRUPTED

MOMENT = 0.1
"""Wall clock (s) that a call of the engine is meant to take."""
FIRST_BUDGET, SMALLEST_BUDGET, LARGEST_BUDGET = 5_000, 100, 20_000
"""Steps in a call: at most so many that they do not take seconds when they suddenly cost more."""
MOST_ROUND_TRIPS = 2**53
"""Round trips of a slab, or periods of a block, that a float counts one by one."""
SHARE = 0.1
"""Largest share of the time that goes into anything done now and then."""


@dataclass
class NowAndThen:
    """Says when something is due: every so many seconds of wall clock, but never so often that it takes too much of the time."""

    every: float
    due_at: float = field(default_factory=time.monotonic)

    @classmethod
    def from_now(cls, every: float) -> Self:
        """For the first time after the first interval."""
        return cls(every, time.monotonic() + every)

    @property
    def is_due(self) -> bool:
        """Whether it is time."""
        return time.monotonic() >= self.due_at

    @contextmanager
    def done(self) -> Iterator[None]:
        """Around what is due."""
        start = time.monotonic()
        yield
        end = time.monotonic()
        self.due_at = end + max(self.every, (end - start) / SHARE)


class Watch(Protocol):
    """Looks after a run between two calls of the engine, when everything in it fits together."""

    def look(self, run: RunInProgress, *, now: bool) -> int | None:
        """Called after every call; `now` where what is done now and then is due: at an end, or when the history is full.

        A code ends the run.
        """

    def make_room(self, run: RunInProgress) -> bool:
        """The history is full: make room; False where that must not be."""


def drive(run: RunInProgress, duration: float, watch: Watch) -> int:
    """Go on up to `duration` (s from the start of the run). Returns the code of what ended the run (see `status`)."""
    last, budget = split_time(duration, row_time(run.problem)), FIRST_BUDGET
    with interrupts() as is_interrupted:
        try:
            while True:
                start = time.perf_counter()
                code = run.advance(last, budget)
                if code == OUT_OF_BUDGET:
                    budget = next_budget(budget, time.perf_counter() - start)
                stop = watch.look(run, now=code != OUT_OF_BUDGET)
                if stop is not None:
                    return stop
                if code == at.END_AHEAD:
                    run.cut_at_end()
                elif code == at.FULL:
                    if not watch.make_room(run):
                        return FULL_HISTORY
                elif code != OUT_OF_BUDGET:
                    return code
                if is_interrupted():
                    return INTERRUPTED
        except KeyboardInterrupt:  # raised by `look`, or by a handler that is not ours
            if is_interrupted():
                raise
            return INTERRUPTED


def repeat(run: RunInProgress, since: Checkpoint, duration: float, length: int) -> None:
    """Go back to where the run has been, and from there step by step to the moment when the history has so many pieces."""
    last = split_time(duration, row_time(run.problem))
    run.restore(since)
    while run.length < length:
        if run.advance(last, 1) == at.END_AHEAD:
            run.cut_at_end()


def next_budget(budget: int, took: float) -> int:
    """Steps in the next call, from how long (s) those of the last one took."""
    wanted = budget * min(MOMENT / max(took, 1e-9), 4.0)
    return int(min(max(wanted, SMALLEST_BUDGET), LARGEST_BUDGET))


@contextmanager
def interrupts() -> Iterator[Callable[[], bool]]:
    """Ctrl-C does not break in, it is noted: the run ends between two calls of the engine. A second one breaks in.

    Handlers that are not Python's own stay as they are; so they do outside the main thread, where none can be set.
    """
    noted = False

    def note(_: int, __: FrameType | None) -> None:
        nonlocal noted
        noted = True
        signal.signal(signal.SIGINT, signal.default_int_handler)

    ours = threading.current_thread() is threading.main_thread() and signal.getsignal(signal.SIGINT) is signal.default_int_handler
    if ours:
        signal.signal(signal.SIGINT, note)
    try:
        yield lambda: noted
    finally:
        if ours:
            signal.signal(signal.SIGINT, signal.default_int_handler)


def check_round_trips(duration: float, row: float, where: str) -> None:
    """Refuse a run of so many round trips that times in the last one cannot be told apart. Raises InputError."""
    if not duration <= MOST_ROUND_TRIPS * row:
        raise InputError(
            f"{where}: duration must be at most {MOST_ROUND_TRIPS * row:.3g} s, 2^53 round trips of {row:.3g} s, got {duration:g} s"
        )


def split_time(time: float, row: float) -> tuple[int, float]:
    """Return a time as (whole rows, offset in the row), the offset in (0, row]. Raises InputError for too many rows."""
    check_round_trips(time, row, "run")
    rows = math.floor(time / row)
    offset = time - rows * row
    if offset <= 0.0 and rows > 0:
        return rows - 1, row
    return rows, min(offset, row)
