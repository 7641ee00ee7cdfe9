"""Slip events of a run: the points that `trajectory.slip_events.turning_points` finds, in order, and where each event begins and
ends."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from stickslip.engine.codegen.compiler import kernel
from stickslip.engine.state.layout import Floats, Integers, Store
from stickslip.trajectory.slip_events import NOT_YET, count_pulses, highest, turning_points

POINTS_PER_PIECE = 8
"""Turning points for which there is room at first."""


class Points(NamedTuple):
    """Room for the turning points of a slip rate, in order of time, and for the events made of them."""

    piece: Integers
    xi: Floats
    rate: Floats
    kind: Integers
    begin: Integers
    past: Integers
    top: Integers
    pulses: Integers


def new_points(capacity: int) -> Points:
    """Room for so many."""
    whole = [np.empty(capacity, np.int64) for _ in range(6)]
    return Points(whole[0], np.empty(capacity), np.empty(capacity), *whole[1:])


@kernel
def put_in_order(points: Points, found: int) -> None:
    """By piece, place in it, and at one place first what rises: as `slip_events.walk`, whose order of pieces is right already."""
    for n in range(1, found):
        piece, xi, rate, kind = points.piece[n], points.xi[n], points.rate[n], points.kind[n]
        k = n - 1
        while k >= 0 and points.piece[k] == piece and comes_later(points.xi[k], points.kind[k], xi, kind):
            move(points, k, k + 1)
            k -= 1
        points.piece[k + 1], points.xi[k + 1], points.rate[k + 1], points.kind[k + 1] = piece, xi, rate, kind


@kernel
def comes_later(xi: float, kind: int, other_xi: float, other_kind: int) -> bool:
    """Whether a point comes behind another one of the same piece."""
    return xi > other_xi or (xi == other_xi and xi < 1.0 and kind < other_kind)


@kernel
def move(points: Points, source: int, target: int) -> None:
    """A point to another place in the order."""
    points.piece[target], points.xi[target] = points.piece[source], points.xi[source]
    points.rate[target], points.kind[target] = points.rate[source], points.kind[source]


@kernel
def find_events(store: Store, length: int, threshold: float, points: Points) -> int:
    """Slip events: where each begins, is fastest and ends among the points. Returns how many; NOT_YET if there is no room."""
    found = turning_points(store, 0, length, threshold, points.piece, points.xi, points.rate, points.kind)
    if found < 0:
        return NOT_YET
    put_in_order(points, found)
    events = 0
    for n in range(found):
        if points.kind[n] == 1:
            points.begin[events] = n
            events += 1
    for n in range(events):
        points.past[n] = points.begin[n + 1] if n + 1 < events else found
    highest(points.rate, points.begin[:events], points.past[:events], points.top)
    count_pulses(points.rate, points.begin[:events], points.past[:events], points.pulses)
    return events
