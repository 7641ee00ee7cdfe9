"""Monitor a run between two calls of the engine: count its events, report its progress, write checkpoints."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Self

from stickslip.engine.state import layout as at
from stickslip.engine.state.layout import Stop
from stickslip.run.progress import Progress, Reporter
from stickslip.run.run_loop import NowAndThen, repeat
from stickslip.run.session import RunInProgress
from stickslip.solution.solution import Solution
from stickslip.trajectory.checkpoint import Checkpoint
from stickslip.trajectory.event_stream import EventStream, Look
from stickslip.trajectory.history import History
from stickslip.trajectory.status import ENOUGH_EVENTS, FULL_HISTORY, STATUSES, UNDER_WAY
from stickslip.trajectory.tables import default_event_rate

MAX_PIECES = 1_000_000
"""Largest number of pieces of a history unless `max_pieces` is given: some 0.4 GB."""
PIECE_SIZE = 8 * (6 + 8 + 2 * at.TERMS)
"""Bytes of a piece, in memory and in a file, without the polynomial of a law's state."""
CHECKPOINT_EVERY = 30.0
"""Default interval between two checkpoints, s of wall clock: a killed run loses little, and writing costs little."""


@dataclass(frozen=True)
class Orders:
    """The options of a run: when it ends, and what to report and store on the way (see `simulate`)."""

    duration: float
    events: int | None = None
    progress: Progress | None = None
    checkpoint: Path | None = None
    checkpoint_every: float = CHECKPOINT_EVERY
    max_pieces: int | None = None
    """None stands for MAX_PIECES; a history that reaches this limit is then not written to the file."""

    @property
    def most_pieces(self) -> int:
        """Return the largest number of pieces that the history may have."""
        return MAX_PIECES if self.max_pieces is None else self.max_pieces

    def keeps(self, code: int) -> bool:
        """Return True if a run that ended with this code goes into its file: a full history only if `max_pieces` was given."""
        return code != FULL_HISTORY or self.max_pieces is not None


def as_solution(run: RunInProgress, orders: Orders, code: int) -> Solution:
    """Return the solution computed so far, with the status that belongs to this code."""
    kept = at.trimmed(run.store, run.length)
    whole = code in (Stop.FINISHED, Stop.LOCKED)
    reached = orders.duration if whole else float(kept.row[-1] * run.problem.round_trip_time + kept.theta_to[-1])
    history = History(kept, run.problem, run.problem.round_trip_time, float(run.setup.par.ramp), reached, creep=run.creep)
    found = Solution(run.problem, orders.duration, run.rtol, STATUSES[code], history, run.checkpoint(), orders.events)
    found = replace(found, lumping_note=run.lumping_note, rounding_note=run.rounding_note)
    return replace(found, creep_rtol=run.creep_rtol, shortest_event=run.shortest_event)


@dataclass(kw_only=True)
class Keeper:
    """A monitor that keeps the whole history.

    `looked` is a checkpoint of the moment when events were last counted; it is None if the run never has to return there.
    """

    orders: Orders
    stream: EventStream
    reporter: Reporter | None
    saving: NowAndThen
    counting: NowAndThen = field(default_factory=lambda: NowAndThen(0.0))
    looked: Checkpoint | None = None

    @classmethod
    def of(cls, run: RunInProgress, orders: Orders, stream: EventStream | None = None) -> Self:
        """Return a monitor for a run with these options. A stream that is given has already reported the earlier events."""
        stream = stream or EventStream(run.problem, default_event_rate(run.problem), float(run.setup.par.ramp))
        reporter = Reporter.of(orders.progress, orders.duration, orders.events, stream.threshold)
        keeper = cls(orders=orders, stream=stream, reporter=reporter, saving=NowAndThen.from_now(orders.checkpoint_every))
        keeper.looked = keeper.stands(run)
        return keeper

    @property
    def counts(self) -> bool:
        """Return True if events must be counted."""
        return self.reporter is not None or self.orders.events is not None

    def look(self, run: RunInProgress, *, now: bool) -> int | None:
        """Count events, report progress and write a checkpoint where each is due: see `run_loop.Watch`."""
        enough = False
        if self.counts and run.length > 0 and (now or self.counting.is_due):
            with self.counting.done():
                enough = self.count(run)
        if self.reporter is not None:
            self.reporter.report(run, self.stream.told)
        if run.length > 0 and not enough and self.saving.is_due:
            with self.saving.done():
                self.save(run)
        return ENOUGH_EVENTS if enough else None

    def count(self, run: RunInProgress) -> bool:
        """Count new events. Returns True if they are enough; the run then goes back to the piece by which the last one is known."""
        look, wanted = self.stream.look(run.store, run.length), self.orders.events
        missing = None if wanted is None else wanted - self.stream.told
        if missing is None or len(look.known_by) < missing:
            self.note(run, look)
            return False
        assert self.looked is not None
        repeat(run, self.looked, self.orders.duration, look.known_by[missing - 1] + 1)
        self.note(run, replace(look, known_by=look.known_by[:missing]))
        return True

    def note(self, run: RunInProgress, look: Look) -> None:
        """Count these events as reported, and remember the present state of the run."""
        look.tell()
        self.looked = self.stands(run)

    def stands(self, run: RunInProgress) -> Checkpoint | None:
        """Return a checkpoint if the run may have to return here, which is so only if it stops after a number of events."""
        return None if self.orders.events is None else run.stands()

    def save(self, run: RunInProgress) -> None:
        """Renew the checkpoint if a file for it was given."""
        if self.orders.checkpoint is not None:
            from stickslip.io.netcdf import save_checkpoint

            save_checkpoint(as_solution(run, self.orders, UNDER_WAY), self.orders.checkpoint)

    def make_room(self, run: RunInProgress) -> bool:
        """Enlarge the store of the history, up to the largest number of pieces allowed: see `run_loop.Watch`."""
        return run.grow(self.orders.most_pieces)
