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
from itertools import pairwise

import numpy as np

from stickslip.engine import History, Side
from stickslip.foundation.arrays import Floats
from stickslip.foundation.errors import InputError
from stickslip.solution.observables.asked import AtContact, Field
from stickslip.solution.observables.field import WaveInterval, check_side, rounding, slab_of
from stickslip.solution.observables.waves import Waves

ROUNDS = 8
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
    batch = np.floor(moment / (ROUNDS * waves.round))
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
        steps = self.waves.driver.steps
        meets = [self.interval.first + start - self.waves.half for start, _ in steps[1:]]
        edges = [-math.inf, *meets, math.inf]
        within = [(np.clip(low, begin, end), np.clip(high, begin, end)) for begin, end in pairwise(edges)]
        return np.asarray(sum(share * self._left(*one) for (_, share), one in zip(steps, within, strict=True)))

    def _left(self, low: Floats, high: Floats) -> Floats:
        """Return the integral between two times of the wave that leaves the contact plus the reference, Pa s."""
        return self.interval.total(high) - self.interval.total(low)
