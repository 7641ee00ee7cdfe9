"""All slip rates at which g' = Z + S dmu/dv changes its sign, with proof, and its smallest value; in compiled code.

A cell (an interval of slip rates) holds no turn if the bounds of g' on it leave out 0, and exactly one if g'' keeps its sign there
while g' has opposite signs at its ends. Any other cell is cut in two. Cells that rounding keeps open are undecided.

Source: Moore, Kearfott & Cloud 2009, Introduction to Interval Analysis, ch. 8 (interval Newton, mean value form) and ch. 11.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from stickslip.engine.codegen.compiler import kernel
from stickslip.engine.enclosure.formula import Formulas, bound_at_slips, bound_friction
from stickslip.engine.enclosure.intervals import add, multiply
from stickslip.engine.state.layout import Floats, Integers

FASTEST = 1e30
"""Slip rate (m/s) up to which g' is bounded; no contact is that fast."""
SLOWEST = 1e-100
"""Slip rate (m/s) below which a cell is not cut any more."""
BELOW, ABOVE = 1e-4, 1e4
"""The first cells have ends in the ratio RATIO between these multiples of the slowest and the fastest scale of a contact."""
RATIO, FAR = 16.0, 1e12
"""Ratio of the ends of the first cells, and of those beyond the fastest scale, where g' hardly changes."""
NOISE = 4.0
"""A cell is not worth cutting if g' changes on it by no more than this multiple of the rounding of its bounds."""
NARROW = 1e-15
"""Width of a cell, relative to its upper end, below which it is not cut any more."""
NUDGES = 4
"""Number of places tried for a cut at which the sign of g' is known."""
MOST_EVALUATIONS = 200_000
"""Largest number of cells and single rates at which g' is bounded, about 0.1 s; cells that remain are left undecided."""
FLAT = 2
"""Marks an undecided interval with a whole piece of the law: friction falls there exactly as fast as Z v rises."""
COUNT, EVALUATIONS = 0, 1
"""Places in the tally of a search: number of intervals in its table, and of cells and slip rates at which g' was bounded."""
DEPTH = 4096
"""Room for cells that wait."""


class Resistance(NamedTuple):
    """Hold what the bounds of g(v) = Z v + S mu(u, v) and its derivatives are worked out from."""

    formulas: Formulas
    knots: Floats  # m/s, ascending: slip rates above 0 at which the law changes its formula
    pieces: Integers  # (knots + 1,): the piece of the law below each knot, and above the last
    damping: float  # Z, Pa s/m, or that of a block, N s/m
    normal: float  # S, Pa
    slowest: float  # slowest and fastest scale of the contact, m/s
    fastest: float
    cells: Floats  # (DEPTH, 4): memory for cells that wait


class Slopes(NamedTuple):
    """Hold bounds of g' (Pa s/m) and of g'' (Pa s2/m2)."""

    low: float
    high: float
    bend_low: float
    bend_high: float


class Turns(NamedTuple):
    """Hold where g' changes its sign, ascending, each with the interval (m/s) in which this is proven or not decided."""

    low: Floats
    high: Floats
    rate: Floats  # m/s: the turn to rounding; NaN where g' has the same sign on both sides of an undecided interval
    proven: Integers  # 1 if the interval holds exactly one turn, 0 if it is undecided, FLAT if it holds a whole piece of the law
    before: Integers  # sign of g' at its two ends, 0 if that is not known
    after: Integers


class Cell(NamedTuple):
    """Hold an interval of slip rates (m/s) and the signs of g' at its ends, 0 where the sign is not known."""

    low: float
    high: float
    before: int
    after: int


class Finder(NamedTuple):
    """Hold a search for turns: where it looks, what it has found, and the sums of COUNT and EVALUATIONS."""

    g: Resistance
    turns: Turns
    tally: Integers
    budget: int


class Account(NamedTuple):
    """Hold the sums of a search: number of intervals in the table of turns (-1: it has no room), and what was seen on the way."""

    intervals: int
    at_rest: int  # sign of g' at 0+, or 0 if that is not known
    at_end: int  # sign of g' at the fastest rate
    evaluations: int


