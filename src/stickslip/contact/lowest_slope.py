"""The smallest g' = Z + S dmu/dv over all slip rates, with proven bounds, for many contacts side by side.

Source: Moore, Kearfott & Cloud 2009, Introduction to Interval Analysis, ch. 11 (branch and bound).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from stickslip.contact.folds import Interval, Verdict
from stickslip.contact.slopes import MOST_EVALUATIONS, NARROW_SLOPE_CELL, SLOWEST_CELL, Integers, Pieces, cut_between, pieces_of
from stickslip.foundation.arrays import Floats
from stickslip.problem import Resistance

_TOLERANCE, _NEAR = 1e-12, 1e3
"""The search for the smallest g' ends when its two bounds differ by less than _TOLERANCE, relative to the larger of Z and |g'|. If
rounding keeps them apart by at most _NEAR times that, the smallest g' still counts as proven."""
_ROUNDING = 8.0 * float(np.finfo(float).eps)
"""Relative rounding error allowed for three operations."""
CUTS = 8
"""A cell is cut into this many parts."""
PLACES_IN_CELL = np.linspace(0.0, 1.0, 257)
"""Places in a cell where the sign of g'' is determined at once."""


class LowestOfEach(NamedTuple):
    """Hold bounds (Pa s/m) of the smallest g' of each contact, and the cell of slip rates (m/s) of the upper one."""

    at_least: Floats
    at_most: Floats
    piece: Integers
    rate: Floats
    low: Floats
    high: Floats


def find_lowest(of: Pieces, tolerance: float) -> LowestOfEach:
    """Bound the smallest g' of each contact until both bounds agree to a tolerance, relative to Z or to g' if that is larger."""
    many = int(of.contact[-1]) + 1
    nothing, left = np.full(many, np.inf), np.full(many, MOST_EVALUATIONS)
    found = LowestOfEach(nothing, nothing.copy(), np.zeros(many, np.int64), *np.zeros((3, many)))
    damping = of.damping[np.searchsorted(of.contact, np.arange(many))]
    piece, edges = np.arange(len(of.begin)), of.first_edges()
    while len(piece):
        low, high, pieces = edges[:-1], edges[1:], np.broadcast_to(piece, edges.shape)
        there, seen = of.slopes_between(pieces, edges)
        contact = of.contact[pieces]
        left -= 2 * np.bincount(contact.ravel(), minlength=many)
        _lower(found, contact, there.high, pieces, edges)
        contact = contact[1:]
        least = np.minimum(there.low[:-1], there.low[1:])
        with np.errstate(invalid="ignore"):
            reach = seen.reach(low, low + 0.5 * (high - low), high)
            least = np.fmax(seen.low, np.where(seen.bends, least, least - reach))
        enough = found.at_most - tolerance * np.maximum(damping, np.abs(found.at_most))
        done = seen.bends | (least >= enough[contact]) | (left < 0)[contact]
        done |= (high - low <= NARROW_SLOPE_CELL * high) | (high <= SLOWEST_CELL)
        np.minimum.at(found.at_least, contact[done], least[done])
        piece, edges = pieces[1:][~done], _edges_in(low[~done], high[~done])
    return found._replace(at_least=np.minimum(found.at_least, found.at_most))


def _edges_in(low: Floats, high: Floats) -> Floats:
    """Return the edges (m/s) of the parts of cells, which are cut as `cut_between` does."""
    edges = [low, high]
    while len(edges) <= CUTS:
        edges = [edges[0], *(one for pair in pairwise(edges) for one in (cut_between(*pair), pair[1]))]
    return np.array(edges)


def _lower(found: LowestOfEach, contact: Integers, at_most: Floats, piece: Integers, edges: Floats) -> None:
    """Lower the upper bounds of the smallest g' to its values at edges; it is then sought between the neighbours of these edges."""
    order = np.lexsort((at_most.ravel(), contact.ravel()))
    by_contact = contact.ravel()[order]
    best = order[np.append(True, by_contact[1:] != by_contact[:-1])]
    best = best[at_most.ravel()[best] < found.at_most[contact.ravel()[best]]]
    below, above = np.vstack((edges[:1], edges[:-1])), np.vstack((edges[1:], edges[-1:]))
    for column, values in zip(found[1:], (at_most, piece, edges, below, above), strict=True):
        column[contact.ravel()[best]] = values.ravel()[best]


def polished(of: Pieces, found: LowestOfEach) -> tuple[Floats, Floats]:
    """Return the slip rate (m/s) of the smallest g' of each contact and its value (Pa s/m) to rounding, where g'' changes sign."""
    low, high = found.low, found.high
    for _ in range(64):
        rates = low + PLACES_IN_CELL[:, None] * (high - low)
        rates[-1] = high
        if not ((low < rates[1:-1]) & (rates[1:-1] < high)).any():
            break
        seen = of.slopes(np.tile(found.piece, len(PLACES_IN_CELL)), rates.ravel(), rates.ravel())
        rises = (seen.bend_low + seen.bend_high).reshape(rates.shape) > 0.0
        rises[-1] = True
        k, each = rises.argmax(axis=0), np.arange(len(low))
        low, high = rates[np.maximum(k - 1, 0), each], rates[k, each]
    places = np.array([found.low, low, found.rate, high, found.high])
    seen = of.slopes(np.tile(found.piece, len(places)), places.ravel(), places.ravel())
    values = 0.5 * (seen.low + seen.high).reshape(places.shape)
    best = values.argmin(axis=0), np.arange(len(low))
    return places[best], values[best]


@dataclass(frozen=True)
class LowestSlope:
    """The smallest g' (Pa s/m) at slip rates up to 1e30 m/s: proven bounds, its value to rounding, and where it is (m/s).

    The verdict is "not decided" if the lower bound could not be brought close to the upper one.
    """

    verdict: Verdict
    at_least: float
    at_most: float
    slope: float
    rate: float


@lru_cache(maxsize=64)
def lowest_slope(g: Resistance) -> LowestSlope:
    """Return `lowest_slopes` of one contact."""
    return lowest_slopes([g])[0]


def lowest_slopes(contacts: Sequence[Resistance], tolerance: float = _TOLERANCE) -> list[LowestSlope]:
    """Bound the smallest g' of each contact, and find it to rounding, for contacts under laws of one kind.

    The tolerance of the bounds is relative to the larger of Z and the smallest g' itself.
    """
    if not contacts:
        return []
    pieces = pieces_of(contacts)
    found = find_lowest(pieces, tolerance)
    columns = (one.tolist() for one in (found.at_least, found.at_most, *polished(pieces, found)))
    lowest = []
    for g, least, most, rate, slope in zip(contacts, *columns, strict=True):
        near = most - least <= _NEAR * tolerance * max(g.damping, abs(most))
        lowest.append(LowestSlope("proven" if near else "not decided", least, most, slope, rate))
    return lowest


def critical_stress_between(g: Resistance) -> Interval | None:
    """Enclose the critical normal stress Z / max(-dmu/dv) (Pa) by the bounds of the smallest g'.

    Returns None if friction is not proven to fall with the slip rate, if it steps down as slip begins, or without finite bounds.
    """
    if not g.law.depends_on_rate or g.law.static_excess > 0.0:
        return None
    lowest = lowest_slope(g)
    steepest, at_least = ((g.damping - bound) / g.normal for bound in (lowest.at_least, lowest.at_most))
    if not (at_least > 0.0 and math.isfinite(steepest)):
        return None
    return g.damping / steepest * (1.0 - _ROUNDING), g.damping / at_least * (1.0 + _ROUNDING)
