"""Bounds of g' = Z + S dmu/dv and of g'' on cells of slip rates, for many contacts side by side.

The formulas of their laws are bounded by interval arithmetic that includes rounding (`friction.formula.bounds.Enclosure`).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from stickslip.foundation.arrays import Floats, Floats1, Floats2, Integers1
from stickslip.foundation.kernels.kernels import exact, exact_entry
from stickslip.friction.formula import (
    AtPoints,
    Enclosure,
    Expression,
    OnCells,
    add,
    enclose,
    multiply,
    points_of,
    tape_of_changes,
)
from stickslip.problem import Resistance

Integers = NDArray[np.int64]

FASTEST_BOUNDED = 1e30
"""Bounds of g' cover slip rates up to this (m/s); no contact is that fast."""
SLOWEST_CELL = 1e-100
"""Cells below this slip rate (m/s) are not cut any more."""
BELOW, ABOVE = 1e-4, 1e4
"""The first cells have ends in the ratio RATIO between these multiples of the slowest and the fastest scale of a contact."""
RATIO, FAR = 16.0, 1e12
"""Ratio of the ends of the first cells, and of those beyond the fastest scale, where g' hardly changes."""
NARROW_SLOPE_CELL = 1e-15
"""Cells narrower than this, relative to their upper end, are not cut any more."""
MOST_EVALUATIONS = 200_000
"""Largest number of bounds of g' (on cells and at single rates) for one contact; remaining cells are left undecided."""


class Bounds(NamedTuple):
    """Bounds of g' (Pa s/m) and of g'' (Pa s2/m2) on one cell."""

    low: float
    high: float
    bend_low: float
    bend_high: float


DAMPING, NORMAL, SLOW, FAST, BEGIN, END = range(6)
"""Columns of `Contacts.pieces`, which are the fields of `Pieces` with the same names."""


class Contacts(NamedTuple):
    """What compiled code needs to bound g': the formulas of the pieces of the laws, and six numbers of each piece."""

    formulas: OnCells
    pieces: Floats2


@exact
def slope_bounds(of: Contacts, piece: int, low: float, high: float) -> Bounds:
    """Bound g' and g'' on a cell of slip rates (m/s)."""
    w, normal, damping = of.formulas.room, of.pieces[piece, NORMAL], of.pieces[piece, DAMPING]
    row = enclose(of.formulas, piece, low, high)
    a, b = multiply(normal, normal, w[row, 1], w[row, 4])
    a, b = add(damping, damping, a, b)
    c, d = multiply(2.0 * normal, 2.0 * normal, w[row, 2], w[row, 5])
    return Bounds(a, b, c, d)


@exact
def sign_of(of: Bounds) -> int:
    """Return the sign that all values of g' in a cell share, or 0 if they do not share one."""
    return 1 if of.low > 0.0 else -1 if of.high < 0.0 else 0


@exact
def bend_sign(of: Bounds) -> int:
    """Return the sign that all values of g'' in a cell share, or 0 if they do not share one."""
    return 1 if of.bend_low > 0.0 else -1 if of.bend_high < 0.0 else 0


@exact
def reach_of(of: Bounds, low: float, middle: float, high: float) -> float:
    """Return how far g' may be from its value in the middle of a cell, by the mean value theorem."""
    steepest = max(abs(of.bend_low), abs(of.bend_high))
    return steepest * max(high - middle, middle - low) * (1.0 + 1e-15)


@exact
def cut(low: float, high: float) -> float:
    """Return where a cell is cut: in the geometric middle if its ends differ by more than a factor of four."""
    if low == 0.0:
        return high / RATIO
    return math.sqrt(low) * math.sqrt(high) if high > 4.0 * low else 0.5 * (low + high)


class Slopes(NamedTuple):
    """Hold bounds of g' (Pa s/m) and of g'' (Pa s2/m2) on cells."""

    low: Floats
    high: Floats
    bend_low: Floats
    bend_high: Floats

    @property
    def sign(self) -> Integers:
        """The sign that all values of g' in a cell share, or 0 if they do not share one."""
        return 1 * (self.low > 0.0) - 1 * (self.high < 0.0)

    @property
    def bends(self) -> NDArray[np.bool_]:
        """True if g'' keeps its sign in a cell."""
        return (self.bend_low > 0.0) | (self.bend_high < 0.0)

    def reach(self, low: Floats, middle: Floats, high: Floats) -> Floats:
        """Return how far g' may be from its value in the middle of a cell, by the mean value theorem."""
        steepest = np.maximum(np.abs(self.bend_low), np.abs(self.bend_high))
        return steepest * np.maximum(high - middle, middle - low) * (1.0 + 1e-15)


