"""Find all slip rates where g' = Z + S dmu/dv changes its sign, with proof, for many contacts side by side.

A cell (an interval of slip rates) holds no turn if the bounds of g' on it leave out 0, and exactly one if g'' keeps its sign there
while g' has opposite signs at its ends. Any other cell is cut in two. Cells that rounding keeps open are undecided.

Source: Moore, Kearfott & Cloud 2009, Introduction to Interval Analysis, ch. 8 (interval Newton, mean value form) and ch. 11.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from stickslip.contact.slopes import MOST_EVALUATIONS, NARROW, SLOWEST, Integers, Pieces, cut_between
from stickslip.foundation.arrays import Floats

NOISE = 4.0
"""A cell is not worth cutting if g' changes on it by no more than this multiple of the rounding of its bounds."""
NUDGES = 4
"""Number of places to try for a cut, until the sign of g' is known there."""
MOST_WAITING = 256
"""Largest number of cells of one contact to examine together: the slowest come first, as there may be no end of turns."""
UNDECIDED, PROVEN, FLAT = 0, 1, 2
"""Knowledge about an interval: none; that it holds exactly one turn; that it holds a whole piece of the law and friction falls on
this piece exactly as fast as Z v rises."""


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

    def and_(self, others: Cells) -> Cells:
        """Return the cells and others."""
        return Cells._make(np.concatenate(pair) for pair in zip(self, others, strict=True))


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
    search = _TurnSearch(of, budget, most)
    waiting, at_rest, at_end = search.first_cells()
    knots = np.flatnonzero((of.contact[1:] == of.contact[:-1]) & (at_end[:-1] * at_rest[1:] <= 0)) + 1
    found = Cells(knots, of.begin[knots], of.begin[knots], at_end[knots - 1], at_rest[knots])
    search.keep(found, np.where(found.before * found.after < 0, PROVEN, UNDECIDED))
    while len(waiting.low):
        cells, waiting = search.slowest(waiting)
        waiting = waiting.and_(search.halves(cells))
    cells, known = _joined(of, *search.sorted())
    whole = _holds_a_piece(of, cells) & (known == UNDECIDED)
    known = np.where(whole, FLAT, known)
    sharp = (known == PROVEN) & (cells.low < cells.high)
    low, high = cells.low.copy(), cells.high.copy()
    low[sharp], high[sharp] = _narrowed(of, cells.some(sharp))
    return Turns(cells._replace(low=low, high=high), known, at_rest, at_end, int((budget - search.left).sum()))


