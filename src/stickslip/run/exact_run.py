"""The exact solver of one contact, as a run sees it: a `Session` with its reports, counts of events, files and result."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from typing_extensions import override

from stickslip.engine import SPARE, Checkpoint, Session
from stickslip.problem import (
    ENOUGH_EVENTS,
    EXACT_TRIPS,
    FULL_HISTORY,
    MOST_PIECES,
    STATUSES,
    UNDER_WAY,
    Crowd,
    Status,
    Stop,
    default_event_rate,
    leaps_over,
    lumps_by_itself,
)
from stickslip.run.options import CallOptions
from stickslip.run.progress import Doing, Pace, Report
from stickslip.solution import Solution

if TYPE_CHECKING:
    from stickslip.solution.observables import EventStream, Look


@dataclass(eq=False)
class ExactRun(Session[CallOptions]):
    """A session with its slip events, an implementation of `run.solver.Solver`."""

    keeps_events_only: bool = False
    """True if the history is discarded on the way, for a catalogue."""
    looked: Checkpoint | None = None
    """State before the first step since events were counted or forgotten; None if the run never has to return there."""

    @cached_property
    def stream(self) -> EventStream:
        """The slip events, each reported once; many runs never ask for them."""
        return self._new_stream()

    def _new_stream(self) -> EventStream:
        from stickslip.solution.observables import EventStream

        return EventStream(default_event_rate(self.problem))

    @override
    def advance(self, budget: int) -> int:
        if self.looked is None and self.options.max_events is not None:
            self.looked = self.snapshot()
        return super().advance(budget)

    @property
    def can_be_saved(self) -> bool:
        """True if there is a history to be written."""
        return self.length > 0

    @property
    def has_enough(self) -> bool:
        """True if as many events have been reported as the options ask for."""
        return self.options.max_events is not None and self.stream.reported >= self.options.max_events

    def report(self, pace: Pace) -> Report:
        """Return the progress of the run: see `Solver.report`."""
        options, reported = self.options, self.stream.reported
        now = min(self.time, options.duration)
        share = max(now / options.duration, reported / options.max_events if options.max_events else 0.0)
        rate = abs(float(self.state.rate_now)) if self.count.mode != 0 else 0.0
        doing: Doing = "stuck" if rate == 0.0 else "slipping" if rate > self.stream.threshold else "creeping"
        pieces = self.forgotten + self.length
        return Report(now, options.duration, reported, options.max_events, pieces, doing, *pace.at(now, share))

    def new_events(self) -> Look:
        """Return the events that are new, no more than the options still ask for: see `Solver.new_events`."""
        look, most = self.stream.look(self.history()), self.options.max_events
        missing = len(look.known_by) + 1 if most is None else most - self.stream.reported
        if missing <= len(look.known_by):
            look = look.first_ones(missing)
            self._return(int(look.known_by[-1]) + 1)
        self.looked = None
        return look

    def _return(self, length: int) -> None:
        """Go back to where events were last counted, and step from there until the history has `length` pieces."""
        assert self.looked is not None
        self.restore(self.looked)
        while self.length < length:
            self.advance(1)

    def solution(self, code: int) -> Solution:
        """Return the solution computed so far, with the status that belongs to this code."""
        options, history = self.options, self.history()
        reached = options.duration if code in (Stop.FINISHED, Stop.LOCKED) else history.duration
        counted = options.max_events if code == ENOUGH_EVENTS else None
        history = replace(history, duration=reached, creep=self.creep, max_events=counted)
        status = self._full() if code == FULL_HISTORY else STATUSES[code]
        notes = self.lumping_note, self.rounding_note
        return Solution(self.problem, options.options, status, history, self.checkpoint(), *notes)

    def save(self) -> None:
        """Renew the checkpoint, if a file for it was given."""
        if self.options.checkpoint is not None:
            from stickslip.solution.files import save_checkpoint

            save_checkpoint(self.solution(UNDER_WAY), self.options.checkpoint)

    def finish(self, code: int) -> Solution:
        """Return the solution with the status that belongs to this code, and write it if a file for it was given."""
        solution = self.solution(code)
        if self.options.checkpoint is not None:
            solution.to_netcdf(self.options.checkpoint)
        return solution

    def _full(self) -> Status:
        """Return the status of a run whose history is full, with remedies; measures that begin after its end would not help."""
        from stickslip.run.check.asked import CHECK_DRIVERS

        options, history = self.options, self.history()
        trips, cures, stream = history.store.trip, [], self._new_stream()
        stream.look(history).tell()
        if not self.keeps_events_only and 2 * stream.needed(history) > self.length:
            cures.append("a catalogue, which keeps events only")
        if options.creep_rtol == 0.0 and leaps_over(self.problem) and np.unique(trips[history.store.mode != 0]).size > EXACT_TRIPS:
            cures.append("leaps (leave out creep_rtol = 0)")
        counts = np.unique(trips, return_counts=True)[1]
        if options.shortest_event == 0.0 and counts.max() > MOST_PIECES and lumps_by_itself(self.problem):
            cures.append("lumping of the shortest events (leave out shortest_event = 0)")
        body, heals = self.problem.body, self.problem.friction.memory == "since-arrest"
        if heals and counts[-2:].max() > counts[len(counts) // 2]:
            cures += CHECK_DRIVERS[body.driver_kind].to_let_waves_out
        half, last = history.start[[self.length // 2, max(self.length // 2, self.length - 4 * SPARE)]].tolist()
        taken = self.taken if self.is_short_of_memory else None
        return Crowd(self.length, history.duration, half, last, options.duration, body.turn, taken).status(cures)

    def forget_reported(self) -> int:
        """Discard history that neither events to come nor the engine need. Returns the number of pieces discarded.

        Nothing is discarded after the checkpoint for a longer run has been stored, which refers to pieces by their number.
        """
        if self.before_end is not None:
            return 0
        dropped = self.forget_before(self.stream.needed(self.history()))
        if dropped > 0:
            self.stream.forget(dropped)
            self.looked = None  # it refers to pieces by their number
        return dropped
