"""A member whose history is too long to be kept, or that creeps for long: run by itself, as `simulate` would run it.

Its events are folded as they become known, and the rest is forgotten.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from stickslip.batch.kernels import reduction as of
from stickslip.engine.state.layout import Floats, Integers, Store
from stickslip.engine_input.forcing import row_time
from stickslip.run.run_loop import drive
from stickslip.run.session import RunInProgress
from stickslip.scenarios.scenario import Scenario
from stickslip.trajectory.event_stream import EventStream
from stickslip.trajectory.status import INTERRUPTED
from stickslip.trajectory.tables import default_event_rate

if TYPE_CHECKING:
    import pandas as pd

LARGEST = 500_000
"""Pieces of one event, with what stands in the body before it, beyond which a member ends: 250 MB."""
FIRST = ("start", "end", "duration", "slip", "traction_drop", "static_drop")


@dataclass
class Fold:
    """Numbers of events so far: those of `reduction.fold_events` and `fold_first`, row after row of a catalogue."""

    out: Floats
    recurrences: int = 0
    spread: float = 0.0

    def add(self, rows: pd.DataFrame) -> None:
        """More events, in order of time."""
        out = self.out
        if len(rows) and out[of.EVENTS] == 0:
            out[of.FIRST_START : of.FIRST_STATIC_DROP + 1] = rows[list(FIRST)].iloc[0]
        out[of.EVENTS] += len(rows)
        out[of.PULSES] += rows.pulses.sum()
        for rate, when in zip(rows.peak_rate, rows.peak_time, strict=True):
            if not rate <= out[of.PEAK_RATE]:
                out[of.PEAK_RATE], out[of.PEAK_TIME] = rate, when
        for since in rows.recurrence.dropna():
            self.recur(since)

    def recur(self, since: float) -> None:
        """The next time between starts of events, s."""
        mean = 0.0 if self.recurrences == 0 else self.out[of.RECURRENCE]
        self.recurrences += 1
        change = since - mean
        mean += change / self.recurrences
        self.spread += change * (since - mean)
        self.out[of.RECURRENCE] = mean
        if self.recurrences > 1:
            self.out[of.RECURRENCE_CV] = math.sqrt(self.spread / (self.recurrences - 1)) / mean


@dataclass
class Folding:
    """Looks after the run (`run_loop.Watch`)."""

    stream: EventStream
    fold: Fold
    stop: Integers
    counted: int = field(default=0)
    """Pieces whose shocks are counted."""

    def look(self, run: RunInProgress, *, now: bool) -> int | None:
        """See `run_loop.Watch`."""
        return INTERRUPTED if self.stop[0] != 0 else None

    def make_room(self, run: RunInProgress) -> bool:
        """See `run_loop.Watch`: what is known is folded, what stands nowhere is forgotten."""
        self.count_shocks(run.store, run.length)
        look = self.stream.look(run.store, run.length)
        self.fold.add(look.table())
        look.tell()
        dropped = run.forget_before(self.stream.needed(run.store)) if run.before_end is None else 0
        if dropped > 0:
            self.stream.forget(dropped)
            self.counted -= dropped
        return run.length < len(run.store.whole) // 2 or run.grow(LARGEST)

    def count_shocks(self, store: Store, length: int) -> None:
        """Those of the pieces that came since the last count."""
        self.fold.out[of.SHOCKS] += np.count_nonzero(store.cause[self.counted : length])
        self.counted = length


def run_alone(scenario: Scenario, capacity: int, stop: Integers, out: Floats) -> int:
    """Run a member in bounded memory and fill in its numbers, but for the contact equation's. Returns the code of its end."""
    problem = scenario.problem
    run = RunInProgress.begin(problem, scenario.rtol, scenario.creep_rtol, scenario.shortest_event)
    run.reserve(capacity)
    stream = EventStream(problem, default_event_rate(problem), float(run.setup.par.ramp))
    out[:] = np.nan
    out[[of.EVENTS, of.PULSES, of.SHOCKS]] = 0.0
    watch = Folding(stream, Fold(out), stop)
    code = drive(run, scenario.duration, watch)
    watch.count_shocks(run.store, run.length)
    watch.fold.add(stream.look(run.store, run.length).table(unknown=True))
    of.fold_end(run.store, run.length, row_time(problem), scenario.duration, code, out)
    return code
