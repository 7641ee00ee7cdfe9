"""The wave of a round trip on a mesh: polynomials between its kinks, which events of the cycle leave in it.

What left the contact up to a moment, over one round trip before it, decides with the contact's own state all that follows. Phases
count from the beginning of that round trip.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from stickslip.engine import TERMS, History
from stickslip.foundation.arrays import Floats

NODES = 10
"""Points of Gauss and Legendre on each piece of the mesh (1): none is at a kink, which a disturbance moves."""
_GAUSS_POINTS, _GAUSS_WEIGHTS = np.polynomial.legendre.leggauss(NODES)
MESH_PLACES = 0.5 * (_GAUSS_POINTS + 1.0)
"""The points as places (1) on a piece."""
TERMS_OF_VALUES = (np.arange(NODES) + 0.5)[:, None] * (
    np.polynomial.legendre.legvander(_GAUSS_POINTS, NODES - 1) * _GAUSS_WEIGHTS[:, None]
).T
"""From values at the points to the coefficients of a series of Legendre's polynomials, by the rule of Gauss and Legendre."""
POWERS_OF_TERMS = np.array(
    [[(-1.0) ** (n + k) * math.comb(n, k) * math.comb(n + k, k) for n in range(NODES)] for k in range(NODES)]
)
"""From these to coefficients of powers of the place (1)."""
FADED, MOST_ECHOES = 1e-9, 160
"""A kink is kept until its echo is this share of itself (1), and for no more round trips than this."""
SHORTEST_PIECE, COARSE = 2e-3, 1.0 / 6.0
"""Shortest and longest piece of a mesh before it is divided (1, shares of a round trip)."""
RESOLVED, MOST_PIECES, FINEST = 1e-9, 240, 1e-4
"""Pieces are halved until the last terms are below this share (1) of the wave's extent, up to a number, down to a length (1)."""


@dataclass(frozen=True)
class WaveMesh:
    """Pieces of a round trip, each with the same points."""

    edges: Floats
    """Phases (s) of their ends, from 0 on."""

    @cached_property
    def phases(self) -> Floats:
        """The phases (s) of all points."""
        return np.asarray((self.edges[:-1, None] + np.diff(self.edges)[:, None] * MESH_PLACES).ravel())

    def series(self, values: Floats) -> Floats:
        """Return the polynomials of a wave with these values at the points, one for each piece."""
        found = np.zeros((len(self.edges) - 1, TERMS))
        found[:, :NODES] = values.reshape(-1, NODES) @ TERMS_OF_VALUES.T @ POWERS_OF_TERMS.T
        return found

    def at(self, values: Floats, phases: Floats) -> Floats:
        """Return a wave with these values at the points, at phases (s)."""
        piece = np.clip(np.searchsorted(self.edges, phases, side="right") - 1, 0, len(self.edges) - 2)
        xi = (phases - self.edges[piece]) / (self.edges[piece + 1] - self.edges[piece])
        return np.asarray(np.sum(self.series(values)[piece, :NODES] * xi[:, None] ** np.arange(NODES), axis=1))


@dataclass(frozen=True)
class WaveSource:
    """A wave that left the contact of a run, over the round trip that ends at a time (s)."""

    history: History
    end: float

    def at(self, phases: Floats) -> Floats:
        """Return the wave 2 Z v - load, plus the reference strength (Pa), at phases (s)."""
        begin, history = self.end - self.history.round_trip_time, self.history
        where = history.find(begin + phases, "right")
        return np.asarray(2.0 * history.problem.body.echo_impedance * history.rate(where) - history.excess(where))


def kinks(history: History, end: float, period: float, share: float) -> Floats:
    """Return the phases (s) of kinks of the wave up to a time (s), the sharpest first.

    Each event of the last period leaves one, whose echo is smaller by a `share` (1) after each round trip, in a motion that repeats
    itself after a period (s).
    """
    mode, trip = history.store.mode, history.round_trip_time
    here = 1 + np.flatnonzero(np.diff(mode) != 0)
    changes = np.concatenate([history.start[here], history.end[:-1][history.rests[:-1]]])
    changes = np.unique(changes[(changes > end - period - 1e-9 * trip) & (changes <= end)])
    echoes = min(math.ceil(math.log(FADED) / math.log(share)) if 0.0 < share < 1.0 else 1, MOST_ECHOES)
    times = changes[None, :] + trip * np.arange(echoes + 1)[:, None] - (end - trip)
    shifts = np.arange(math.ceil((trip * echoes + period) / period) + 1)
    found = (times[:, :, None] - period * shifts).reshape(len(times), -1)
    return np.concatenate([row[(row > 0.0) & (row < trip)] for row in found])


def mesh_of(source: WaveSource, sharp: Floats) -> WaveMesh:
    """Return a mesh that resolves a wave with `sharp` kinks at phases (s), the sharpest first."""
    trip = source.history.round_trip_time
    kept = [0.0, trip]
    for one in sharp.tolist():
        if min(abs(one - other) for other in kept) > SHORTEST_PIECE * trip:
            kept.append(one)
    edges = np.sort(np.array(kept))
    parts = np.ceil(np.diff(edges) / (COARSE * trip)).astype(int)
    ends = zip(edges[:-1], edges[1:], parts.tolist(), strict=True)
    divided = [np.linspace(low, high, n, endpoint=False) for low, high, n in ends]
    edges = np.append(np.concatenate(divided), trip)
    while True:
        mesh = WaveMesh(edges)
        values = source.at(mesh.phases).reshape(-1, NODES)
        rough = np.abs(values @ TERMS_OF_VALUES[-2:].T).max(axis=1) > RESOLVED * np.ptp(values)
        rough &= np.diff(edges) > FINEST * trip
        if not rough.any() or len(edges) + rough.sum() > MOST_PIECES:
            return mesh
        edges = np.sort(np.append(edges, 0.5 * (edges[:-1] + edges[1:])[rough]))
