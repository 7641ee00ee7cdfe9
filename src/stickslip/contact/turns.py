"""Find all slip rates where g' = Z + S dmu/dv changes its sign, with proof, for many contacts side by side.

A cell (an interval of slip rates) holds no turn if the bounds of g' on it leave out 0, and exactly one if g'' keeps its sign there
while g' has opposite signs at its ends. Any other cell is cut in two. Cells that rounding keeps open are undecided.

Source: Moore, Kearfott & Cloud 2009, Introduction to Interval Analysis, ch. 8 (interval Newton, mean value form) and ch. 11.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from stickslip.contact.fold_rates import Intervals, fold_rates
from stickslip.contact.slopes import MOST_EVALUATIONS, Integers, Pieces
from stickslip.contact.turn_search import AFTER, BEFORE, COLUMNS_OF_PIECE, FLAT, HIGH, KNOWN, LOW, PIECE, UNDECIDED, Room, search
from stickslip.foundation.arrays import Floats

FIRST_ROOM = 128
"""Room for cells of a search; it grows eightfold when it is full."""


class Cells(NamedTuple):
    """Hold intervals of slip rates (m/s) of pieces, and the signs of g' at their ends, 0 where the sign is not known."""

    piece: Integers
    low: Floats
    high: Floats
    before: Integers
    after: Integers

    def some(self, chosen: Any) -> Cells:
        """Return some of the cells."""
        return Cells._make(column[chosen] for column in self)


class Turns(NamedTuple):
    """Hold intervals where g' changes its sign, proven or undecided, by contact and ascending."""

    cells: Cells
    known: Integers
    """PROVEN, UNDECIDED or FLAT."""
    at_rest: Integers
    """Sign of g' at 0+ and at the fastest rate for each piece, or 0 if that is not known."""
    at_end: Integers
    evaluations: int
    """Number of bounds of g', on cells and at single rates."""

    @property
    def changes(self) -> NDArray[np.bool_]:
        """True for intervals over which g' changes its sign."""
        return self.cells.before * self.cells.after < 0


def find_turns(of: Pieces, budget: int = MOST_EVALUATIONS, most: int = MOST_EVALUATIONS) -> Turns:
    """Find all turns of g, with at most about `budget` evaluations for each contact.

    The search for a contact ends early once it is known to turn more than `most` times.
    """
    first_piece = of.contact.searchsorted(np.arange(of.contact[-1] + 2))
    table, ends, left = _searched(of, first_piece, budget, most)
    cells, known = _cells_in(table)
    if (known == UNDECIDED).any():
        cells, known = _joined(of, cells, known)
        known = np.where(_holds_a_piece(of, cells) & (known == UNDECIDED), FLAT, known)
    return Turns(cells, known, ends[:, 0], ends[:, 1], int((budget - left).sum()))


def _searched(of: Pieces, first_piece: Integers, budget: int, most: int) -> tuple[Floats, Integers, Integers]:
    """Return the table of cells with turns, by piece and ascending, the signs of g' at the ends of pieces, and the budgets left."""
    many = FIRST_ROOM
    while True:
        waiting, found = np.empty((2, many, COLUMNS_OF_PIECE))
        ends, left = np.empty((len(of.contact), 2), np.int64), np.full(len(first_piece) - 1, budget)
        count = search(of.for_code, first_piece, most, Room(waiting, found, ends, left))
        if count >= 0:
            table = found[:count]
            return table[np.lexsort((table[:, HIGH], table[:, LOW], table[:, PIECE]))] if count > 1 else table, ends, left
        many *= 8


def _cells_in(table: Floats) -> tuple[Cells, Integers]:
    """Return the cells of a table, and what is known of them."""
    piece, before, after, known = table[:, [PIECE, BEFORE, AFTER, KNOWN]].T.astype(int)
    return Cells(piece, table[:, LOW], table[:, HIGH], before, after), known


def _joined(of: Pieces, cells: Cells, known: Integers) -> tuple[Cells, Integers]:
    """Join undecided neighbours."""
    contact = of.contact[cells.piece]
    joins = (known[1:] == UNDECIDED) & (known[:-1] == UNDECIDED) & (cells.low[1:] == cells.high[:-1])
    joins &= contact[1:] == contact[:-1]
    first, last = np.append(True, ~joins)[: len(known)], np.append(~joins, True)[: len(known)]
    begins, ends = cells.some(first), cells.some(last)
    return begins._replace(high=ends.high, after=ends.after), known[first]


def _holds_a_piece(of: Pieces, cells: Cells) -> NDArray[np.bool_]:
    """Return True for intervals with all slip rates of a piece that ends at a knot."""
    ends_at_knot = np.append(of.contact[1:] == of.contact[:-1], False)
    after = np.minimum(cells.piece + 1, len(of.end) - 1)
    found = np.zeros(len(cells.piece), bool)
    for piece in (cells.piece, after):
        same = (of.contact[piece] == of.contact[cells.piece]) & ends_at_knot[piece]
        found |= same & (cells.low <= of.begin[piece]) & (of.end[piece] <= cells.high)
    return found


def folds_of(of: Pieces, turns: Turns, parts: int = 64) -> tuple[Floats, Integers]:
    """Return the slip rates of the ends of branches, by contact and ascending, and the piece of each.

    The interval of a fold is cut into `parts` parts again and again. No branch lies in a flat interval.
    """
    cells, flat, changes = turns.cells, turns.known == FLAT, turns.changes
    rates, first = np.array([cells.low, cells.high]), changes & ~flat
    sharp = first & (cells.low < cells.high)
    if sharp.any():
        found, piece, ends = np.empty(np.count_nonzero(sharp)), cells.piece[sharp], np.ascontiguousarray(rates[:, sharp])
        fold_rates(of.points, of.for_code.pieces, Intervals(piece, ends, parts), found)
        rates[0, sharp] = found
    if not flat.any():
        return rates[0, first], cells.piece[first]
    chosen = np.array([np.where(flat, cells.before > 0, changes), flat & (cells.after > 0)]).T
    return rates.T[chosen], np.array([cells.piece] * 2).T[chosen]
