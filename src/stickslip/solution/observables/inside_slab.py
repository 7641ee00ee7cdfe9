"""Exact displacement, velocity and shear stress anywhere inside the slab, from the waves that its contact sent and received.

Two waves travel in the slab (d'Alembert): with x = 0 at the contact and x = h at the driver,

    Z v(x, t) + sigma(x, t) = beta(t + x/c)      towards the contact
    Z v(x, t) - sigma(x, t) = w(t - x/c)         away from it, w = 2 Z v(0, t) - beta(t)
    u(x, t) = u(0, t) + [integral of beta over (t, t + x/c) - integral of w over (t - x/c, t)] / (2 Z)

There is no grid. The load beta that is still on its way is an earlier w, reflected by the driver, plus what the driver adds. So
the present field follows from the past alone, and does not change when a run is made longer.

The kinetic energy needs both waves at the same place, Z v = (A + B) / 2: A is the beta that is on its way to the contact, B the w
that is on its way to the driver. Between the ends of pieces of either wave, both are smooth functions of the travel time from the
contact, except for a square root at a fold. With s^2 (3 - 2 s) for the place in such an interval they are smooth functions of s up
to its ends.
"""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np

from stickslip.engine import Epoch, History, Positions, Side
from stickslip.foundation.arrays import Floats
from stickslip.foundation.errors import InputError
from stickslip.solution.observables.asked import AtContact, Field
from stickslip.solution.observables.field import WaveInterval, check_side, rounding, slab_of, velocity_and_stress
from stickslip.solution.observables.quadrature import CURVED_NODES, CURVED_WEIGHTS
from stickslip.solution.observables.waves import Waves

ROUND_TRIPS_TOGETHER = 8
"""Round trips that are evaluated together."""


def field_of_slab(history: History, contact: AtContact, place: Floats, time: Floats, side: Side) -> Field:
    """Return the field in a uniform body at places (m) and times (s) of one shape, from the displacement of the contact.

    Raises InputError for places outside the body, and for what is no side.
    """
    body = slab_of(history.problem)
    if not np.all((place >= 0.0) & (place <= body.distance)):
        raise InputError(f"field: x must lie between 0 (the contact) and {body.distance:g} m (the driver)")
    check_side(side)
    at_contact = contact()  # raises InputError for times outside the run
    waves, away, moment = Waves(history, body), place.ravel() / body.wave_speed, time.ravel()
    rise, velocity, stress = np.empty((3, moment.size))
    batch = np.floor(moment / (ROUND_TRIPS_TOGETHER * waves.round))
    for number in np.unique(batch):
        chosen = batch == number
        rise[chosen], velocity[chosen], stress[chosen] = _InsideOfSlab(waves, moment[chosen]).field(away[chosen], side)
    displacement = at_contact.ravel() + rise
    if (ground := history.problem.ground) is not None:
        begun = waves.begun(history.epoch)
        displacement += ground.displacement_at(begun + moment) - ground.displacement_at(begun)
    return Field(*(np.reshape(values, place.shape) for values in (displacement, velocity, stress)))


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
        return rise / (2.0 * impedance), *velocity_and_stress(leaving, load, impedance, reference)

    def _coming(self, away: Floats, side: Side) -> Floats:
        """Return the load minus the reference (Pa) that reaches the contact after the time `away` (s).

        It comes from the initial state, or was sent back by the driver.
        """
        waves, half = self.waves, self.waves.half
        since = self.time - self.interval.first + away
        slack = rounding(since, half) * (1.0 if side == "left" else -1.0)  # moves a time to the side that is seen
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
        """Return the integral of the driver's echo of the waves that leave the contact between times, Pa s."""
        steps = self.waves.driver.steps
        meets = [self.interval.first + start - self.waves.half for start, _ in steps[1:]]
        edges = [-math.inf, *meets, math.inf]
        within = [(np.clip(low, begin, end), np.clip(high, begin, end)) for begin, end in pairwise(edges)]
        return np.asarray(sum(share * self._left(*one) for (_, share), one in zip(steps, within, strict=True)))

    def _left(self, low: Floats, high: Floats) -> Floats:
        """Return the integral between two times of the wave that leaves the contact plus the reference, Pa s."""
        return self.interval.total(high) - self.interval.total(low)


# ---- kinetic energy --------------------------------------------------------------------------------------------------------------


def kinetic(waves: Waves, now: Epoch) -> float:
    """Return the kinetic energy of the slab at a moment, J/m^2, without a contact mass.

    Raises InputError if the waves inside are not known: in a leap over creep, and within a round trip after it.
    """
    return _BothWaves(waves, now).kinetic()


class _BothWaves:
    """The two waves in the slab at a moment. Times are in s since then, places are travel times (s) from the contact."""

    def __init__(self, waves: Waves, now: Epoch) -> None:
        self.waves, self.begun = waves, waves.begun(now)
        low = max(-waves.round, -self.begun)
        trips = range(max(now.trip + int((now.offset + low) // waves.round), 0), now.trip + 1)
        standing = [waves.standing(trip) for trip in trips]
        piece, begin, end = (np.concatenate(parts) for parts in zip(*standing, strict=True))
        trip = np.repeat(trips, [len(pieces) for pieces, _, _ in standing])
        start, store = (trip - now.trip) * waves.round - now.offset, waves.history.store
        inside = (start + end > low) & (start + begin < 0.0)
        self.piece, self.start = piece[inside], (start + begin)[inside]
        self.origin, self.leaped = (start + store.phase_from[piece])[inside], (trip - store.trip[piece]).astype(float)[inside]

    def kinetic(self) -> float:
        """Return the kinetic energy, J/m^2."""
        half = self.waves.half
        comes = self.waves.inflow.edges(self.begun, self.begun + half) - self.begun
        fronts = np.concatenate([-self.start, self.start + self.waves.round, [self.begun, half - self.begun], comes])
        edges = np.unique(np.concatenate([[0.0, half], fronts[(fronts > 0.0) & (fronts < half)]]))
        lengths = np.diff(edges)[:, None]
        away = edges[:-1, None] + lengths * CURVED_NODES
        both = self._coming(away.ravel()) + self._left(-away.ravel())
        return float((both.reshape(away.shape) ** 2 * CURVED_WEIGHTS * lengths).sum()) / (8.0 * self.waves.body.impedance)

    def _left(self, time: Floats) -> Floats:
        """Return w plus the reference (Pa) that left the contact at these times."""
        found = self.waves.left_before(self.begun + time)
        known = np.flatnonzero(time > -self.begun) if len(self.start) else np.empty(0, np.intp)
        which = np.maximum(np.searchsorted(self.start, time[known], side="right") - 1, 0)
        piece = self.piece[which]
        xi = self.waves.history.xi(piece, np.maximum(time[known] - self.origin[which], 0.0))
        at = Positions(piece, xi, self.leaped[which], np.zeros(len(piece), bool), piece)
        found[known] = self.waves.leaving(at)
        return found

    def _coming(self, away: Floats) -> Floats:
        """Return the load minus the reference (Pa) that reaches the contact after the time `away` (s)."""
        since, left = self.begun + away, away - self.waves.round
        return np.where(
            since < self.waves.half, self.waves.first_load(since), self.waves.arriving(self._left(left), self.begun + left)
        )
