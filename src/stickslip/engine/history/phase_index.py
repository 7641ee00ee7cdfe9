"""Index of a history by phase: find the piece that was recorded last at a given phase of the round trip.

While the contact rests nothing is recorded: the load is then an echo of what was recorded last at the same phase. Pieces are
intervals of phase in order of time. They are kept in a segment tree over the phases of all ends of pieces; each node
lists its pieces in order of time (Bentley 1977, unpublished; see de Berg et al. 2008, Computational Geometry, section 10.3).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, Self

import numpy as np
from numpy.typing import NDArray

from stickslip.engine.state.layout import Floats, Integers, Store, trimmed
from stickslip.foundation.arrays import Integers1
from stickslip.foundation.kernels.kernels import entry, kernel

NO_RECORDED_PIECE = -1
"""Marks a phase without a recorded piece."""
HALVINGS_OF_INDEX = 64
"""Largest number of halvings of an index or of a range of indices: they have 64 bits."""
RECENT_PIECES = 64
"""Number of recent pieces that are searched first for the waves in the body."""


@entry
def _collect(first: Integers1, past: Integers1, leaves: int, place: Integers1, members: Integers1) -> None:
    """Enter each piece into the nodes that make up its interval, from place[node] on; with empty `members`, only count them."""
    for n in range(len(first)):
        low, high = first[n] + leaves, past[n] + leaves
        for _ in range(HALVINGS_OF_INDEX):
            if low >= high:
                break
            if low & 1:
                _put(low, n, place, members)
                low += 1
            if high & 1:
                high -= 1
                _put(high, n, place, members)
            low >>= 1
            high >>= 1


@kernel
def _put(node: int, n: int, place: Integers, members: Integers) -> None:
    if len(members) > 0:
        members[place[node]] = n
    place[node] += 1


@kernel
def _last(members: Integers, begin: int, end: int, upto: int) -> int:
    """Return the index of the last of members[begin:end] (ascending) that is at most `upto`; begin - 1 if there is none."""
    for _ in range(HALVINGS_OF_INDEX):
        if begin >= end:
            break
        middle = (begin + end) // 2
        if members[middle] <= upto:
            begin = middle + 1
        else:
            end = middle
    return begin - 1


@entry
def _latest(begins: Integers1, members: Integers1, leaf: Integers1, upto: Integers1, found: Integers1) -> None:
    """Find, for each leaf (by the number of its node), the last piece up to upto[q] in any node on the way to the root."""
    for q in range(len(leaf)):
        node, found[q] = leaf[q], NO_RECORDED_PIECE
        while node >= 1:
            place = _last(members, begins[node], begins[node + 1], upto[q])
            if place >= begins[node]:
                found[q] = max(found[q], members[place])
            node >>= 1


@entry
def _standing(begins: Integers1, members: Integers1, upto: int, best: Integers1) -> None:
    """Find, for every node from the root down, the last piece up to `upto` that covers it."""
    best[0] = NO_RECORDED_PIECE
    for node in range(1, len(best)):
        place = _last(members, begins[node], begins[node + 1], upto)
        best[node] = max(best[node // 2], members[place]) if place >= begins[node] else best[node // 2]


@dataclass(frozen=True, eq=False)
class Phases:
    """The pieces of a history, indexed by phase (offset in the round trip, s) and by the order of recording."""

    edges: Floats
    leaves: int  # a power of two, at least the number of intervals between the edges
    begins: Integers
    members: Integers

    @classmethod
    def of(cls, store: Store, round_trip_time: float) -> Self:
        """Index the pieces of a history whose round trips last `round_trip_time` (s).

        Leaps over creep are longer than a round trip; they are averages, not waves in the body, and are left out.
        """
        stands = store.phase_to <= round_trip_time
        edges = np.unique(np.concatenate([store.phase_from[stands], store.phase_to[stands]]))
        first, past = (np.where(stands, np.searchsorted(edges, phase), 0) for phase in (store.phase_from, store.phase_to))
        leaves = 1 << max(len(edges) - 2, 0).bit_length()
        counts = np.zeros(2 * leaves, np.int64)
        _collect(first, past, leaves, counts, np.empty(0, np.int64))
        begins = np.append(0, np.cumsum(counts))
        members = np.empty(begins[-1], np.int64)
        _collect(first, past, leaves, begins[:-1].copy(), members)
        return cls(edges, leaves, begins, members)

    def latest(self, phase: Floats, upto: Integers, side: Literal["left", "right"] = "right") -> Integers:
        """Return the last piece up to `upto` at each phase, or -1 if there is none; `side` picks the piece at an edge.

        A phase that rounding puts before the first or after the last edge belongs to the interval next to it.
        """
        leaf = np.searchsorted(self.edges, phase, side=side) - 1
        found = np.empty(len(leaf), np.int64)
        _latest(self.begins, self.members, self.leaves + np.clip(leaf, 0, len(self.edges) - 2), upto, found)
        return found

    def standing(self, upto: int) -> tuple[NDArray[np.intp], Floats, Floats]:
        """Return the pieces whose waves are in the body after the piece `upto`.

        The pieces are in order of phase; the other arrays hold the first and the last phase (s) of each.
        """
        best = np.empty(2 * self.leaves, np.int64)
        _standing(self.begins, self.members, upto, best)
        leaf = best[self.leaves : self.leaves + len(self.edges) - 1]
        first = np.flatnonzero(np.append(True, leaf[1:] != leaf[:-1]))
        low, high, piece = self.edges[first], self.edges[np.append(first[1:], len(leaf))], leaf[first]
        known = piece != NO_RECORDED_PIECE
        return piece[known], low[known], high[known]


def standing_behind(store: Store, round_trip_time: float) -> tuple[NDArray[np.intp], Floats, Floats]:
    """Return the pieces whose waves are in the body after the whole history, as `Phases.standing` does.

    The search goes back only until every phase is known.
    """
    looked = RECENT_PIECES
    while True:
        first = max(len(store.pieces) - looked, 0)
        recent = trimmed(store, len(store.pieces), first)
        piece, low, high = Phases.of(recent, round_trip_time).standing(len(recent.pieces) - 1)
        if first == 0 or (low[0] == 0.0 and high[-1] == round_trip_time and np.array_equal(low[1:], high[:-1])):
            return first + piece, low, high
        looked *= 4
