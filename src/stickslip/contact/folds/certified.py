"""Proof of the folds: all slip rates at which g' = Z + S dmu/dv changes sign, by interval arithmetic and bisection.

A cell (an interval of slip rates) is settled if the bounds of g' on it exclude 0: it then holds no root. It is also settled if g''
keeps one sign on it and g' has opposite signs at its ends: it then holds exactly one root. Other cells are subdivided. Cells that
remain open because of rounding are reported as undecided.

Source: Moore, Kearfott & Cloud 2009, Introduction to Interval Analysis, ch. 8 (bisection with the mean value form).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from stickslip.contact.equation import Resistance
from stickslip.contact.folds.slope_bounds import Cells, Floats, SlopeBounds, joined
from stickslip.friction.formula.enclosure import NotEnclosedError

Verdict = Literal["proven", "not decided", "searched"]
"""proven: by interval arithmetic. not decided: proven except on some intervals of slip rates. searched: on a grid, unproven."""

MOST_EVALUATIONS = 200_000
"""Largest number of cells and single rates at which g' is bounded, about 0.2 s; cells that remain are left undecided."""

Interval = tuple[float, float]


@dataclass(frozen=True)
class Certificate:
    """A proof of the roots of g' at slip rates from 0 to 1e100 m/s; intervals are of slip rates (m/s), ascending."""

    verdict: Verdict
    turns: tuple[Interval, ...] = ()
    """Intervals that hold exactly one change of sign of g' each; outside them and `undecided` there is none."""
    undecided: tuple[Interval, ...] = ()
    """Intervals in which neither a root nor its absence is proven."""
    rises_at_rest: bool | None = None
    """True if g rises at 0+, None if that is not decided."""
    evaluations: int = 0
    """Number of cells and single rates at which g' was bounded."""

    @property
    def always_rises(self) -> bool:
        """True if g is proven to rise at all rates above 0: there is then one branch and nothing to search."""
        return self.verdict == "proven" and not self.turns and self.rises_at_rest is True


def certificate(g: Resistance) -> Certificate:
    """Prove where g' changes sign; the verdict is "searched" if the law has no guaranteed bounds."""
    bounds = SlopeBounds(g)
    try:
        return _certified(bounds)
    except NotEnclosedError:
        return Certificate("searched")


@dataclass(frozen=True)
class _Signs:
    """Signs on cells (0: not known) of g' at both ends and on the whole cell and of g'' on the whole cell, and a flag.

    The flag `hopeless` marks cells that are not worth subdividing.
    """

    at_low: NDArray[np.int8]
    at_high: NDArray[np.int8]
    inside: NDArray[np.int8]
    bend: NDArray[np.int8]
    hopeless: NDArray[np.bool_]

    def __getitem__(self, chosen: NDArray[np.bool_] | NDArray[np.intp]) -> _Signs:
        return _Signs(*(getattr(self, name)[chosen] for name in ("at_low", "at_high", "inside", "bend", "hopeless")))

    @property
    def turns(self) -> NDArray[np.bool_]:
        """True for each cell that holds exactly one root of g'."""
        return np.asarray((self.bend != 0) & (self.at_low * self.at_high < 0))


def _certified(bounds: SlopeBounds) -> Certificate:
    cells = bounds.first_cells()
    edges, spent = _at_knots(bounds, cells), 0
    none = cells[np.zeros(0, np.intp)]
    turns, kept = [none], [none]
    while len(cells):
        spent += 4 * len(cells)
        signs = _signs(bounds, cells)
        turns.append(cells[signs.turns])
        open_ = (signs.inside == 0) & ~signs.turns
        cells, signs = cells[open_], signs[open_]
        if not len(cells):
            break
        more, settled = _unions(cells, signs)
        turns.append(more)
        cells, signs = cells[~settled], signs[~settled]
        kept.append(cells[signs.hopeless])
        cells = cells[~signs.hopeless]
        if spent + 4 * cells.parts * len(cells) > MOST_EVALUATIONS:
            kept.append(cells)
            break
        cells = cells.split(cells.parts)
    at_rest, knots, loose = edges
    undecided = _merged([*_intervals(joined(kept)), *loose])
    found = sorted([*_intervals(joined(turns)), *knots])
    return Certificate("not decided" if undecided else "proven", tuple(found), undecided, at_rest, spent)


