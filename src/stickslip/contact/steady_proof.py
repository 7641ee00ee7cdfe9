"""Prove where steady sliding gains or loses its stability under a law with states, over a whole range of slip rates.

The range is cut into cells. In each, bounds of the slopes of f in w' = f(v, w) enclose the steady states w(v) of all its rates, and
then those of friction mu(v, w) and of f. They say whether all of the cell is stable, or none of it. A cell without a certain answer
is halved, until only narrow ones are left: there stability changes. `wave_proof` decides cells of a slab.

A disturbance exp(s t) of a block under a law with one or two states solves, with n = D + S mu_v,

    (m s^2 + K) B(s) + s N(s) = 0,   one state: B = s + p, N = n s + k;   two: B = s^2 + t s + d, N = n s^2 + j s + k

so sliding is stable if and only if all of these are positive (Routh & Hurwitz), without differences of large terms:

    one state       K p,   m p + n,   n (K + k) + m p k
    two states      K d,   a1 = K t + k,   a3 = m t + n,   j a1 a3 + (n K - m k) (a1 - d a3)

Source: Rice & Ruina 1983, J. Appl. Mech. 50, 343; Rump 2010, Acta Numerica 19, for the arithmetic on discs.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache, reduce
from typing import Any, NamedTuple

import numpy as np

from stickslip.contact.wave_proof import of_slab, slope_symbols
from stickslip.foundation.arrays import Floats
from stickslip.friction.formula import (
    RATE,
    SLIP,
    STATES,
    Disc,
    Expression,
    Parameter,
    largest,
    on_discs,
    slope_formula,
    value_and_slopes,
)
from stickslip.friction.law import FrictionLaw
from stickslip.problem.bodies import BodyOnCharacteristics

CELLS = 64
"""Number of cells in a decade of slip rates, before any is halved."""
NARROW = 1e-9
"""Cells narrower than this (relative) are not halved any more."""
MOST_CELLS = 80_000
"""Largest number of cells that are examined at a time, a second of work; beyond it nothing is proven."""
NEWTON_STEPS = 3
"""Number of Newton's steps from the law's steady state to that of its formula."""
LEAST_CHANGE = 1e-3
"""Least relative change of the state, while the slip rate doubles, that discs of the state allow for."""
WIDER = 1.5
"""How much wider the disc of the state is than its change in a cell."""
_Variables = dict[Expression, Disc]


class ProvenChange(NamedTuple):
    """An interval of slip rates (m/s) with a change of stability, and whether sliding is stable above it."""

    low: float
    high: float
    stable_above: bool


def proven_changes(
    body: BodyOnCharacteristics, normal: float, law: FrictionLaw, slip: float, rates: tuple[float, float]
) -> list[ProvenChange] | None:
    """Return where stability changes between two slip rates (m/s), slowest first; None if that cannot be proven.

    `normal` is the normal load (N or Pa), and `slip` (m) one on which friction and states do not depend.
    """
    if not (body.has_waves or body.stiffness > 0.0) or not 0 < len(law.states) <= 1 + (not body.has_waves) or len(law.pieces) != 1:
        return None
    contact = _Contact(body, normal, law, slip)
    edges = np.geomspace(*rates, 1 + int(CELLS * np.log10(rates[1] / rates[0])))
    low, high, done = edges[:-1], edges[1:], []
    while len(low):
        if len(low) > MOST_CELLS:
            return None
        verdict = contact.judge(low, high)
        over = (verdict != 0) | (high - low <= NARROW * high)
        done.append(np.array([low[over], high[over], verdict[over]]))
        low, high = low[~over], high[~over]
        middle = 0.5 * (low + high)
        low, high = np.concatenate((low, middle)), np.concatenate((middle, high))
    cells = np.concatenate(done, axis=1)
    return _changes(cells[:, np.argsort(cells[0])])


def _changes(cells: Floats) -> list[ProvenChange] | None:
    """Return the changes between cells in order, whose rows are low, high and verdict; None if something stays open."""
    found: list[ProvenChange] = []
    before, open_from = 0.0, None
    for low, _, verdict in cells.T.tolist():
        if verdict == 0.0:
            open_from = low if open_from is None else open_from
            continue
        if before == 0.0 and open_from is not None:
            return None
        if before not in (0.0, verdict):
            found.append(ProvenChange(low if open_from is None else open_from, low, verdict > 0.0))
        elif open_from is not None:  # the same on both sides: it may have changed twice
            return None
        before, open_from = verdict, None
    return found if open_from is None else None


@lru_cache
def _conditions(many: int) -> tuple[Expression, ...]:
    """Return formulas of the slopes and of the body's numbers that are all positive if and only if a block is stable."""
    stiffness, damping, mass, normal = (Parameter(name) for name in ("K", "D", "m", "S"))
    (mu_v, *mu_w), *change = slope_symbols(many)
    f_v, f_w = [row[0] for row in change], [row[1:] for row in change]
    n = damping + normal * mu_v
    if many == 1:
        p = -f_w[0][0]
        k = n * p + normal * mu_w[0] * f_v[0]
        return stiffness * p, mass * p + n, n * (stiffness + k) + mass * p * k
    (one, two), (three, four) = f_w
    t, d = -(one + four), one * four - two * three
    late = mu_w[0] * (two * f_v[1] - four * f_v[0]) + mu_w[1] * (three * f_v[0] - one * f_v[1])
    k, j = n * d + normal * late, n * t + normal * (mu_w[0] * f_v[0] + mu_w[1] * f_v[1])
    a1, a3 = stiffness * t + k, mass * t + n
    return stiffness * d, a1, a3, j * a1 * a3 + (n * stiffness - mass * k) * (a1 - d * a3)


