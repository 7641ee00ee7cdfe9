"""Points along the slip rate: where it begins, ends, turns or crosses a threshold, and the rest next to the crossings."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from stickslip.engine.codegen.compiler import kernel
from stickslip.engine.series.polynomial import clearly_positive, crossings, evaluate, magnitude, total
from stickslip.engine.state.layout import TERMS, Floats, HistoryPiece, Integers
from stickslip.engine.state.workspace import pieces_in

MAXIMA_PER_PIECE = 32
"""Largest number of extrema of the slip rate, or of crossings of the threshold, in one piece."""
SAME = 1e-12
"""Relative distance of a slip rate from the threshold below which rounding may decide on which side it is."""
SLACK = 1e-6
"""Share of the threshold by which the slip rate may rise on its way to rest, or fall on its way from it: rounding, and no turn."""
NO_REST = -1
"""Marks a crossing of the threshold from which the slip rate does not lead straight to rest."""
TURNS = math.inf
"""Marks a slip rate that turns."""


class Turns(NamedTuple):
    """Hold points along |slip rate|: where it begins, ends, turns, or crosses a threshold. Arrays may be longer than needed."""

    piece: Integers  # piece of the history
    xi: Floats  # place in the piece, from 0 to 1
    rate: Floats  # m/s
    kind: Integers  # +1 if the rate rises above the threshold there, -1 if it falls to it, 0 above it


def new_turns(capacity: int) -> Turns:
    """Return uninitialised arrays for `capacity` points."""
    return Turns(np.empty(capacity, np.int64), np.empty(capacity), np.empty(capacity), np.empty(capacity, np.int64))


@kernel
def turning_points(table: Integers, begin: int, length: int, threshold: float, turns: Turns) -> int:
    """Walk along |slip rate| from piece `begin` on and record its starts, ends, extrema and crossings of the threshold.

    `table` is that of a history (`Store.pieces`) with `length` pieces. Returns the number of points, or -1 if there is no room for
    all of them.
    """
    found, pieces = 0, pieces_in(table)
    p, slope, places = np.empty(TERMS), np.zeros(TERMS), np.empty(MAXIMA_PER_PIECE)
    above = False
    for n in range(begin, length):
        if found + 3 * MAXIMA_PER_PIECE > len(turns.piece):
            return -1
        mode, its_rate = pieces[n].mode, pieces[n].rate
        sign = 1.0 if mode >= 0 else -1.0
        for k in range(TERMS):
            p[k] = sign * its_rate[k]
        contiguous = n > begin and not starts_from_rest(pieces, n)
        begins = mode != 0 and (p[0] > threshold or (p[0] == threshold and _rises(p)))
        if above and not (begins and contiguous):
            found = _note(turns, found, (n - 1, 1.0), 0.0, -1)
            above = False
        if mode == 0:
            continue
        if begins:
            found = _note(turns, found, (n, 0.0), p[0], 0 if above else 1)
            above = True
        monotone, last = is_monotone(p, slope), total(p)
        p[0] -= threshold
        stays = monotone and p[0] * (last - threshold) > 0.0 and abs(last - threshold) > SAME * last
        crossed = 0 if stays or keeps_its_sign(p) else crossings(p, places)
        for i in range(crossed):
            above = not above
            found = _note(turns, found, (n, places[i]), threshold, 1 if above else -1)
        p[0] += threshold
        for i in range(0 if monotone else crossings(slope, places)):
            height = evaluate(p, places[i])
            if height > threshold:
                found = _note(turns, found, (n, places[i]), height, 0)
        if above:
            found = _note(turns, found, (n, 1.0), last, 0)
    return found


@kernel
def is_monotone(p: Floats, slope: Floats) -> bool:
    """Return True if bounds show at once that p only rises or only falls on (0, 1].

    `slope` receives the derivative of p, with the sign that makes it start at or above zero.
    """
    way = 1.0 if p[1] >= 0.0 else -1.0
    for k in range(TERMS - 1):
        slope[k] = way * (k + 1) * p[k + 1]
    # The quickest bound that suffices is asked first.
    return (slope[0] > 0.0 and (slope[0] > magnitude(slope) or clearly_positive(slope))) or keeps_its_sign(slope)


@kernel
def keeps_its_sign(c: Floats) -> bool:
    """Return True if bounds show at once that the polynomial does not change sign on (0, 1].

    The bounds come from Horner's rule in interval arithmetic, after leading zeros are divided out.
    """
    low = high = 0.0
    lead = 0
    while lead < TERMS - 1 and c[lead] == 0.0:
        lead += 1
    for k in range(TERMS - 1, lead - 1, -1):
        low, high = c[k] + min(low, 0.0), c[k] + max(high, 0.0)
    return low > 0.0 or high < 0.0


@kernel
def _rises(p: Floats) -> bool:
    for k in range(1, len(p)):
        if p[k] != 0.0:
            return p[k] > 0.0
    return False


@kernel
def _note(turns: Turns, n: int, place: tuple[int, float], rate: float, kind: int) -> int:
    """Write point n, at a place (piece, xi), and return the number of points."""
    turns.piece[n], turns.xi[n] = place
    turns.rate[n], turns.kind[n] = rate, kind
    return n + 1


# ---- onset and arrest -------------------------------------------------------------------------------------------------------


@kernel
def extend_to_rest(table: Integers, span: tuple[int, int], threshold: float, turns: Turns, found: int) -> None:
    """Move each crossing of the threshold to the onset of slip before it, or the arrest after it, unless the rate turns between.

    The first `found` points are in order of time. `span` holds the first piece of the history that was searched, and the number of
    pieces of the history.
    """
    for n in range(found):
        way = -turns.kind[n]
        if way == 0:
            continue
        piece = piece_next_to_rest(table, span, (turns.piece[n], turns.xi[n]), way, threshold)
        if piece != NO_REST:
            turns.piece[n], turns.xi[n] = piece, 0.0 if way < 0 else 1.0
            turns.rate[n] = min(turns.rate[n], abs(evaluate(pieces_in(table)[piece].rate, turns.xi[n])))


@kernel
def piece_next_to_rest(table: Integers, span: tuple[int, int], place: tuple[int, float], way: int, threshold: float) -> int:
    """Return the piece in which slip begins from rest before a place (way is -1), or comes to rest after it (1).

    The slip rate passes the threshold (m/s) at that place (piece, xi). Returns NO_REST if the rate turns between the place and the
    rest, or if the history does not reach to the rest.
    """
    pieces, rate = pieces_in(table), np.empty(TERMS)
    (n, xi), slack = place, SLACK * threshold
    low = threshold - slack
    while True:
        for k in range(TERMS):
            rate[k] = pieces[n].mode * pieces[n].rate[k]
        low = descend(rate, xi, way, low, slack)
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

    Where slip turns round, or begins again as it ends, the contact rests for an instant, of which the history has no piece. A
    contact whose load balances friction to the last digit may also slide at a rate of zero: it rests all the same.
    """
    if n == 0 or pieces[n].mode != pieces[n - 1].mode or pieces[n].rate[0] == 0.0:
        return True
    return pieces[n - 1].rate[0] == 0.0 and total(pieces[n - 1].rate) == 0.0


@kernel
def descend(rate: Floats, xi: float, way: int, low: float, slack: float) -> float:
    """Follow |slip rate| (m/s), a polynomial, from the place xi to the start of its piece (way is -1) or to its end (1).

    Returns the lowest value so far, of which `low` is that before, or TURNS if the rate rises by more than `slack` above it.
    """
    slope, places = np.zeros(TERMS), np.empty(MAXIMA_PER_PIECE)
    extrema = 0 if is_monotone(rate, slope) else crossings(slope, places)
    for k in range(extrema + 1):
        last = 0.0 if way < 0 else 1.0
        place = last if k == extrema else places[k if way > 0 else extrema - 1 - k]
        if way * (place - xi) <= 0.0:
            continue
        value = evaluate(rate, place)
        if value > low + slack:
            return TURNS
        low = min(low, value)
    return low
