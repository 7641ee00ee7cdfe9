"""Slip rates of folds to the last digit, in compiled code: the sign of g' at many places in an interval over which it changes."""

from __future__ import annotations

from typing import NamedTuple

from stickslip.contact.slopes import DAMPING, NORMAL
from stickslip.foundation.arrays import Floats, Floats1, Floats2, Integers1
from stickslip.foundation.kernels.kernels import exact, exact_entry
from stickslip.friction.formula import SLOPE, AtPoints, change_at

MOST_CUTS = 100
"""Cut an interval into parts at most this many times; it is at rounding long before."""
NEXT = 2.0**-53 * (1.0 + 2.0**-52)
"""A number that is increased by this share (1) of itself is rounded to the next larger one, unless it is tiny."""


@exact
def spacing(x: float) -> float:
    """Return the distance of a number above 0 to the next larger one (Rump et al. 2009, BIT 49, 419)."""
    return x + NEXT * x - x


@exact
def rises(of: AtPoints, pieces: Floats, piece: int, rate: float) -> bool:
    """Return True if g rises at a slip rate (m/s) by the formula of a piece."""
    slope = of.room[change_at(of, piece, 0.0, rate), SLOPE]
    return bool(pieces[piece, DAMPING] + pieces[piece, NORMAL] * slope > 0.0)


@exact
def fold_rate(of: AtPoints, pieces: Floats, piece: int, ends: tuple[float, float], parts: int) -> float:
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


class Intervals(NamedTuple):
    """Intervals over which g' changes its sign, each of one piece, and the number of parts into which they are cut."""

    piece: Integers1
    ends: Floats2  # (2, intervals), m/s
    parts: int


@exact_entry
def fold_rates(of: AtPoints, pieces: Floats2, intervals: Intervals, found: Floats1) -> None:
    """Write `fold_rate` of intervals; `pieces` are those of `Contacts`."""
    piece, ends, parts = intervals
    for k in range(len(piece)):
        found[k] = fold_rate(of, pieces, piece[k], (ends[0, k], ends[1, k]), parts)
