"""Folds with proof: every slip rate at which g' = Z + S dmu/dv changes its sign, by interval arithmetic and bisection.

A cell of slip rates is done when the bounds of g' on it leave out 0, or when g'' keeps one sign on it and g' has opposite signs at
its ends: then it holds exactly one root. Other cells are cut into parts. What rounding leaves open is reported, not guessed.

Source: Moore, Kearfott & Cloud 2009, Introduction to Interval Analysis, ch. 8 (bisection with the mean value form).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from stickslip.contact.resistance import Resistance
from stickslip.contact.slope_bounds import Cells, Floats, SlopeBounds, joined
from stickslip.friction.enclosure import NotEnclosedError

Verdict = Literal["proven", "not decided", "searched"]
"""proven: by interval arithmetic. not decided: so but for some intervals of slip rates. searched: on a grid, without proof."""

MOST_EVALUATIONS = 200_000
"""Cells and single rates at which g' is bounded before the rest is left undecided: some 0.2 s."""
_AT_A_TIME = 256
"""Cells that a round of cutting aims at: up to here the cost of a round hardly grows with their number."""
_MOST_PARTS, _FEWEST_PARTS = 16, 2
"""Parts into which a cell is cut in one round."""
_NOISE = 4.0
"""A cell is given up when g' changes on it by less than this multiple of the rounding of its bounds."""

Interval = tuple[float, float]


@dataclass(frozen=True)
class Certificate:
    """What is proven of the roots of g' at slip rates from 0 to 1e100 m/s. Intervals are of slip rates (m/s), ascending."""

    verdict: Verdict
    turns: tuple[Interval, ...] = ()
    """Each holds exactly one rate at which g' changes its sign; outside them and `undecided` it never does."""
    undecided: tuple[Interval, ...] = ()
    """Where neither a root nor its absence is proven."""
    rises_at_rest: bool | None = None
    """Whether g rises at 0+; None where that is not decided."""
    evaluations: int = 0
    """Cells and single rates at which g' was bounded."""


def certificate(g: Resistance) -> Certificate:
    """Prove where g' changes its sign."""
    bounds = SlopeBounds(g)
    try:
        return _certified(bounds)
    except NotEnclosedError:
        return Certificate("searched")


@dataclass(frozen=True)
class _Signs:
    """Signs on cells, 0 where not known: of g' at the ends and all over, of g'' all over; and whether to give a cell up."""

    at_low: NDArray[np.int8]
    at_high: NDArray[np.int8]
    inside: NDArray[np.int8]
    bend: NDArray[np.int8]
    hopeless: NDArray[np.bool_]

    def __getitem__(self, chosen: NDArray[np.bool_] | NDArray[np.intp]) -> _Signs:
        return _Signs(*(getattr(self, name)[chosen] for name in ("at_low", "at_high", "inside", "bend", "hopeless")))

    @property
    def turns(self) -> NDArray[np.bool_]:
        """Whether each cell holds exactly one root."""
        return (self.bend != 0) & (self.at_low * self.at_high < 0)


