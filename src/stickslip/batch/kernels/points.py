"""Find the slip events of a run: sort the points of `trajectory.slip_events.turning_points`, and find where each event begins and
ends."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from stickslip.engine.codegen.compiler import kernel
from stickslip.engine.state.layout import Floats, Integers
from stickslip.trajectory.slip_events import NOT_YET, count_pulses, highest, turning_points

POINTS_PER_PIECE = 8
"""Number of turning points for which there is room at first, for each piece of history."""


class Points(NamedTuple):
    """The turning points of a slip rate in order of time, and the events that they form. Arrays may be longer than needed."""

    piece: Integers  # of each point: its piece of history
    xi: Floats  # of each point: its place in the piece, from 0 to 1
    rate: Floats  # of each point: magnitude of the slip rate, m/s
    kind: Integers  # of each point: +1 if the rate rises above the threshold, -1 if it falls to it, 0 above it
    begin: Integers  # of each event: its first point
    past: Integers  # of each event: the point after its last one
    top: Integers  # of each event: its fastest point
    pulses: Integers  # of each event: its number of pulses


def new_points(capacity: int) -> Points:
    """Return uninitialised arrays for `capacity` points."""
    whole = [np.empty(capacity, np.int64) for _ in range(6)]
    return Points(whole[0], np.empty(capacity), np.empty(capacity), *whole[1:])


@kernel
def put_in_order(points: Points, found: int) -> None:
    """Sort the first `found` points by piece and place, and at one place those at which the rate rises first.

    This is the order of `slip_events.walk`. The pieces are in order already.
    """
    for n in range(1, found):
        piece, xi, rate, kind = points.piece[n], points.xi[n], points.rate[n], points.kind[n]
        k = n - 1
        while k >= 0 and points.piece[k] == piece and comes_later(points.xi[k], points.kind[k], xi, kind):
            move(points, k, k + 1)
            k -= 1
        points.piece[k + 1], points.xi[k + 1], points.rate[k + 1], points.kind[k + 1] = piece, xi, rate, kind


@kernel
def comes_later(xi: float, kind: int, other_xi: float, other_kind: int) -> bool:
    """Return True if a point belongs after another one of the same piece."""
    return xi > other_xi or (xi == other_xi and xi < 1.0 and kind < other_kind)


@kernel
def move(points: Points, source: int, target: int) -> None:
    """Copy a point to another position in the order."""
    points.piece[target], points.xi[target] = points.piece[source], points.xi[source]
    points.rate[target], points.kind[target] = points.rate[source], points.kind[source]


@kernel
def find_events(table: Integers, length: int, threshold: float, points: Points) -> int:
    """Find slip events, which are faster than `threshold` (m/s), in a history's table of `length` pieces; return their number.

    The points of each event are written into `points`. Returns NOT_YET if there is no room for all turning points.
    """
    found = turning_points(table, 0, length, threshold, points.piece, points.xi, points.rate, points.kind)
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
