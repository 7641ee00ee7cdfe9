"""Which piece of a history holds at a phase of the round trip: the last one recorded there.

Where the contact rests nothing is recorded: the load there is an echo of what was recorded last. Pieces are intervals of phase, in
order of time; they are kept in a segment tree over the phases at which any of them begins or ends (Bentley 1977, unpublished; see
de Berg et al. 2008, Computational Geometry, section 10.3), each node with its pieces in order.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, Self

import numpy as np
from numpy.typing import NDArray

from stickslip.engine.codegen.compiler import kernel
from stickslip.engine.state.layout import Floats, Integers, Store, trimmed

NOTHING = -1
FEW = 64
"""Pieces that are looked at first for what stands in the body."""


@kernel
def _collect(first: Integers, past: Integers, leaves: int, place: Integers, members: Integers) -> None:
    """Put each piece into the nodes that make up its interval, from place[node] on; without room for members only count."""
    for n in range(len(first)):
        low, high = first[n] + leaves, past[n] + leaves
        while low < high:
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
    """The largest of members[begin:end], ascending, that does not exceed upto."""
    while begin < end:
        middle = (begin + end) // 2
        if members[middle] <= upto:
            begin = middle + 1
        else:
            end = middle
    return begin - 1


@kernel
def _latest(begins: Integers, members: Integers, leaves: int, leaf: Integers, upto: Integers, found: Integers) -> None:
    for q in range(len(leaf)):
        node, best = leaf[q] + leaves, NOTHING
        while node >= 1:
            place = _last(members, begins[node], begins[node + 1], upto[q])
            if place >= begins[node]:
                best = max(best, members[place])
            node >>= 1
        found[q] = best


@kernel
def _standing(begins: Integers, members: Integers, upto: int, best: Integers) -> None:
    """For every node, from the root down, the last piece up to `upto` that covers it."""
    best[0] = NOTHING
    for node in range(1, len(best)):
        place = _last(members, begins[node], begins[node + 1], upto)
        best[node] = max(best[node // 2], members[place]) if place >= begins[node] else best[node // 2]


@dataclass(frozen=True, eq=False)
class Phases:
    """The pieces of a history, to be found by phase (offset in the round trip, s) and by when they were recorded."""

    edges: Floats
    leaves: int  # a power of two, not less than the intervals between the edges
    begins: Integers
    members: Integers

    @classmethod
    def of(cls, store: Store, row_time: float) -> Self:
        """Of the pieces of a history with rows so long (s). Leaps over creep, which are longer, are averages, and stand nowhere."""
        stands = store.theta_to <= row_time
        edges = np.unique(np.concatenate([store.theta_from[stands], store.theta_to[stands]]))
        first, past = (np.where(stands, np.searchsorted(edges, theta), 0) for theta in (store.theta_from, store.theta_to))
        leaves = 1 << max(len(edges) - 2, 0).bit_length()
        counts = np.zeros(2 * leaves, np.int64)
        _collect(first, past, leaves, counts, np.empty(0, np.int64))
        begins = np.append(0, np.cumsum(counts))
        members = np.empty(begins[-1], np.int64)
        _collect(first, past, leaves, begins[:-1].copy(), members)
        return cls(edges, leaves, begins, members)

    def latest(self, phase: Floats, upto: Integers, side: Literal["left", "right"] = "right") -> Integers:
        """The last piece up to `upto` at each phase; at an edge, that on the `side`. -1 where there is none.

        Beyond the first and last edge (by rounding) what holds next to them.
        """
        leaf = np.searchsorted(self.edges, phase, side=side) - 1
        found = np.empty(len(leaf), np.int64)
        _latest(self.begins, self.members, self.leaves, np.clip(leaf, 0, len(self.edges) - 2), upto, found)
        return found

    def standing(self, upto: int) -> tuple[NDArray[np.intp], Floats, Floats]:
        """What stands in the body behind the piece `upto`: pieces in order of phase, each from where to where (s)."""
        best = np.empty(2 * self.leaves, np.int64)
        _standing(self.begins, self.members, upto, best)
        leaf = best[self.leaves : self.leaves + len(self.edges) - 1]
        first = np.flatnonzero(np.append(True, leaf[1:] != leaf[:-1]))
        low, high, piece = self.edges[first], self.edges[np.append(first[1:], len(leaf))], leaf[first]
        known = piece != NOTHING
        return piece[known], low[known], high[known]


def standing_behind(store: Store, row_time: float) -> tuple[NDArray[np.intp], Floats, Floats]:
    """What stands in the body behind a history, as `Phases.standing`: looks back no further than to where all phases are known."""
    looked = FEW
    while True:
        first = max(len(store.whole) - looked, 0)
        recent = trimmed(store, len(store.whole), first)
        piece, low, high = Phases.of(recent, row_time).standing(len(recent.whole) - 1)
        if first == 0 or (low[0] == 0.0 and high[-1] == row_time and np.array_equal(low[1:], high[:-1])):
            return first + piece, low, high
        looked *= 4
