"""Slip events as they become known, each once, while the run that makes them goes on.

An event is known when nothing that comes can change its row in the table: when the contact has come to rest (or turned) behind
its end, or the slip rate has risen again. What is told does not depend on when the stream is asked.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from stickslip.engine.state import layout as at
from stickslip.engine.state.layout import Integers, Store
from stickslip.engine_input.forcing import row_time
from stickslip.problem.problem import Problem
from stickslip.trajectory.history import History
from stickslip.trajectory.slip_events import NOT_YET, SlipEvents
from stickslip.trajectory.tables import with_energies

if TYPE_CHECKING:
    import pandas as pd


class Place(NamedTuple):
    """A place in the history: a piece, and xi in it."""

    piece: int
    xi: float


BEFORE = Place(-1, 0.0)
WAVES_OF = 3
"""Round trips before an event whose waves are in the slab when it begins, or have just left it."""


@dataclass
class EventStream:
    """Follows a history. `first` is the piece from which it still needs it, and what stands in the body then; `told` counts the
    events it has told.
    """

    problem: Problem
    threshold: float
    ramp: float
    first: int = 0
    last_start: Place = BEFORE  # of the last event that was told
    told: int = 0
    energies: bool = False
    """Whether rows have the energies of events too."""

    def needed(self, store: Store) -> int:
        """The first piece without which new events could not be told, and the energy of the waves under way."""
        return int(np.searchsorted(store.row, store.row[self.first] - WAVES_OF))

    def look(self, store: Store, length: int) -> Look:
        """What is new in the first `length` pieces of a history."""
        history = self.history(store, length)
        events = SlipEvents.of(history, self.threshold, self.first)
        place = events.piece[0] + 0.5 * events.xi[0]
        old = int(np.searchsorted(place, self.last_start.piece + 0.5 * self.last_start.xi, "right"))
        new = events.some(slice(old, None))
        by = new.known_by(history)
        open_from = np.flatnonzero(~new.is_over | (by == NOT_YET))[:1]
        return Look(self, history, events, old, by[: open_from[0]] if open_from.size else by)

    def history(self, store: Store, length: int) -> History:
        """The history so far."""
        kept, row = at.trimmed(store, length), row_time(self.problem)
        reached = float(kept.row[-1] * row + kept.theta_to[-1]) if len(kept.whole) else 0.0
        return History(kept, self.problem, row, self.ramp, reached)

    def forget(self, pieces: int) -> None:
        """The history has lost its first pieces."""
        self.first -= pieces
        self.last_start = Place(self.last_start.piece - pieces, self.last_start.xi)
        assert self.first >= 0


@dataclass(frozen=True)
class Look:
    """New events in a stream; they count as told when `tell` is called."""

    stream: EventStream
    history: History
    events: SlipEvents
    """Of which the first `old` were told before."""
    old: int
    known_by: Integers
    """For each new event the piece by which it is known."""

    def table(self, *, unknown: bool = False) -> pd.DataFrame:
        """Rows of the new events; on demand also of those that the end of the history leaves open."""
        before = min(self.old, 1)  # whose start says when the first new one recurs
        wanted = slice(self.old - before, None if unknown else self.old + len(self.known_by))
        events = self.events.some(wanted)
        return with_energies(self.history, events, self.stream.energies).iloc[before:].reset_index(drop=True)

    def tell(self) -> None:
        """The new events are old ones from now on; what lies well before the last of them is no longer needed."""
        if not len(self.known_by):
            return
        stream, last = self.stream, self.old + len(self.known_by) - 1
        stream.first = int(self.events.piece[0, last])
        stream.last_start = Place(stream.first, float(self.events.xi[0, last]))
        stream.told += len(self.known_by)
