"""Slip events as they become known, each once, while the run that makes them goes on.

An event is known when nothing that comes can change its row in the table: when the contact has come to rest (or turned) behind
its end, or the slip rate has risen again. What is told does not depend on when the stream is asked.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from stickslip.evolution import layout as at
from stickslip.evolution.history import History, Moments, horner
from stickslip.evolution.layout import Floats, Integers, Store
from stickslip.evolution.setup import row_time
from stickslip.evolution.tables import events_table, walk
from stickslip.problem import Problem

if TYPE_CHECKING:
    import pandas as pd

PLACES = np.array([0.25, 0.5, 0.75, 1.0])
"""Where in a piece a rise of the slip rate is looked for, as the table of events does it."""
AT_ONCE = 256
NOT_YET = -1


class Place(NamedTuple):
    """A place in the history: a piece, and xi in it."""

    piece: int
    xi: float


BEFORE = Place(-1, 0.0)


@dataclass
class EventStream:
    """Follows a history. `first` is the piece from which it still needs it; `told` counts the events it has told."""

    problem: Problem
    threshold: float
    ramp: float
    first: int = 0
    last_start: Place = BEFORE  # of the last event that was told
    told: int = 0

    def look(self, store: Store, length: int) -> Look:
        """What is new in the first `length` pieces of a history."""
        history = self.history(store, length)
        piece, xi, _, kind = walk(history, self.threshold)
        starts = np.flatnonzero(kind == 1)
        place = piece[starts] + 0.5 * xi[starts]
        old = int(np.searchsorted(place, self.last_start.piece - self.first + 0.5 * self.last_start.xi, "right"))
        ends = np.append(starts[1:], len(kind))[: len(starts)] - 1
        known = []
        for n in ends[old:]:
            by = known_by(history, int(piece[n]), float(xi[n])) if kind[n] == -1 else NOT_YET
            if by == NOT_YET:
                break
            known.append(self.first + by)
        return Look(self, history, piece[starts], xi[starts], old, known)

    def history(self, store: Store, length: int) -> History:
        """The part of a history that is still needed, as one of its own."""
        kept, row = at.trimmed(store, length, self.first), row_time(self.problem)
        return History(
            kept, self.problem, row, self.ramp, float(kept.row[-1] * row + kept.theta_to[-1]) if len(kept.whole) else 0.0
        )

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
    start_piece: Integers
    start_xi: Floats
    old: int
    known_by: list[int]
    """For each new event the piece (counted as the stream's history was) by which it is known."""

    def table(self, *, unknown: bool = False) -> pd.DataFrame:
        """Rows of the new events; on demand also of those that the end of the history leaves open."""
        rows = events_table(self.history, self.stream.threshold)
        return rows.iloc[self.old : None if unknown else self.old + len(self.known_by)].reset_index(drop=True)

    def tell(self) -> None:
        """The new events are old ones from now on; what lies well before the last of them is no longer needed."""
        if not self.known_by:
            return
        stream, last = self.stream, self.old + len(self.known_by) - 1
        piece = int(self.start_piece[last])
        stream.last_start = Place(stream.first + piece, float(self.start_xi[last]))
        stream.told += len(self.known_by)
        stream.first += round_trip_before(self.history.store, piece)


def round_trip_before(store: Store, piece: int) -> int:
    """First piece of the round trip in the history before that of a piece: the history of an event reaches back so far."""
    first = int(np.searchsorted(store.row, store.row[piece]))
    return int(np.searchsorted(store.row, store.row[first - 1])) if first > 0 else 0


def known_by(history: History, piece: int, xi: float) -> int:
    """The piece by which it is known what an event that ends here has left behind; NOT_YET where the history ends before."""
    mode = history.store.mode
    rate = abs(history.rate(Moments(np.array([piece]), np.array([xi]), np.zeros(1), np.zeros(1, bool)))[0])
    for begin in range(piece + 1, len(history), AT_ONCE):
        turned = mode[begin : begin + AT_ONCE] != mode[piece]
        same = int(np.argmax(turned)) if turned.any() else len(turned)
        rates = history.store.rate[begin : begin + same]
        rises = np.abs([horner(rates, np.full(same, x)) for x in PLACES]).max(axis=0) > rate
        if same < len(turned) or rises.any():
            return begin + (int(np.argmax(rises)) if rises.any() else same)
    return NOT_YET
