"""The wave of a round trip on a mesh: polynomials between its kinks, which events of the cycle leave in it.

What left the contact up to a moment, over one round trip before it, decides with the contact's own state all that follows. Phases
count from the beginning of that round trip. A body of layers has a wave in each cell (`waves.layers`): their values stand one cell
after the other.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from stickslip.engine import TERMS, History, Positions
from stickslip.foundation.arrays import Floats
from stickslip.problem.bodies import as_waves

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
SHORTEST_PIECE, COARSE = 1e-5, 1.0 / 6.0
"""Shortest and longest piece of a mesh before it is divided (1, shares of a round trip)."""
RESOLVED, MOST_PIECES, FINEST = 1e-9, 240, 1e-4
"""Pieces are halved until the last terms are below this share (1) of the wave's extent, up to a number, down to a length (1)."""
BESIDE = np.sort(np.append(ONE_END := 10.0 ** np.arange(-4.0, 0.0, 0.25), 1.0 - ONE_END))
"""Places (1) on a piece of the mesh, most of them near its ends, where a wave is compared with the mesh."""
SEEN_BESIDE = 1e-5
"""Pieces are halved, too, where the wave is off by more than this share (1) of its extent there: points may not see a front."""


@dataclass(frozen=True)
class WaveMesh:
    """Pieces of a round trip, each with the same points."""

    edges: Floats
    """Phases (s) of their ends, from 0 on."""
    resolved: float = RESOLVED
    """The share (1) of the wave's extent to which it is resolved."""

    @property
    def is_fine(self) -> bool:
        """True if it resolves a wave as well as meshes do."""
        return self.resolved <= RESOLVED

    @cached_property
    def phases(self) -> Floats:
        """The phases (s) of all points."""
        return np.asarray((self.edges[:-1, None] + np.diff(self.edges)[:, None] * MESH_PLACES).ravel())

    @cached_property
    def beside(self) -> Floats:
        """Phases (s) of places in all pieces that are no points."""
        return np.asarray((self.edges[:-1, None] + np.diff(self.edges)[:, None] * BESIDE).ravel())

    def series(self, values: Floats) -> Floats:
        """Return the polynomials of a wave with these values at the points, one for each piece; of several waves for each cell."""
        pieces = len(self.edges) - 1
        found = np.zeros((len(values) // NODES, TERMS))
        found[:, :NODES] = values.reshape(-1, NODES) @ TERMS_OF_VALUES.T @ POWERS_OF_TERMS.T
        return found if len(found) == pieces else np.ascontiguousarray(found.reshape(-1, pieces, TERMS).swapaxes(0, 1))

    def at(self, values: Floats, phases: Floats) -> Floats:
        """Return a wave with these values at the points, at phases (s)."""
        piece, powers = self._found(phases)
        terms = self.series(values)[piece].reshape(len(phases), -1, TERMS)[..., :NODES]
        return np.asarray(np.einsum("pck,pk->cp", terms, powers).ravel())

    def matrix_at(self, phases: Floats) -> Floats:
        """Return the matrix that makes values at phases (s) of those at the points."""
        piece, powers = self._found(phases)
        found = np.zeros((len(phases), len(self.phases)))
        np.put_along_axis(found, piece[:, None] * NODES + np.arange(NODES), powers @ POWERS_OF_TERMS @ TERMS_OF_VALUES, axis=1)
        return found

    def _found(self, phases: Floats) -> tuple[NDArray[np.intp], Floats]:
        """Return the pieces that hold phases (s), and the powers of the places (1) there."""
        piece = np.clip(np.searchsorted(self.edges, phases, side="right") - 1, 0, len(self.edges) - 2)
        xi = (phases - self.edges[piece]) / (self.edges[piece + 1] - self.edges[piece])
        return piece, np.vander(xi, NODES, increasing=True)


@dataclass(frozen=True)
class WaveSource:
    """A wave that left the contact of a run, over the round trip that ends at a time (s)."""

    history: History
    end: float
    is_one_wave: ClassVar[bool] = True
    """True if this wave, with what moves the contact, is all that decides what follows."""

    def at(self, phases: Floats) -> Floats:
        """Return the wave 2 Z v - load, plus the reference strength (Pa), at phases (s)."""
        begin, history = self.end - self.history.round_trip_time, self.history
        where = history.find(begin + phases, "right")
        return np.asarray(2.0 * history.problem.body.echo_impedance * history.rate(where) - history.excess(where))

    def kinks(self, period: float) -> Floats:
        """Return the phases (s) of its kinks, the sharpest first, in a motion that repeats itself after a period (s)."""
        return kinks(self.history, self.end, period, abs(as_waves(self.history.problem.body).front_reflection))

    def sharp_factor(self, begin: float) -> float:
        """Return what a disturbance that lasts an instant is multiplied by (1) on its ways from a time (s) to the end, in the mean.

        Each way multiplies it by r (1 - 2 Z / g'), where g' = D + S dmu/dv is how the contact resists at once: mass or rest resist
        whole.
        """
        history, end = self.history, self.end
        problem, trip = history.problem, history.round_trip_time
        body, law = as_waves(problem.body), problem.friction
        back = (end - begin) / trip * math.log(max(abs(body.front_reflection), 1e-300))
        if body.has_inertia:
            return math.exp(back)
        first, last = np.searchsorted(history.start, [begin, end])
        here = np.arange(first, last)
        here = here[history.store.mode[here] != 0]
        piece, xi = np.repeat(here, 5), np.tile(np.linspace(0.1, 0.9, 5), len(here))
        at = Positions.inside(piece, xi)
        by_rate = law.slopes(0.0, np.abs(history.rate(at)), history.state(at))[1]
        lasts = np.repeat((history.end - history.start)[here] / 5.0, 5)
        answer = np.abs(1.0 - 2.0 * body.echo_impedance / (body.total_damping + problem.normal * by_rate))
        return math.exp(back + float(np.sum(lasts * np.log(np.maximum(answer, 1e-300)))) / trip)

    def pace_at(self, phases: Floats) -> Floats:
        """Return how fast the wave changes (Pa/s) at phases (s)."""
        history = self.history
        where, store = history.find(self.end - history.round_trip_time + phases, "right"), history.store
        series = 2.0 * history.problem.body.echo_impedance * store.rate[where.piece] - store.load[where.piece]
        slopes = np.sum(series[:, 1:] * np.arange(1, TERMS) * where.xi[:, None] ** np.arange(TERMS - 1), axis=1)
        lasts = store.speed[where.piece] + 2.0 * store.bend[where.piece] * where.xi
        return np.asarray(slopes / lasts * (-as_waves(history.problem.body).front_reflection) ** where.leaped)


def changes_in(history: History, end: float, period: float) -> Floats:
    """Return the times (s) of events in the period up to an end (s) that leave kinks in waves: onsets, arrests, ends of rests."""
    mode, trip = history.store.mode, history.round_trip_time
    here = 1 + np.flatnonzero(np.diff(mode) != 0)
    changes = np.concatenate([history.start[here], history.end[:-1][history.rests[:-1]]])
    return np.unique(changes[(changes > end - period - 1e-9 * trip) & (changes <= end)])


def kinks(history: History, end: float, period: float, share: float) -> Floats:
    """Return the phases (s) of kinks of the wave up to a time (s), the sharpest first.

    Each event of the last period leaves one, whose echo is smaller by a `share` (1) after each round trip, in a motion that repeats
    itself after a period (s).
    """
    changes, trip = changes_in(history, end, period), history.round_trip_time
    echoes = min(math.ceil(math.log(FADED) / math.log(share)) if 0.0 < share < 1.0 else 1, MOST_ECHOES)
    times = changes[None, :] + trip * np.arange(echoes + 1)[:, None] - (end - trip)
    shifts = np.arange(math.ceil((trip * echoes + period) / period) + 1)
    found = (times[:, :, None] - period * shifts).reshape(len(times), -1)
    return np.concatenate([row[(row > 0.0) & (row < trip)] for row in found])


def mesh_of(source: WaveSource, sharp: Floats, resolved: float = RESOLVED) -> WaveMesh:
    """Return a mesh that resolves a wave with `sharp` kinks at phases (s), the sharpest first, to a share (1) of its extent."""
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
        mesh = WaveMesh(edges, resolved)
        values = source.at(mesh.phases).reshape(-1, len(edges) - 1, NODES)
        rough = np.abs(values @ TERMS_OF_VALUES[-2:].T).max(axis=(0, 2)) > resolved * np.ptp(values)
        rough &= np.diff(edges) > FINEST * trip
        if not rough.any():
            off = np.abs(source.at(mesh.beside) - mesh.at(values.ravel(), mesh.beside)).reshape(-1, len(edges) - 1, len(BESIDE))
            rough = off.max(axis=(0, 2)) > max(SEEN_BESIDE, resolved) * np.ptp(values)
            rough &= np.diff(edges) > FINEST * trip
        if not rough.any() or len(edges) + rough.sum() > MOST_PIECES:
            return mesh
        edges = np.sort(np.append(edges, 0.5 * (edges[:-1] + edges[1:])[rough]))
