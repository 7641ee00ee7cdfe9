"""Exact displacement, velocity and shear stress anywhere inside the slab, from the waves that its contact sent and received.

Two waves travel in the slab (d'Alembert): with x = 0 at the contact and x = h at the driver,

    Z v(x, t) + sigma(x, t) = beta(t + x/c)      towards the contact
    Z v(x, t) - sigma(x, t) = w(t - x/c)         away from it, w = 2 Z v(0, t) - beta(t)
    u(x, t) = u(0, t) + [integral of beta over (t, t + x/c) - integral of w over (t - x/c, t)] / (2 Z)

There is no grid. The load beta that is still on its way is an earlier w, reflected by the driver, plus what the driver adds. So
the present field follows from the past alone, and does not change when a run is made longer.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple, get_args

import numpy as np
from numpy.typing import ArrayLike

from stickslip.bodies import ElasticSlab, as_slab
from stickslip.foundation.errors import InputError
from stickslip.observables.wave_interval import WaveInterval, rounding
from stickslip.observables.waves import Waves
from stickslip.problem.problem import Problem
from stickslip.trajectory.history import Floats, History, Side

ROUNDS = 8
"""Round trips that are evaluated together."""


class Field(NamedTuple):
    """Displacement, velocity and stress in a slab at given places and times: arrays of the same shape."""

    displacement: Floats
    """Displacement u, m: absolute, as the slip is; in a window, relative to the contact at the start of the event."""
    velocity: Floats
    """Velocity v, m/s."""
    stress: Floats
    """Shear stress sigma, Pa: positive if it pulls the contact forwards."""


def field(history: History, slip: Callable[[ArrayLike], Floats], x: ArrayLike, t: ArrayLike, side: Side = "right") -> Field:
    """Return displacement, velocity and shear stress inside the slab; for the parameters see `Solution.field`.

    `slip` returns the displacement of the contact (m) at times (s). At a wave front `side` "left" is the limit before the front
    passes, "right" the one after it; a point within rounding of a front lies on it. Raises InputError for a block, for places
    outside the slab, for times outside the run, and if the waves in the slab left the contact in a leap over creep.
    """
    body = slab_of(history.problem)
    place, time = np.broadcast_arrays(np.asarray(x, float), np.asarray(t, float))
    if not np.all((place >= 0.0) & (place <= body.thickness)):
        raise InputError(f"field: x must lie between 0 (the contact) and the thickness, {body.thickness:g} m (the driver)")
    if side not in get_args(Side):
        raise InputError(f"side must be 'left' or 'right', got {side!r}")
    at_contact = np.broadcast_to(slip(t), time.shape)  # raises InputError for times outside the run
    waves, away, moment = Waves(history, body), place.ravel() / body.wave_speed, time.ravel()
    rise, velocity, stress = np.empty((3, moment.size))
    batch = np.floor(moment / (ROUNDS * waves.round))
    for number in np.unique(batch):
        chosen = batch == number
        rise[chosen], velocity[chosen], stress[chosen] = _Inside(waves, moment[chosen]).field(away[chosen], side)
    return Field(*(np.reshape(values, place.shape) for values in (at_contact.ravel() + rise, velocity, stress)))


def slab_of(problem: Problem) -> ElasticSlab:
    """Return the slab of a problem. Raises InputError for a block."""
    return as_slab(problem.body, "field: a block is rigid and has no interior field: only an ElasticSlab has a field")


class _Inside:
    """The slab at several times (s since the epoch), evaluated from one interval of its past."""

    def __init__(self, waves: Waves, time: Floats) -> None:
        self.waves, self.time = waves, time
        self.interval = WaveInterval(waves, float(time.min()) - waves.round, float(time.max()))

    def field(self, away: Floats, side: Side) -> tuple[Floats, Floats, Floats]:
        """Return displacement minus that of the contact, velocity and stress at travel times `away` (s) from the contact."""
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
        slack = rounding(since, half) * (1.0 if side == "left" else -1.0)
        left = self.time - (waves.round - away)  # when the wave left the contact
        sent_back = waves.arriving(self.interval.leaving(left, side), left - self.interval.first)
        return np.where(since < half + slack, waves.first_load(since), sent_back)

    def _load_coming(self, away: Floats) -> Floats:
        """Return the integral of that load over the time until then, Pa s."""
        waves, first = self.waves, self.interval.first
        since = np.minimum(self.time - first, waves.half)
        until = np.minimum(self.time - first + away, waves.half)
        of_start = (until - since) * (waves.excess + 0.5 * waves.slope * (since + until))
        low, high = (np.maximum(time, first + waves.half) - waves.round for time in (self.time, self.time + away))
        inflow = waves.inflow.total(low + waves.round - first, high + waves.round - first)
        return np.asarray(of_start + waves.body.reflection * self._left(low, high) + inflow)

    def _left(self, low: Floats, high: Floats) -> Floats:
        """Return the integral between two times of the wave that leaves the contact plus the reference, Pa s."""
        return self.interval.total(high) - self.interval.total(low)
