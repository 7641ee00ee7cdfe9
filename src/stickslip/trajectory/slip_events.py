"""Slip events in a history: where each begins, is fastest and ends, and from which piece on its aftermath is known."""

from __future__ import annotations

from typing import NamedTuple, Self

import numpy as np
from numpy.typing import NDArray

from stickslip.engine.codegen.compiler import kernel
from stickslip.engine.series.polynomial import evaluate
from stickslip.engine.state.layout import Floats, Integers
from stickslip.engine.state.workspace import pieces_in
from stickslip.problem.problem import Problem
from stickslip.trajectory.history import History, Positions
from stickslip.trajectory.turning_points import MAXIMA_PER_PIECE, Turns, extend_to_rest, new_turns, turning_points

NOT_YET = -1
"""Marks an event whose aftermath is not known within the history."""


@kernel
def highest(values: Floats, begin: Integers, past: Integers, found: Integers) -> None:
    """Find the index of the largest of values[begin:past] (the first, if several are equal) for each of several ranges.

    Not with `np.argmax`: machine code with such reductions makes numba load scipy and its linear algebra at every start.
    """
    for n in range(len(begin)):
        found[n] = begin[n]
        for k in range(begin[n] + 1, past[n]):
            if values[k] > values[found[n]]:
                found[n] = k


@kernel
def count_pulses(rate: Floats, begin: Integers, past: Integers, pulses: Integers) -> None:
    """Count the pulses in each of several ranges of turning points; the result is 0 for a range at rest.

    Pulses are maxima of |v| separated by minima below half the lower of the two.
    """
    for n in range(len(begin)):
        pulses[n], peak, low = 0, 0.0, 0.0
        for k in range(begin[n], past[n]):
            if rate[k] <= 0.0:
                continue
            if pulses[n] == 0 or low < 0.5 * min(peak, rate[k]):
                pulses[n], peak, low = pulses[n] + 1, rate[k], rate[k]
            elif rate[k] > peak:
                peak = low = rate[k]
            low = min(low, rate[k])


@kernel
def rises_over(c: Floats, rate: float) -> bool:
    """Return True if |slip rate| exceeds a rate at any of four places of a piece."""
    highest = 0.0
    for k in range(1, 5):
        highest = max(highest, abs(evaluate(c, 0.25 * k)))
    return highest > rate


@kernel
def find_aftermath(table: Integers, piece: Integers, xi: Floats, by: Integers) -> None:
    """Find the piece from which on the aftermath of each event is known; see `SlipEvents.known_by`."""
    pieces = pieces_in(table)
    for n in range(len(piece)):
        mode, rate = pieces[piece[n]].mode, abs(evaluate(pieces[piece[n]].rate, xi[n]))
        by[n] = NOT_YET
        for k in range(piece[n] + 1, len(table)):
            if pieces[k].mode != mode or rises_over(pieces[k].rate, rate):
                by[n] = k
                break


def walk(history: History, threshold: float, begin: int = 0) -> Turns:
    """Return the points of `turning_points` in order of time; events begin and end at rest where `extend_to_rest` allows it."""
    room = 8 * (len(history) - begin) + 4 * MAXIMA_PER_PIECE
    while True:
        turns = new_turns(room)
        found = turning_points(history.store.pieces, begin, len(history), threshold, turns)
        if found >= 0:
            piece, xi, rate, kind = turns.piece[:found], turns.xi[:found], turns.rate[:found], turns.kind[:found]
            order = np.lexsort((-kind * (xi < 1.0), xi, piece))
            turns = Turns(piece[order], xi[order], rate[order], kind[order])
            if history.problem.friction.sticks:
                extend_to_rest(history.store.pieces, (begin, len(history)), threshold, turns, found)
            return turns
        room *= 2


def default_event_rate(problem: Problem) -> float:
    """Return the default slip rate (m/s) that defines an event: 1e-6 S (range of mu) / Z; for the block sqrt(K m) replaces Z."""
    return 1e-6 * problem.normal * problem.friction.variation / problem.body.impedance


class SlipEvents(NamedTuple):
    """Slip events in order of time. Their begin, peak and end are places in the history: pieces, and xi in each."""

    piece: Integers  # (3, events)
    xi: Floats  # (3, events)
    peak_rate: Floats
    pulses: Integers
    is_over: NDArray[np.bool_]
    """True if the slip rate falls to the threshold within the history."""

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
        piece, xi, rate, kind = walk(history, threshold, first)
        begin = np.flatnonzero(kind == 1)
        past = np.append(begin, len(kind))[1:]
        top, pulses = np.empty_like(begin), np.empty_like(begin)
        highest(rate, begin, past, top)
        count_pulses(rate, begin, past, pulses)
        places = np.stack([begin, top, past - 1])
        return cls(piece[places], xi[places], rate[top], pulses, kind[past - 1] == -1)

    def some(self, which: slice) -> Self:
        """Return a part of the events."""
        return self._replace(**{name: column[..., which] for name, column in self._asdict().items()})

    @property
    def begin(self) -> Positions:
        """The positions at which the events begin."""
        return Positions.inside(self.piece[0], self.xi[0])

    @property
    def peak(self) -> Positions:
        """The positions at which the slip rate is largest."""
        return Positions.inside(self.piece[1], self.xi[1])

    @property
    def end(self) -> Positions:
        """The positions at which the events end, or the history does."""
        return Positions.inside(self.piece[2], self.xi[2])

    def largest(self, values: Floats) -> Floats:
        """Return the largest value in each event, from values given for each piece of the history."""
        ends = np.stack([self.piece[0], self.piece[2] + 1], axis=1).ravel()
        found: Floats = np.maximum.reduceat(np.append(values, np.nan), ends)[::2] if len(ends) else np.empty(0)
        return found

    def known_by(self, history: History) -> Integers:
        """Return the piece from which on it is known what each event leaves behind; NOT_YET if the history ends before that.

        In that piece the contact has come to rest or reversed its direction, or the slip rate exceeds its value at the end of the
        event.
        """
        by = np.empty(len(self.pulses), np.int64)
        find_aftermath(history.store.pieces, self.piece[2], self.xi[2], by)
        return by