@kernel
def room_for_turns(count: int) -> Turns:
    """Return an empty table of turns with room for so many."""
    places, signs = np.zeros((3, count)), np.zeros((3, count), np.int64)
    return Turns(places[0], places[1], places[2], signs[0], signs[1], signs[2])


@kernel
def new_cells() -> Floats:
    """Return memory for cells that wait."""
    return np.zeros((DEPTH, 4))


# ---- bounds -----------------------------------------------------------------------------------------------------------------


@kernel
def slopes_on(g: Resistance, piece: int, low: float, high: float) -> Slopes:
    """Bound g' and g'' at slip rates (m/s) between two, under a piece of the law and at the slips of `bound_at_slips`."""
    friction, normal = bound_friction(g.formulas, piece, low, high), g.normal
    least, most = multiply(normal, normal, friction[2], friction[3])
    least, most = add(g.damping, g.damping, least, most)
    bend = multiply(2.0 * normal, 2.0 * normal, friction[4], friction[5])
    return Slopes(least, most, bend[0], bend[1])


@kernel
def sign_of(slopes: Slopes) -> int:
    """Return the sign that all values of g' share, or 0 if they do not share one."""
    if slopes.low > 0.0:
        return 1
    return -1 if slopes.high < 0.0 else 0


@kernel
def sign_at(g: Resistance, piece: int, rate: float) -> int:
    """Return the sign of g' at a slip rate, or 0 if rounding leaves it open."""
    return sign_of(slopes_on(g, piece, rate, rate))


@kernel
def slope_at(g: Resistance, piece: int, rate: float) -> float:
    """Return g' (Pa s/m) at a slip rate, to rounding."""
    slopes = slopes_on(g, piece, rate, rate)
    return 0.5 * (slopes.low + slopes.high)


@kernel
def reach_of(slopes: Slopes, low: float, middle: float, high: float) -> float:
    """Return how far g' may be from its value in the middle of a cell, by the mean value theorem."""
    return max(abs(slopes.bend_low), abs(slopes.bend_high)) * max(high - middle, middle - low) * (1.0 + 1e-15)


# ---- cells ------------------------------------------------------------------------------------------------------------------


@kernel
def next_edge(g: Resistance, edge: float, end: float) -> float:
    """Return the upper end of the first cell that begins at `edge`."""
    low = max(BELOW * g.slowest, SLOWEST)
    after = low if edge < 0.5 * low else (RATIO if edge < ABOVE * g.fastest else FAR) * edge
    return end if 2.0 * after > end else after


@kernel
def cut_between(low: float, high: float) -> float:
    """Return where a cell is cut: in the geometric middle if its ends differ by more than a factor of four."""
    if low == 0.0:
        return high / RATIO
    return math.sqrt(low) * math.sqrt(high) if high > 4.0 * low else 0.5 * (low + high)


@kernel
def known_place(find: Finder, piece: int, low: float, place: float, high: float) -> tuple[float, int]:
    """Return a place near `place` in a cell at which the sign of g' is known, if there is one, and that sign."""
    found, sign = place, sign_at(find.g, piece, place)
    for k in range(1, NUDGES):
        find.tally[EVALUATIONS] += 1
        if sign != 0:
            break
        other = place + 0.2 * k * (high - place) if k % 2 == 1 else place - 0.2 * k * (place - low)
        sign = sign_at(find.g, piece, other)
        if sign != 0:
            found = other
    return found, sign


@kernel
def push(cells: Floats, count: int, cell: Cell) -> int:
    """Put a cell on the pile of those that wait, and return their number."""
    cells[count, 0], cells[count, 1], cells[count, 2], cells[count, 3] = cell.low, cell.high, cell.before, cell.after
    return count + 1


@kernel
def note(find: Finder, cell: Cell, proven: int) -> None:
    """Write a cell into the table of turns; undecided neighbours are joined. Without room the number of intervals becomes -1."""
    turns, count = find.turns, find.tally[COUNT]
    if count < 0:
        return
    if proven == 0 and count > 0 and turns.proven[count - 1] == 0 and turns.high[count - 1] == cell.low:
        turns.high[count - 1], turns.after[count - 1] = cell.high, cell.after
        return
    if count == len(turns.low):
        find.tally[COUNT] = -1
        return
    turns.low[count], turns.high[count], turns.proven[count] = cell.low, cell.high, proven
    turns.before[count], turns.after[count], turns.rate[count] = cell.before, cell.after, math.nan
    find.tally[COUNT] = count + 1


