"""Do the work of one page beside it, in a thread of its own, so that neither this page nor another one has to wait."""

from __future__ import annotations

import logging
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial
from traceback import walk_tb
from typing import Any, Literal

from stickslip.extensions.explorer.model.solve import Stopped, Told
from stickslip.foundation.axis import Axis
from stickslip.foundation.errors import InputError

Call = Callable[[], None]

TIME_TO_FINISH = 0.3
"""Work that takes less than this (s) is finished and shown even if a newer request waits: pictures follow while a slider moves."""
QUIET = 0.2
"""Nothing is said of work in its first moments (s): most of it is finished then, and lines that flicker tell nothing."""
LOOK_AGAIN = 0.2
"""Time (s) after which a desk that waits for its page looks whether the page is still open."""
STOPPED_EARLY = "stopped before there was anything to show"


class Dropped(BaseException):
    """Raised inside work that nobody waits for any more."""


@dataclass(eq=False)
class _Task:
    """One piece of work, and what the page does with its result."""

    work: Callable[[Told], Any]
    done: Callable[[Any], None]
    failed: Callable[[Exception], None]
    begun: float = 0.0
    fate: Literal["goes on", "stop", "drop"] = "goes on"


class ThreadDesk:
    """The `Desk` of a page: one piece of work at a time; of the requests that come meanwhile only the latest is kept.

    Work is given the function `told` and calls it about ten times a second. After `stop`, `told` raises `Stopped`, which ends a run
    with its results so far. It raises `Dropped` if the page is closed, or if the work has taken longer than TIME_TO_FINISH and a
    newer request waits.

    `deliver`, which any thread may call, has a function called on the page's own thread. There `report` is called with lines on the
    progress of the work.
    """

    def __init__(self, deliver: Callable[[Call], object]) -> None:
        self.report: Told = lambda text: None
        self._deliver = deliver
        self._changed = threading.Condition()
        self._present: _Task | None = None
        self._next: _Task | None = None
        self._news: str | None = None
        self._thread: threading.Thread | None = None
        self._closed = False

    def ask(self, work: Callable[[Told], Any], done: Callable[[Any], None], failed: Callable[[Exception], None]) -> None:
        """Have `work` done in place of any that waits; then call `done` with its result, or `failed`, on the page."""
        with self._changed:
            if self._closed:
                return
            self._next = _Task(work, done, failed)
            if self._thread is None:
                self._thread = threading.Thread(target=self._work, name="explorer-desk", daemon=True)
                self._thread.start()
            self._changed.notify()

    def stop(self) -> None:
        """Stop the work that is under way; what it has calculated so far is its result."""
        with self._changed:
            if self._present is not None:
                self._present.fate = "stop"

    def close(self) -> None:
        """End all work, because the page is gone, and forget what it would have been done for."""
        with self._changed:
            self._closed, self._next = True, None
            if self._present is not None:
                self._present.fate = "drop"
            self.report = lambda text: None
            self._changed.notify()

    def say(self, text: str) -> None:
        """Have a line reported on the page, from any thread; of several that wait only the latest is kept."""
        with self._changed:
            waits, self._news = self._news is not None, text
        if not waits:
            self._on_page(self._tell_news)

    @property
    def is_at_work(self) -> bool:
        """True while work is under way or waits."""
        with self._changed:
            return self._present is not None or self._next is not None

    def _work(self) -> None:
        while self._take_next():
            self._carry_out()

    def _take_next(self) -> bool:
        """Wait for the next task and make it the present one. Returns False if the page has been closed."""
        with self._changed:
            self._present = None
            self._changed.wait_for(lambda: self._closed or self._next is not None)
            if self._closed:
                return False
            self._present, self._next = self._next, None
            return True

    def _carry_out(self) -> None:
        """Do the present task, and wait until the page has shown its result: a page that is slow is not flooded with results."""
        task = self._present
        assert task is not None
        task.begun = time.monotonic()
        try:
            outcome: Call = partial(task.done, task.work(partial(self._told, task)))
        except Dropped:
            return
        except Stopped:
            outcome = partial(task.failed, InputError(STOPPED_EARLY))
        except InputError as error:
            outcome = partial(task.failed, error.with_traceback(None))
        except Exception as error:
            outcome = partial(task.failed, unforeseen(error))
        shown = threading.Event()
        self._on_page(partial(self._show, outcome, shown))
        while not shown.wait(LOOK_AGAIN) and not self._closed:
            pass

    def _show(self, outcome: Call, shown: threading.Event) -> None:
        with self._changed:
            self._news = None  # what is still under way to the page is of the work that is finished now
        try:
            if not self._closed:
                outcome()
        finally:
            shown.set()

    def _told(self, task: _Task, text: str) -> None:
        taken = time.monotonic() - task.begun
        if task.fate == "drop" or (self._next is not None and taken > TIME_TO_FINISH):
            raise Dropped
        if task.fate == "stop":
            raise Stopped
        if taken >= QUIET:
            self.say(text)

    def _tell_news(self) -> None:
        with self._changed:
            text, self._news = self._news, None
        if text is not None:
            self.report(text)

    def _on_page(self, call: Call) -> None:
        if not self._closed:
            self._deliver(call)


