"""The waves inside the slab, as the contact sent and received them: what its stored energy and the driver's work are made of.

Everything is written with what leaves the contact, w = 2 Z v - beta, plus the reference strength: small where the slab is near
its strength. The load that arrives one round trip later is r w + inflow, so the past alone says what the slab holds now.
Before t = 0, w(-y) = G V y / h - tau0 for 0 < y < h/c; the load is tau0 + G V t / h up to h/c.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np
from numpy.typing import NDArray

from stickslip.bodies import ElasticSlab
from stickslip.errors import InputError
from stickslip.evolution.history import History, Moments
from stickslip.evolution.setup import inflow
from stickslip.observables.quadrature import NODES, WEIGHTS, over

Floats = NDArray[np.float64]
OfWave = Callable[[Floats, Floats], Floats]
"""A density as a function of the wave that leaves (plus the reference) and of the time at which it left."""


class Waves:
    """Integrals over the waves of a slab's run; energies in J/m^2."""

    def __init__(self, history: History, body: ElasticSlab) -> None:
        self.history, self.body = history, body
        self.reference, self.excess = history.problem.strength, history.problem.excess
        self.round, self.half = body.two_way_time, 0.5 * body.two_way_time
        self.slope = body.impedance * history.problem.pull_rate / self.half  # G V / h
        self.inflow, self.inflow_rate = inflow(history.problem)

    def leaving(self, at: Moments) -> Floats:
        """w plus the reference, Pa."""
        return 2.0 * self.body.impedance * self.history.rate(at) - self.history.excess(at)

    def arriving(self, leaving: Floats, left: Floats) -> Floats:
        """Load minus the reference one round trip after a wave left the contact."""
        return self.body.reflection * leaving + self.inflow + self.inflow_rate * (left + self.round)

    # ---- energies -----------------------------------------------------------------------------------------------------------

    def stored(self, t: float) -> float:
        """Elastic and kinetic energy inside the slab at time t, less a constant."""

        def down(load: Floats) -> Floats:
            return load * (2.0 * self.reference + load)

        def up(leaving: Floats, left: Floats) -> Floats:
            return leaving * (leaving - 2.0 * self.reference)

        total = self._between(t - self.half, t, up)
        if t < self.half:  # the load that the start sends down, before anything has come back
            length = self.half - t
            total += length * float(down(self.excess + self.slope * (t + length * NODES)) @ WEIGHTS)
        back = self._between(max(t, self.half) - self.round, t - self.half, lambda w, left: down(self.arriving(w, left)))
        return (total + back) / (4.0 * self.body.impedance)

    def power(self, leaving: Floats, left: Floats) -> Floats:
        """sigma v at the driver, h/c after a wave left: (A^2 - B^2) / (4 Z) of arriving A and leaving B, without cancellation."""
        gain, incoming = 1.0 + self.body.reflection, self.inflow + self.inflow_rate * (left + self.round)
        drop = 2.0 * self.reference + (self.body.reflection - 1.0) * leaving + incoming
        return (gain * leaving + incoming) * drop / (4.0 * self.body.impedance)

    def work(self, t: float) -> float:
        """Work of the driver up to time t."""
        end = t - self.half
        total = self._before(-self.half, min(end, 0.0), self.power)
        if end <= 0.0:
            return total
        store, row = self.history.store, int(end // self.round)
        for first, last, begin, rows in self._rows():
            if begin > row:
                break
            if self.history.in_creep_leap(begin):  # averages, which have the work of what they stand for
                total += self._in_row(first, last, 0, 0.0, end - begin * self.round, self.power)
                continue
            whole = min(rows, row - begin)  # round trips like this one that lie wholly before the end
            total += self._row_work(first, last, whole)
            if row < begin + rows:
                theta = end - row * self.round
                total += self._in_row(first, last, row - begin, store.theta_from[first], theta, self.power)
        return total

    def _row_work(self, first: int, last: int, rows: int) -> float:
        """Work over `rows` round trips at rest, each like the last but for the ramp (one round trip if the contact moves)."""
        if rows == 0:
            return 0.0
        piece = np.arange(first, last)
        ends = np.zeros(len(piece)), np.ones(len(piece))
        once = float(over(self.history, piece, *ends, self._of(self.power)).sum())
        if rows == 1:
            return once
        gain = 1.0 + self.body.reflection
        pull = self._of(lambda w, left: gain * w + self.inflow + self.inflow_rate * (left + self.round))
        growth = 2.0 * self.history.ramp * float(over(self.history, piece, *ends, pull).sum()) / (4.0 * self.body.impedance)
        return rows * once + growth * rows * (rows - 1) / 2.0

    # ---- integrals ----------------------------------------------------------------------------------------------------------

    def _rows(self) -> Iterator[tuple[int, int, int, int]]:
        """Stored rows: first piece, last piece + 1, round trip, and for how many round trips it stands."""
        row = self.history.store.row
        first = np.flatnonzero(np.diff(row, prepend=-1))
        ends = np.append(first[1:], len(row))
        lasting = np.append(np.diff(row[first]), np.iinfo(np.int64).max // 2)
        for values in zip(first, ends, row[first], lasting, strict=True):
            yield tuple(int(value) for value in values)  # type: ignore[misc]

    def _of(self, density: OfWave) -> Callable[[Moments], Floats]:
        def integrand(at: Moments) -> Floats:
            store = self.history.store
            theta = store.theta_from[at.piece] + at.xi * (store.speed[at.piece] + at.xi * store.bend[at.piece])
            left = (store.row[at.piece] + at.leaped) * self.round + theta
            return density(self.leaving(at), left)

        return integrand

    def _before(self, start: float, end: float, density: OfWave) -> float:
        """Integral over waves that left before the run began."""
        if end <= start:
            return 0.0
        left = start + (end - start) * NODES
        return (end - start) * float(density(-self.slope * left - self.excess, left) @ WEIGHTS)

    def _between(self, start: float, end: float, density: OfWave) -> float:
        """Integral of a density over the waves that left between two times, at most one round trip apart."""
        total = self._before(start, min(end, 0.0), density)
        start = max(start, 0.0)
        if end <= start:
            return total
        for row in range(int(start // self.round), int(end // self.round) + 1):
            stored = np.searchsorted(self.history.store.row, row, side="right")
            begin = int(self.history.store.row[stored - 1])
            first, last = (int(np.searchsorted(self.history.store.row, begin, side=side)) for side in ("left", "right"))
            low, high = max(start - row * self.round, 0.0), min(end - row * self.round, self.round)
            if high > low:
                if self.history.in_creep_leap(begin):
                    raise InputError(f"the waves at {end:g} s are not known: they left the contact in a leap over creep")
                total += self._in_row(first, last, row - begin, low, high, density)
        return total

    def _in_row(self, first: int, last: int, leaped: int, low: float, high: float, density: OfWave) -> float:
        """Integral over the offsets low to high of a row, `leaped` round trips later."""
        store, piece = self.history.store, np.arange(first, last)
        piece = piece[(store.theta_to[piece] > low) & (store.theta_from[piece] < high)]
        begin = self.history.xi(piece, np.maximum(low - store.theta_from[piece], 0.0))
        end = np.where(store.theta_to[piece] <= high, 1.0, self.history.xi(piece, high - store.theta_from[piece]))
        return float(over(self.history, piece, begin, end, self._of(density), float(leaped)).sum())
