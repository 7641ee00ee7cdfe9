"""Monitor a run between two calls of its solver: count its events, report its progress, have it stored.

`simulate` and `catalogue` run in the same way, `run_to_end`, and differ in the sink that takes the result: `WholeHistory`
(`run/simulate.py`) keeps everything, `EventRows` (`run/catalogue.py`) keeps one row for each slip event.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, Protocol, Self, TypeVar

from stickslip.foundation.errors import InputError
from stickslip.run.options import RunOptions
from stickslip.run.progress import Reporter
from stickslip.run.run_loop import Interrupts, NowAndThen, repeat, run_loop
from stickslip.run.solver import Events, NewEvents, Solver
from stickslip.trajectory.status import ENOUGH_EVENTS, INTERRUPTED, STATUSES

Result_co = TypeVar("Result_co", covariant=True)


class Sink(Protocol[Result_co]):
    """What takes the results of a run.

    The run is typed as whatever solver the sink is for: `Any` stands for a `Solver`, and for its events.
    """

    who: str
    """Name of the public function, for messages."""
    wants_events: bool
    """True if `record` must be called for each event also when nothing else counts them."""

    def record(self, run: Any, stream: Any, look: Any) -> None:
        """Take new events, before they count as reported, and report them."""

    def make_room(self, run: Any, stream: Any) -> bool:
        """Make room in a full history. Returns False if that is not allowed."""

    def save(self, run: Any) -> None:
        """Write a checkpoint."""

    def finish(self, run: Any, stream: Any, code: int) -> Result_co:
        """Store the end of a run that ended with this code, and return the result."""


def run_to_end(run: Solver[Any], sink: Sink[Result_co], stream: Events | None = None) -> Result_co:
    """Run a solver to the end and return the result of the sink; a stream that is given has already reported the earlier events.

    Raises InputError if the run ends where it starts, and KeyboardInterrupt if Ctrl-C stopped it there or came too late to stop it.
    """
    monitor = Monitor.of(run, sink, stream)
    with Interrupts() as interrupts:
        code = run_loop(run, monitor, interrupts)
        if run.length == 0:
            if code == INTERRUPTED:
                raise KeyboardInterrupt
            raise InputError(f"{sink.who}: the run ends where it starts: {STATUSES[code].message}")
        if sink.wants_events and code != ENOUGH_EVENTS:
            monitor.count(run)
        return sink.finish(run, monitor.stream, code)


@dataclass(kw_only=True)
class Monitor:
    """The watch (`run_loop.Watch`) of a run whose results go to a sink.

    `looked` is a snapshot of the moment when events were last counted; it is None if the run never has to return there.
    """

    sink: Sink[object]
    stream: Events
    reporter: Reporter | None
    saving: NowAndThen
    options: RunOptions
    counting: NowAndThen = field(default_factory=lambda: NowAndThen(0.0))
    looked: Any = None

    @classmethod
    def of(cls, run: Solver[Any], sink: Sink[object], stream: Events | None = None) -> Self:
        """Return the monitor of a run."""
        options = run.options
        stream = stream or run.events()
        monitor = cls(
            sink=sink,
            stream=stream,
            reporter=Reporter.of(options, stream.threshold),
            saving=NowAndThen.from_now(options.checkpoint_every),
            options=options,
        )
        monitor.remember(run)
        return monitor

    @property
    def counts(self) -> bool:
        """True if events must be counted."""
        return self.reporter is not None or self.options.max_events is not None or self.sink.wants_events

    def look(self, run: Solver[Any], *, now: bool) -> int | None:
        """Count events, report progress and write a checkpoint where each is due: see `run_loop.Watch`."""
        enough = False
        if self.counts and run.length > 0 and (now or self.counting.is_due):
            with self.counting.done():
                enough = self.count(run)
        if self.reporter is not None:
            self.reporter.report(run, self.stream.told)
        if run.length > 0 and not enough and self.saving.is_due:
            with self.saving.done():
                self.sink.save(run)
        return ENOUGH_EVENTS if enough else None

    def count(self, run: Solver[Any]) -> bool:
        """Count new events. Returns True if they are enough; the run then goes back to the piece by which the last one is known."""
        look = self.stream.look(run.history())
        missing = None if self.options.max_events is None else self.options.max_events - self.stream.told
        if missing is None or len(look.known_by) < missing:
            self.record(run, look)
            return False
        assert self.looked is not None
        repeat(run, self.looked, look.known_by[missing - 1] + 1)
        self.record(run, look.first_ones(missing))
        return True

    def record(self, run: Solver[Any], look: NewEvents) -> None:
        """Hand these events to the sink, and remember the present state of the run."""
        self.sink.record(run, self.stream, look)
        self.remember(run)

    def remember(self, run: Solver[Any]) -> None:
        """Keep a snapshot if the run may have to return here, which is so only if it stops after a number of events."""
        self.looked = None if self.options.max_events is None else run.snapshot()

    def make_room(self, run: Solver[Any]) -> bool:
        """Have the sink make room in the full history: see `run_loop.Watch`."""
        room = self.sink.make_room(run, self.stream)
        self.remember(run)  # the sink may have discarded history, and a snapshot refers to pieces by their number
        return room