def _intervals(cells: Cells) -> list[Interval]:
    return list(zip(cells.low.tolist(), cells.high.tolist(), strict=True))


def _merged(intervals: list[Interval]) -> tuple[Interval, ...]:
    """Join intervals that touch or overlap, and return them ascending."""
    found: list[Interval] = []
    for low, high in sorted(intervals):
        if found and low <= found[-1][1]:
            found[-1] = (found[-1][0], max(found[-1][1], high))
        else:
            found.append((low, high))
    return tuple(found)


def sign_of(bounds: Floats) -> NDArray[np.int8]:
    """Return the sign that all numbers between two bounds share, or 0 if they do not share one."""
    return np.asarray((bounds[0] > 0.0).astype(np.int8) - (bounds[1] < 0.0).astype(np.int8))


def _signs(bounds: SlopeBounds, cells: Cells) -> _Signs:
    """Return the signs on cells that follow from the bounds of g' and g''."""
    seen = bounds.look(cells)
    low, high, bend, inside = (sign_of(one) for one in (seen.at_low, seen.at_high, seen.second, seen.inside))
    monotone = np.where((bend != 0) & (low * high > 0), low, 0)
    inside = np.where(inside != 0, inside, monotone).astype(np.int8)
    return _Signs(low, high, inside, bend, seen.hopeless & (sign_of(seen.at_middle) == 0) | cells.at_rounding)


def _unions(cells: Cells, signs: _Signs) -> tuple[Cells, NDArray[np.bool_]]:
    """Settle chains of adjacent cells on which g'' keeps one sign and at whose outer ends the sign of g' is known.

    A root at the common edge of two cells leaves both of them open, while their union can be settled. Returns the unions that hold
    one root, and for each cell whether a union has settled it, with or without a root.
    """
    order = np.argsort(cells.low)
    one, two = order[:-1], order[1:]
    alike = (signs.bend[one] != 0) & (signs.bend[one] == signs.bend[two]) & (cells.piece[one] == cells.piece[two])
    apart = ~(alike & (cells.high[one] == cells.low[two]) & (signs.at_high[one] == 0))
    first = np.flatnonzero(np.concatenate(([True], apart)))
    last = np.flatnonzero(np.concatenate((apart, [True])))
    outer = signs.at_low[order[first]] * signs.at_high[order[last]]
    done = (outer != 0) & (last > first)
    settled = np.zeros(len(cells), bool)
    settled[order] = np.repeat(done, last - first + 1)
    low, high = order[first[done & (outer < 0)]], order[last[done & (outer < 0)]]
    return Cells(cells.low[low], cells.high[high], cells.piece[low]), settled


def _at_knots(bounds: SlopeBounds, cells: Cells) -> tuple[bool | None, list[Interval], list[Interval]]:
    """Compare the signs of g' on the two sides of each knot.

    Returns whether g rises at 0+ (None: not decided), the knots at which g' changes sign, and the intervals left undecided. The
    last cell is one of these if g is not proven to rise at its upper end.
    """
    knots = np.array(bounds.g.rate_knots)
    first = bounds(Cells(np.zeros(1), np.zeros(1), cells.piece[:1]))[0]
    rest = int(sign_of(first)[0])
    last = cells[np.array([len(cells) - 1])]
    ends = sign_of(bounds(last.at(last.high))[0])
    loose = [] if ends[0] > 0 else [(float(last.low[0]), float(last.high[0]))]
    if not len(knots):
        return (None if rest == 0 else rest > 0), [], loose
    below = sign_of(bounds(Cells(knots, knots, bounds.piece_from(np.nextafter(knots, 0.0))))[0])
    above = sign_of(bounds(Cells(knots, knots, bounds.piece_from(knots)))[0])
    turns = [(knot, knot) for knot in knots[below * above < 0].tolist()]
    loose += [(knot, knot) for knot in knots[below * above == 0].tolist()]
    return (None if rest == 0 else rest > 0), turns, loose
