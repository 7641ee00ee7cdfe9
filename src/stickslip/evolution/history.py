"""The history of a run: pieces of load and slip rate, and how to read them at any time."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from stickslip.bodies import ElasticSlab
from stickslip.errors import InputError
from stickslip.evolution.layout import Store
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


NO_LEAPS = np.empty((0, 4))


@dataclass(frozen=True)
class Moments:
    """Times found in the history: piece, place xi in it, whole round trips since (a leap over rest), before = left of t = 0."""

    piece: NDArray[np.intp]
    xi: Floats
    leaped: Floats
    before: NDArray[np.bool_]


@dataclass(frozen=True)
class History:
    """Pieces in order of time. Loads are minus the reference strength, slips minus the initial slip (see `layout.Store`)."""

    store: Store
    problem: Problem
    row_time: float
    ramp: float
    duration: float
    creep: Floats = field(default_factory=NO_LEAPS.copy)
    """Leaps over creep, one a row: start and end (s), round trips, bound of the error of slip (m)."""

    @cached_property
    def start(self) -> Floats:
        """Time at which each piece starts, s."""
        return np.asarray(self.store.row * self.row_time + self.store.theta_from)

    @cached_property
    def end(self) -> Floats:
        """Time at which each piece ends, s."""
        return np.asarray(self.store.row * self.row_time + self.store.theta_to)

    def __len__(self) -> int:
        return len(self.store.whole)

    def rested(self, piece: int) -> int:
        """Whole round trips at rest that were leaped over just before a piece."""
        if piece == 0 or self.start[piece] <= self.end[piece - 1]:
            return 0  # at once behind it, be that a leap over creep
        return max(int(self.store.row[piece] - self.store.row[piece - 1]) - 1, 0)

    def in_creep_leap(self, row: int) -> bool:
        """Whether a stored row is a leap over creep, and its pieces so are averages over round trips."""
        return bool((np.round(self.creep[:, 0] / self.row_time) == row).any())

    def find(self, time: Floats, side: Side) -> Moments:
        """Where the times (s, one-dimensional) lie; `side` picks the piece at a boundary. InputError outside the run."""
        if side not in ("left", "right"):
            raise InputError(f"side must be 'left' or 'right', got {side!r}")
        slack = 1e-12 * self.duration
        if not np.all((time >= 0.0) & (time <= self.duration + slack)):
            raise InputError(f"times must lie between 0 and the end of the run, {self.duration:g} s")
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
        if last + 1 == len(self) or self.store.row[last + 1] == row:
            return last, time - float(self.start[last]), 0.0
        rows = max(np.floor((time - row * self.row_time) / self.row_time), 0.0)
        theta = time - (row + rows) * self.row_time
        if theta <= 0.0 and side == "left":
            rows, theta = rows - 1.0, self.row_time
        first = int(np.searchsorted(self.store.row, row, side="left"))
        inside = np.searchsorted(self.store.theta_from[first : last + 1], theta, side="left" if side == "left" else "right") - 1
        piece = first + max(int(inside), 0)
        return piece, theta - float(self.store.theta_from[piece]), float(rows)

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
        integral = self.store.speed[at.piece, None] * rate / powers
        bent = 2.0 * self.store.bend[at.piece, None] * rate / (powers + 1)
        return at.xi * (horner(integral, at.xi) + at.xi * horner(bent, at.xi))

    def slipped(self, at: Moments) -> Floats:
        """Slip since the start of the run, m."""
        return np.where(at.before, 0.0, self.store.slip[at.piece] + self.grown(at))

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