def _certified(bounds: SlopeBounds) -> Certificate:
    cells = bounds.first_cells()
    edges, spent = _at_knots(bounds, cells), 0
    turns: list[Cells] = []
    kept: list[Cells] = []
    while len(cells):
        spent += 4 * len(cells)
        signs = _signs(bounds, cells)
        turns.append(cells[signs.turns])
        open_ = (signs.inside == 0) & ~signs.turns
        cells, signs = cells[open_], signs[open_]
        more, settled = _unions(cells, signs)
        turns.append(more)
        cells, signs = cells[~settled], signs[~settled]
        kept.append(cells[signs.hopeless])
        cells = cells[~signs.hopeless]
        parts = int(np.clip(_AT_A_TIME // max(len(cells), 1), _FEWEST_PARTS, _MOST_PARTS))
        if spent + 4 * parts * len(cells) > MOST_EVALUATIONS:
            kept.append(cells)
            break
        cells = cells.split(parts)
    at_rest, knots, loose = edges
    undecided = _merged([*_intervals(joined(kept)), *loose])
    found = sorted([*_intervals(joined(turns)), *knots])
    return Certificate("not decided" if undecided else "proven", tuple(found), undecided, at_rest, spent)


def _intervals(cells: Cells) -> list[Interval]:
    return list(zip(cells.low.tolist(), cells.high.tolist(), strict=True))


def _merged(intervals: list[Interval]) -> tuple[Interval, ...]:
    """Join intervals that touch."""
    found: list[Interval] = []
    for low, high in sorted(intervals):
        if found and low <= found[-1][1]:
            found[-1] = (found[-1][0], max(found[-1][1], high))
        else:
            found.append((low, high))
    return tuple(found)


def _sign(bounds: Floats) -> NDArray[np.int8]:
    """Return the sign that all numbers between two bounds have, 0 where they do not share one."""
    return (bounds[0] > 0.0).astype(np.int8) - (bounds[1] < 0.0).astype(np.int8)


def _signs(bounds: SlopeBounds, cells: Cells) -> _Signs:
    """Bound g' and g'' on cells, at their ends and in their middle, all at once."""
    middle = cells.middle
    stacked = joined([cells, cells.at(cells.low), cells.at(cells.high), cells.at(middle)])
    first, second = bounds(stacked)
    whole, at_low, at_high, at_middle = np.split(first, 4, axis=1)
    steepest = np.max(np.abs(second[:, : len(cells)]), axis=0)
    with np.errstate(invalid="ignore", over="ignore"):
        reach = np.nextafter(steepest * np.maximum(cells.high - middle, middle - cells.low) * _JUST_ABOVE_ONE, np.inf)
        near = np.stack((np.nextafter(at_middle[0] - reach, -np.inf), np.nextafter(at_middle[1] + reach, np.inf)))
        noise = at_middle[1] - at_middle[0]
        hopeless = (_sign(at_middle) == 0) & (reach <= _NOISE * noise)
    bend, low, high = _sign(second[:, : len(cells)]), _sign(at_low), _sign(at_high)
    inside = np.where(_sign(whole) != 0, _sign(whole), _sign(near))  # the mean value form is the second one
    inside = np.where((inside == 0) & (bend != 0) & (low * high > 0), low, inside).astype(np.int8)
    return _Signs(low, high, inside, bend, hopeless | cells.at_rounding)


_JUST_ABOVE_ONE = 1.0 + 8.0 * float(np.finfo(float).eps)
"""Covers the rounding of the half widths of cells."""


def _unions(cells: Cells, signs: _Signs) -> tuple[Cells, NDArray[np.bool_]]:
    """Settle rows of cells that touch, on which g'' keeps one sign, and at whose outer ends g' is decided.

    A root at the edge of two cells leaves both of them open: together they hold it. Returns those unions that hold one root, and
    which of the cells are settled by a union, with a root or without.
    """
    settled = np.zeros(len(cells), bool)
    order = np.argsort(cells.low)
    one, two = order[:-1], order[1:]
    alike = (signs.bend[one] != 0) & (signs.bend[one] == signs.bend[two]) & (cells.piece[one] == cells.piece[two])
    touch = alike & (cells.high[one] == cells.low[two]) & (signs.at_high[one] == 0)
    found: list[tuple[float, float, int]] = []
    for row in np.split(order, np.flatnonzero(~touch) + 1):
        outer = (int(signs.at_low[row[0]]), int(signs.at_high[row[-1]])) if len(row) > 1 else (0, 0)
        if 0 not in outer:
            settled[row] = True
            if outer[0] != outer[1]:
                found.append((float(cells.low[row[0]]), float(cells.high[row[-1]]), int(cells.piece[row[0]])))
    low, high, piece = (np.array(one) for one in zip(*found, strict=True)) if found else (np.empty(0), np.empty(0), np.empty(0))
    return Cells(low, high, piece.astype(np.intp)), settled


def _at_knots(bounds: SlopeBounds, cells: Cells) -> tuple[bool | None, list[Interval], list[Interval]]:
    """Compare the signs of g' on the two sides of each knot.

    Returns whether g rises at 0+, the knots at which g' changes its sign, and those at which that is not decided; at the rate up
    to which g' is bounded it must rise.
    """
    knots = np.array(bounds.g.rate_knots)
    first = bounds(Cells(np.zeros(1), np.zeros(1), cells.piece[:1]))[0]
    rest = int(_sign(first)[0])
    last = cells[np.array([len(cells) - 1])]
    ends = _sign(bounds(last.at(last.high))[0])
    loose = [] if ends[0] > 0 else [(float(last.low[0]), float(last.high[0]))]
    if not len(knots):
        return (None if rest == 0 else rest > 0), [], loose
    below = _sign(bounds(Cells(knots, knots, bounds.piece_from(np.nextafter(knots, 0.0))))[0])
    above = _sign(bounds(Cells(knots, knots, bounds.piece_from(knots)))[0])
    turns = [(knot, knot) for knot in knots[below * above < 0].tolist()]
    loose += [(knot, knot) for knot in knots[below * above == 0].tolist()]
    return (None if rest == 0 else rest > 0), turns, loose


def sharpened(g: Resistance, turn: Interval, rate: float) -> Interval:
    """Narrow an interval that holds one sign change of g' around a rate at which it seems to be, with proof."""
    low, high = turn
    if low == high:
        return turn
    steps = np.abs(rate) * np.exp2(np.arange(-52.0, 0.0))
    below, above = np.clip(rate - steps, low, high), np.clip(rate + steps, low, high)
    bounds = SlopeBounds(g)
    piece = np.repeat(bounds.piece_from(np.array([low])), 2 * len(steps) + 2)
    places = np.concatenate(([low], below, [high], above))
    signs = _sign(bounds(Cells(places, places, piece))[0])
    first, last = signs[: len(steps) + 1], signs[len(steps) + 1 :]
    return float(places[: len(steps) + 1][first == first[0]].max()), float(places[len(steps) + 1 :][last == last[0]].min())
