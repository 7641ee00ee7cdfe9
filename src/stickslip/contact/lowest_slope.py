"""The smallest g' = Z + S dmu/dv over all slip rates, with proven bounds, for many contacts side by side.

Source: Moore, Kearfott & Cloud 2009, Introduction to Interval Analysis, ch. 11 (branch and bound).
"""

from __future__ import annotations

from itertools import pairwise
from typing import NamedTuple

import numpy as np

from stickslip.contact.slopes import MOST_EVALUATIONS, NARROW, SLOWEST, Integers, Pieces, cut_between
from stickslip.foundation.arrays import Floats

CUTS = 8
"""Number of parts into which a cell is cut."""
PARTS = np.linspace(0.0, 1.0, 65)
"""Places in a cell at which the sign of g'' is asked for at once."""


class Lowest(NamedTuple):
    """Hold bounds (Pa s/m) of the smallest g' of each contact, and in which cell of slip rates (m/s) the upper one was found."""

    at_least: Floats
    at_most: Floats
    piece: Integers
    rate: Floats
    low: Floats
    high: Floats


class _Cells(NamedTuple):
    """Hold cells (m/s) with the lower bounds of g' (Pa s/m) at their ends."""

    piece: Integers
    low: Floats
    high: Floats
    at_low: Floats
    at_high: Floats


def find_lowest(of: Pieces, tolerance: float) -> Lowest:
    """Bound the smallest g' of each contact until both bounds agree to a tolerance, relative to Z or to g' if that is larger."""
    many = int(of.contact[-1]) + 1
    least, left = np.full(many, np.inf), np.full(many, MOST_EVALUATIONS)
    found = Lowest(least, least.copy(), np.zeros(many, np.int64), *np.zeros((3, many)))
    damping = of.damping[np.searchsorted(of.contact, np.arange(many))]
    cells = _cells_between(of, found, np.arange(len(of.begin)), of.first_edges())
    while True:
        contact, width = of.contact[cells.piece], cells.high - cells.low
        seen = of.slopes(cells.piece, cells.low, cells.high)
        left -= CUTS * np.bincount(contact, minlength=many)
        at_ends = np.minimum(cells.at_low, cells.at_high)
        with np.errstate(invalid="ignore"):
            reach = seen.reach(cells.low, cells.low + 0.5 * width, cells.high)
            least = np.fmax(seen.low, np.where(seen.bends, at_ends, at_ends - reach))
        enough = found.at_most - tolerance * np.maximum(damping, np.abs(found.at_most))
        done = seen.bends | (least >= enough[contact]) | (left < 0)[contact]
        done |= (width <= NARROW * cells.high) | (cells.high <= SLOWEST)
        np.minimum.at(found.at_least, contact[done], least[done])
        if done.all():
            break
        cells = _Cells._make(column[~done] for column in cells)
        cells = _cells_between(of, found, cells.piece, _edges_in(cells.low, cells.high))
    return found._replace(at_least=np.minimum(found.at_least, found.at_most))


def _edges_in(low: Floats, high: Floats) -> Floats:
    """Return the edges (m/s) of the parts of cells, which are cut as `cut_between` does."""
    edges = [low, high]
    while len(edges) <= CUTS:
        edges = [edges[0], *(one for pair in pairwise(edges) for one in (cut_between(*pair), pair[1]))]
    return np.array(edges)


def _cells_between(of: Pieces, found: Lowest, piece: Integers, edges: Floats) -> _Cells:
    """Return the cells of pieces between edges of shape (edges, pieces), and take g' at the edges into account."""
    pieces = np.broadcast_to(piece, edges.shape)
    there = of.slopes(pieces.ravel(), edges.ravel(), edges.ravel())
    contact, at_most = of.contact[pieces.ravel()], there.high
    order = np.lexsort((at_most, contact))
    best = order[np.append(True, contact[order][1:] != contact[order][:-1])[: len(order)]]
    best = best[at_most[best] < found.at_most[contact[best]]]
    above, below = (np.roll(edges, shift, axis=0) for shift in (-1, 1))
    above[-1], below[0] = edges[-1], edges[0]
    news = at_most, pieces.ravel(), edges.ravel(), below.ravel(), above.ravel()
    for column, values in zip(found[1:], news, strict=True):
        column[contact[best]] = values[best]
    at, some = there.low.reshape(edges.shape), edges[:-1] < edges[1:]
    return _Cells._make(one[some] for one in (pieces[1:], edges[:-1], edges[1:], at[:-1], at[1:]))


def polished(of: Pieces, found: Lowest) -> tuple[Floats, Floats]:
    """Return the slip rate (m/s) of the smallest g' of each contact and its value (Pa s/m) to rounding, where g'' changes sign."""
    low, high = found.low, found.high
    for _ in range(64):
        rates = low + PARTS[:, None] * (high - low)
        rates[-1] = high
        if not ((low < rates[1:-1]) & (rates[1:-1] < high)).any():
            break
        seen = of.slopes(np.tile(found.piece, len(PARTS)), rates.ravel(), rates.ravel())
        rises = (seen.bend_low + seen.bend_high).reshape(rates.shape) > 0.0
        rises[-1] = True
        k, each = rises.argmax(axis=0), np.arange(len(low))
        low, high = rates[np.maximum(k - 1, 0), each], rates[k, each]
    places = np.array([found.low, low, found.rate, high, found.high])
    seen = of.slopes(np.tile(found.piece, len(places)), places.ravel(), places.ravel())
    values = 0.5 * (seen.low + seen.high).reshape(places.shape)
    best = values.argmin(axis=0), np.arange(len(low))
    return places[best], values[best]
