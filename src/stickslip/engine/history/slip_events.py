"""Slip events in a history: the begin, peak and end of each, and the piece that makes its aftermath known."""

from __future__ import annotations

from typing import Any, NamedTuple, Self

import numpy as np
from numpy.typing import NDArray

from stickslip.engine.history.history import History, Positions
from stickslip.engine.history.turning_points import FULL, Known, SearchMemory, Spare, Turn, search_history, turns_in
from stickslip.engine.series.polynomial import MOST_CROSSINGS, evaluate
from stickslip.engine.state.layout import Floats, HistoryPiece, Integers
from stickslip.engine.state.workspace import pieces_in
from stickslip.foundation.arrays import Floats1, Integers1, Integers2
from stickslip.foundation.kernels.kernels import entry, kernel
from stickslip.foundation.kernels.memory.pointers import record_at
from stickslip.foundation.kernels.memory.records import MemoryRecord
from stickslip.problem import default_event_rate

LAST_THIRD = 2.0 / 3.0
"""After this share of a run (1), transients from its start count as over."""
HARDLY = 0.01
"""A contact that never rests counts as sticking below this share of the pull rate (1)."""
NEGLIGIBLE_REMAINDER = 1e-9
"""Share of a run (1) that may be the rounding of its parts."""
NOT_YET = -1
"""Marks an event whose aftermath is not known within the history."""


class EventTurns(MemoryRecord):
    """Hold which of the points of |slip rate| belong to an event."""

    begin: int  # its first point
    past: int  # the point after its last one
    top: int  # its fastest point, the first of several
    pulses: int  # number of its pulses


events_in: Any = record_at(EventTurns)
"""Function for compiled code that returns the first of these records in memory."""


@kernel
def group_turns(turns: Turn, found: int, events: EventTurns) -> int:
    """Group the first `found` points of |slip rate|, in order of time, to events, and return their number."""
    points, out, count = turns, events, 0
    for n in range(found):
        if points[n].kind == 1:
            out[count].begin = out[count].top = n
            out[count].pulses = 0
            peak = low = 0.0
            count += 1
        if count == 0:
            continue
        event, rate = out[count - 1], points[n].rate
        event.past = n + 1
        if rate > points[event.top].rate:
            event.top = n
        # Pulses are maxima of |v| separated by minima below half the lower of the two.
        if rate > 0.0:
            if event.pulses == 0 or low < 0.5 * min(peak, rate):
                event.pulses, peak, low = event.pulses + 1, rate, rate
            elif rate > peak:
                peak = low = rate
            low = min(low, rate)
    return count


@entry
def group_turns_in(turns: Integers2, events: Integers2) -> int:
    """Do what `group_turns` does for tables."""
    return group_turns(turns_in(turns), len(turns), events_in(events))


@kernel
def rises_over(c: Floats, rate: float) -> bool:
    """Return True if |slip rate| exceeds a rate at any of four places of a piece."""
    highest = 0.0
    for k in range(1, 5):
        highest = max(highest, abs(evaluate(c, 0.25 * k)))
    return highest > rate


@entry
def find_aftermath(table: Integers2, piece: Integers1, xi: Floats1, by: Integers1) -> None:
    """Find the piece that makes the aftermath of each event known; see `SlipEvents.known_by`."""
    pieces = pieces_in(table)
    for n in range(len(piece)):
        mode, rate = pieces[piece[n]].mode, abs(evaluate(pieces[piece[n]].rate, xi[n]))
        by[n] = NOT_YET
        for k in range(piece[n] + 1, len(table)):
            if pieces[k].mode != mode or rises_over(pieces[k].rate, rate):
                by[n] = k
                break


@kernel
def time_slipping(pieces: HistoryPiece, length: int, round_trip_time: float, begin: float, end: float) -> float:
    """Return how long (s) the contact slips between two times, in the first `length` pieces."""
    total = 0.0
    for n in range(length):
        if pieces[n].mode != 0:
            start = pieces[n].trip * round_trip_time
            low, high = max(start + pieces[n].phase_from, begin), min(start + pieces[n].phase_to, end)
            total += max(high - low, 0.0)
    return total


@entry
def time_slipping_in(table: Integers2, round_trip_time: float, begin: float, end: float) -> float:
    """Do what `time_slipping` does for the table of a history."""
    return time_slipping(pieces_in(table), len(table), round_trip_time, begin, end)


@entry
def rest_of(slipping: float, length: float) -> float:
    """Return the share (1) of rest in a length of time (s), given the time of slip; a share that may be rounding counts as 0."""
    share = 1.0 - slipping / length
    return share if share > NEGLIGIBLE_REMAINDER else 0.0


def time_creeping(creep: Floats, round_trip_time: float, begin: float, end: float) -> float:
    """Return the time (s) between two others that leaps over creep take beyond their first, recorded round trips."""
    low, high = (creep[:, 0] + 1.0) * round_trip_time, (creep[:, 0] + creep[:, 1]) * round_trip_time
    return float(np.sum(np.maximum(np.minimum(high, end) - np.maximum(low, begin), 0.0)))


