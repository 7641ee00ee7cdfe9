"""Points along the slip rate: where it begins, ends, turns or crosses a threshold, and the rest next to the crossings."""

from __future__ import annotations

import math
from typing import NamedTuple

from stickslip.engine.series.polynomial import MOST_CROSSINGS, bound_below, crossings, differentiate, evaluate, total
from stickslip.engine.state.layout import TERMS, Floats, HistoryPiece
from stickslip.engine.state.workspace import pieces_in
from stickslip.foundation.arrays import Floats2, Integers2
from stickslip.foundation.kernels.kernels import entry, inlined, kernel
from stickslip.foundation.kernels.memory.pointers import record_at
from stickslip.foundation.kernels.memory.records import MemoryRecord, floats_inside

NEAR_THRESHOLD = 1e-12
"""If a slip rate is closer to the threshold, or a bound closer to zero, than this (relative), rounding may decide its sign."""
SLACK = 1e-6
"""A rise on the way to rest, or a fall on the way from it, by less than this share of the threshold is rounding and no turn."""
NO_REST = -1
"""Marks a crossing of the threshold that does not lead straight to rest."""
TURNS = math.inf
"""Marks a slip rate that turns."""
FULL = -1
"""Number of points if there is no room for all of them."""


class Turn(MemoryRecord):
    """Hold a point along |slip rate|: where it begins, ends, turns, or crosses a threshold."""

    piece: int  # piece of the history
    xi: float  # place in the piece, from 0 to 1
    rate: float  # m/s
    kind: int  # +1 if the rate rises above the threshold there, -1 if it falls to it, 0 above it


class Known(MemoryRecord):
    """Hold what is known of a piece of the history, because lanes of a batch have made it."""

    way: int  # +1 or -1 if |slip rate| is proven to rise or to fall in it, from the piece before on; else 0
    grown: float  # m: slip in it, or NaN


class Spare(MemoryRecord):
    """Hold room for the polynomials of one piece."""

    rate: Floats = floats_inside(TERMS)  # m/s: |slip rate|
    slope: Floats = floats_inside(TERMS)
    spare: Floats = floats_inside(TERMS)
    found: Floats = floats_inside(MOST_CROSSINGS)  # places in the piece


known_in = record_at(Known)
"""Function for compiled code that returns what is known of the first piece, in memory or at an address."""
turns_in = record_at(Turn)
"""Function for compiled code that returns the first of the points in memory."""
spare_in = record_at(Spare)
"""Function for compiled code that returns the room at a pointer or in an array."""


class Search(NamedTuple):
    """Hold pointers to the history to search and to room for the points."""

    pieces: HistoryPiece  # the history (`Store.pieces`)
    known: Known  # what is known of each piece
    turns: Turn  # the points
    room: int  # number of points that fit
    spare: Spare


class SearchMemory(NamedTuple):
    """Hold the arrays of a `Search`: points, known and room."""

    turns: Integers2
    known: Integers2
    spare: Floats2


@entry
def search_history(table: Integers2, memory: SearchMemory, begin: int, threshold: float, sticks: bool) -> int:
    """Do what `find_turns` does for the table of a history."""
    points = turns_in(memory.turns)
    search = Search(pieces_in(table), known_in(memory.known), points, len(memory.turns), spare_in(memory.spare))
    return find_turns(search, (begin, len(table)), threshold, sticks)


@kernel
def find_turns(search: Search, span: tuple[int, int], threshold: float, sticks: bool) -> int:
    """Find the points of |slip rate| in order of time, and return their number, or FULL if there is no room for all of them.

    `span` holds the first piece that is searched and the number of pieces of the history. If the contact `sticks`, crossings of the
    threshold (m/s) are moved to the onset and the arrest of slip.
    """
    found = turning_points(search, span, threshold)
    put_in_order(search.turns, found)
    if sticks:
        extend_to_rest(search, span, threshold, found)
    return found


