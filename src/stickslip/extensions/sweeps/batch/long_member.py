"""Members of a batch whose history is too long to be kept, or that creep for long. They run by themselves, as in `simulate`.

Slip events are reduced to numbers as soon as they are complete, and history that is no longer needed is discarded.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from stickslip.engine import LAST_THIRD, Floats, Integers, rest_of, time_creeping, time_slipping_in
from stickslip.engine.lanes import Reduced, fold_end
from stickslip.problem import INTERRUPTED, Stop
from stickslip.problem.scenarios import Scenario
from stickslip.run import CallOptions, ExactRun, Interrupts
from stickslip.run.run_loop import run_loop

if TYPE_CHECKING:
    import pandas as pd

LARGEST_HISTORY = 500_000
"""Largest number of pieces of history: those of one event, and those whose waves are still in the body. They take 250 MB."""
LARGEST_SHARE = 0.75
"""Largest share of LARGEST_HISTORY that a member may need once all other history is discarded; a member that needs more fails.

In a storm of events each piece that is discarded leaves less room than the one before. Near LARGEST_HISTORY the run would discard,
which takes a second, for every few pieces.
"""
COLUMNS_OF_FIRST_EVENT = ("start", "end", "duration", "slip", "traction_drop", "static_drop")
"""Columns of an event table that are kept of the first event, as fields `first_...` of `reduction.Reduced`."""


@dataclass
class Folding:
    """The watch (`run_loop.Watch`) of a run in bounded memory: it reduces events and discards history when this is full.

    Events are reduced one by one to the numbers of `reduction.fold_events` and `reduction.fold_first` in `out`.
    """

    run: ExactRun
    stop: Integers
    """The flag that ends the whole batch."""
    out: Reduced
    recurrences: int = 0
    """Number of recurrence times so far."""
    deviations: float = 0.0
    """Sum of the squared deviations of the recurrence times from their mean (s^2)."""
    counted: int = 0
    """Number of pieces whose shocks, and whose time in slip, have been counted."""
    slips: float = 0.0
    """Time (s) of slip in the last third of the run, so far."""

    def look(self, *, now: bool) -> int | None:
        """End the run if the batch is to stop: see `run_loop.Watch`."""
        return INTERRUPTED if self.stop[0] != 0 else None

    def make_room(self) -> bool:
        """Reduce the events that are complete, and discard pieces whose waves have left the body: see `run_loop.Watch`.

        Returns False if that does not make enough room, and the history cannot grow any more either.
        """
        run = self.run
        self.count()
        new = run.stream.look(run.history())
        self.add(new.table())
        new.tell()
        if run.before_end is not None:
            return run.grow()
        self.counted -= run.forget_reported()
        if run.length > LARGEST_SHARE * LARGEST_HISTORY:
            return False
        return run.length < len(run.store.pieces) // 2 or run.grow()

    def count(self) -> None:
        """Count the shocks, and the time in slip, of the pieces that were added since the last count."""
        run = self.run
        self.out.shocks += np.count_nonzero(run.store.cause[self.counted : run.length])
        added, end = run.store.pieces[self.counted : run.length], run.options.duration
        self.slips += time_slipping_in(added, run.problem.round_trip_time, LAST_THIRD * end, end)
        self.counted = run.length

    def set_sticking(self, code: int) -> None:
        """Write the share of sticking in the last third; NaN if the run has not reached its end."""
        run = self.run
        if code in (Stop.FINISHED, Stop.LOCKED):
            end, creep = run.options.duration, run.history().creep
            begin = LAST_THIRD * end
            slips = self.slips + time_creeping(creep, run.problem.round_trip_time, begin, end)
            self.out.sticking = rest_of(slips, end - begin)

    def add(self, rows: pd.DataFrame) -> None:
        """Add events, in order of time."""
        out = self.out
        if len(rows) and out.events == 0:
            for name in COLUMNS_OF_FIRST_EVENT:
                setattr(out, f"first_{name}", rows[name].iloc[0])
        out.events += len(rows)
        out.pulses += rows.pulses.sum()
        for rate, when in zip(rows.peak_rate, rows.peak_time, strict=True):
            if not rate <= out.peak_rate:  # also where no event has been counted yet, and the peak is NaN
                out.peak_rate, out.peak_time = rate, when
        for since in rows.recurrence.dropna():
            self.add_recurrence(since)

    def add_recurrence(self, since: float) -> None:
        """Add the time (s) between the starts of two successive events to the running mean and coefficient of variation."""
        mean = 0.0 if self.recurrences == 0 else self.out.recurrence
        self.recurrences += 1
        change = since - mean
        mean += change / self.recurrences
        self.deviations += change * (since - mean)
        self.out.recurrence = mean
        if self.recurrences > 1:
            self.out.recurrence_cv = math.sqrt(self.deviations / (self.recurrences - 1)) / mean


def run_alone(scenario: Scenario, capacity: int, stop: Integers, out: Floats) -> int:
    """Run a member in bounded memory and fill `out`, which holds NaN, with its numbers, except those of the contact equation.

    `capacity` is the number of pieces for which the history has room at first. Returns the code of what ended the run.
    """
    problem = scenario.problem
    run = ExactRun.begin(problem, CallOptions.of(scenario, max_pieces=LARGEST_HISTORY))
    run.reserve(capacity)
    reduced = Reduced(out)
    reduced.events = reduced.pulses = reduced.shocks = 0.0
    watch = Folding(run, stop, reduced)
    with Interrupts() as interrupts:
        code = run_loop(run, watch, interrupts)
        watch.count()
        watch.set_sticking(code)
        watch.add(run.stream.look(run.history()).table(unknown=True))
        fold_end(run.store.pieces[: run.length], problem.round_trip_time, scenario.duration, code, out)
        return code
