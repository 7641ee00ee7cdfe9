"""The smallest g' = Z + S dmu/dv over all slip rates, with proven bounds; in compiled code.

Source: Moore, Kearfott & Cloud 2009, Introduction to Interval Analysis, ch. 11 (branch and bound).
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from stickslip.engine.codegen.compiler import kernel
from stickslip.engine.enclosure.formula import bound_at_slips
from stickslip.engine.folds.turns import (
    DEPTH,
    FASTEST,
    NARROW,
    NOISE,
    SLOWEST,
    Resistance,
    cut_between,
    next_edge,
    reach_of,
    slopes_on,
)
from stickslip.engine.state.layout import Floats


class Lowest(NamedTuple):
    """Hold bounds (Pa s/m) of the smallest g', and where the upper one was found, in a cell of slip rates (m/s)."""

    at_least: float
    at_most: float
    piece: int
    low: float
    high: float
    evaluations: int  # number of cells and single rates at which g' was bounded


class Ends(NamedTuple):
    """Hold a cell (m/s) with the lower bounds of g' (Pa s/m) at its ends."""

    low: float
    high: float
    at_low: float
    at_high: float


class Finder(NamedTuple):
    """Hold a search for the smallest g': where it looks, its tolerance (1), and the numbers of what it has found."""

    g: Resistance
    tolerance: float
    found: Floats  # AT_LEAST, AT_MOST, PIECE, LOW, HIGH of `Lowest`, and LEFT: number of evaluations that may follow


AT_LEAST, AT_MOST, PIECE, LOW, HIGH, LEFT = range(6)
"""Places in `Finder.found`."""


@kernel
def find_lowest(g: Resistance, slip: float, tolerance: float, budget: int) -> Lowest:
    """Bound the smallest g' at a law slip (m) until both bounds agree to a tolerance, relative to Z or to g' if that is larger."""
    find = Finder(g, tolerance, np.array([math.inf, math.inf, 0.0, 0.0, 0.0, budget]))
    begin = 0.0
    for k in range(len(g.pieces)):
        piece, end = g.pieces[k], g.knots[k] if k < len(g.knots) else FASTEST
        bound_at_slips(g.formulas, piece, slip, slip)
        low, at_low = begin, look_at(find, piece, begin)
        for _ in range(DEPTH):
            if not low < end:
                break
            high = next_edge(g, low, end)
            at_high = look_at(find, piece, high)
            lowest_in(find, piece, Ends(low, high, at_low, at_high))
            low, at_low = high, at_high
        begin = end
    found = find.found
    least, used = min(found[AT_LEAST], found[AT_MOST]), budget - int(found[LEFT])
    return Lowest(least, found[AT_MOST], int(found[PIECE]), found[LOW], found[HIGH], used)


@kernel
def look_at(find: Finder, piece: int, rate: float) -> float:
    """Take g' at a slip rate into account, and return its lower bound."""
    slopes = slopes_on(find.g, piece, rate, rate)
    lower_to(find, slopes.high, piece, rate, rate)
    return slopes.low


@kernel
def lower_to(find: Finder, at_most: float, piece: int, low: float, high: float) -> None:
    """Note that g' is somewhere in a cell at most this small, if this is news."""
    if at_most < find.found[AT_MOST]:
        find.found[AT_MOST], find.found[PIECE], find.found[LOW], find.found[HIGH] = at_most, piece, low, high


@kernel
def lowest_in(find: Finder, piece: int, first: Ends) -> None:
    """Take a cell into account."""
    g, found, waiting = find.g, find.found, wait(find.g, 0, first)
    for _ in range(int(found[LEFT]) + DEPTH):
        if waiting == 0:
            break
        waiting -= 1
        cell = Ends(g.cells[waiting, 0], g.cells[waiting, 1], g.cells[waiting, 2], g.cells[waiting, 3])
        found[LEFT] -= 2
        seen = slopes_on(g, piece, cell.low, cell.high)
        enough = found[AT_MOST] - find.tolerance * max(g.damping, abs(found[AT_MOST]))
        is_monotone = seen.bend_low > 0.0 or seen.bend_high < 0.0
        least = max(seen.low, min(cell.at_low, cell.at_high)) if is_monotone else seen.low
        if not (is_monotone or least >= enough):
            middle = cut_between(cell.low, cell.high)
            there, reach = slopes_on(g, piece, middle, middle), reach_of(seen, cell.low, middle, cell.high)
            lower_to(find, there.high, piece, cell.low, cell.high)
            least = max(seen.low, there.low - reach)
            noisy = reach <= NOISE * (there.high - there.low)
            narrow = cell.high - cell.low <= NARROW * cell.high or cell.high <= SLOWEST
            if not (least >= enough or noisy or narrow or found[LEFT] < 0.0 or waiting + 2 > DEPTH):
                waiting = wait(g, waiting, Ends(middle, cell.high, there.low, cell.at_high))
                waiting = wait(g, waiting, Ends(cell.low, middle, cell.at_low, there.low))
                continue
        found[AT_LEAST] = min(found[AT_LEAST], least)


@kernel
def wait(g: Resistance, count: int, cell: Ends) -> int:
    """Put a cell on the pile of those that wait, and return their number."""
    g.cells[count, 0], g.cells[count, 1], g.cells[count, 2], g.cells[count, 3] = cell
    return count + 1


@kernel
def polished(g: Resistance, slip: float, found: Lowest) -> tuple[float, float]:
    """Return the slip rate (m/s) of the smallest g' and its value (Pa s/m) to rounding, by bisection of g'' in the cell found."""
    bound_at_slips(g.formulas, found.piece, slip, slip)
    low, high = found.low, found.high
    for _ in range(200):
        middle = 0.5 * (low + high)
        if not low < middle < high:
            break
        seen = slopes_on(g, found.piece, middle, middle)
        if seen.bend_low + seen.bend_high > 0.0:
            high = middle
        else:
            low = middle
    best, rate = math.inf, low
    for place in (found.low, low, high, found.high):
        seen = slopes_on(g, found.piece, place, place)
        if 0.5 * (seen.low + seen.high) < best:
            best, rate = 0.5 * (seen.low + seen.high), place
    return rate, best
