"""Exact displacement, velocity and shear stress anywhere inside the slab, from the waves that its contact sent and received.

Two waves travel in the slab (d'Alembert): with x = 0 at the contact and x = h at the driver,

    Z v(x, t) + sigma(x, t) = beta(t + x/c)      towards the contact
    Z v(x, t) - sigma(x, t) = w(t - x/c)         away from it, w = 2 Z v(0, t) - beta(t)
    u(x, t) = u(0, t) + [integral of beta over (t, t + x/c) - integral of w over (t - x/c, t)] / (2 Z)

There is no grid. The load beta that is still on its way is an earlier w, reflected by the driver, plus what the driver adds. So
the present field follows from the past alone, and does not change when a run is made longer.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from functools import cached_property
from itertools import pairwise
from typing import NamedTuple, get_args

import numpy as np
from numpy.polynomial import chebyshev
from numpy.typing import ArrayLike, NDArray

from stickslip.engine import TERMS, History, Positions, Side
from stickslip.foundation.arrays import Floats
from stickslip.foundation.errors import InputError
from stickslip.problem import Problem
from stickslip.problem.bodies import BodyWithWaves, OfLayers, as_waves
from stickslip.solution.observables.inside_layers import field_of_layers
from stickslip.solution.observables.waves import Waves

ROUNDS = 8
"""Round trips that are evaluated together."""
POINTS: Floats = np.asarray(chebyshev.chebpts1(TERMS + 1), float)
"""Sampling points for the wave of a piece. Their number makes the interpolation exact for the polynomials of the history times the
linear derivative of time with respect to xi.
"""
TO_SERIES: Floats = np.asarray(np.linalg.inv(chebyshev.chebvander(POINTS, TERMS)), float)
"""Matrix from values at these points to the coefficients of a Chebyshev series; the transformation loses no digits."""


class Field(NamedTuple):
    """Displacement, velocity and stress in a slab at given places and times: arrays of the same shape."""

    displacement: Floats
    """Displacement u, m: absolute, as the slip is where the ground does not move; in a window, relative to the contact at the start
    of the event. It includes that of moving ground, as velocity does."""
    velocity: Floats
    """Velocity v, m/s."""
    stress: Floats
    """Shear stress sigma, Pa: positive if it pulls the contact forwards."""


def field(history: History, slip: Callable[[ArrayLike], Floats], x: ArrayLike, t: ArrayLike, side: Side = "right") -> Field:
    """Return displacement, velocity and shear stress inside the slab; for the parameters see `Solution.field`.

    `slip` returns the displacement of the contact (m) at times (s). At a wave front `side` "left" is the limit before the front
    passes, "right" the limit after it; a point within rounding of a front lies on it. Raises InputError for a block, for places
    outside the slab, for times outside the run, and if the waves in the slab left the contact in a leap over creep.
    """
    place, time = np.broadcast_arrays(np.asarray(x, float), np.asarray(t, float))
    if isinstance(layers := history.problem.body, OfLayers):
        at_contact = np.broadcast_to(slip(t), time.shape)
        if (ground := history.problem.ground) is not None:
            begun = history.epoch.trip * layers.round_trip_time + history.epoch.offset
            at_contact = at_contact + ground.displacement_at(begun + time) - ground.displacement_at(begun)
        check_side(side)
        inside = field_of_layers(history, layers, at_contact.ravel(), x=place.ravel(), t=time.ravel(), side=side)
        return Field(*(np.reshape(values, place.shape) for values in inside))
    body = slab_of(history.problem)
    if not np.all((place >= 0.0) & (place <= body.distance)):
        raise InputError(f"field: x must lie between 0 (the contact) and {body.distance:g} m (the driver)")
    check_side(side)
    at_contact = np.broadcast_to(slip(t), time.shape)  # raises InputError for times outside the run
    waves, away, moment = Waves(history, body), place.ravel() / body.wave_speed, time.ravel()
    rise, velocity, stress = np.empty((3, moment.size))
    batch = np.floor(moment / (ROUNDS * waves.round))
    for number in np.unique(batch):
        chosen = batch == number
        rise[chosen], velocity[chosen], stress[chosen] = _InsideOfSlab(waves, moment[chosen]).field(away[chosen], side)
    displacement = at_contact.ravel() + rise
    if (ground := history.problem.ground) is not None:
        begun = waves.begun(history.epoch)
        displacement += ground.displacement_at(begun + moment) - ground.displacement_at(begun)
    return Field(*(np.reshape(values, place.shape) for values in (displacement, velocity, stress)))


def check_side(side: str) -> None:
    """Raise InputError for what is no side of a front."""
    if side not in get_args(Side):
        raise InputError(f"side must be 'left' or 'right', got {side!r}")


NO_INSIDE = "field: a block is rigid and has no interior field: only a slab or a string has one"


def slab_of(problem: Problem) -> BodyWithWaves:
    """Return the slab or the string of a problem. Raises InputError for a rigid body, and for one of layers."""
    return as_waves(problem.body, NO_INSIDE)


class Extent(NamedTuple):
    """The places (m) inside a body with waves, from that of one driver to that of the other; the contact is at 0."""

    lowest: float
    """0 if there is one side."""
    highest: float
    boundaries: tuple[float, ...]
    """Where layers meet."""
    two_way_time: float
    """The longest two-way travel time to a driver (s)."""


def extent_of(problem: Problem) -> Extent:
    """Return the places inside the body of a problem. Raises InputError for a rigid body."""
    body = problem.body
    if not isinstance(body, OfLayers):
        slab = slab_of(problem)
        return Extent(0.0, slab.distance, (), slab.two_way_time)
    depths = [np.cumsum(one.thickness).tolist() for one in body.stacks]
    lowest = -depths[1][-1] if len(depths) > 1 else 0.0
    below = tuple(-one for one in depths[1][:-1]) if len(depths) > 1 else ()
    return Extent(lowest, depths[0][-1], (*below, *depths[0][:-1]), body.two_way_time)


class _InsideOfSlab:
    """The slab at several times (s since the epoch), evaluated from one interval of its past."""

    def __init__(self, waves: Waves, time: Floats) -> None:
        self.waves, self.time = waves, time
        beside = 2.0 * float(rounding(time, waves.round).max())  # so that both limits at its ends are inside the interval
        self.interval = WaveInterval(waves, float(time.min()) - waves.round - beside, float(time.max()) + beside)

    def field(self, away: Floats, side: Side) -> tuple[Floats, Floats, Floats]:
        """Return displacement relative to the contact, velocity and stress at travel times `away` (s) from the contact."""
        impedance, reference = self.waves.body.impedance, self.waves.reference
        load, leaving = self._coming(away, side), self.interval.leaving(self.time - away, side)
        rise = 2.0 * reference * away + self._load_coming(away) - self._left(self.time - away, self.time)
        return rise / (2.0 * impedance), (load + leaving) / (2.0 * impedance), reference + 0.5 * (load - leaving)

    def _coming(self, away: Floats, side: Side) -> Floats:
        """Return the load minus the reference (Pa) that reaches the contact after the time `away` (s).

        It comes from the initial state, or was sent back by the driver.
        """
        waves, half = self.waves, self.waves.half
        since = self.time - self.interval.first + away
        slack = rounding(since, half) * (1.0 if side == "left" else -1.0)  # by which a time is moved to the side that is seen
        left = self.time - (waves.round - away)  # when the wave left the contact
        sent_back = waves.arriving(self.interval.leaving(left, side), left - self.interval.first, slack)
        return np.where(since < half + slack, waves.first_load(since), sent_back)

    def _load_coming(self, away: Floats) -> Floats:
        """Return the integral of that load over the time until then, Pa s."""
        waves, first = self.waves, self.interval.first
        since = np.minimum(self.time - first, waves.half)
        until = np.minimum(self.time - first + away, waves.half)
        of_start = (until - since) * (waves.excess + 0.5 * waves.slope * (since + until))
        low, high = (np.maximum(time, first + waves.half) - waves.round for time in (self.time, self.time + away))
        inflow = waves.inflow.total(low + waves.round - first, high + waves.round - first)
        return np.asarray(of_start + self._sent_back(low, high) + inflow)

    def _sent_back(self, low: Floats, high: Floats) -> Floats:
        """Return the integral of what the driver sends back of the waves that leave the contact between times, Pa s."""
        waves, steps = self.waves, self.waves.history.problem.driver_steps
        if not waves.changes:
            return np.asarray(waves.share * self._left(low, high))
        meets = [self.interval.first + start - waves.half for start, _ in steps[1:]]
        edges = [-math.inf, *meets, math.inf]
        within = [(np.clip(low, begin, end), np.clip(high, begin, end)) for begin, end in pairwise(edges)]
        return np.asarray(sum(share * self._left(*one) for (_, share), one in zip(steps, within, strict=True)))

    def _left(self, low: Floats, high: Floats) -> Floats:
        """Return the integral between two times of the wave that leaves the contact plus the reference, Pa s."""
        return self.interval.total(high) - self.interval.total(low)


NOT_KNOWN = "the field is not known here: the waves in the slab left the contact in a leap over creep"


def check_known(history: History, low: float, high: float) -> None:
    """Raise InputError if waves that left the contact between two times (s since the epoch) left it in a leap over creep."""
    trip, trips = history.creep[:, 0], history.creep[:, 1]
    begin, end = (history.seconds(when, np.zeros(len(trip))) for when in (trip, trip + trips))
    slack = rounding(np.append(end, high), history.round_trip_time).max()
    if ((begin < high - slack) & (end > low + slack)).any():
        raise InputError(NOT_KNOWN)


def many_places(history: History, low: float, high: float) -> float:
    """Return how often, at most, another piece may begin to hold between two times (s): see `WaveInterval`."""
    pieces = int(np.searchsorted(history.start, high, side="right"))
    return (1.0 + 2.0 * pieces) * (2.0 + (high - low) / history.round_trip_time)


class WaveInterval:
    """The wave that left the contact between two times (s since the epoch): w = 2 Z v - beta, plus the reference strength.

    The pieces of the history that hold in the interval are looked up once, including those whose echoes arrive in rests that were
    leaped over; then any number of moments is evaluated together. Before the run the wave follows from the initial state, linear in
    time.
    """

    def __init__(self, waves: Waves, low: float, high: float) -> None:
        self.waves, self.history = waves, waves.history
        self.first, last = self.history.span
        self.high = min(max(high, self.first), last)
        low = min(max(low, self.first), self.high)
        check_known(self.history, low, self.high)
        breaks = np.append(low, self._candidates(low, self.high))
        middle = 0.5 * (breaks + np.append(breaks[1:], self.high))
        at = self.history.find(middle, "right")
        another = np.append(True, (np.diff(at.piece) != 0) | (np.diff(at.leaped) != 0.0))
        if any(self.history.is_averaged(trip) for trip in np.unique(self.history.store.trip[at.piece])):
            raise InputError(NOT_KNOWN)
        self.start: Floats = breaks[another]
        """Times (s) when another piece of the history begins to hold, or the same one a number of whole round trips later."""
        self._piece, leaped = at.piece[another], at.leaped[another]
        store = self.history.store
        self._origin = self.history.seconds(store.trip[self._piece] + leaped, store.phase_from[self._piece])
        count = len(POINTS)
        places = Positions.inside(np.repeat(self._piece, count), np.tile(0.5 + 0.5 * POINTS, len(self._piece)))
        self._values = waves.leaving(replace(places, leaped=np.repeat(leaped, count))).reshape(-1, count).T
        self._wave = TO_SERIES @ self._values

    def _candidates(self, low: float, high: float) -> Floats:
        """Return the times inside when another piece may begin to hold: phases of all pieces so far, in every round trip."""
        history, store = self.history, self.history.store
        known = max(int(np.searchsorted(history.start, high, side="right")), 1)
        phases = np.unique(np.concatenate([[0.0], store.phase_from[:known], store.phase_to[:known]]))
        epoch = history.epoch
        first, last = (epoch.trip + int((time + epoch.offset) // history.round_trip_time) for time in (low, high))
        times = np.concatenate([history.seconds(np.full(len(phases), trip), phases) for trip in range(first, last + 1)])
        return np.unique(times[(times > low) & (times < high)])

    def leaving(self, time: Floats, side: Side) -> Floats:
        """Return w plus the reference (Pa) at times (s) in the interval."""
        part = self._part(time, side)
        inside = np.maximum(part, 0)
        start = self.waves.left_before(time - self.first)
        return np.where(part < 0, start, _series(self._wave, inside, self._xi(time, inside)))

    def total(self, time: Floats) -> Floats:
        """Return the integral of w plus the reference up to times (s) in the interval, Pa s.

        It begins at the start of the interval, or at the start of the run if that is later.
        """
        part = np.maximum(self._part(time, "right"), 0)
        before = np.minimum(time - self.first, 0.0)
        start = -before * (0.5 * self.waves.slope * before + self.waves.before)
        return np.where(before < 0.0, start, self._sums[part] + _series(self._integral, part, self._xi(time, part)))

    def _part(self, time: Floats, side: Side) -> NDArray[np.intp]:
        """Return the part in which each time lies, -1 before the run.

        Times within rounding of a break lie on it, and `side` picks the part.
        """
        slack = rounding(time, self.history.round_trip_time)
        if side == "right":
            return np.searchsorted(self.start, time + slack, side="right") - 1
        return np.searchsorted(self.start, time - slack, side="left") - 1

    def _xi(self, time: Floats, part: NDArray[np.intp]) -> Floats:
        return self.history.xi(self._piece[part], time - self._origin[part])

    @cached_property
    def _integral(self) -> Floats:
        """The Chebyshev series of the wave's integral in time from the start of each piece.

        The integral is taken in xi: dtheta = (speed + 2 bend xi) dxi.
        """
        speed, bend = (column[self._piece] for column in (self.history.store.speed, self.history.store.bend))
        pace = speed + bend * (1.0 + POINTS[:, None])
        return np.asarray(chebyshev.chebint(TO_SERIES @ (pace * self._values), scl=0.5, lbnd=-1.0, axis=0))

    @cached_property
    def _sums(self) -> Floats:
        """Constants, one for each part, that make those integrals count from the start of the interval.

        Each is the integral up to the start of the part, minus the value of the part's own series there.
        """
        parts = np.arange(len(self.start))
        begin, end = (
            _series(self._integral, parts, self._xi(time, parts)) for time in (self.start, np.append(self.start[1:], self.high))
        )
        return np.append(0.0, np.cumsum(end - begin)[:-1]) - begin


def _series(coefficients: Floats, part: NDArray[np.intp], xi: Floats) -> Floats:
    """Evaluate the Chebyshev series of the parts (one per column) at xi."""
    return np.asarray(chebyshev.chebval(2.0 * xi - 1.0, coefficients[:, part], tensor=False))


def rounding(time: Floats, round_trip_time: float) -> Floats:
    """Return the possible error (s) of a time that was computed from times and travel times."""
    return np.asarray(4.0 * np.spacing(np.maximum(np.abs(time), round_trip_time)))
