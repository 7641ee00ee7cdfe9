"""Stream of slip events: each event is reported once, as soon as it is final, while the run continues.

An event is final when nothing that follows can change its row in the table: when the contact has come to rest (or reversed its
direction) after the end of the event, or the slip rate has risen again. The rows do not depend on when the stream is asked.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from stickslip.engine import NOT_YET, History, Integers, SlipEvents

if TYPE_CHECKING:
    import pandas as pd


class HistoryPlace(NamedTuple):
    """A place in the history: a piece, and xi in it."""

    piece: int
    xi: float


BEFORE = HistoryPlace(-1, 0.0)
"""A place before the first piece, for a stream that has reported no event yet."""
WAVES_OF = 3
"""Number of round trips before an event whose waves are in the slab when it begins, or have just left it."""


@dataclass
class EventStream:
    """Follow a history and report its slip events.

    An event is slip at more than `threshold` (m/s). `first` is the first piece that the stream still has to search, and `told` the
    number of events that it has reported. It also needs the waves that travel in the body when piece `first` begins (see `needed`).
    """

    threshold: float
    first: int = 0
    last_start: HistoryPlace = BEFORE  # of the last event that was reported
    reported: int = 0
    energies: bool = False
    """True if the rows also hold the energies of the events."""

    def needed(self, history: History) -> int:
        """Return the first piece of the history that is needed for new events and for the energy of the waves under way.

        Whether the last event began from rest is seen from the piece before its first one.
        """
        trips = history.store.trip
        return max(min(int(np.searchsorted(trips, trips[self.first] - WAVES_OF)), self.first - 1), 0)

    def look(self, history: History) -> Look:
        """Return the new events in a history."""
        events = SlipEvents.of(history, self.threshold, self.first)
        place = events.piece[0] + 0.5 * events.xi[0]
        old = int(np.searchsorted(place, self.last_start.piece + 0.5 * self.last_start.xi, "right"))
        new = events.some(slice(old, None))
        by = new.known_by(history)
        open_from = np.flatnonzero(~new.is_over | (by == NOT_YET))[:1]
        return Look(self, history, events, old, by[: open_from[0]] if open_from.size else by)

    def forget(self, pieces: int) -> None:
        """Shift the piece numbers after the given number of pieces was removed from the start of the history."""
        self.first -= pieces
        self.last_start = HistoryPlace(self.last_start.piece - pieces, self.last_start.xi)
        assert self.first >= 0


@dataclass(frozen=True)
class Look:
    """New events in a stream; they count as reported after `tell`."""

    stream: EventStream
    history: History
    events: SlipEvents
    """All events that were found; the first `old` of them were reported before."""
    old: int
    known_by: Integers
    """For each new event that is final, the piece that made it final."""

    def first_ones(self, count: int) -> Look:
        """Return the first few of the new events."""
        return replace(self, known_by=self.known_by[:count])

    def table(self, *, unknown: bool = False) -> pd.DataFrame:
        """Return the rows of the new events; with `unknown`, also of those that are not final at the end of the history."""
        from stickslip.solution.observables.event_table import with_energies

        before = min(self.old, 1)  # the recurrence time of the first new event counts from its start
        wanted = slice(self.old - before, None if unknown else self.old + len(self.known_by))
        events = self.events.some(wanted)
        return with_energies(self.history, events, self.stream.energies).iloc[before:].reset_index(drop=True)

    def tell(self) -> None:
        """Mark the new events as reported, so that the history well before the last of them is no longer needed."""
        if not len(self.known_by):
            return
        stream, last = self.stream, self.old + len(self.known_by) - 1
        stream.first = int(self.events.piece[0, last])
        stream.last_start = HistoryPlace(stream.first, float(self.events.xi[0, last]))
        stream.reported += len(self.known_by)