@dataclass(frozen=True)
class Pieces:
    """The pieces of the laws of many contacts, with one entry for each: those of a contact follow each other, slowest first."""

    trees: Sequence[Expression]
    formula: Integers
    """Place of each piece's formula in `trees`."""
    contact: Integers
    """Number of each piece's contact, ascending."""
    numbers: dict[str, Floats]
    """The law's numbers, by name."""
    slip: Floats  # m: law slip
    damping: Floats  # Z, Pa s/m, or that of a block, N s/m
    normal: Floats  # S, Pa
    slowest: Floats  # slowest and fastest scale of the contact, m/s
    fastest: Floats
    begin: Floats  # m/s: smallest and largest slip rate of the piece
    end: Floats

    def friction(self, piece: Integers, low: Floats, high: Floats) -> Floats:
        """Bound mu, dmu/dv and half of d2mu/dv2 on cells of slip rates (m/s), shape (2, 3, cells)."""
        return self.enclosure.on(low, high, piece)

    @cached_property
    def enclosure(self) -> Enclosure:
        """The bounds of the pieces' formulas."""
        return Enclosure(tuple(self.trees), self.numbers, self.slip, self.formula)

    def slopes(self, piece: Integers, low: Floats, high: Floats) -> Slopes:
        """Bound g' and g'' on cells of slip rates (m/s)."""
        found = np.empty((4, len(low)))
        bound_cells(self.for_code, piece, np.ascontiguousarray(low), np.ascontiguousarray(high), found)
        return Slopes(*found)

    @cached_property
    def for_code(self) -> Contacts:
        """What compiled code needs to bound g'."""
        of = (self.damping, self.normal, self.slowest, self.fastest, self.begin, self.end)
        return Contacts(self.enclosure.formulas, np.column_stack(of))

    @cached_property
    def points(self) -> AtPoints:
        """What compiled code needs for friction at slip rates."""
        numbers = np.empty((len(self.slip), len(self.numbers) + 1))
        for column, values in zip(numbers.T, (*self.numbers.values(), self.slip), strict=True):
            column[:] = values
        return points_of(tape_of_changes(tuple(self.trees), tuple(self.numbers)), self.formula, numbers)

    def slopes_between(self, piece: Integers, edges: Floats) -> tuple[Slopes, Slopes]:
        """Bound g' and g'' at edges, and on the cells between those that follow each other along the first axis."""
        low, high = np.concatenate((edges, edges[:-1])), np.concatenate((edges, edges[1:]))
        both = self.slopes(np.concatenate((piece, piece[1:])).ravel(), low.ravel(), high.ravel())
        columns = [column.reshape(low.shape) for column in both]
        return Slopes._make(one[: len(edges)] for one in columns), Slopes._make(one[len(edges) :] for one in columns)

    def first_edges(self) -> Floats:
        """Return the edges (m/s) of the first cells of each piece, shape (edges, pieces): its upper end is repeated."""
        start = np.maximum(BELOW * self.slowest, SLOWEST_CELL)
        edges = [self.begin]
        while (edges[-1] < self.end).any():
            after = np.where(edges[-1] < ABOVE * self.fastest, RATIO, FAR) * edges[-1]
            after = np.where(edges[-1] < 0.5 * start, start, after)
            edges.append(np.where(2.0 * after > self.end, self.end, after))
        return np.array(edges)


@exact_entry
def bound_cells(of: Contacts, piece: Integers1, low: Floats1, high: Floats1, found: Floats2) -> None:
    """Bound g' and g'' on cells of slip rates (m/s); `found` has the rows of `Slopes`."""
    for k in range(len(low)):
        found[0, k], found[1, k], found[2, k], found[3, k] = slope_bounds(of, piece[k], low[k], high[k])


def pieces_of(contacts: Sequence[Resistance], reach: float = FASTEST_BOUNDED) -> Pieces:
    """Return the input for bounds of g' up to a slip rate (m/s), for contacts under laws of one kind."""
    formulas: dict[Expression, int] = {}
    rows, values = [], []
    for n, g in enumerate(contacts):
        knots = [knot for knot in g.rate_knots if knot < reach]
        pieces = np.atleast_1d(g.law.piece_at(g.law_slip, np.array([0.0, *knots]))).tolist()
        scales = min(g.scales), max(g.scales)
        for i, begin, end in zip(pieces, [0.0, *knots], [*knots, reach], strict=True):
            formula = formulas.setdefault(g.trees[i], len(formulas))
            rows.append((formula, n, g.law_slip, g.damping, g.normal, *scales, begin, end))
            values.append(g.law.piece_values(i))
    formula_of, contact, *numbers = np.array(rows).T
    named = dict(zip(contacts[0].law.parameters(), np.array(values, float).reshape(len(rows), -1).T, strict=True))
    return Pieces(tuple(formulas), formula_of.astype(int), contact.astype(int), named, *numbers)


def cut_between(low: Floats, high: Floats) -> Floats:
    """Return where cells are cut: in the geometric middle if their ends differ by more than a factor of four."""
    middle = np.where(high > 4.0 * low, np.sqrt(low) * np.sqrt(high), 0.5 * (low + high))
    return np.where(low == 0.0, high / RATIO, middle)