def share_sticking(history: History) -> float:
    """Return the share (1) of sticking in the last third of a run.

    The contact sticks while it rests. Under a law without rest it sticks while it is slower than HARDLY times the pull rate, or
    HARDLY times its mean slip rate in that third if that is larger.
    """
    begin, end, trip = LAST_THIRD * history.duration, history.duration, history.round_trip_time
    if history.problem.friction.sticks:
        slips = time_slipping_in(history.store.pieces, trip, begin, end) + time_creeping(history.creep, trip, begin, end)
        return float(rest_of(slips, end - begin))
    mean = abs(float(np.diff(history.slipped(history.find(np.array([begin, end]), "right")))[0])) / (end - begin)
    pulled = abs(float(history.problem.pull_rate_at(end)))
    events = SlipEvents.of(history, HARDLY * max(mean, pulled))
    low, high = (history.seconds(*history.placed(at)) for at in (events.begin, events.end))
    slips = float(np.sum(np.maximum(np.minimum(high, end) - np.maximum(low, begin), 0.0)))
    return float(rest_of(slips, end - begin))


def walk(history: History, threshold: float, begin: int = 0) -> Integers:
    """Return a table of `Turn`: the points of |slip rate| (m/s) from piece `begin` on; events begin and end at rest if they can."""
    known, spare, room = Known.table(len(history)), Spare.table(1), 8 * (len(history) - begin) + 4 * MOST_CROSSINGS
    while True:
        turns = Turn.table(room)
        memory = SearchMemory(turns, known, spare)
        found = search_history(history.store.pieces, memory, begin, threshold, history.problem.friction.sticks)
        if found != FULL:
            return turns[:found]
        room *= 2


class SlipEvents(NamedTuple):
    """Slip events in order of time. Their begin, peak and end are places in the history: pieces, and xi in each."""

    piece: Integers  # (3, events)
    xi: Floats  # (3, events)
    peak_rate: Floats
    pulses: Integers
    is_over: NDArray[np.bool_]
    """True if the slip rate falls to the threshold within the history."""
    threshold: float
    """Slip above this rate (m/s) is an event."""

    @classmethod
    def of(cls, history: History, threshold: float, first: int = 0) -> Self:
        """Find the maximal intervals with |slip rate| above the threshold (m/s), from piece `first` on.

        If the run stopped after a number of events, what begins after the last of them does not count.
        """
        found = cls._all_of(history, threshold, first)
        if history.max_events is None:
            return found
        counted = cls._all_of(history, default_event_rate(history.problem)).some(slice(history.max_events))
        if not len(counted.pulses):
            return found
        # Piece plus half of xi puts places in order; the end of a piece stays before the start of the next one.
        last = counted.piece[2, -1] + 0.5 * counted.xi[2, -1]
        return found.some(slice(int(np.searchsorted(found.piece[0] + 0.5 * found.xi[0], last))))

    @classmethod
    def _all_of(cls, history: History, threshold: float, first: int = 0) -> Self:
        table = walk(history, threshold, first)
        grouped = EventTurns.table(len(table))
        found = EventTurns.of(grouped[: group_turns_in(table, grouped)])
        turns, last = Turn.of(table), found.past - 1
        places = np.stack([found.begin, found.top, last])
        return cls(turns.piece[places], turns.xi[places], turns.rate[found.top], found.pulses, turns.kind[last] == -1, threshold)

    def some(self, which: slice) -> Self:
        """Return a part of the events."""
        parts = {name: column[..., which] for name, column in self._asdict().items() if name != "threshold"}
        return self._replace(**parts)

    @property
    def begin(self) -> Positions:
        """The positions of the beginnings of the events."""
        return Positions.inside(self.piece[0], self.xi[0])

    @property
    def peak(self) -> Positions:
        """The positions of the largest slip rates."""
        return Positions.inside(self.piece[1], self.xi[1])

    @property
    def end(self) -> Positions:
        """The positions of the ends of the events, or of the history if an event is not over."""
        return Positions.inside(self.piece[2], self.xi[2])

    def largest(self, values: Floats) -> Floats:
        """Return the largest value in each event, from values given for each piece of the history."""
        ends = np.stack([self.piece[0], self.piece[2] + 1], axis=1).ravel()
        found: Floats = np.maximum.reduceat(np.append(values, np.nan), ends)[::2] if len(ends) else np.empty(0)
        return found

    def known_by(self, history: History) -> Integers:
        """Return the piece that makes the aftermath of each event known; NOT_YET if the history ends before that.

        In that piece the contact has come to rest or reversed its direction, or the slip rate exceeds its value at the end of the
        event.
        """
        by = np.empty(len(self.pulses), np.int64)
        find_aftermath(history.store.pieces, self.piece[2], self.xi[2], by)
        return by
