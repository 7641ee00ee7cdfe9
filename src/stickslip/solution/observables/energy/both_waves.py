"""Kinetic energy of a slab, for which both of its waves are needed at the same place.

There Z v = (A + B) / 2: A is the beta that is on its way to the contact, B the w that is on its way to the driver. Between the ends
of pieces of either wave, both are smooth functions of the travel time from the contact, except for a square root at a fold. With
s^2 (3 - 2 s) for the place in such an interval they are smooth functions of s up to its ends.
"""

from __future__ import annotations

import numpy as np

from stickslip.engine import Epoch, Positions
from stickslip.foundation.arrays import Floats
from stickslip.solution.observables.quadrature import NODES, WEIGHTS
from stickslip.solution.observables.waves import Waves

CURVED_PLACES = NODES**2 * (3.0 - 2.0 * NODES)
"""Places of the quadrature in an interval of length 1: s^2 (3 - 2 s) at the nodes s of the Gauss-Legendre rule."""
SHARES = 6.0 * NODES * (1.0 - NODES) * WEIGHTS
"""Weights of these places: the derivative of s^2 (3 - 2 s) times the weights of the rule."""


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
        away = edges[:-1, None] + lengths * CURVED_PLACES
        both = self._coming(away.ravel()) + self._left(-away.ravel())
        return float((both.reshape(away.shape) ** 2 * SHARES * lengths).sum()) / (8.0 * self.waves.body.impedance)

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