def _of_block(body: BodyOnCharacteristics, normal: float, slopes: _Variables, many: int) -> tuple[Floats, Floats]:
    """Return for each cell whether sliding is proven to be stable, and whether it is proven to be unstable."""
    numbers = {"m": body.inertia, "D": body.damping, "K": body.stiffness, "S": normal}
    found = [on_discs(one, numbers, slopes) for one in _conditions(many)]
    stable = reduce(np.logical_and, (one.centre > one.radius for one in found))
    return stable, reduce(np.logical_or, (one.centre < -one.radius for one in found))


@dataclass(frozen=True)
class _Contact:
    """A body on a contact under a law with states."""

    body: BodyOnCharacteristics
    normal: float
    law: FrictionLaw
    slip: float

    @property
    def numbers(self) -> Mapping[str, Any]:
        return self.law.numbers(0)

    def judge(self, low: Floats, high: Floats) -> Floats:
        """Return for each cell of slip rates (m/s) 1 if all of it is stable, -1 if none is, and 0 if that is open."""
        many = len(self._trees)
        with np.errstate(all="ignore"):
            cells, is_sure = self._cells(low, high)
            slopes = {
                name: slope
                for names, tree in zip(slope_symbols(many), (self.law.trees()[0], *self._trees), strict=True)
                for name, slope in zip(names, self._slopes(tree, cells), strict=True)
            }
            if self.body.has_waves:
                stable, unstable = of_slab(self.body, self.normal, slopes)
                fade = slopes[slope_symbols(1)[1][1]]
                is_sure &= fade.centre < -fade.radius
            else:
                stable, unstable = _of_block(self.body, self.normal, slopes, many)
        return np.where(is_sure, 1.0 * stable - 1.0 * unstable, 0.0)

    @property
    def _trees(self) -> tuple[Expression, ...]:
        return self.law.state_trees()

    def _cells(self, low: Floats, high: Floats) -> tuple[_Variables, Any]:
        """Return the discs of cells, and True for cells if each rate provably has one steady state in the discs of the states.

        Newton's step w - Y f(v, w), with Y close to the inverse of f_w, maps the discs of radius q into themselves if
        |Y f(centre)| + |Y f_v| r + |1 - Y f_w| q < q, with bounds of the slopes on discs of the radii r and q.
        """
        rate = 0.5 * (low + high)
        radius = np.maximum(high - rate, rate - low) * (1.0 + 1e-15)
        states = self._steady(rate)
        _, by_rate, inverse = self._at(rate, states)
        centre = self._variables(Disc.of(rate), [Disc.of(one) for one in states])
        miss = _summed(np.abs(inverse), np.array([largest(on_discs(tree, self.numbers, centre)) for tree in self._trees]))
        reach = np.maximum(np.abs(_summed(inverse, by_rate)), LEAST_CHANGE * np.abs(states) / rate) * radius
        radii = WIDER * (reach + miss)
        cells = self._variables(Disc.of(rate, radius), [Disc.of(*one) for one in zip(states, radii, strict=True)])
        is_sure = np.ones(len(rate), bool)
        slopes = [self._slopes(tree, cells) for tree in self._trees]
        for i, row in enumerate(inverse):
            most = [
                np.abs(sum(one * f[k].centre for one, f in zip(row, slopes, strict=True)) - float(k == i + 1))
                + sum(np.abs(one) * f[k].radius for one, f in zip(row, slopes, strict=True))
                for k in range(len(row) + 1)
            ]
            reached = miss[i] + most[0] * radius + sum(one * q for one, q in zip(most[1:], radii, strict=True))
            is_sure &= reached * (1.0 + 1e-9) < radii[i]
        return cells, is_sure

    def _variables(self, rate: Disc, states: Sequence[Disc]) -> _Variables:
        return {SLIP: Disc.of(self.slip), RATE: rate, **dict(zip(STATES, states, strict=False))}

    def _slopes(self, tree: Expression, cells: _Variables) -> list[Disc]:
        """Return a formula's slopes by slip rate and by each state in all of each cell."""
        by = RATE, *STATES[: len(self._trees)]
        return [on_discs(slope_formula(tree, one), self.numbers, cells) for one in by]

    def _at(self, rate: Floats, states: Floats) -> tuple[Floats, Floats, Floats]:
        """Return the rates of the states, their slopes by slip rate, and the inverse of their slopes by state."""
        found = [value_and_slopes(tree, self.numbers, self.slip, rate, *states) for tree in self._trees]
        slopes = np.array([one[1][1:] for one in found])
        matrix = slopes[:, 1:]
        if len(matrix) == 1:
            inverse = 1.0 / matrix
        else:
            (one, two), (three, four) = matrix
            inverse = np.array([[four, -two], [-three, one]]) / (one * four - two * three)
        return np.array([one[0] for one in found]), slopes[:, 0], inverse

    def _steady(self, rate: Floats) -> Floats:
        """Return the states, as formulas use them, that make the formulas of their rates zero."""
        seen = np.asarray(self.law.steady_state(rate), float).reshape(-1, len(rate))
        states = np.array([self.law.inner_states(one) for one in seen.T.tolist()]).T
        for _ in range(NEWTON_STEPS):
            value, _, inverse = self._at(rate, states)
            states = np.where(np.isfinite(step := _summed(inverse, value)), states - step, states)
        return states


def _summed(matrix: Floats, vector: Floats) -> Floats:
    """Return the product of a matrix and a vector of each cell."""
    return np.asarray(np.einsum("ij...,j...->i...", matrix, vector))
