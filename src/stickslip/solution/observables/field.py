"""Displacement, velocity and shear stress anywhere inside a body, and the wave that left its contact in an interval of time.

How the waves of a slab make its field is in `inside_slab`, and those of layers in `inside_layers`.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import cached_property
from typing import get_args

import numpy as np
from numpy.polynomial import chebyshev
from numpy.typing import ArrayLike, NDArray

from stickslip.engine import TERMS, History, Positions, Side
from stickslip.foundation.arrays import Floats
from stickslip.foundation.errors import InputError
from stickslip.problem import Problem
from stickslip.problem.bodies import BodyWithWaves, as_waves
from stickslip.solution.observables.asked import Extent, Field, observables_of
from stickslip.solution.observables.waves import Waves

POINTS_OF_WAVE: Floats = np.asarray(chebyshev.chebpts1(TERMS + 1), float)
"""Sampling points for the wave of a piece. Their number makes the interpolation exact for the polynomials of the history times the
linear derivative of time with respect to xi.
"""
TO_SERIES: Floats = np.asarray(np.linalg.inv(chebyshev.chebvander(POINTS_OF_WAVE, TERMS)), float)
"""Matrix from values at these points to the coefficients of a Chebyshev series; the transformation loses no digits."""


def field(history: History, slip: Callable[[ArrayLike], Floats], x: ArrayLike, t: ArrayLike, side: Side = "right") -> Field:
    """Return displacement, velocity and shear stress inside the slab; for the parameters see `Solution.field`.

    `slip` returns the displacement of the contact (m) at times (s). At a wave front `side` "left" is the limit before the front
    passes, "right" the limit after it; a point within rounding of a front lies on it. Raises InputError for a block, for places
    outside the slab, for times outside the run, and if the waves in the slab left the contact in a leap over creep.
    """
    place, time = np.broadcast_arrays(np.asarray(x, float), np.asarray(t, float))
    history.check_begun(time)
    answers = observables_of(history.problem)
    return answers.field(history, lambda: np.broadcast_to(slip(t), time.shape), place, time, side)


def check_side(side: str) -> None:
    """Raise InputError for what is no side of a front."""
    if side not in get_args(Side):
        raise InputError(f"side must be 'left' or 'right', got {side!r}")


NO_INSIDE = "field: a block is rigid and has no interior field: only a slab or a string has one"


def slab_of(problem: Problem) -> BodyWithWaves:
    """Return the slab or the string of a problem. Raises InputError for a rigid body, and for one of layers."""
    return as_waves(problem.body, NO_INSIDE)


def extent_of(problem: Problem) -> Extent:
    """Return the places inside the body of a problem. Raises InputError for a rigid body."""
    return observables_of(problem).extent(problem)


NOT_KNOWN = "the field is not known here: the waves in the slab left the contact in a leap over creep"


def check_known(history: History, low: float, high: float) -> None:
    """Raise InputError if waves that left the contact between two times (s since the epoch) left it in a leap over creep."""
    trip, trips = history.creep[:, 0], history.creep[:, 1]
    begin, end = (history.seconds(when, np.zeros(len(trip))) for when in (trip, trip + trips))
    slack = rounding(np.append(end, high), history.round_trip_time).max()
    if ((begin < high - slack) & (end > low + slack)).any():
        raise InputError(NOT_KNOWN)


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
        count = len(POINTS_OF_WAVE)
        places = Positions.inside(np.repeat(self._piece, count), np.tile(0.5 + 0.5 * POINTS_OF_WAVE, len(self._piece)))
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
        """Return the part that each time lies in, -1 before the run.

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
        pace = speed + bend * (1.0 + POINTS_OF_WAVE[:, None])
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


def velocity_and_stress(away: Floats, towards: Floats, impedance: Floats | float, stress: Floats | float) -> tuple[Floats, Floats]:
    """Return velocity (m/s) and stress (Pa) where a wave away from the contact, Z v - sigma, meets one towards it, Z v + sigma.

    Both (Pa) are less those of a stress at rest, and this is added.
    """
    return (away + towards) / (2.0 * impedance), stress + 0.5 * (towards - away)


def rounding(time: Floats, round_trip_time: float) -> Floats:
    """Return the possible error (s) of a time that was computed from times and travel times."""
    return np.asarray(4.0 * np.spacing(np.maximum(np.abs(time), round_trip_time)))
