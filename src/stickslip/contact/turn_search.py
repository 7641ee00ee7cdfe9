"""The search of `contact.turns` in compiled code: cells of slip rates one by one, in the order of the search.

A row of a table of cells is a cell: its piece, its low and high end (m/s), the signs of g' at both, and what is known of it.
"""

from __future__ import annotations

from stickslip.contact.slopes import (
    ABOVE,
    BELOW,
    FAR,
    NARROW,
    RATIO,
    SLOWEST,
    Contacts,
    Integers,
    bend_sign,
    cut,
    reach_of,
    sign_of,
    slope_bounds,
)
from stickslip.foundation.arrays import Floats
from stickslip.foundation.compiled import exact
from stickslip.friction.formula.tape import Formulas

NOISE = 4.0
"""A cell is not worth cutting if g' changes on it by no more than this multiple of the rounding of its bounds."""
NUDGES = 4
"""Number of places to try for a cut, until the sign of g' is known there."""
MOST_WAITING = 256
"""Largest number of cells of one contact to examine together: the slowest come first, as there may be no end of turns."""
UNDECIDED, PROVEN, FLAT = 0, 1, 2
"""Knowledge about an interval: none; that it holds exactly one turn; that it holds a whole piece of the law and friction falls on
this piece exactly as fast as Z v rises."""
PIECE, LOW, HIGH, BEFORE, AFTER, KNOWN = range(6)
"""Columns of tables of cells."""
COLUMNS = 6


@exact
def put(cells: Floats, n: int, piece: int, low: float, high: float, before: int, after: int, known: int) -> int:
    """Write a cell into a row of a table, if there is room; return the number of the next row."""
    if n < len(cells):
        cells[n, PIECE], cells[n, LOW], cells[n, HIGH] = piece, low, high
        cells[n, BEFORE], cells[n, AFTER], cells[n, KNOWN] = before, after, known
    return n + 1


@exact
def next_edge(of: Contacts, piece: int, edge: float) -> float:
    """Return the edge (m/s) of the first cells of a piece that follows another one; its upper end is repeated."""
    start = max(BELOW * of.slowest[piece], SLOWEST)
    after = (RATIO if edge < ABOVE * of.fastest[piece] else FAR) * edge
    after = start if edge < 0.5 * start else after
    return of.end[piece] if 2.0 * after > of.end[piece] else after


@exact
def sign_at(of: Contacts, piece: int, rate: float) -> int:
    """Return the sign of g' at a slip rate, 0 if it is not known."""
    return sign_of(slope_bounds(of, piece, rate, rate))


@exact
def known_place(of: Contacts, piece: int, low: float, place: float, high: float, sign: int, left: Integers) -> tuple[float, int]:
    """Return a place in a cell where the sign of g' is known, if there is any, and this sign."""
    for k in range(1, NUDGES):
        if sign != 0:
            break
        other = place + 0.2 * k * ((high if k % 2 == 1 else low) - place)
        sign = sign_at(of, piece, other)
        left[0] -= 1
        if sign != 0:
            place = other
    return place, sign


@exact
def first_cells(of: Contacts, piece: int, cells: Floats, n: int, ends: Integers, left: Integers) -> int:
    """Write the cells of a piece before any is cut, and the signs of g' at its lower and upper end; return the next row."""
    low, begin, end = of.begin[piece], of.begin[piece], of.end[piece]
    before = sign_at(of, piece, low)
    ends[0], known_to = before, low
    while low < end:
        high = next_edge(of, piece, low)
        after = sign_at(of, piece, high)
        edge, place = high, high
        if begin < high < end:
            place, after = known_place(of, piece, low, high, min(end, 2.0 * high), after, left)
        if known_to < place:
            n = put(cells, n, piece, known_to, place, before, after, UNDECIDED)
        low, known_to, before = edge, place, after
    ends[1] = before
    return n


@exact
def edges_of(of: Contacts, piece: int) -> int:
    """Return the number of edges of the first cells of a piece."""
    many, edge = 1, of.begin[piece]
    while edge < of.end[piece]:
        edge = next_edge(of, piece, edge)
        many += 1
    return many


@exact
def examined(of: Contacts, cells: Floats, n: int, left: Integers) -> tuple[int, float, int]:
    """Examine a cell: return PROVEN, UNDECIDED, -1 if there is no turn in it, or -2, with place and sign, if it is to be cut."""
    piece, low, high = int(cells[n, PIECE]), cells[n, LOW], cells[n, HIGH]
    middle = cut(low, high)
    seen, there = slope_bounds(of, piece, low, high), slope_bounds(of, piece, middle, middle)
    left[0] -= 2
    change = cells[n, BEFORE] * cells[n, AFTER]
    reach = reach_of(seen, low, middle, high)
    bends, sign = bend_sign(seen) != 0, sign_of(there)
    if sign_of(seen) == 0 and bends and change < 0:
        return PROVEN, middle, sign
    if sign_of(seen) != 0 or (bends and change > 0) or there.low - reach > 0.0 or there.high + reach < 0.0:
        return -1, middle, sign
    noisy = sign == 0 and reach <= NOISE * (there.high - there.low)
    if noisy or high - low <= NARROW * high or high <= SLOWEST:
        return UNDECIDED, middle, sign
    middle, sign = known_place(of, piece, low, middle, high, sign, left)
    return -2, middle, sign


