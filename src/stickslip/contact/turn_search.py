"""The search of `contact.turns` in compiled code: cells of slip rates one by one, in the order of the search.

A row of a table of cells is a cell: its piece, its low and high end (m/s), the signs of g' at both, and what is known of it.
"""

from __future__ import annotations

from typing import NamedTuple

from stickslip.contact.slopes import (
    ABOVE,
    BEGIN,
    BELOW,
    END,
    FAR,
    FAST,
    NARROW_SLOPE_CELL,
    RATIO,
    SLOW,
    SLOWEST_CELL,
    Contacts,
    Integers,
    bend_sign,
    cut,
    reach_of,
    sign_of,
    slope_bounds,
)
from stickslip.foundation.arrays import Floats, Floats2, Integers1, Integers2
from stickslip.foundation.kernels.kernels import exact, exact_entry

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
COLUMNS_OF_PIECE = 6

EMPTY, TO_BE_CUT = -1, -2
"""Knowledge about a cell that is examined: that there is no turn, and none."""

Search = tuple[int, int, int, int]
"""First piece of a contact, the one after its last, the number of turns that ends its search, and a row of the table of turns."""
Place = tuple[int, float, float]
"""Piece, and low and high end of a cell (m/s)."""
Signs = tuple[int, int]
"""Signs of g' at both ends of a cell."""


@exact
def put(cells: Floats, n: int, place: Place, signs: Signs, known: int) -> int:
    """Write a cell into a row of a table, if there is room; return the number of the next row."""
    if n < len(cells):
        cells[n, PIECE], cells[n, LOW], cells[n, HIGH] = place
        cells[n, BEFORE], cells[n, AFTER] = signs
        cells[n, KNOWN] = known
    return n + 1


@exact
def next_edge(of: Contacts, piece: int, edge: float) -> float:
    """Return the edge (m/s) of the first cells of a piece that follows another one; its upper end is repeated."""
    start = max(BELOW * of.pieces[piece, SLOW], SLOWEST_CELL)
    after = (RATIO if edge < ABOVE * of.pieces[piece, FAST] else FAR) * edge
    after = start if edge < 0.5 * start else after
    return of.pieces[piece, END] if 2.0 * after > of.pieces[piece, END] else after


@exact
def sign_at(of: Contacts, piece: int, rate: float) -> int:
    """Return the sign of g' at a slip rate, 0 if it is not known."""
    return sign_of(slope_bounds(of, piece, rate, rate))


