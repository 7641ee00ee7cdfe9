"""Intervals that are rounded outwards, and the Taylor coefficients of operations as such intervals.

The coefficients of a formula in the slip rate are its value, its first derivative and half its second one. Each node of a formula
has a row of a table: the low ends of its coefficients in columns 0 to 2, the high ends in columns 3 to 5, and in the last column
how many orders may differ from 0; the columns of others are not read. A rule writes the row n of a node from the rows i and j of
its arguments, of which a function has only the first.

An infinite end means that nothing is known on that side; it is never reached, so that 0 times such an end is 0.

Sources: Moore, Kearfott & Cloud 2009, Introduction to Interval Analysis; Griewank & Walther 2008, Evaluating Derivatives, ch. 13.
"""

from __future__ import annotations

import math

from stickslip.foundation.arrays import Floats
from stickslip.foundation.kernels.kernels import exact
from stickslip.friction.formula.operations.sets import multiplied, squared

ORDERS = 3
"""Number of Taylor coefficients: value, first derivative and half the second one."""
COUNT = 2 * ORDERS
"""Column with the number of orders of a node, one more than the last column of ends."""
ONE_STEP = 2.3e-16
"""Relative rounding error (1) of a sum, product or quotient, with room to spare: it is 1.2e-16 at most."""
LIBRARY = 1.8e-15
"""Relative error (1) assumed for functions of the library of mathematics: eight units in the last place."""
SMALLEST_RESULT = 1e-307
"""Absolute error assumed for all operations but sums: smaller results may lose digits or become 0."""
_HUGE = 1.7e308
"""A number that is smaller than what overflows."""
_INFINITE = math.inf

Ends = tuple[float, float]
"""Low and high end of an interval."""


@exact
def known(low: float, high: float) -> Ends:
    """Return an interval, of which nothing is known on a side where the end is not a number; an overflow is not reached."""
    if not (abs(low) < _INFINITE and abs(high) < _INFINITE):
        low = -_INFINITE if math.isnan(low) else min(low, _HUGE)
        high = _INFINITE if math.isnan(high) else max(high, -_HUGE)
    return low, high


@exact
def rounded(low: float, high: float, error: float) -> Ends:
    """Move ends outwards by a relative error, where no digits are lost and nothing becomes 0."""
    low, high = known(low, high)
    return low - abs(low) * error, high + abs(high) * error


@exact
def outward(low: float, high: float, error: float) -> Ends:
    """Move ends outwards by a relative error and by SMALLEST_RESULT; a low end stays at least 0 if it was."""
    low, high = known(low, high)
    return outward_from(low, high, error, low >= 0.0)


@exact
def outward_from(low: float, high: float, error: float, positive: bool) -> Ends:
    """Do the same; low ends stay at least 0 where the values are `positive`."""
    low, high = known(low, high)
    low, high = low - (abs(low) * error + SMALLEST_RESULT), high + (abs(high) * error + SMALLEST_RESULT)
    return (max(low, 0.0) if positive else low), high


@exact
def add(a: float, b: float, c: float, d: float) -> Ends:
    """Return [a, b] + [c, d]."""
    return rounded(a + c, b + d, ONE_STEP)


@exact
def multiply(a: float, b: float, c: float, d: float) -> Ends:
    """Return [a, b] times [c, d]."""
    low, high = multiplied(a, b, c, d)
    return outward_from(low, high, ONE_STEP, min(a, c) >= 0.0)


@exact
def square(a: float, b: float) -> Ends:
    """Return [a, b] squared, which is never negative."""
    low, high = squared(a, b)
    return outward(low, high, ONE_STEP)


@exact
def reciprocal(a: float, b: float) -> Ends:
    """Return 1 / [a, b]; nothing is known if the interval holds 0."""
    if a <= 0.0 <= b:
        return -_INFINITE, _INFINITE
    return outward(1.0 / b, 1.0 / a, ONE_STEP)


@exact
def of_positive(a: float, b: float) -> Ends:
    """Return 1 / [a, b]; nothing is known where it may not be positive."""
    if a > 0.0:
        return reciprocal(a, b)
    return -_INFINITE, _INFINITE


# ---- rules of operations --------------------------------------------------------------------------------------------------------


@exact
def sum_of_series(w: Floats, n: int, i: int, j: int) -> None:
    """Write the coefficients of a + b."""
    p, q = int(w[i, COUNT]), int(w[j, COUNT])
    for k in range(max(p, q)):
        if k >= q:
            w[n, k], w[n, k + 3] = w[i, k], w[i, k + 3]
        elif k >= p:
            w[n, k], w[n, k + 3] = w[j, k], w[j, k + 3]
        else:
            w[n, k], w[n, k + 3] = add(w[i, k], w[i, k + 3], w[j, k], w[j, k + 3])