@exact
def search_contact(
    of: Contacts, first: int, last: int, most: int, waiting: Floats, halves: Floats, found: Floats, n: int, ends: Integers, left: Integers
) -> int:
    """Find all turns of one contact, whose pieces are those from `first` to before `last`; return the next row of `found`.

    `left` is the number of bounds that may still be worked out; `waiting` are cells, the slowest ones last.
    """
    turns, many, edges = 0, 0, 0
    for piece in range(last - 1, first - 1, -1):
        start = many
        many = first_cells(of, piece, waiting, many, ends[piece], left)
        if many > len(waiting):
            return len(found) + 1
        for k in range((many - start) // 2):
            for column in range(COLUMNS):
                one, other = start + k, many - 1 - k
                waiting[one, column], waiting[other, column] = waiting[other, column], waiting[one, column]
        edges = max(edges, edges_of(of, piece))
    left[0] -= (last - first) * edges
    for knot in range(first + 1, last):
        before, after = ends[knot - 1, 1], ends[knot, 0]
        if before * after <= 0:
            turns += before * after < 0
            n = put(found, n, knot, of.begin[knot], of.begin[knot], before, after, PROVEN if before * after < 0 else UNDECIDED)
    while many > 0 and n <= len(found):
        room = 0 if turns > most else min(max(left[0] // 2, 0), MOST_WAITING)
        if room == 0:
            for k in range(many):
                n = put(found, n, int(waiting[k, 0]), waiting[k, 1], waiting[k, 2], int(waiting[k, 3]), int(waiting[k, 4]), UNDECIDED)
            break
        taken, many_halves = min(room, many), 0
        for k in range(many - 1, many - 1 - taken, -1):
            known, middle, sign = examined(of, waiting, k, left)
            piece, low, high = int(waiting[k, 0]), waiting[k, LOW], waiting[k, HIGH]
            before, after = int(waiting[k, BEFORE]), int(waiting[k, AFTER])
            if known >= 0:
                n = put(found, n, piece, low, high, before, after, known)
                turns += known == PROVEN
            elif known == -2:
                many_halves = put(halves, many_halves, piece, low, middle, before, sign, UNDECIDED)
                many_halves = put(halves, many_halves, piece, middle, high, sign, after, UNDECIDED)
        many -= taken
        if many + many_halves > len(waiting):
            return len(found) + 1
        for k in range(many_halves - 1, -1, -1):
            waiting[many] = halves[k]
            many += 1
    return n


@exact
def narrowed(of: Contacts, piece: int, low: float, high: float, before: int) -> tuple[float, float]:
    """Narrow an interval with one turn by bisection and interval Newton steps, until rounding of g' hides where the turn lies."""
    for _ in range(200):
        if not high - low > NARROW * high:
            break
        width, middle = high - low, cut(low, high)
        seen, there = slope_bounds(of, piece, low, high), slope_bounds(of, piece, middle, middle)
        sign = sign_of(there)
        low, high = middle if sign == before else low, middle if sign == -before else high
        if bend_sign(seen) != 0:
            gentle = min(abs(seen.bend_low), abs(seen.bend_high))
            steep = max(abs(seen.bend_low), abs(seen.bend_high))
            rises = seen.bend_low > 0.0
            least, most = (there.low, there.high) if rises else (-there.high, -there.low)
            from_ = middle - most / (gentle if most > 0.0 else steep)
            to = middle - least / (steep if least > 0.0 else gentle)
            low, high = max(low, from_ - 1e-15 * abs(from_)), min(high, to + 1e-15 * abs(to))
        if not (sign != 0 or high - low < 0.75 * width):
            break
    return low, high


@exact
def search(
    steps: Integers,
    values: Floats,
    first: Integers,
    formula: Integers,
    low_numbers: Floats,
    high_numbers: Floats,
    room: Floats,
    present: Integers,
    damping: Floats,
    normal: Floats,
    slowest: Floats,
    fastest: Floats,
    begin: Floats,
    end: Floats,
    first_piece: Integers,
    most: int,
    waiting: Floats,
    halves: Floats,
    found: Floats,
    ends: Integers,
    left: Integers,
) -> int:
    """Find all turns of contacts, and narrow the intervals that hold one; return their number, -1 if there is no room for them.

    `left` has the number of bounds that may be worked out for each contact, `ends` the signs of g' at both ends of each piece.
    """
    formulas = Formulas(steps, values, first, formula, low_numbers, high_numbers, room, present)
    of, n = Contacts(formulas, damping, normal, slowest, fastest, begin, end), 0
    for contact in range(len(left)):
        own, last = left[contact : contact + 1], first_piece[contact + 1]
        n = search_contact(of, first_piece[contact], last, most, waiting, halves, found, n, ends, own)
        if n > len(found):
            return -1
    for k in range(n):
        if found[k, KNOWN] == PROVEN and found[k, LOW] < found[k, HIGH]:
            low, high = found[k, LOW], found[k, HIGH]
            found[k, LOW], found[k, HIGH] = narrowed(of, int(found[k, PIECE]), low, high, int(found[k, BEFORE]))
    return n
