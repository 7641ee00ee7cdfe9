"""A sliding block integrated segment by segment with 40 digits, in another way than the package: by bisection of polynomials.

The load per mass (m/s^2) is a straight line between samples, and 0 after the last one.
"""

from __future__ import annotations

import math
from itertools import pairwise
from typing import NamedTuple

import mpmath

DIGITS = 40
HALVINGS = 150


class Slid(NamedTuple):
    """Where the block is at the end (m), how far away it was at most (m), its fastest rate (m/s), slips, and its last stop (s)."""

    displacement: float
    furthest: float
    fastest: float
    slips: int
    last_stop: float


def root(function, low, high):
    """Return where a function that is positive at `low` and not at `high` passes 0."""
    for _ in range(HALVINGS):
        middle = (low + high) / 2
        low, high = (middle, high) if function(middle) > 0 else (low, middle)
    return high


def first_stop(v, a, k, lasting):
    """Return the first time in (0, lasting] at which v + a t + k t^2/2 is 0 from above; None if there is none."""

    def rate(t):
        return v + t * (a + t * k / 2)

    marks = [mpmath.mpf(0)]
    if k != 0 and 0 < -a / k < lasting:
        marks.append(-a / k)  # between these marks the rate only rises or only falls
    marks.append(lasting)
    for low, high in pairwise(marks):
        if rate(high) <= 0:
            return root(rate, low, high)
    return None


def integrated_exactly(load, interval: float, forward: float, backward: float = math.inf) -> Slid:
    """Return how a block slides that yields at these accelerations (m/s^2), forward and backward."""
    with mpmath.workdps(DIGITS):
        samples, h = [mpmath.mpf(float(x)) for x in load], mpmath.mpf(interval)
        yields = {1: mpmath.mpf(forward), -1: mpmath.mpf(backward)}
        way, v, u, slips, stop = 0, mpmath.mpf(0), mpmath.mpf(0), 0, mpmath.nan
        furthest = fastest = mpmath.mpf(0)
        for n, (here, there) in enumerate(pairwise(samples)):
            s, slope = mpmath.mpf(0), (there - here) / h
            while s < h:
                now = here + slope * s
                if way == 0:
                    starts = {w: s for w in (1, -1) if w * now > yields[w]}
                    starts = starts or {w: (w * yields[w] - here) / slope for w in (1, -1) if w * there > yields[w]}
                    if not starts:
                        break
                    ((way, s),) = starts.items()
                    v, slips, now = mpmath.mpf(0), slips + 1, here + slope * s
                a, k, lasting = way * now - yields[way], way * slope, h - s
                a = a if v > 0 else max(a, mpmath.mpf(0))  # where it begins to slide, rounding alone is below 0
                moved = first_stop(v, a, k, lasting) if v > 0 else first_stop_after_start(a, k, lasting)
                time = lasting if moved is None else moved
                if k != 0 and 0 < -a / k < time:
                    top = -a / k
                    fastest = max(fastest, v + top * (a + top * k / 2))
                u += way * time * (v + time * (a / 2 + time * k / 6))
                v = max(v + time * (a + time * k / 2), mpmath.mpf(0)) if moved is None else mpmath.mpf(0)
                fastest, furthest, s = max(fastest, v), max(furthest, abs(u)), s + time
                if moved is not None:
                    way, stop = 0, n * h + s
        if way:
            u += way * v * v / (2 * yields[way])
            stop = (len(samples) - 1) * h + v / yields[way]
        return Slid(float(u), float(max(furthest, abs(u))), float(fastest), slips, float(stop))


def first_stop_after_start(a, k, lasting):
    """Return the first stop of a block that begins to slide now: it gathers speed before it slows down."""
    if k >= 0:
        return None
    end = -2 * a / k
    return end if end <= lasting else None