@exact
def difference_of_series(w: Floats, n: int, i: int, j: int) -> None:
    """Write the coefficients of a - b."""
    p, q = int(w[i, COUNT]), int(w[j, COUNT])
    for k in range(max(p, q)):
        if k >= q:
            w[n, k], w[n, k + 3] = w[i, k], w[i, k + 3]
        elif k >= p:
            w[n, k], w[n, k + 3] = -w[j, k + 3], -w[j, k]
        else:
            w[n, k], w[n, k + 3] = add(w[i, k], w[i, k + 3], -w[j, k + 3], -w[j, k])


@exact
def product_of_series(w: Floats, n: int, i: int, j: int) -> None:
    """Write the coefficients of a b; a square is narrower than a product of two factors that vary independently."""
    p, q = int(w[i, COUNT]), int(w[j, COUNT])
    if i == j:
        _square_of_series(w, n, i)
    elif p == 1 or q == 1:
        for k in range(max(p, q)):
            x, y = min(k, p - 1), min(k, q - 1)
            w[n, k], w[n, k + 3] = multiply(w[i, x], w[i, x + 3], w[j, y], w[j, y + 3])
    else:
        w[n, 0], w[n, 3] = multiply(w[i, 0], w[i, 3], w[j, 0], w[j, 3])
        for k in range(1, ORDERS):
            low, high, some = 0.0, 0.0, False
            for x in range(max(0, k + 1 - q), min(p, k + 1)):
                c, d = multiply(w[i, x], w[i, x + 3], w[j, k - x], w[j, k - x + 3])
                low, high = add(low, high, c, d) if some else (c, d)
                some = True
            w[n, k], w[n, k + 3] = low, high


@exact
def _square_of_series(w: Floats, n: int, i: int) -> None:
    p = int(w[i, COUNT])
    w[n, 0], w[n, 3] = square(w[i, 0], w[i, 3])
    if p > 1:
        low, high = multiply(w[i, 0], w[i, 3], w[i, 1], w[i, 4])
        w[n, 1], w[n, 4] = 2.0 * low, 2.0 * high
        low, high = square(w[i, 1], w[i, 4])
        if p > 2:
            c, d = multiply(w[i, 0], w[i, 3], w[i, 2], w[i, 5])
            low, high = add(2.0 * c, 2.0 * d, low, high)
        w[n, 2], w[n, 5] = low, high


@exact
def quotient_of_series(w: Floats, n: int, i: int, j: int) -> None:
    """Write the coefficients of a / b."""
    p, q = int(w[i, COUNT]), int(w[j, COUNT])
    c, d = reciprocal(w[j, 0], w[j, 3])
    for k in range(p if q == 1 else 1):
        w[n, k], w[n, k + 3] = multiply(w[i, k], w[i, k + 3], c, d)
    if q > 1:
        low, high = multiply(w[n, 0], w[n, 3], w[j, 1], w[j, 4])
        low, high = -high, -low
        if p > 1:
            low, high = add(w[i, 1], w[i, 4], low, high)
        w[n, 1], w[n, 4] = multiply(low, high, c, d)
        low, high = multiply(w[n, 1], w[n, 4], w[j, 1], w[j, 4])
        low, high = -high, -low
        if q > 2:
            less, more = multiply(w[n, 0], w[n, 3], w[j, 2], w[j, 5])
            low, high = add(-more, -less, low, high)
        if p > 2:
            low, high = add(w[i, 2], w[i, 5], low, high)
        w[n, 2], w[n, 5] = multiply(low, high, c, d)


@exact
def chain(w: Floats, n: int, i: int, value: Ends, slopes: tuple[Ends, Ends]) -> None:
    """Write the coefficients of f(a) from those of a, f(a), and bounds of f' and f''/2 there."""
    p, (first, second) = int(w[i, COUNT]), slopes
    w[n, 0], w[n, 3] = value
    if p > 1:
        w[n, 1], w[n, 4] = multiply(first[0], first[1], w[i, 1], w[i, 4])
        low, high = square(w[i, 1], w[i, 4])
        low, high = multiply(second[0], second[1], low, high)
        if p > 2:
            c, d = multiply(first[0], first[1], w[i, 2], w[i, 5])
            low, high = add(c, d, low, high)
        w[n, 2], w[n, 5] = low, high
