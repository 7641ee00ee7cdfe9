"""The motion of a driver that is a machine behind layers, from the series of its rate that the run kept with each piece."""

from __future__ import annotations

from functools import cached_property

import numpy as np
from numpy.polynomial import polynomial as poly
from numpy.typing import NDArray

from stickslip.engine import Epoch, Floats, History, Integers
from stickslip.problem import settled_rate

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
        piece, xi, known = self._placed(trips, phases)
        rest = self._settled(trips)
        rate = np.where(known, poly.polyval(xi, self.series[piece].T, tensor=False), rest)
        way = np.where(known, self.before[piece] + poly.polyval(xi, self.way[piece].T, tensor=False), rest * phases)
        return np.reshape(rate, shape), np.reshape(way, shape)

    def acceleration(self, trip: Integers, phase: Floats) -> Floats:
        """Return how fast the rate grows (m/s^2) at places in time, one-dimensional."""
        piece, xi, known = self._placed(trip, phase)
        slope = poly.polyval(xi, (self.series[piece, 1:] * np.arange(1, self.series.shape[1])).T, tensor=False)
        pace = self.store.speed[piece] + 2.0 * self.store.bend[piece] * xi
        return np.asarray(np.where(known, slope / np.where(pace > 0.0, pace, 1.0), 0.0))

    def moved(self, trip: Integers, phase: Floats) -> Floats:
        """Return the way (m) since the start of the run at places in time, one-dimensional."""
        rank = np.searchsorted(self._trips, trip, side="right") - 1
        begun, lasted = self._begun[rank], trip - self._trips[rank]
        of_trip = np.where(lasted > 0, self._whole[rank], 0.0)
        rested = np.maximum(lasted - 1, 0) * self._settled(self._trips[rank] + 1) * self.round
        return np.asarray(begun + of_trip + rested + self.motion(trip, phase)[1])

    @cached_property
    def _whole(self) -> Floats:
        """The way (m) in each whole round trip that was kept."""
        return np.asarray(self.before[self._starts[1:] - 1] + self.way[self._starts[1:] - 1].sum(axis=1))

    @cached_property
    def _begun(self) -> Floats:
        """The way (m) up to the start of each of these, over the rests between them, too."""
        rests = (np.diff(self._trips) - 1) * self._settled(self._trips[:-1] + 1) * self.round
        return np.append(0.0, np.cumsum(self._whole[:-1] + rests))

    def _settled(self, trip: Integers) -> Floats:
        """Return the rate (m/s) of a long rest, under the loading of round trips."""
        return np.asarray(settled_rate(self.problem, np.asarray((trip + 0.5) * self.round, float)))

    def _placed(self, trips: Integers, phases: Floats) -> tuple[NDArray[np.intp], Floats, NDArray[np.bool_]]:
        """Return the piece at each place in time, the place xi in it, and whether anything was kept of that round trip."""
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
        return piece, np.clip(2.0 * since / np.where(pace > 0.0, pace, 1.0), 0.0, 1.0), known

    def kinetic(self, now: Epoch) -> float:
        """Return the kinetic energy of the machine (J/m^2) at a moment."""
        rate, _ = self.motion(np.array([now.trip]), np.array([now.offset]))
        return 0.5 * self.problem.body.driver_inertia * float(rate[0]) ** 2
