"""Prove where steady sliding gains or loses its stability under a law with states, over a whole range of slip rates.

The range is cut into cells. In each, bounds of the slopes of f in w' = f(v, w) enclose the steady states w(v) of all its rates, and
then those of friction mu(v, w) and of f. They say whether all of the cell is stable, or none of it. A cell without a certain answer
is halved, until only narrow ones are left: there stability changes. What slopes make sliding stable is an answer of each kind of
body (`contact.kinds`).

Source: Rump 2010, Acta Numerica 19, for the arithmetic on discs.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from stickslip.foundation.arrays import Floats
from stickslip.friction import FrictionLaw
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

CELLS_OF_DECADE = 64
"""Number of cells in a decade of slip rates, before any is halved."""
NARROW_PROOF_CELL = 1e-9
"""Cells narrower than this (relative) are not halved any more."""
MOST_CELLS = 80_000
"""Examine at most this many cells at a time, a second of work; beyond it nothing is proven."""
NEWTON_STEPS = 3
"""Number of Newton's steps from the law's steady state to that of its formula."""
LEAST_CHANGE = 1e-3
"""Least relative change of the state, while the slip rate doubles, that discs of the state allow for."""
WIDER = 1.5
"""How much wider the disc of the state is than its change in a cell."""
Discs = dict[Expression, Disc]
"""The discs of variables or slopes by their symbols, with one entry for each cell."""
Judge = Callable[[Discs], tuple[Floats, Floats]]
"""What returns for each cell whether sliding is proven to be stable, and whether it is proven to be unstable."""


class ChangeBetween(NamedTuple):
    """An interval of slip rates (m/s) with a change of stability, and whether sliding is stable above it."""

    low: float
    high: float
    stable_above: bool


def slope_symbols(many: int) -> tuple[tuple[Expression, ...], ...]:
    """Return symbols of the slopes of friction, and then of the rate of each state, by slip rate and by each state."""
    states = range(1, many + 1)
    return tuple(tuple(Parameter(f"{of}_{by}") for by in ("v", *states)) for of in ("mu", *states))


def proven_changes(judge: Judge, law: FrictionLaw, slip: float, rates: tuple[float, float]) -> list[ChangeBetween] | None:
    """Return where stability changes between two slip rates (m/s), slowest first; None if that cannot be proven.

    `slip` (m) is one on which friction and states do not depend.
    """
    if len(law.pieces) != 1:
        return None
    contact = _Contact(judge, law, slip)
    edges = np.geomspace(*rates, 1 + int(CELLS_OF_DECADE * np.log10(rates[1] / rates[0])))
    low, high, done = edges[:-1], edges[1:], []
    while len(low):
        if len(low) > MOST_CELLS:
            return None
        verdict = contact.judge(low, high)
        over = (verdict != 0) | (high - low <= NARROW_PROOF_CELL * high)
        done.append(np.array([low[over], high[over], verdict[over]]))
        low, high = low[~over], high[~over]
        middle = 0.5 * (low + high)
        low, high = np.concatenate((low, middle)), np.concatenate((middle, high))
    cells = np.concatenate(done, axis=1)
    return _changes(cells[:, np.argsort(cells[0])])


def _changes(cells: Floats) -> list[ChangeBetween] | None:
    """Return the changes between cells in order, whose rows are low, high and verdict; None if something stays open."""
    found: list[ChangeBetween] = []
    before, open_from = 0.0, None
    for low, _, verdict in cells.T.tolist():
        if verdict == 0.0:
            open_from = low if open_from is None else open_from
            continue
        if before == 0.0 and open_from is not None:
            return None
        if before not in (0.0, verdict):
            found.append(ChangeBetween(low if open_from is None else open_from, low, verdict > 0.0))
        elif open_from is not None:  # the same on both sides: it may have changed twice
            return None
        before, open_from = verdict, None
    return found if open_from is None else None


@dataclass(frozen=True)
class _Contact:
    """A contact under a law with states."""

    proven: Judge
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
            stable, unstable = self.proven(slopes)
        return np.where(is_sure, 1.0 * stable - 1.0 * unstable, 0.0)

    @property
    def _trees(self) -> tuple[Expression, ...]:
        return self.law.state_trees()

    def _cells(self, low: Floats, high: Floats) -> tuple[Discs, Any]:
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

    def _variables(self, rate: Disc, states: Sequence[Disc]) -> Discs:
        return {SLIP: Disc.of(self.slip), RATE: rate, **dict(zip(STATES, states, strict=False))}

    def _slopes(self, tree: Expression, cells: Discs) -> list[Disc]:
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
