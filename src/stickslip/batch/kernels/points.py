"""Find the slip events of a run from the turning points of its slip rate (`trajectory.turning_points`)."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from stickslip.engine.codegen.compiler import kernel
from stickslip.engine.state.layout import Integers
from stickslip.trajectory.slip_events import NOT_YET, count_pulses, highest
from stickslip.trajectory.turning_points import Turns, extend_to_rest, new_turns, turning_points

POINTS_PER_PIECE = 8
"""Number of turning points for which there is room at first, for each piece of history."""


class Points(NamedTuple):
    """The turning points of a slip rate in order of time, and the events that they form. Arrays may be longer than needed."""

    turns: Turns
    begin: Integers  # of each event: its first point
    past: Integers  # of each event: the point after its last one
    top: Integers  # of each event: its fastest point
    pulses: Integers  # of each event: its number of pulses


def new_points(capacity: int) -> Points:
    """Return uninitialised arrays for `capacity` points."""
    return Points(new_turns(capacity), *(np.empty(capacity, np.int64) for _ in range(4)))


@kernel
def put_in_order(turns: Turns, found: int) -> None:
    """Sort the first `found` points by piece and place, and at one place those at which the rate rises first.

    This is the order of `slip_events.walk`. The pieces are in order already.
    """
    for n in range(1, found):
        piece, xi, rate, kind = turns.piece[n], turns.xi[n], turns.rate[n], turns.kind[n]
        k = n - 1
        while k >= 0 and turns.piece[k] == piece and comes_later(turns.xi[k], turns.kind[k], xi, kind):
            move(turns, k, k + 1)
            k -= 1
        turns.piece[k + 1], turns.xi[k + 1], turns.rate[k + 1], turns.kind[k + 1] = piece, xi, rate, kind


@kernel
def comes_later(xi: float, kind: int, other_xi: float, other_kind: int) -> bool:
    """Return True if a point belongs after another one of the same piece."""
    return xi > other_xi or (xi == other_xi and xi < 1.0 and kind < other_kind)


@kernel
def move(turns: Turns, source: int, target: int) -> None:
    """Copy a point to another position in the order."""
    turns.piece[target], turns.xi[target] = turns.piece[source], turns.xi[source]
    turns.rate[target], turns.kind[target] = turns.rate[source], turns.kind[source]


@kernel
def find_events(table: Integers, length: int, threshold: float, sticks: bool, points: Points) -> int:
    """Find slip events, which are faster than `threshold` (m/s), in a history's table of `length` pieces; return their number.

    `sticks` is True if the law knows rest. The points of each event are written into `points`. Returns NOT_YET if there is no room
    for all turning points.
    """
    found = turning_points(table, 0, length, threshold, points.turns)
    if found < 0:
        return NOT_YET
    put_in_order(points.turns, found)
    if sticks:
        extend_to_rest(table, (0, length), threshold, points.turns, found)
    events = 0
    for n in range(found):
        if points.turns.kind[n] == 1:
            points.begin[events] = n
            events += 1
    for n in range(events):
        points.past[n] = points.begin[n + 1] if n + 1 < events else found
    highest(points.turns.rate, points.begin[:events], points.past[:events], points.top)
    count_pulses(points.turns.rate, points.begin[:events], points.past[:events], points.pulses)
    return events