@kernel
def find_turns(g: Resistance, slip: float, top: float, budget: int, turns: Turns) -> Account:
    """Find all turns of g at a law slip (m) between rest and the slip rate `top` (m/s), with about so many evaluations at most."""
    find = Finder(g, turns, np.zeros(2, np.int64), budget)
    at_rest = before = 0
    begin = 0.0
    for k in range(len(g.pieces)):
        piece, end = g.pieces[k], min(g.knots[k] if k < len(g.knots) else FASTEST, top)
        if k > 0 and not begin < end:
            break
        bound_at_slips(g.formulas, piece, slip, slip)
        first = sign_at(g, piece, begin)
        if k == 0:
            at_rest = first
        elif before * first <= 0:
            note(find, Cell(begin, begin, before, first), 1 if before * first < 0 else 0)
        before = turns_between(find, piece, begin, end, first)
        begin = end
    finish(find, slip)
    return Account(find.tally[COUNT], at_rest, before, find.tally[EVALUATIONS])


@kernel
def turns_between(find: Finder, piece: int, begin: float, end: float, first: int) -> int:
    """Find the turns between two slip rates under one piece of the law; `first` is the sign of g' at the lower one.

    Returns the sign at the upper one.
    """
    low, before = begin, first
    for _ in range(DEPTH):
        if not low < end or find.tally[COUNT] < 0:
            break
        high = next_edge(find.g, low, end)
        if high < end:
            high, after = known_place(find, piece, low, high, min(end, 2.0 * high))
        else:
            after = sign_at(find.g, piece, high)
        turns_in(find, piece, Cell(low, high, before, after))
        low, before = high, after
    return before


@kernel
def turns_in(find: Finder, piece: int, first: Cell) -> None:
    """Find the turns in a cell."""
    g, waiting = find.g, push(find.g.cells, 0, first)
    for _ in range(find.budget + DEPTH):
        if waiting == 0 or find.tally[COUNT] < 0:
            break
        waiting -= 1
        low, high = g.cells[waiting, 0], g.cells[waiting, 1]
        cell = Cell(low, high, int(g.cells[waiting, 2]), int(g.cells[waiting, 3]))
        find.tally[EVALUATIONS] += 2
        seen = slopes_on(g, piece, low, high)
        if sign_of(seen) != 0:
            continue
        if seen.bend_low > 0.0 or seen.bend_high < 0.0:
            if cell.before * cell.after > 0:
                continue
            if cell.before * cell.after < 0:
                note(find, cell, 1)
                continue
        middle = cut_between(low, high)
        there, reach = slopes_on(g, piece, middle, middle), reach_of(seen, low, middle, high)
        if there.low - reach > 0.0 or there.high + reach < 0.0:
            continue
        sign = sign_of(there)
        noisy = sign == 0 and reach <= NOISE * (there.high - there.low)
        narrow = high - low <= NARROW * high or high <= SLOWEST
        if noisy or narrow or find.tally[EVALUATIONS] > find.budget or waiting + 2 > DEPTH:
            note(find, cell, 0)
            continue
        if sign == 0:
            middle, sign = known_place(find, piece, low, middle, high)
        waiting = push(g.cells, waiting, Cell(middle, high, sign, cell.after))
        waiting = push(g.cells, waiting, Cell(low, middle, cell.before, sign))


# ---- one turn -----------------------------------------------------------------------------------------------------------------


