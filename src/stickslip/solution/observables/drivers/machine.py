"""A driver that is a machine, which sends what its own motion makes beside the echo of a rigid driver.

Behind a uniform body its motion follows from all the waves that have met it. Behind layers the run has kept the series of its rate
with each piece.
"""

from __future__ import annotations

from functools import cached_property

import numpy as np
from numpy.polynomial import polynomial as poly
from numpy.typing import NDArray

from stickslip.engine import Epoch, Floats, History, Integers
from stickslip.foundation.constants import RIGID
from stickslip.problem import driver_of, settled_rate
from stickslip.problem.bodies import BodyWithWaves, OfLayers
from stickslip.solution.observables.driver_of_waves import BehindLayers, BehindSlab, DriverBehind, FromMachine, SumOfPower
from stickslip.solution.observables.given_load import far_excess_at, pulled, value_at

BEYOND_TRIP = 1.0 + 1e-9
"""Factor (1) that keeps a phase at the end of a round trip below that of the start of the next one."""


class MachineBehindSlab(BehindSlab):
    """A machine behind a uniform body: it sends back what a rigid driver would, and what its own motion adds."""

    def __init__(self, history: History, body: BodyWithWaves) -> None:
        super().__init__(history, body)
        self.adds = FromMachine(history)

    @property
    def steps(self) -> tuple[tuple[float, float], ...]:
        """The share of a rigid driver at all times."""
        return ((0.0, RIGID),)

    def shears_at(self, time: float) -> float:
        """Return 0."""
        return 0.0

    def kinetic(self, time: float) -> float:
        """Return that of its mass."""
        return self.history.machine.kinetic(time)

    def work(self, passed: SumOfPower, first: Epoch | None, last: Epoch) -> float:
        """Return the work of its gains and of the far stress."""
        return self.history.machine.work(self._begun(first), self._begun(last))

    def radiated(self, passed: SumOfPower, first: Epoch | None, last: Epoch) -> float:
        """Return what its proportional gain takes up."""
        return self.history.machine.dissipated(self._begun(first), self._begun(last))

    def _begun(self, now: Epoch | None) -> float:
        """Return the time since the start of the run (s)."""
        return 0.0 if now is None else now.trip * self.body.two_way_time + now.offset

    def load_at(self, leaving: Floats, time: Floats, inside: Floats) -> Floats:
        """Return the load from the motion of the machine."""
        return self.adds.at(time) - leaving


class MachineBehindLayers(BehindLayers):
    """The rate of a machine at round trips and phases; where the contact rests and nothing was kept, it has settled."""

    def __init__(self, history: History, body: OfLayers) -> None:
        super().__init__(history, body)
        self.store, self.gain = history.store, float(body.stacks[0].driver_impedance)
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
        self._order = rank + np.array(self.store.phase_from, float) / (BEYOND_TRIP * self.round)
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
        piece = np.clip(np.searchsorted(self._order, rank + phases / (BEYOND_TRIP * self.round), side="right") - 1, first, last)
        piece = np.where((piece > first) & (phases < self.store.phase_from[piece]), piece - 1, piece)  # if rounding missed it
        after = np.minimum(piece + 1, last)
        piece = np.where(phases >= self.store.phase_from[after], after, piece)
        return piece, self.history.xi(piece, np.maximum(phases - self.store.phase_from[piece], 0.0)), known

    def kinetic(self, now: Epoch) -> float:
        """Return the kinetic energy of the machine (J/m^2) at a moment."""
        rate, _ = self.motion(np.array([now.trip]), np.array([now.offset]))
        return 0.5 * self.problem.body.driver_inertia * float(rate[0]) ** 2

    def sent(self, trip: Integers, phase: Floats, loaded: tuple[Floats, Floats]) -> tuple[Floats, Floats]:
        """Return what its motion sends, whatever it is loaded with."""
        rate, way = self.motion(trip, phase)
        doubled = 2.0 * self.body.last_impedance
        return doubled * rate, doubled * way

    def ramp(self, trip: Integers) -> Floats:
        """Return the growth of the load while the machine has settled."""
        return np.asarray(self.body.grows_in_a_trip(1.0) * self._settled(trip))

    def missed(self, last: Floats, trip: Integers, phase: Floats) -> Floats:
        """Return by how much (Pa) it misses M dVd/dt = kp (V0 - Vd) + q + s - Z Vd + w, `last` being the wave that it sends.

        There q is the force of the integral gain, and w = 2 Z Vd - `last` what it meets.
        """
        problem, body, time = self.problem, self.problem.body, trip * self.round + phase
        rate, faster = self.motion(trip, phase)[0], self.acceleration(trip, phase)
        force = body.driver_impedance * value_at(problem.pull_rate, time, time) + far_excess_at(problem, time, time)
        first = driver_of(problem).at_first(problem)[1]
        push = first + body.driver_integral_gain * (pulled(problem, time) - self.moved(trip, phase))
        met = 2.0 * body.last_impedance * rate - last
        return np.asarray(body.driver_inertia * faster - force - push + (body.driver_impedance + body.last_impedance) * rate - met)


ANSWERS = DriverBehind(MachineBehindSlab, MachineBehindLayers)