@kernel
def turning_points(search: Search, span: tuple[int, int], threshold: float) -> int:
    """Walk along |slip rate| and record its starts, ends, extrema and crossings of the threshold; return their number or FULL.

    Where it is known only to rise, or only to fall, through several pieces, no point between them is recorded.
    """
    pieces, turns = search.pieces, search.turns
    found, above, heading, last = 0, False, 0, span[1] - 1
    for n in range(span[0], span[1]):
        if found + 3 * MOST_CROSSINGS > search.room:
            return FULL
        way = search.known[n].way
        if way < 0 and (n == last or search.known[n + 1].way == 0 or abs(pieces[n + 1].rate[0]) <= 2.0 * threshold):
            way = 0  # it may fall to the threshold
        if above and way != 0:
            if heading == -way:
                found = note_end(pieces, turns, found, n - 1)
            heading = way
            continue
        if heading != 0:
            found, heading = note_end(pieces, turns, found, n - 1), 0
        found, above = points_in_piece(search, n, n == span[0], threshold, (found, above))
    return note_end(pieces, turns, found, last) if heading != 0 else found


@kernel
def points_in_piece(search: Search, n: int, first: bool, threshold: float, so_far: tuple[int, bool]) -> tuple[int, bool]:
    """Record the points in piece n, which is the first that is searched or not, after those `so_far`.

    Before and after it, say how many points there are, and whether the rate is above the threshold.
    """
    (found, above), pieces, turns, mode = so_far, search.pieces, search.turns, search.pieces[n].mode
    p, slope, places = search.spare.rate, search.spare.slope, search.spare.found
    for k in range(TERMS):
        p[k] = pieces[n].rate[k] if mode >= 0 else -pieces[n].rate[k]
    begins = mode != 0 and (p[0] > threshold or (p[0] == threshold and _rises(p)))
    if above and not (begins and not first and not starts_from_rest(pieces, n)):
        found = _note(turns, found, (n - 1, 1.0), 0.0, -1)
        above = False
    if mode == 0:
        return found, above
    if begins:
        found = _note(turns, found, (n, 0.0), p[0], 0 if above else 1)
        above = True
    monotone, last = is_monotone(p, slope), total(p)
    p[0] -= threshold
    stays = monotone and p[0] * (last - threshold) > 0.0 and abs(last - threshold) > NEAR_THRESHOLD * last
    crossed = 0 if stays or keeps_its_sign(p) else crossings(p, places, search.spare.spare)
    for i in range(crossed):
        above = not above
        found = _note(turns, found, (n, places[i]), threshold, 1 if above else -1)
    p[0] += threshold
    for i in range(0 if monotone else crossings(slope, places, search.spare.spare)):
        height = evaluate(p, places[i])
        if height > threshold:
            found = _note(turns, found, (n, places[i]), height, 0)
    return _note(turns, found, (n, 1.0), last, 0) if above else found, above


@inlined
def note_end(pieces: HistoryPiece, turns: Turn, n: int, piece: int) -> int:
    """Write the end of a piece as point n, and return the number of points."""
    return _note(turns, n, (piece, 1.0), abs(total(pieces[piece].rate)), 0)


@kernel
def put_in_order(turns: Turn, found: int) -> None:
    """Sort the first `found` points by piece and place; at one place, points with rising rate come first.

    The pieces are in order already.
    """
    for n in range(1, found):
        piece, xi, rate, kind = turns[n].piece, turns[n].xi, turns[n].rate, turns[n].kind
        k = n
        while k > 0 and turns[k - 1].piece == piece and comes_later(turns[k - 1].xi, turns[k - 1].kind, xi, kind):
            before, here = turns[k - 1], turns[k]
            here.piece, here.xi, here.rate, here.kind = before.piece, before.xi, before.rate, before.kind
            k -= 1
        _note(turns, k, (piece, xi), rate, kind)


@inlined
def comes_later(xi: float, kind: int, other_xi: float, other_kind: int) -> bool:
    """Return True if a point belongs after another one of the same piece."""
    return xi > other_xi or (xi == other_xi and xi < 1.0 and kind < other_kind)


@kernel
def is_monotone(p: Floats, slope: Floats) -> bool:
    """Return True if bounds show at once that p only rises or only falls on (0, 1].

    `slope` receives the derivative of p, with the sign that makes it start at or above zero.
    """
    way = 1.0 if p[1] >= 0.0 else -1.0
    differentiate(p, way, slope)
    return keeps_its_sign(slope)


@kernel
def keeps_its_sign(c: Floats) -> bool:
    """Return True if bounds show at once that the polynomial does not change sign on (0, 1].

    They come from Bernstein coefficients, or from Horner's rule in interval arithmetic, after leading zeros are divided out. A root
    at 1 may lie inside by rounding, and counts.
    """
    if c[0] > 0.0 and bound_below(c) > NEAR_THRESHOLD * c[0]:
        return True
    if c[0] > 0.0 and total(c) < 0.0:
        return False
    low = high = 0.0
    lead = 0
    while lead < TERMS - 1 and c[lead] == 0.0:
        lead += 1
    for k in range(TERMS - 1, lead - 1, -1):
        low, high = c[k] + min(low, 0.0), c[k] + max(high, 0.0)
    return low > 0.0 or high < 0.0


