"""The motion of a driver that is a machine behind layers, from the series of its rate that the run kept with each piece."""

from __future__ import annotations

import numpy as np
from numpy.polynomial import polynomial as poly

from stickslip.engine.state.layout import Floats, Integers
from stickslip.engine_input.forcing import settled_rate
from stickslip.trajectory.history import Epoch, History

BEYOND = 1.0 + 1e-9
"""Factor (1) that keeps a phase at the end of a round trip below that of the start of the next one."""


class LayerMachine:
    """The rate of a machine at round trips and phases; where the contact rests and nothing was kept, it has settled."""

    def __init__(self, history: History) -> None:
        self.problem, self.round, self.store = history.problem, history.round_trip_time, history.store
        self.series = history.store.state[:, -1]
        count = self.series.shape[1]
        speed, bend = (np.array(column, float)[:, None] for column in (self.store.speed, self.store.bend))
        order = np.arange(1.0, count + 1.0)
        way = np.zeros((len(self.series), count + 2))  # the integral of rate (speed + 2 bend xi)
        way[:, 1:-1] = speed * self.series / order
        way[:, 2:] += 2.0 * bend * self.series / (order + 1.0)
        self.way = way
        trip = np.array(self.store.trip, np.int64)
        self._trips, rank = np.unique(trip, return_inverse=True)
        self._starts = np.append(np.flatnonzero(np.diff(rank, prepend=-1)), len(trip))
        self._order = rank + np.array(self.store.phase_from, float) / (BEYOND * self.round)
        whole = np.append(0.0, np.cumsum(way.sum(axis=1)))
        self.before = whole[:-1] - whole[self._starts[rank]]
        """Way (m) in the round trip of each piece, up to its start."""

    def motion(self, trip: Integers, phase: Floats) -> tuple[Floats, Floats]:
        """Return the rate (m/s) at places in time, and the way (m) since the start of each round trip."""
        shape = trip.shape
        trips, phases = trip.ravel(), phase.ravel()
        rank = np.minimum(np.searchsorted(self._trips, trips), len(self._trips) - 1)
        known = self._trips[rank] == trips
        first, last = self._starts[rank], self._starts[rank + 1] - 1
        piece = np.clip(np.searchsorted(self._order, rank + phases / (BEYOND * self.round), side="right") - 1, first, last)
        piece = np.where((piece > first) & (phases < self.store.phase_from[piece]), piece - 1, piece)  # if rounding missed it
        after = np.minimum(piece + 1, last)
        piece = np.where(phases >= self.store.phase_from[after], after, piece)
        since = phases - self.store.phase_from[piece]
        speed, bend = self.store.speed[piece], self.store.bend[piece]
        pace = speed + np.sqrt(np.maximum(speed * speed + 4.0 * bend * np.maximum(since, 0.0), 0.0))
        xi = np.clip(2.0 * since / np.where(pace > 0.0, pace, 1.0), 0.0, 1.0)
        rest = settled_rate(self.problem, np.asarray((trips + 0.5) * self.round, float))
        rate = np.where(known, poly.polyval(xi, self.series[piece].T, tensor=False), rest)
        way = np.where(known, self.before[piece] + poly.polyval(xi, self.way[piece].T, tensor=False), rest * phases)
        return np.reshape(rate, shape), np.reshape(way, shape)

    def kinetic(self, now: Epoch) -> float:
        """Return the kinetic energy of the machine (J/m^2) at a moment."""
        rate, _ = self.motion(np.array([now.trip]), np.array([now.offset]))
        return 0.5 * self.problem.body.driver_inertia * float(rate[0]) ** 2