class _TurnSearch:
    """A search for turns: what it has found, and how many bounds it may still work out."""

    def __init__(self, of: Pieces, budget: int, most: int) -> None:
        many = int(of.contact[-1]) + 1
        self.of, self.most = of, most
        self.left, self.turns = np.full(many, budget), np.zeros(many, np.int64)
        self._found: list[tuple[Cells, Integers]] = []

    def count(self, piece: Integers) -> Integers:
        """Return how many of some cells belong to each contact."""
        return np.bincount(self.of.contact[piece], minlength=len(self.left))

    def sorted(self) -> tuple[Cells, Integers]:
        """Return what is found by piece, ascending."""
        columns, known = zip(*self._found, strict=True)
        cells = Cells._make(np.concatenate(one) for one in zip(*columns, strict=True))
        order = np.lexsort((cells.high, cells.low, cells.piece))
        return cells.some(order), np.concatenate(known)[order]

    def keep(self, cells: Cells, known: int | Integers) -> None:
        """Note what is known of cells."""
        each = np.broadcast_to(known, cells.low.shape)
        self._found.append((cells, each))
        self.turns += self.count(cells.piece[each == PROVEN])

    def slowest(self, cells: Cells) -> tuple[Cells, Cells]:
        """Return the slowest cells of each contact, to be examined next, and those that wait.

        The remaining cells of a contact are noted as undecided if its search is over.
        """
        room = np.where(self.turns > self.most, 0, np.clip(self.left // 2, 0, MOST_WAITING))
        if (self.count(cells.piece) > room).any():
            order = np.lexsort((cells.low, cells.piece))
            cells = cells.some(order)
            contact = self.of.contact[cells.piece]
            rank = np.arange(len(contact)) - np.searchsorted(contact, contact)
            self.keep(cells.some(room[contact] == 0), UNDECIDED)
            return cells.some(rank < room[contact]), cells.some((rank >= room[contact]) & (room[contact] > 0))
        return cells, cells.some(slice(0))

    def signs(self, piece: Integers, rate: Floats) -> Integers:
        """Return the sign of g' at slip rates."""
        self.left -= self.count(piece)
        return self.of.slopes(piece, rate, rate).sign

    def known_places(self, piece: Integers, low: Floats, place: Floats, high: Floats, sign: Integers) -> tuple[Floats, Integers]:
        """Return places in cells where the sign of g' is known, if there are any, and these signs."""
        place, sign = place.copy(), sign.copy()
        for k in range(1, NUDGES):
            open_ = np.flatnonzero(sign == 0)
            if not len(open_):
                break
            to, share = (high, 0.2 * k) if k % 2 == 1 else (low, 0.2 * k)
            other = place[open_] + share * (to[open_] - place[open_])
            found = self.signs(piece[open_], other)
            sign[open_] = found
            place[open_] = np.where(found != 0, other, place[open_])
        return place, sign

    def first_cells(self) -> tuple[Cells, Integers, Integers]:
        """Return the cells of all pieces, before any is cut, and the signs of g' at the lower and upper ends of the pieces."""
        edges = self.of.first_edges()
        piece = np.broadcast_to(np.arange(edges.shape[1]), edges.shape)
        sign = self.signs(piece.ravel(), edges.ravel()).reshape(edges.shape)
        inner = np.nonzero((edges > self.of.begin) & (edges < self.of.end))
        place, upper = edges[inner], np.minimum(self.of.end[inner[1]], 2.0 * edges[inner])
        edges[inner], sign[inner] = self.known_places(piece[inner], edges[inner[0] - 1, inner[1]], place, upper, sign[inner])
        cells = Cells(piece[1:], edges[:-1], edges[1:], sign[:-1], sign[1:])
        return cells.some(edges[:-1] < edges[1:]), sign[0], sign[-1]

    def halves(self, cells: Cells) -> Cells:
        """Return the halves of the cells that are still open; note the results for the others."""
        low, high = cells.low, cells.high
        middle = cut_between(low, high)
        seen, there = self.of.seen(cells.piece, low, middle, high)
        self.left -= 2 * self.count(cells.piece)
        change = cells.before * cells.after
        reach = seen.reach(low, middle, high)
        proven = (seen.sign == 0) & seen.bends & (change < 0)
        clear = (seen.sign != 0) | (seen.bends & (change > 0)) | (there.low - reach > 0.0) | (there.high + reach < 0.0)
        noisy = (there.sign == 0) & (reach <= NOISE * (there.high - there.low))
        self.keep(cells.some(proven), PROVEN)
        rest = ~(proven | clear)
        stuck = noisy | (high - low <= NARROW * high) | (high <= SLOWEST)
        self.keep(cells.some(rest & stuck), UNDECIDED)
        rest &= ~stuck
        cells, middle, sign = cells.some(rest), middle[rest], there.sign[rest]
        middle, sign = self.known_places(cells.piece, cells.low, middle, cells.high, sign)
        return cells._replace(high=middle, after=sign).and_(cells._replace(low=middle, before=sign))


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


def _narrowed(of: Pieces, cells: Cells) -> tuple[Floats, Floats]:
    """Narrow intervals with one turn by bisection and interval Newton steps, until rounding of g' hides where the turn lies."""
    ends, left = np.array([cells.low, cells.high]), np.arange(len(cells.low))
    for _ in range(200):
        left = left[ends[1, left] - ends[0, left] > NARROW * ends[1, left]]
        if not len(left):
            break
        (low, high), piece = ends[:, left], cells.piece[left]
        width, middle = high - low, cut_between(low, high)
        seen, there = of.seen(piece, low, middle, high)
        sign, before = there.sign, cells.before[left]
        low, high = np.where(sign == before, middle, low), np.where(sign == -before, middle, high)
        with np.errstate(all="ignore"):
            sizes = np.abs((seen.bend_low, seen.bend_high))
            gentle, steep = sizes.min(axis=0), sizes.max(axis=0)
            rises = seen.bend_low > 0.0
            least, most = np.where(rises, there.low, -there.high), np.where(rises, there.high, -there.low)
            newton = middle - most / np.where(most > 0.0, gentle, steep), middle - least / np.where(least > 0.0, steep, gentle)
            low = np.where(seen.bends, np.maximum(low, newton[0] - 1e-15 * np.abs(newton[0])), low)
            high = np.where(seen.bends, np.minimum(high, newton[1] + 1e-15 * np.abs(newton[1])), high)
        ends[:, left] = low, high
        left = left[(sign != 0) | (high - low < 0.75 * width)]
    return ends[0], ends[1]


def folds_of(turns: Turns, slope: Callable[[Floats, Integers], Floats], parts: int = 64) -> tuple[Floats, Integers]:
    """Return the slip rates of the ends of branches, by contact and ascending, and the piece of each.

    `slope` returns g' at slip rates under pieces, for arrays whose last axis has an entry for each piece; the interval of a fold is
    cut into `parts` parts again and again. No branch lies in a flat interval.
    """
    cells, flat = turns.cells, turns.known == FLAT
    rates = np.array([cells.low, cells.high])
    sharp = turns.changes & ~flat & (cells.low < cells.high)
    if sharp.any():
        rates[0, sharp] = _refined(lambda rate: slope(rate, cells.piece[sharp]), cells.low[sharp], cells.high[sharp], parts)
    chosen = np.array([np.where(flat, cells.before > 0, turns.changes), flat & (cells.after > 0)]).T
    return rates.T[chosen], np.array([cells.piece] * 2).T[chosen]


def _refined(slope: Callable[[Floats], Floats], low: Floats, high: Floats, parts: int) -> Floats:
    """Return the last, or the first, slip rate with rising g in each interval over which g' changes its sign."""
    low, high = low.copy(), high.copy()
    rising = slope(low[None])[0] > 0.0
    for _ in range(100):
        left = np.flatnonzero(high - low > 2.0 * np.spacing(high))
        if not len(left):
            break
        rates = np.linspace(low, high, parts + 1)
        other = (slope(rates)[1:] > 0.0) != rising
        k = np.where(other.any(axis=0), other.argmax(axis=0), parts - 1)[left]
        low[left], high[left] = rates[k, left], rates[k + 1, left]
    return np.where(rising, low, high)