@kernel
def _rises(p: Floats) -> bool:
    for k in range(1, TERMS):
        if p[k] != 0.0:
            return p[k] > 0.0
    return False


@inlined
def _note(turns: Turn, n: int, place: tuple[int, float], rate: float, kind: int) -> int:
    """Write point n, at a place (piece, xi), and return the number of points."""
    turn = turns[n]
    turn.piece, turn.xi = place
    turn.rate, turn.kind = rate, kind
    return n + 1


# ---- onset and arrest -------------------------------------------------------------------------------------------------------


@kernel
def extend_to_rest(search: Search, span: tuple[int, int], threshold: float, found: int) -> None:
    """Move each crossing of the threshold to the onset of slip before it, or the arrest after it, unless the rate turns between.

    The first `found` points are in order of time.
    """
    for n in range(found):
        turn = search.turns[n]
        way = -turn.kind
        if way == 0:
            continue
        piece = piece_next_to_rest(search, span, (turn.piece, turn.xi), way, threshold)
        if piece != NO_REST:
            turn.piece, turn.xi = piece, 0.0 if way < 0 else 1.0
            turn.rate = min(turn.rate, abs(evaluate(search.pieces[piece].rate, turn.xi)))


@kernel
def piece_next_to_rest(search: Search, span: tuple[int, int], place: tuple[int, float], way: int, threshold: float) -> int:
    """Return the piece of the onset of slip before a place (way is -1), or of the arrest after it (1).

    The slip rate passes the threshold (m/s) at that place (piece, xi). Returns NO_REST if the rate turns between the place and the
    rest, or if the history does not reach to the rest.
    """
    pieces, rate = search.pieces, search.spare.rate
    (n, xi), slack = place, SLACK * threshold
    low = threshold - slack
    while True:
        for k in range(TERMS):
            rate[k] = pieces[n].mode * pieces[n].rate[k]
        low = descend(search.spare, (xi, way), low, slack)
        if low == TURNS:
            return NO_REST
        behind = n if way < 0 else n + 1
        if behind < span[1] and starts_from_rest(pieces, behind):
            return n
        # A piece that follows in a later round trip without rest comes after a leap over creep, whose rates are averages.
        if behind <= span[0] or behind >= span[1] or pieces[behind].trip - pieces[behind - 1].trip > 1:
            return NO_REST
        n, xi = n + way, 0.0 if way > 0 else 1.0
        entry = pieces[n].mode * evaluate(pieces[n].rate, xi)
        if entry > low + slack:
            return NO_REST
        low = min(low, entry)


@kernel
def starts_from_rest(pieces: HistoryPiece, n: int) -> bool:
    """Return True if slip in a piece begins from rest, or, at a piece at rest, if rest begins there.

    If slip turns round, or begins again as it ends, the contact rests for an instant without a piece in the history. A contact
    whose load balances friction to the last digit may also slide at a rate of zero: it rests all the same.
    """
    if n == 0 or pieces[n].mode != pieces[n - 1].mode or pieces[n].rate[0] == 0.0:
        return True
    return pieces[n - 1].rate[0] == 0.0 and total(pieces[n - 1].rate) == 0.0


@kernel
def descend(memory: Spare, start: tuple[float, int], low: float, slack: float) -> float:
    """Follow |slip rate| (m/s), a polynomial, from the place xi to the start of its piece (way is -1) or to its end (1).

    `start` is xi and way, and `low` the lowest value before. Returns the lowest value so far, or TURNS if the rate rises by more
    than `slack` above it.
    """
    (xi, way), spare = start, spare_in(memory)
    rate, places, last = spare.rate, spare.found, 0.0 if way < 0 else 1.0
    extrema = 0 if xi == last or is_monotone(rate, spare.slope) else crossings(spare.slope, places, spare.spare)
    for k in range(extrema + 1):
        place = last if k == extrema else places[k if way > 0 else extrema - 1 - k]
        if way * (place - xi) <= 0.0:
            continue
        value = evaluate(rate, place)
        if value > low + slack:
            return TURNS
        low = min(low, value)
    return low