OWN = "stickslip"
"""Name of our own loggers and modules."""


def is_ours(error: BaseException) -> bool:
    """Return True if our own code is among what failed with an error; otherwise a library refused what a browser sent."""
    frames = walk_tb(error.__traceback__)
    return any(str(frame.f_globals.get("__name__")).startswith(f"{OWN}.") for frame, _ in frames)


def unforeseen(error: Exception) -> InputError:
    """Write the traceback of an error that is no user's mistake to the terminal, and return one line on it for the page."""
    logging.getLogger(__name__).error("the explorer could not do this:", exc_info=error)
    line = " ".join(str(error).split())[:200]
    return InputError(f"this cannot be shown, because of a program fault ({type(error).__name__}{f': {line}' if line else ''})")


FIRST_RUNS = (("fig6-slab", 20.0), ("fig6-block-reconstructed", 20.0), ("rate-and-state-block", 1.0), ("fig4-loop", 1.0))
"""Scenarios, each with a duration (s), that between them use the parts of the engine that most runs need."""
FIRST_STRIP = Axis("friction.alpha", 0.05, 2.0, 16)
"""A strip of a few runs, to warm up batches."""
ENGINE_IS_LOADED = "The engine is being loaded: the first picture takes a moment longer."


@dataclass(eq=False)
class Warming:
    """The warming of the compiler, in a thread of its own; pages ask for its `line` and are told when it changes."""

    line: str = ENGINE_IS_LOADED
    _calls: list[Callable[[str], None]] = field(default_factory=list)
    _lock: threading.Lock = field(default_factory=threading.Lock)

    def begin(self) -> None:
        """Begin in the background."""
        threading.Thread(target=self._warm, name="explorer-warming", daemon=True).start()

    def tell(self, call: Callable[[str], None]) -> Callable[[], None]:
        """Have `call` called with the present line and, from another thread, with later ones. Returns what ends that."""
        with self._lock:
            self._calls.append(call)
        call(self.line)
        return lambda: self._calls.remove(call) if call in self._calls else None

    def _say(self, line: str) -> None:
        self.line = line
        with self._lock:
            calls = list(self._calls)
        for call in calls:
            call(line)

    def _warm(self) -> None:
        try:
            from stickslip.extensions.explorer.model.strip import has_strips, strip_of
            from stickslip.foundation.kernels.code import announce_by
            from stickslip.foundation.sealed_files import tell
            from stickslip.problem.scenarios import load_scenario
            from stickslip.run.simulate import simulate

            announce_by(lambda text: self._say(f"{text[0].upper()}{text[1:]}."))
            try:
                for name, duration in FIRST_RUNS:
                    simulate(load_scenario(name), duration)
                if has_strips():
                    strip_of(load_scenario(FIRST_RUNS[0][0]), FIRST_STRIP)
            finally:
                announce_by(tell)
        except Exception as error:  # pages say what is wrong when they run into it themselves
            unforeseen(error)
        finally:
            self._say("")
