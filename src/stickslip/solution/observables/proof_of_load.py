"""Compare the loads of a history with what its slip and the problem make of them: the waves, the spring, the drivers, the ground.

The contact equation, and the energy that it balances, take the load of a step from the history. Here the load is found again: for a
block from the way of its driver and from its slip; for a uniform body from the wave that left the contact one round trip before,
and from what the driver of the moment adds; for layers from all their waves, replayed from the slip rate alone. It is compared at
places inside the steps: a measurement, not a bound.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from stickslip.engine import History, Positions
from stickslip.foundation.arrays import Floats
from stickslip.solution.observables.asked import LoadCompared, observables_of
from stickslip.solution.observables.given_load import beside, breaks_at_contact
from stickslip.solution.observables.given_on_discs import near_break
from stickslip.solution.observables.proof import Places, chosen_steps

Expected = Callable[[History, Places, Floats], Floats]
"""Loads minus the reference strength at places in pieces of a history, as they are found again."""
INSIDE = 0.5 - 0.5 * np.cos(np.pi * (np.arange(12) + 0.5) / 12)
"""Places (1) in a step where loads are compared; not its ends, where a load may jump."""
AT_ONCE = 1024
"""Compare this many steps together: it keeps the memory bounded."""
BREAKS = 1000
"""Compare loads beside at most this many breaks of the loading."""
SHORT_STEP = 1e-11
"""Steps shorter than this share (1) of the round trip, or of the time since the start, are not compared: times are rounded."""


def load_compared(history: History) -> LoadCompared:
    """Return how far the loads of a history are from those that follow from its slip and its problem."""
    return observables_of(history.problem).load_compared(history)


def compared_in_steps(history: History, expected: Expected) -> LoadCompared:
    """Return how far the loads of a history are from those expected, at places in its steps, and beside breaks of the loading."""
    n = chosen_steps(history.store, comparable(history))
    worst, compared = 0.0, 0
    for some in np.array_split(n, len(n) // AT_ONCE + 1):
        xi = np.tile(INSIDE, len(some))
        piece = np.repeat(some, len(INSIDE))
        differs = np.abs(expected(history, piece, xi) - history.excess(Positions.inside(piece, xi))).reshape(-1, len(INSIDE))
        known = ~np.isnan(differs).any(axis=1)
        worst, compared = max(worst, float(differs[known].max(initial=0.0))), compared + int(np.count_nonzero(known))
    return LoadCompared(max(worst, _beside_breaks(history, expected)), compared)


def _beside_breaks(history: History, expected: Expected) -> float:
    """Return the largest difference just before and after a break of the loading: the engine may have it in the wrong place."""
    begin, end = history.span
    times = beside(history.problem, breaks_at_contact(history.problem)[:BREAKS]) + begin
    times = times[(times > begin) & (times < end)]
    if not len(times):
        return 0.0
    at = history.find(times, "right")
    known = ~at.at_rest & np.isin(at.piece, comparable(history))
    piece, xi = at.piece[known], at.xi[known]
    return float(np.nanmax(np.abs(expected(history, piece, xi) - history.excess(Positions.inside(piece, xi))), initial=0.0))


def comparable(history: History) -> Places:
    """Return the pieces of a history that are long enough, and neither averages nor echoes of averages."""
    store, trips = history.store, history.store.trip
    lasting, since = store.speed + store.bend, trips * history.round_trip_time + store.phase_from
    known = lasting > SHORT_STEP * np.maximum(history.round_trip_time, since)
    known[: history.given] = False
    for first, leaped in history.creep[:, :2]:
        known &= (trips < first) | (trips > first + leaped)
    return np.flatnonzero(known)


def times_in(history: History, piece: Places, xi: Floats) -> tuple[NDArray[np.int64], Floats, Floats, Floats]:
    """Return the round trips and phases (s) of places in pieces, their times (s since the start), and these away from breaks.

    A time at a break of the loading, to rounding, counts as on that side of it where the middle of its piece is.
    """
    store, trip = history.store, history.store.trip[piece]
    phase = store.phase_from[piece] + xi * (store.speed[piece] + xi * store.bend[piece])
    middle = store.phase_from[piece] + 0.5 * store.speed[piece] + 0.25 * store.bend[piece]
    time = trip * history.round_trip_time + phase
    near = near_break(history, time)
    return trip, phase, time, time + np.clip(middle - phase, -near, near)
