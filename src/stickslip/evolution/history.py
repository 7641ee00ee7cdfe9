"""The history of a run: pieces of load and slip rate, and how to read them at any time."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stickslip.bodies import ElasticSlab
from stickslip.errors import InputError
from stickslip.evolution.layout import Integers, Store
from stickslip.problem import Problem

Floats = NDArray[np.float64]
Side = Literal["left", "right"]


def horner(coefficients: Floats, x: Floats) -> Floats:
    """Polynomials (one a row, ascending) at x (one value a row)."""
    value = coefficients[:, -1].copy()
    for k in range(coefficients.shape[1] - 2, -1, -1):
        value *= x
        value += coefficients[:, k]
    return value


class Epoch(NamedTuple):
    """A moment without rounding: whole rows (round trips of a slab) since t = 0, and an offset in s."""

    row: int
    offset: float


START = Epoch(0, 0.0)
"""t = 0, the start of the run."""

NO_LEAPS = np.empty((0, 4))


@dataclass(frozen=True)
class Moments:
    """Times found in the history: piece, place xi in it, whole round trips since (a leap over rest), before = left of t = 0."""

    piece: NDArray[np.intp]
    xi: Floats
    leaped: Floats
    before: NDArray[np.bool_]

    @classmethod
    def inside(cls, piece: ArrayLike, xi: ArrayLike) -> Moments:
        """Places in the history by piece and xi."""
        pieces, places = np.broadcast_arrays(np.atleast_1d(np.asarray(piece, np.intp)), np.atleast_1d(np.asarray(xi, float)))
        return cls(pieces, places, np.zeros(len(pieces)), np.zeros(len(pieces), bool))


@dataclass(frozen=True)
class History:
    """Pieces in order of time. Loads are minus the reference strength, slips minus the initial slip (see `layout.Store`).

    Times go in and out as seconds since `epoch`, and are as sharp as their own rounding: take an epoch near what you look at.
    """

    store: Store
    problem: Problem
    row_time: float
    ramp: float
    duration: float
    epoch: Epoch = START
    creep: Floats = field(default_factory=NO_LEAPS.copy)
    """Leaps over creep, one a row: round trips before it, round trips in it, bounds of the error of slip (m) where it lands and of
    the time (s) at which that slip is reached."""

    def seen_from(self, epoch: Epoch) -> History:
        """The same history with its times counted from another epoch."""
        return replace(self, epoch=epoch)

    def seconds(self, row: Integers | Floats, offset: Floats) -> Floats:
        """Times (s since the epoch) of offsets in whole rows."""
        return np.asarray((row - self.epoch.row) * self.row_time + (offset - self.epoch.offset))

    @cached_property
    def start(self) -> Floats:
        """Time at which each piece starts, s."""
        return self.seconds(self.store.row, self.store.theta_from)

    @cached_property
    def end(self) -> Floats:
        """Time at which each piece ends, s."""
        return self.seconds(self.store.row, self.store.theta_to)

    @property
    def span(self) -> tuple[float, float]:
        """Times (s) of the start and the end of the run."""
        start = float(self.seconds(np.zeros(1), np.zeros(1))[0])
        return start, start + self.duration

    def __len__(self) -> int:
        return len(self.store.whole)

    def rested(self, piece: int) -> int:
        """Whole rows at rest that were leaped over just before a piece; what a leap over creep has passed was no rest."""
        if piece == 0:
            return 0
        passed = max(round(float(self.store.theta_to[piece - 1]) / self.row_time), 1)
        return max(int(self.store.row[piece] - self.store.row[piece - 1]) - passed, 0)

    def is_averaged(self, row: int) -> bool:
        """Whether a stored row is a leap over creep: its pieces are averages over round trips."""
        return bool((self.creep[:, 0] == row).any())

    def find(self, time: Floats, side: Side) -> Moments:
        """Where the times (s, one-dimensional) lie; `side` picks the piece at a boundary. InputError outside the run."""
        if side not in ("left", "right"):
            raise InputError(f"side must be 'left' or 'right', got {side!r}")
        first, last = self.span
        if not np.all((time >= first) & (time <= last + 1e-12 * self.duration)):
            raise InputError(f"times must lie between {first:g} and the end of the run, {last:g} s")
        piece = np.searchsorted(self.start, time, side="left" if side == "left" else "right") - 1
        before = piece < 0
        piece = np.maximum(piece, 0)
        leaped = np.zeros(len(time))
        local = time - self.start[piece]
        for n in np.flatnonzero(time > self.end[piece]):
            piece[n], local[n], leaped[n] = self._in_leap(int(piece[n]), float(time[n]), side)
        return Moments(piece, self.xi(piece, local), leaped, before)

    def _in_leap(self, last: int, time: float, side: Side) -> tuple[int, float, float]:
        """A time behind a row at rest that was leaped over: the same place in that row, whole rows later."""
        row = int(self.store.row[last])
        if last + 1 == len(self) or self.rested(last + 1) == 0:
            return last, time - float(self.start[last]), 0.0
        since = time + self.epoch.offset - (row - self.epoch.row) * self.row_time  # since that row began
        rows = max(np.floor(since / self.row_time), 0.0)
        theta = time + self.epoch.offset - (row - self.epoch.row + rows) * self.row_time
        if theta <= 0.0 and side == "left":
            rows, theta = rows - 1.0, self.row_time
        first = int(np.searchsorted(self.store.row, row, side="left"))
        inside = np.searchsorted(self.store.theta_from[first : last + 1], theta, side="left" if side == "left" else "right") - 1
        piece = first + max(int(inside), 0)
        return piece, theta - float(self.store.theta_from[piece]), float(rows)

    def placed(self, at: Moments) -> tuple[Integers, Floats]:
        """Rows and offsets (s) of moments."""
        store, piece, xi = self.store, at.piece, at.xi
        inside = store.theta_from[piece] + xi * (store.speed[piece] + xi * store.bend[piece])
        return store.row[piece] + at.leaped.astype(np.int64), np.where(xi == 1.0, store.theta_to[piece], inside)

    def xi(self, piece: NDArray[np.intp], local: Floats) -> Floats:
        """Place in [0, 1] of a time `local` s after the start of a piece."""
        speed, bend = self.store.speed[piece], self.store.bend[piece]
        root = np.sqrt(np.maximum(speed * speed + 4.0 * bend * local, 0.0))
        pace = speed + root  # zero where a piece starts at a fold, and only at its very start
        return np.clip(2.0 * local / np.where(pace > 0.0, pace, 1.0), 0.0, 1.0)

    # ---- values at moments --------------------------------------------------------------------------------------------------

    def excess(self, at: Moments) -> Floats:
        """Load minus the reference strength."""
        value = horner(self.store.load[at.piece], at.xi) + at.leaped * self.ramp
        return np.where(at.before, self.problem.excess, value)

    def rate(self, at: Moments) -> Floats:
        """Slip rate, m/s."""
        return np.where(at.before, 0.0, horner(self.store.rate[at.piece], at.xi))

    def grown(self, at: Moments) -> Floats:
        """Slip since the start of the piece, m: the integral of the rate over dtheta = (speed + 2 bend xi) dxi."""
        rate = self.store.rate[at.piece]
        powers = np.arange(1, rate.shape[1] + 1)
        straight = at.xi * horner(self.store.speed[at.piece, None] * rate / powers, at.xi)
        bend = self.store.bend[at.piece]
        if not bend.any():
            return straight
        return straight + at.xi**2 * horner(2.0 * bend[:, None] * rate / (powers + 1), at.xi)

    def slipped(self, at: Moments) -> Floats:
        """Slip since the start of the run, m."""
        return np.where(at.before, 0.0, self.store.slip[at.piece] + self.grown(at))

    def slipped_since(self, origin: Moments, at: Moments) -> Floats:
        """Slip since one moment, m: summed from there, so that it has all its digits however much has slipped before."""
        begin = int(origin.piece[0])
        first, last = min(begin, int(at.piece.min())), max(begin, int(at.piece.max()))
        crossed = np.arange(first, last)
        pieces, places = (np.concatenate(parts) for parts in ((crossed, origin.piece, at.piece), (crossed >= 0, origin.xi, at.xi)))
        grown = self.grown(Moments.inside(pieces, places))
        earlier, later, behind = np.split(grown, [begin - first, last - first])
        sums = np.concatenate([-np.cumsum(earlier[::-1])[::-1], [0.0], np.cumsum(later)])
        return np.where(at.before, -self.slipped(origin), sums[at.piece - first] + (behind[1:] - behind[0]))

    def state(self, at: Moments) -> Floats:
        """State of the friction law as its formulas see it; 0 for a law without one."""
        if self.problem.friction.state is None:
            return np.zeros(len(at.xi))
        return np.where(at.before, self.problem.state, horner(self.store.state[at.piece], at.xi))

    def friction(self, at: Moments) -> Floats:
        """Friction traction minus the reference strength, signed with the load."""
        excess, rate = self.excess(at), self.rate(at)
        body = self.problem.body
        if isinstance(body, ElasticSlab) and body.contact_mass == 0.0:
            return excess - body.impedance * rate
        law, mode = self.problem.friction, self.store.mode[at.piece]
        grown = self.grown(at)
        walked = mode * grown if law.counts == "path" else grown
        law_slip = self.problem.law_slip + self.store.law_slip[at.piece] + walked
        by_law = mode * self.problem.normal * law.coefficient(law_slip, np.abs(rate), self.state(at)) - self.problem.strength
        return np.where((mode == 0) | at.before, excess, by_law)
