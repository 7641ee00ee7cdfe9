"""Slip rates of folds to the last digit, in compiled code: the sign of g' at many places in an interval over which it changes."""

from __future__ import annotations

import math

from stickslip.contact.slopes import DAMPING, NORMAL, Integers
from stickslip.foundation.arrays import Floats
from stickslip.foundation.compiled import exact
from stickslip.friction.formula.at_points import Points, change_at
from stickslip.friction.formula.operations.changes import SLOPE

MOST_CUTS = 100
"""Largest number of times that an interval is cut into parts; it is at rounding long before."""


@exact
def spacing(x: float) -> float:
    """Return the distance of a number above 0 to the next larger one."""
    return math.ldexp(1.0, max(math.frexp(x)[1] - 53, -1074))


@exact
def rises(of: Points, pieces: Floats, piece: int, rate: float) -> bool:
    """Return True if g rises at a slip rate (m/s) by the formula of a piece."""
    slope = of.room[change_at(of, piece, 0.0, rate), SLOPE]
    return pieces[piece, DAMPING] + pieces[piece, NORMAL] * slope > 0.0


@exact
def fold_rate(of: Points, pieces: Floats, piece: int, ends: tuple[float, float], parts: int) -> float:
    """Return the last, or the first, slip rate with rising g in an interval, which is cut into parts again and again."""
    low, high = ends
    rising = rises(of, pieces, piece, low)
    for _ in range(MOST_CUTS):
        if not high - low > 2.0 * spacing(high):
            break
        step, k = (high - low) / parts, 1
        while k < parts and rises(of, pieces, piece, k * step + low) == rising:
            k += 1
        if k == parts:
            low = (k - 1) * step + low
        else:
            low, high = (k - 1) * step + low, k * step + low
    return low if rising else high


@exact
def fold_rates(  # noqa: PLR0917 # arrays that cross from Python to compiled code
    steps: Integers,
    values: Floats,
    spans: Integers,
    numbers: Floats,
    room: Floats,
    pieces: Floats,
    piece: Integers,
    ends: Floats,
    parts: int,
    found: Floats,
) -> None:
    """Write `fold_rate` of intervals, each of one piece, whose ends are the rows of `ends`."""
    of = Points(steps, values, spans, numbers, room)
    for k in range(len(piece)):
        found[k] = fold_rate(of, pieces, piece[k], (ends[0, k], ends[1, k]), parts)