@exact
def known_place(of: Contacts, cell: Place, place: float, sign: int, left: Integers) -> tuple[float, int]:
    """Return a place in a cell where the sign of g' is known, if there is any, and this sign; `place` is tried already."""
    piece, low, high = cell
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
def first_cells(of: Contacts, piece: int, cells: Floats, ends: Integers, left: Integers) -> int:
    """Write the cells of a piece before any is cut, fastest first, and the signs of g' at both its ends; return their number."""
    begin, end = of.pieces[piece, BEGIN], of.pieces[piece, END]
    low, known_to, before, n = begin, begin, sign_at(of, piece, begin), 0
    ends[0] = before
    while low < end:
        high = next_edge(of, piece, low)
        place, after = high, sign_at(of, piece, high)
        if begin < high < end:
            place, after = known_place(of, (piece, low, min(end, 2.0 * high)), high, after, left)
        if known_to < place:
            n = put(cells, n, (piece, known_to, place), (before, after), UNDECIDED)
        low, known_to, before = high, place, after
    ends[1] = before
    for k in range(min(n, len(cells)) // 2):
        for column in range(COLUMNS_OF_PIECE):
            cells[k, column], cells[n - 1 - k, column] = cells[n - 1 - k, column], cells[k, column]
    return n


@exact
def edges_of(of: Contacts, piece: int) -> int:
    """Return the number of edges of the first cells of a piece."""
    many, edge = 1, of.pieces[piece, BEGIN]
    while edge < of.pieces[piece, END]:
        edge = next_edge(of, piece, edge)
        many += 1
    return many


@exact
def examined(of: Contacts, cell: Floats, left: Integers) -> tuple[int, float, int]:
    """Examine a cell: return PROVEN, UNDECIDED, EMPTY, or TO_BE_CUT, and the place and sign of g' where it is to be cut."""
    piece, low, high = int(cell[PIECE]), cell[LOW], cell[HIGH]
    middle = cut(low, high)
    seen, there = slope_bounds(of, piece, low, high), slope_bounds(of, piece, middle, middle)
    left[0] -= 2
    change = cell[BEFORE] * cell[AFTER]
    reach = reach_of(seen, low, middle, high)
    bends, sign = bend_sign(seen) != 0, sign_of(there)
    if sign_of(seen) == 0 and bends and change < 0:
        return PROVEN, middle, sign
    if sign_of(seen) != 0 or (bends and change > 0) or there.low - reach > 0.0 or there.high + reach < 0.0:
        return EMPTY, middle, sign
    noisy = sign == 0 and reach <= NOISE * (there.high - there.low)
    if noisy or high - low <= NARROW_SLOPE_CELL * high or high <= SLOWEST_CELL:
        return UNDECIDED, middle, sign
    middle, sign = known_place(of, (piece, low, high), middle, sign, left)
    return TO_BE_CUT, middle, sign


@exact
def begin_contact(of: Contacts, search: Search, waiting: Floats, ends: Integers, left: Integers) -> int:
    """Write the first cells of a contact, the slowest ones last; return their number."""
    first, last, _, _ = search
    many, edges = 0, 0
    for piece in range(last - 1, first - 1, -1):
        many += first_cells(of, piece, waiting[many:], ends[piece], left)
        if many > len(waiting):
            break
        edges = max(edges, edges_of(of, piece))
    left[0] -= (last - first) * edges
    return many


@exact
def turns_at_knots(of: Contacts, search: Search, found: Floats, ends: Integers) -> tuple[int, int]:
    """Write the knots where g' may change its sign; return the next row of `found`, and the number of proven turns."""
    first, last, _, n = search
    turns = 0
    for knot in range(first + 1, last):
        before, after = ends[knot - 1, 1], ends[knot, 0]
        if before * after <= 0:
            turns += 1 if before * after < 0 else 0
            place = (knot, of.pieces[knot, BEGIN], of.pieces[knot, BEGIN])
            n = put(found, n, place, (before, after), PROVEN if before * after < 0 else UNDECIDED)
    return n, turns


@exact
def search_contact(of: Contacts, search: Search, tables: tuple[Floats, Floats], ends: Integers, left: Integers) -> int:
    """Find all turns of one contact; return the next row of the table of what is found, more than it has if there is no room.

    The cells that wait are those of the other table, the slowest ones last. `left` is the number of bounds that may be worked out.
    """
    waiting, found = tables
    _, _, most, _ = search
    many = begin_contact(of, search, waiting, ends, left)
    if many > len(waiting):
        return len(found) + 1
    n, turns = turns_at_knots(of, search, found, ends)
    while many > 0 and n <= len(found):
        room = 0 if turns > most else min(max(left[0] // 2, 0), MOST_WAITING)
        first, next_ = many - min(room if room > 0 else many, many), many
        if next_ + 2 * (many - first) > len(waiting):
            return len(found) + 1
        for k in range(first, many):
            known, middle, sign = examined(of, waiting[k], left) if room > 0 else (UNDECIDED, 0.0, 0)
            piece, low, high = int(waiting[k, PIECE]), waiting[k, LOW], waiting[k, HIGH]
            before, after = int(waiting[k, BEFORE]), int(waiting[k, AFTER])
            if known == TO_BE_CUT:
                next_ = put(waiting, next_, (piece, middle, high), (sign, after), UNDECIDED)
                next_ = put(waiting, next_, (piece, low, middle), (before, sign), UNDECIDED)
            elif known != EMPTY:
                n = put(found, n, (piece, low, high), (before, after), known)
                turns += 1 if known == PROVEN else 0
        for k in range(many, next_):
            for column in range(COLUMNS_OF_PIECE):
                waiting[first + k - many, column] = waiting[k, column]
        many = first + next_ - many
    return n


@exact
def narrowed(of: Contacts, piece: int, low: float, high: float, before: int) -> tuple[float, float]:
    """Narrow an interval with one turn by bisection and interval Newton steps, until rounding of g' hides where the turn lies."""
    for _ in range(200):
        if not high - low > NARROW_SLOPE_CELL * high:
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


class Room(NamedTuple):
    """What a search works on, and what it finds."""

    waiting: Floats2  # cells that wait, and cells that are found
    found: Floats2
    ends: Integers2  # (pieces, 2): signs of g' at both ends of each piece
    left: Integers1  # (contacts,): number of bounds that may still be worked out


@exact_entry
def search(of: Contacts, first_piece: Integers1, most: int, room: Room) -> int:
    """Find all turns of contacts, and narrow the intervals that hold one; return their number, -1 if there is no room for them.

    `first_piece` has the first piece of each contact, and the number of all.
    """
    found, n = room.found, 0
    for contact in range(len(room.left)):
        limits = (first_piece[contact], first_piece[contact + 1], most, n)
        n = search_contact(of, limits, (room.waiting, found), room.ends, room.left[contact : contact + 1])
        if n > len(found):
            return -1
    for k in range(n):
        if found[k, KNOWN] == PROVEN and found[k, LOW] < found[k, HIGH]:
            low, high = found[k, LOW], found[k, HIGH]
            found[k, LOW], found[k, HIGH] = narrowed(of, int(found[k, PIECE]), low, high, int(found[k, BEFORE]))
    return n