@kernel
def finish(find: Finder, slip: float) -> None:
    """Narrow the intervals of a table as far as rounding allows, and set the slip rate of each turn."""
    (g, turns), last = (find.g, find.turns), -1
    for n in range(find.tally[COUNT]):
        low, high = turns.low[n], turns.high[n]
        if low == high:
            turns.rate[n] = low if turns.before[n] * turns.after[n] < 0 else math.nan
            continue
        if turns.proven[n] == 0 and holds_a_piece(g, low, high):
            turns.proven[n] = FLAT
            continue
        piece = piece_above(g, low)
        if piece != last:
            bound_at_slips(g.formulas, piece, slip, slip)
            last = piece
        if turns.proven[n] == 1:
            turns.low[n], turns.high[n] = narrowed(g, piece, low, high, turns.before[n])
        if turns.before[n] * turns.after[n] < 0:
            turns.rate[n] = change_between(g, piece, turns.low[n], turns.high[n], turns.before[n])


@kernel
def holds_a_piece(g: Resistance, low: float, high: float) -> bool:
    """Return True if an interval holds all slip rates between two neighbouring knots, or between 0 and the first one."""
    begin = 0.0
    for k in range(len(g.knots)):
        if low <= begin and g.knots[k] <= high:
            return True
        begin = g.knots[k]
    return False


@kernel
def folds_of(turns: Turns, count: int, rates: Floats) -> int:
    """Write the slip rates at which branches begin or end into `rates`, ascending, and return their number.

    No branch lies in a flat interval.
    """
    folds = 0
    for n in range(count):
        if turns.proven[n] != FLAT:
            if not math.isnan(turns.rate[n]):
                rates[folds], folds = turns.rate[n], folds + 1
            continue
        if turns.before[n] > 0:
            rates[folds], folds = turns.low[n], folds + 1
        if turns.after[n] > 0:
            rates[folds], folds = turns.high[n], folds + 1
    return folds


@kernel
def piece_above(g: Resistance, rate: float) -> int:
    """Return the piece of the law just above a slip rate."""
    k = 0
    while k < len(g.knots) and g.knots[k] <= rate:
        k += 1
    return g.pieces[k]


@kernel
def narrowed(g: Resistance, piece: int, low: float, high: float, before: int) -> tuple[float, float]:
    """Narrow an interval with one turn by bisection and interval Newton steps, until rounding of g' hides where the turn lies."""
    for _ in range(200):
        width, middle = high - low, cut_between(low, high)
        if width <= NARROW * high:
            break
        seen, there = slopes_on(g, piece, low, high), slopes_on(g, piece, middle, middle)
        sign = sign_of(there)
        if sign == before:
            low = middle
        elif sign == -before:
            high = middle
        if seen.bend_low > 0.0 or seen.bend_high < 0.0:
            gentle, steep = min(abs(seen.bend_low), abs(seen.bend_high)), max(abs(seen.bend_low), abs(seen.bend_high))
            rises = 1.0 if seen.bend_low > 0.0 else -1.0
            least, most = rises * there.low, rises * there.high
            least, most = min(least, most), max(least, most)
            low = max(low, below(middle - most / (gentle if most > 0.0 else steep)))
            high = min(high, above(middle - least / (steep if least > 0.0 else gentle)))
        if sign == 0 and not high - low < 0.75 * width:
            break
    return low, high


@kernel
def below(x: float) -> float:
    """Return a number below x by more than the rounding of a few operations."""
    return x - 1e-15 * abs(x)


@kernel
def above(x: float) -> float:
    """Return a number above x by more than the rounding of a few operations."""
    return x + 1e-15 * abs(x)


@kernel
def change_between(g: Resistance, piece: int, low: float, high: float, before: int) -> float:
    """Return the slip rate at which g' changes its sign, to rounding, by bisection with false position."""
    first, last, side = slope_at(g, piece, low), slope_at(g, piece, high), 0
    for k in range(200):
        if high - low <= 4e-16 * high:
            break
        rate = (low * last - high * first) / (last - first) if k % 3 < 2 else cut_between(low, high)
        if not low < rate < high:
            rate = cut_between(low, high)
        if not low < rate < high:
            break
        value = slope_at(g, piece, rate)
        if (value > 0.0) == (before > 0):
            low, first = rate, value
            last *= 0.5 if side > 0 else 1.0
            side = 1
        else:
            high, last = rate, value
            first *= 0.5 if side < 0 else 1.0
            side = -1
    return low if before > 0 else high
