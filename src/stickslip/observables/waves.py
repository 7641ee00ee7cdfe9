"""The waves inside the slab, as the contact sent and received them: what its stored energy and the driver's work are made of.

Everything is written with what leaves the contact, w = 2 Z v - beta, plus the reference strength: small where the slab is near
its strength. The load that arrives one round trip later is r w + inflow, so the past alone says what the slab holds now.
Before t = 0, w(-y) = G V y / h - tau0 for 0 < y < h/c; the load is tau0 + G V t / h up to h/c.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from stickslip.bodies import ElasticSlab
from stickslip.errors import InputError
from stickslip.evolution.history import START, Epoch, History, Moments
from stickslip.evolution.setup import inflow
from stickslip.observables.quadrature import NODES, WEIGHTS, over

Floats = NDArray[np.float64]
OfWave = Callable[[Floats, Floats], Floats]
"""A density as a function of a wave (plus or minus the reference) and of a time in s."""


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
        """Load minus the reference one round trip after a wave left the contact, at a time (s) since the start of the run."""
        return self.body.reflection * leaving + self.inflow + self.inflow_rate * (left + self.round)

    def begun(self, now: Epoch) -> float:
        """Time since the start of the run, s: only where its rounding does not matter."""
        return now.row * self.round + now.offset

    # ---- energies -----------------------------------------------------------------------------------------------------------

    def stored(self, now: Epoch) -> float:
        """Elastic and kinetic energy inside the slab, less a constant."""

        def down(load: Floats, _: Floats) -> Floats:
            return load * (2.0 * self.reference + load)

        def up(leaving: Floats, _: Floats) -> Floats:
            return leaving * (leaving - 2.0 * self.reference)

        return self._inside(now, down, up) / (4.0 * self.body.impedance)

    def trapped(self, now: Epoch) -> float:
        """Energy of the waves inside the slab: what it stores beyond the same mean stress at rest (rigid driver: sheared at V)."""
        mean = self._inside(now, lambda load, _: load, lambda leaving, _: -leaving) / (2.0 * self.half)
        drift = self.body.impedance * self.history.problem.pull_rate / self.half if self.body.reflection == -1.0 else 0.0

        def down(load: Floats, away: Floats) -> Floats:
            return (load - mean - drift * away) ** 2

        def up(leaving: Floats, away: Floats) -> Floats:
            return (leaving + mean - drift * away) ** 2

        return self._inside(now, down, up) / (4.0 * self.body.impedance)

    def power(self, leaving: Floats, left: Floats) -> Floats:
        """sigma v at the driver, h/c after a wave left: (A^2 - B^2) / (4 Z) of arriving A and leaving B, without cancellation."""
        gain, incoming = 1.0 + self.body.reflection, self.inflow + self.inflow_rate * (left + self.round)
        drop = 2.0 * self.reference + (self.body.reflection - 1.0) * leaving + incoming
        return (gain * leaving + incoming) * drop / (4.0 * self.body.impedance)

    def work(self, now: Epoch) -> float:
        """Work of the driver since the start of the run."""
        end = Epoch(now.row, now.offset - self.half) if now.offset >= self.half else Epoch(now.row - 1, now.offset + self.half)
        if end.row < 0:
            return self._before(-self.half, end.offset - self.round, self.power)
        total = self._before(-self.half, 0.0, self.power)
        rows, first, past, once, growth, sums = self._rows
        k = int(np.searchsorted(rows, end.row, side="right")) - 1
        self._check_known(int(rows[k]), now)
        leaped = end.row - int(rows[k])
        total += float(sums[k] + leaped * once[k] + growth[k] * leaped * (leaped - 1) / 2.0)
        return total + self._in_row(int(first[k]), int(past[k]), leaped, 0.0, end.offset, self._of(self.power))

    def work_between(self, first: Epoch, last: Epoch) -> float:
        """Work of the driver from one moment to a later one, not long after: nothing outside of these enters."""
        lasting = (last.row - first.row) * self.round + (last.offset - first.offset)
        begun = self.begun(last)
        return self._between(last, -self.half - lasting, -self.half, lambda w, since: self.power(w, begun + since))

    @cached_property
    def _rows(self) -> tuple[NDArray[Any], ...]:
        """Of each stored row: round trip, first piece, last piece + 1, work in it, its growth per row leaped, work before it."""
        store, count = self.history.store, len(self.history)
        first = np.flatnonzero(np.diff(store.row, prepend=-1))
        past = np.append(first[1:], count)
        gain = 1.0 + self.body.reflection
        pull = self._of(lambda w, left: gain * w + self.inflow + self.inflow_rate * (left + self.round))
        ends = np.arange(count), np.zeros(count), np.ones(count)
        once, rise = (np.add.reduceat(over(self.history, *ends, density), first) for density in (self._of(self.power), pull))
        growth = 2.0 * self.history.ramp * rise / (4.0 * self.body.impedance)
        rows = store.row[first]
        lasting = np.diff(rows).astype(float)  # round trips for which a stored one stands
        lasting[np.isin(rows[:-1], self.history.creep[:, 0])] = 1.0  # averages already have the work of what they stand for
        passed = lasting * once[:-1] + growth[:-1] * lasting * (lasting - 1.0) / 2.0
        return rows, first, past, once, growth, np.concatenate([[0.0], np.cumsum(passed)])

    # ---- integrals ----------------------------------------------------------------------------------------------------------

    def _inside(self, now: Epoch, down: OfWave, up: OfWave) -> float:
        """Integral over the waves inside the slab: `down` of those that come to the contact (as a load minus the reference),
        `up` of those that left it, each with the time (s) that it has yet to go, or has come, between its place and the contact.
        """
        begun = self.begun(now)

        def back(leaving: Floats, since: Floats) -> Floats:
            return down(self.arriving(leaving, begun + since), since + self.round)

        total = self._between(now, -self.half, 0.0, lambda leaving, since: up(leaving, -since))
        if begun < self.half:  # the load that the start sends down, before anything has come back
            away = (self.half - begun) * NODES
            total += (self.half - begun) * float(down(self.excess + self.slope * (begun + away), away) @ WEIGHTS)
        return total + self._between(now, max(-self.round, -self.half - begun), -self.half, back)

    def _of(self, density: OfWave, since: Epoch = START) -> Callable[[Moments], Floats]:
        """The density at moments, with the time since an epoch."""

        def integrand(at: Moments) -> Floats:
            store = self.history.store
            theta = store.theta_from[at.piece] + at.xi * (store.speed[at.piece] + at.xi * store.bend[at.piece])
            time = (store.row[at.piece] + at.leaped - since.row) * self.round + (theta - since.offset)
            return density(self.leaving(at), time)

        return integrand

    def _before(self, start: float, end: float, density: OfWave, begun: float = 0.0) -> float:
        """Integral over waves that left at times (s) before the run began; the density's time counts from `begun` after that."""
        if end <= start:
            return 0.0
        left = start + (end - start) * NODES
        return (end - start) * float(density(-self.slope * left - self.excess, left - begun) @ WEIGHTS)

    def _between(self, now: Epoch, low: float, high: float, density: OfWave) -> float:
        """Integral of a density over the waves that left between two times since now (s, not positive)."""
        begun, stored = self.begun(now), self.history.store.row
        total = self._before(begun + low, min(begun + high, 0.0), density, begun)
        low = max(low, -begun)
        first_row, last_row = (now.row + int((now.offset + time) // self.round) for time in (low, high))
        for row in range(max(first_row, 0), last_row + 1):
            start = (row - now.row) * self.round - now.offset
            begin, end = max(low - start, 0.0), min(high - start, self.round)
            if end <= begin:
                continue
            past = int(np.searchsorted(stored, row, side="right"))
            self._check_known(int(stored[past - 1]), now)
            first = int(np.searchsorted(stored, stored[past - 1], side="left"))
            total += self._in_row(first, past, row - int(stored[past - 1]), begin, end, self._of(density, now))
        return total

    def _check_known(self, row: int, now: Epoch) -> None:
        """Refuse averages. Raises InputError for a stored row that is a leap over creep."""
        if self.history.is_averaged(row):
            raise InputError(f"the waves at {self.begun(now):g} s are not known: they left the contact in a leap over creep")

    def _in_row(self, first: int, past: int, leaped: int, low: float, high: float, integrand: Callable[[Moments], Floats]) -> float:
        """Integral over the offsets low to high of a row, `leaped` round trips later."""
        store, piece = self.history.store, np.arange(first, past)
        piece = piece[(store.theta_to[piece] > low) & (store.theta_from[piece] < high)]
        begin = self.history.xi(piece, np.maximum(low - store.theta_from[piece], 0.0))
        end = np.where(store.theta_to[piece] <= high, 1.0, self.history.xi(piece, high - store.theta_from[piece]))
        return float(over(self.history, piece, begin, end, integrand, float(leaped)).sum())
