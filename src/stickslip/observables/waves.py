"""The waves inside the slab, as the contact sent and received them: what its stored energy and the driver's work are made of.

Everything is written with what leaves the contact, w = 2 Z v - beta, plus the reference strength: small where the slab is near
its strength. The load that arrives one round trip later is r w + inflow, so the past alone says what the slab holds now.
Before t = 0, w(-y) = G V y / h - tau0 for 0 < y < h/c; the load is tau0 + G V t / h up to h/c.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property, partial
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from stickslip.bodies import ElasticSlab
from stickslip.engine_input.forcing import inflow_of
from stickslip.foundation.errors import InputError
from stickslip.observables.quadrature import NODES, WEIGHTS, over
from stickslip.trajectory.history import START, Epoch, History, Moments

Floats = NDArray[np.float64]
OfWave = Callable[[Floats, Floats], Floats]
"""A density as a function of a wave (plus or minus the reference) and of a time in s."""


class Waves:
    """Integrals over the waves of a slab's run; energies in J/m^2."""

    def __init__(self, history: History, body: ElasticSlab) -> None:
        self.history, self.body = history, body
        self.reference, self.excess = history.problem.strength, history.problem.excess
        self.round, self.half = body.two_way_time, 0.5 * body.two_way_time
        self.slope = body.impedance * history.problem.first_pull_rate / self.half  # G V / h
        self.inflow = inflow_of(history.problem)

    def leaving(self, at: Moments) -> Floats:
        """w plus the reference, Pa."""
        return 2.0 * self.body.impedance * self.history.rate(at) - self.history.excess(at)

    def arriving(self, leaving: Floats, left: Floats) -> Floats:
        """Load minus the reference one round trip after a wave left the contact, at a time (s) since the start of the run."""
        return np.asarray(self.body.reflection * leaving + self.inflow.at(left + self.round))

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
        rate = float(self.history.problem.pull_rate_at(self.begun(now))) if self.body.reflection == -1.0 else 0.0
        drift = self.body.impedance * rate / self.half

        def down(load: Floats, away: Floats) -> Floats:
            return (load - mean - drift * away) ** 2

        def up(leaving: Floats, away: Floats) -> Floats:
            return (leaving + mean - drift * away) ** 2

        return self._inside(now, down, up) / (4.0 * self.body.impedance)

    def driver_rate(self, leaving: Floats, left: Floats) -> Floats:
        """Velocity (m/s) of the slab at the driver, h/c after a wave left: (A + B) / (2 Z) of arriving A and leaving B."""
        incoming = self.inflow.at(left + self.round)
        return np.asarray(((1.0 + self.body.reflection) * leaving + incoming) / (2.0 * self.body.impedance))

    def power(self, leaving: Floats, left: Floats) -> Floats:
        """sigma v at the driver, h/c after a wave left: (A^2 - B^2) / (4 Z), without cancellation."""
        drop = 2.0 * self.reference + (self.body.reflection - 1.0) * leaving + self.inflow.at(left + self.round)
        return 0.5 * self.driver_rate(leaving, left) * drop

    def power_growth(self, leaving: Floats, left: Floats) -> Floats:
        """By how much that grows from an echo at rest to the next: the stress does, by the ramp."""
        return self.history.ramp * self.driver_rate(leaving, left)

    def work(self, now: Epoch) -> float:
        """Work of the driver since the start of the run."""
        end = Epoch(now.row, now.offset - self.half) if now.offset >= self.half else Epoch(now.row - 1, now.offset + self.half)
        if end.row < 0:
            return self._before(-self.half, end.offset - self.round, self.power)
        total = self._before(-self.half, 0.0, self.power)
        if self.history.problem.varies:
            return total + self._row_by_row(end.row) + self._in_row(end.row, 0.0, end.offset, self._of(self.power))
        total += float(self._passed[int(np.searchsorted(self.history.store.row, end.row, side="right"))])
        piece, low, high = self.standing(end.row)
        total += float(self._work_of(piece, low, high, end.row - self.history.store.row[piece]).sum())
        return total + self._in_row(end.row, 0.0, end.offset, self._of(self.power))

    def _row_by_row(self, past: int) -> float:
        """Work of all that left the contact before a row, where the loading varies: no sum over echoes stands for rows at rest."""
        rows = np.unique(self.history.store.row)
        rows, of_rows = rows[rows < past], self._of_rows
        last = int(rows[-1]) if len(rows) else -1
        return float(of_rows[len(rows)]) + self._at_rest(last + 1, past)

    @cached_property
    def _of_rows(self) -> Floats:
        """Work of all that left before the end of each stored row; 0 at the start."""
        rows = np.unique(self.history.store.row)
        own = [self._in_row(int(row), 0.0, self.round, self._of(self.power)) for row in rows]
        rest = [self._at_rest(int(row) + 1, int(following)) for row, following in pairwise(rows)]
        return np.cumsum([0.0, *(sum(both) for both in zip(own, [0.0, *rest], strict=True))])

    def _at_rest(self, first: int, past: int) -> float:
        """Work of what left in whole rows that were leaped over. Nothing is lost in them: a rigid driver's work is in the slab."""
        if past <= first:
            return 0.0
        of_row = partial(self._in_row, high=self.round, integrand=self._of(self.power))
        if self.body.reflection == -1.0:
            return self.stored(Epoch(past, 0.0)) - self.stored(Epoch(first, self.half)) + of_row(past - 1, low=self.half)
        # nothing changes in these rows; what the driver sends back of the last one may meet another loading
        return (past - first - 1) * of_row(first, low=0.0) + of_row(past - 1, low=0.0)

    def work_between(self, first: Epoch, last: Epoch) -> float:
        """Work of the driver from one moment to a later one, not long after: nothing outside of these enters."""
        lasting = (last.row - first.row) * self.round + (last.offset - first.offset)
        begun = self.begun(last)
        return self._between(last, -self.half - lasting, -self.half, lambda w, since: self.power(w, begun + since))

    @cached_property
    def _passed(self) -> Floats:
        """Work of all that left the contact before an echo of it was recorded, summed over the pieces in order of time."""
        store = self.history.store
        echo = np.flatnonzero(store.echo_of >= 0)
        source, work = store.echo_of[echo], np.zeros(len(store.row))
        work[echo] = self._work_of(source, store.theta_from[echo], store.theta_to[echo], store.row[echo] - store.row[source])
        for row, trips in self.history.creep[:, :2]:  # averages have the work of what they stand for
            way, landing = (np.searchsorted(store.row, when) for when in (row, row + trips))
            own = np.arange(way, landing)
            work[landing] = self._work_of(own, store.theta_from[own], store.theta_to[own], np.ones(len(own), np.int64)).sum()
            before = self.history.standing(int(row) - 1)
            work[way] = self._work_of(*before, row - store.row[before[0]]).sum()
        return np.append(0.0, np.cumsum(work))

    def _work_of(self, piece: NDArray[np.intp], low: Floats, high: Floats, rows: NDArray[np.int64]) -> Floats:
        """Work of what left between two offsets (s) of pieces, and of its echoes: so many rows each."""
        come = rows > 0
        piece, low, high, rows = piece[come], low[come], high[come], rows[come]
        part = piece, *self._places(piece, low, high)
        once, growth = (over(self.history, *part, self._of(density)) for density in (self.power, self.power_growth))
        return rows * once + growth * rows * (rows - 1.0) / 2.0

    def _places(self, piece: NDArray[np.intp], low: Floats, high: Floats) -> tuple[Floats, Floats]:
        """Where in pieces (xi) two offsets (s) lie."""
        history, start, end = self.history, self.history.store.theta_from[piece], self.history.store.theta_to[piece]
        first, last = (history.xi(piece, np.maximum(offset - start, 0.0)) for offset in (low, high))
        return first, np.where(high >= end, 1.0, last)

    def standing(self, row: int) -> tuple[NDArray[np.intp], Floats, Floats]:
        """As `History.standing`. Raises InputError for a row in a leap over creep: it holds averages."""
        last = int(np.searchsorted(self.history.store.row, row, side="right")) - 1
        if self.history.is_averaged(int(self.history.store.row[last])):
            raise InputError(f"the waves of round trip {row} are not known: they left the contact in a leap over creep")
        return self.history.standing(row)

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
        edges = np.concatenate([[start], self.inflow.edges(start + self.round, end + self.round) - self.round, [end]])
        left, lasting = edges[:-1, None] + np.diff(edges)[:, None] * NODES, np.diff(edges)
        values = density(-self.slope * left.ravel() - self.excess, left.ravel() - begun)
        return float(lasting @ (values.reshape(left.shape) @ WEIGHTS))

    def _between(self, now: Epoch, low: float, high: float, density: OfWave) -> float:
        """Integral of a density over the waves that left between two times since now (s, not positive)."""
        begun = self.begun(now)
        total = self._before(begun + low, min(begun + high, 0.0), density, begun)
        low = max(low, -begun)
        first_row, last_row = (now.row + int((now.offset + time) // self.round) for time in (low, high))
        for row in range(max(first_row, 0), last_row + 1):
            start = (row - now.row) * self.round - now.offset
            begin, end = max(low - start, 0.0), min(high - start, self.round)
            if end <= begin:
                continue
            total += self._in_row(row, begin, end, self._of(density, now))
        return total

    def _in_row(self, row: int, low: float, high: float, integrand: Callable[[Moments], Floats]) -> float:
        """Integral over the offsets low to high (s) of a row."""
        piece, begin, end = self.standing(row)
        inside = (end > low) & (begin < high)
        piece, begin, end = piece[inside], np.maximum(begin[inside], low), np.minimum(end[inside], high)
        if self.history.problem.varies:
            piece, begin, end = self._cut(piece, begin, end, row)
        leaped = (row - self.history.store.row[piece]).astype(float)
        return float(over(self.history, piece, *self._places(piece, begin, end), integrand, leaped).sum())

    def _cut(self, piece: NDArray[np.intp], begin: Floats, end: Floats, row: int) -> tuple[NDArray[np.intp], Floats, Floats]:
        """Parts of pieces (offsets in a row, s) whose echo meets the same segment of the loading throughout."""
        breaks = np.array([offset for other, offset in self.inflow.breaks() if other == row + 1])
        edges = np.unique(np.concatenate([begin, breaks[(breaks > begin[:1]) & (breaks < end[-1:])] if len(piece) else breaks[:0]]))
        which = np.searchsorted(begin, edges, side="right") - 1
        return piece[which], edges, np.minimum(np.append(edges[1:], end[-1:]), end[which])


class Radiation(Waves):
    """What leaves through a driver of finite impedance Zd: `work` is that of the waves that go on behind it, Zd (v - V)^2.

    The far stress and the driver's steady motion do the work of the driver and this: it is what `Waves.work` is net of.
    """

    def power(self, leaving: Floats, left: Floats) -> Floats:
        """Of the wave behind the driver, h/c after a wave left the contact; nothing goes into a rigid one."""
        if self.body.reflection == -1.0:
            return np.zeros(len(leaving))
        behind = self.driver_rate(leaving, left) - self.history.problem.pull_rate_at(left + self.half)
        return np.asarray(self.body.driver_impedance * behind**2)

    def _at_rest(self, first: int, past: int) -> float:
        """As `Waves._at_rest`; nothing leaves through a rigid driver."""
        return 0.0 if self.body.reflection == -1.0 else super()._at_rest(first, past)

    def power_growth(self, leaving: Floats, left: Floats) -> Floats:
        """Echoes at rest move the driver alike."""
        return np.zeros(len(leaving))
