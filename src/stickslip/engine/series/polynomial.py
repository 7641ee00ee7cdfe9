"""Polynomials on a piece of the history: TERMS coefficients, ascending, in the piece's own variable, usually on [0, 1].

Coefficients come as pointers (in the engine) or as arrays (in tables made from a history): both are indexed alike. Functions
without a decision also work on several polynomials side by side (pointers to lanes of `memory.simd`). Sums are taken in four
fixed parts, which shortens the chain of additions that depend on each other and gives lanes the same bits as single floats.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from stickslip.engine.state.layout import TERMS
from stickslip.foundation.arrays import Floats1
from stickslip.foundation.kernels.kernels import entry, inlined, kernel
from stickslip.foundation.kernels.memory.addresses import room_for
from stickslip.foundation.kernels.memory.simd import fused

Floats = NDArray[np.float64]

NONE = math.inf
"""Place that functions return if there is no root."""
RECIPROCAL = np.array([0.0, *(1.0 / k for k in range(1, 2 * TERMS))])
"""1 / k at index k, and 0 at index 0: a product is faster than a division."""
ONES = np.ones(TERMS)
"""Weights of plain sums over coefficients."""
LOW = 9
"""Number of terms (1) in the first, cheap test for a root."""


def _bernstein(terms: int) -> Floats:
    """Return a matrix whose row k holds the Bernstein coefficients on [0, 1] of x^k, a polynomial of the given number of terms."""
    return np.array([[math.comb(j, k) / math.comb(terms - 1, k) for j in range(terms)] for k in range(terms)])


BERNSTEIN = _bernstein(TERMS)
LOW_BERNSTEIN = _bernstein(LOW)
"""Bernstein coefficients of the powers of x among polynomials of TERMS and of LOW terms (1)."""
SMALLEST_INTERVAL = 1e-15
"""Intervals narrower than this (1) are not bisected further: floats near 1 are not much denser."""
NEGLIGIBLE_POLYNOMIAL = 1e-300
"""A polynomial of at most this magnitude (any unit) on an interval counts as zero there: near the smallest normal number its
coefficients lose their digits or vanish one after the other, and a bisection would never end."""
UNCLEAR = -1
"""Number of sign changes if rounding may hide one."""
SIGN_ROUNDING = 1e-14
"""Rounding of a Bernstein coefficient (1), as a share of the magnitude of the polynomial."""
CONVERGED = 1e-10
"""Newton's method ends after a correction smaller than this, relative to the root (1): the next one would be about its square."""
DOUBLINGS = 64
"""Largest number of doublings (1) that lead from the narrowest interval of a bisection to the whole of [0, 1], and more."""
MOST_CROSSINGS = 32
"""Room for crossings: more than a polynomial of TERMS terms has, apart from rounding."""
MOST_INTERVALS = 4096
"""Largest number of intervals (1) of a bisection. Clusters of roots and roots of any order take at most some 400 of them. Without
this limit, a polynomial that is not finite could be bisected for ever."""


@inlined
def copy(source: Floats, target: Floats, n: int) -> None:
    """Copy the first n numbers of a row to another."""
    for k in range(n):
        target[k] = source[k]


@inlined
def fill(target: Floats, value: float) -> None:
    """Set all TERMS numbers of a row to a value."""
    for k in range(TERMS):
        target[k] = value


@inlined
def powers_of(x: float, out: Floats) -> None:
    """Write 1, x, x^2, ... into `out`, each as a product of two powers of half its order, to keep chains of products short."""
    out[0], out[1] = 1.0, x
    for k in range(2, TERMS):
        out[k] = out[k >> 1] * out[(k + 1) >> 1]


@inlined
def multiply(c: Floats, powers: Floats, out: Floats) -> None:
    """Write into `out` the coefficients of y -> p(x y), from the powers of x."""
    for k in range(TERMS):
        out[k] = c[k] * powers[k]


@kernel
def evaluate(c: Floats, x: float) -> float:
    """Return p(x), by Horner's rule."""
    value = c[TERMS - 1]
    for k in range(TERMS - 2, -1, -1):
        value = value * x + c[k]
    return value


@kernel
def degree(c: Floats) -> int:
    """Return the index of the last coefficient that is not zero; 0 for the zero polynomial."""
    n = TERMS - 1
    while n > 0 and c[n] == 0.0:
        n -= 1
    return n


@entry
def restrict(c: Floats1, start: float, width: float, out: Floats1) -> None:
    """Write into `out` the coefficients of y -> p(start + width y), exact but for rounding."""
    n = degree(c)
    for k in range(n + 1, TERMS):
        out[k] = 0.0
    restrict_low(c, n, start, width, out)


@kernel
def restrict_low(c: Floats, n: int, start: float, width: float, out: Floats) -> None:
    """Do the same as `restrict` for a polynomial of degree n, and leave the coefficients of `out` above n unchanged."""
    for k in range(n + 1):
        out[k] = c[k]
    if start != 0.0:
        shift_low(out, n, start)
    scale_low(out, n, width)


@inlined
def shift_low(c: Floats, n: int, start: float) -> None:
    """Turn the coefficients of a polynomial p(x) of degree n into those of p(start + x), in place."""
    for j in range(n):
        for k in range(n - 1, j - 1, -1):
            c[k] = c[k] + start * c[k + 1]


@inlined
def scale_low(c: Floats, n: int, width: float) -> None:
    """Turn the coefficients of a polynomial p(x) of degree n into those of p(width x), in place."""
    power = width
    for k in range(1, n + 1):
        c[k] = c[k] * power
        power = power * width


@kernel
def turn_over(c: Floats) -> None:
    """Change the sign of a polynomial in place."""
    for k in range(TERMS):
        c[k] = -c[k]


@inlined
def sizes_from(c: Floats, first: int) -> float:
    """Return the sum of |c_k| for k >= `first`."""
    a, b, d, e = abs(c[first]), abs(c[first + 1]), abs(c[first + 2]), abs(c[first + 3])
    for k in range(first + 4, TERMS - 3, 4):
        a, b, d, e = a + abs(c[k]), b + abs(c[k + 1]), d + abs(c[k + 2]), e + abs(c[k + 3])
    for k in range(TERMS - (TERMS - first) % 4, TERMS):
        a = a + abs(c[k])
    return (a + b) + (d + e)


@inlined
def magnitude(c: Floats) -> float:
    """Return the sum of |c_k| for k >= 1: a bound on |p - c_0| on [-1, 1]."""
    return sizes_from(c, 1)


@inlined
def variation_on_disc(c: Floats, powers: Floats, ratio: float) -> float:
    """Return a bound on |p - c_0| on a disc, whose radius is `ratio` times the length that has the given powers."""
    square = ratio * ratio
    power, found = square, fused(ratio, abs(c[2]) * powers[2], abs(c[1]) * powers[1])
    for n in range(3, TERMS - 1, 2):
        found = fused(power, fused(ratio, abs(c[n + 1]) * powers[n + 1], abs(c[n]) * powers[n]), found)
        power = power * square
    return ratio * found


@inlined
def bounds_on_disc(c: Floats, radius: float) -> tuple[float, float]:
    """Return bounds on a disc of radius r: on |p - c_0|, and on |integral of p from 0 - c_0 x| / r.

    They are sums of magnitudes, two terms at a time.
    """
    first, second = abs(c[1]), abs(c[2]) * radius
    value, mean = first + second, fused(RECIPROCAL[3], second, RECIPROCAL[2] * first)
    square = radius * radius
    power = square
    for k in range(3, TERMS - 1, 2):
        first, second = abs(c[k]), abs(c[k + 1]) * radius
        value = fused(power, first + second, value)
        mean = fused(power, fused(RECIPROCAL[k + 2], second, RECIPROCAL[k + 1] * first), mean)
        power = power * square
    return radius * value, radius * mean


@inlined
def bound_of_slope(c: Floats, radius: float) -> float:
    """Return a bound on |p' - c_1| on a disc of the given radius."""
    square = radius * radius
    slope, power = 2.0 * abs(c[2]) * radius, square
    for k in range(3, TERMS - 1, 2):
        slope = fused(power, fused(float(k + 1) * radius, abs(c[k + 1]), float(k) * abs(c[k])), slope)
        power = power * square
    return slope


@inlined
def weighed_sum(c: Floats, weights: Floats, shift: int) -> float:
    """Return the sum of c_k times weight number k + `shift`."""
    a, b = weights[shift] * c[0], weights[shift + 1] * c[1]
    d, e = weights[shift + 2] * c[2], weights[shift + 3] * c[3]
    for k in range(4, TERMS - 3, 4):
        a, b = a + weights[k + shift] * c[k], b + weights[k + shift + 1] * c[k + 1]
        d, e = d + weights[k + shift + 2] * c[k + 2], e + weights[k + shift + 3] * c[k + 3]
    for k in range(TERMS - TERMS % 4, TERMS):
        a += weights[k + shift] * c[k]
    return (a + b) + (d + e)


@inlined
def total(c: Floats) -> float:
    """Return p(1)."""
    return weighed_sum(c, ONES, 0)


@inlined
def moment(c: Floats, shift: int) -> float:
    """Return the integral of x^(shift - 1) p(x) over [0, 1], for a shift of 1 or 2."""
    return weighed_sum(c, RECIPROCAL, shift)


@inlined
def integral(c: Floats, end: float, shift: int) -> float:
    """Return the integral of x^(shift - 1) p(x) from 0 to `end`, for a shift of 1 or 2."""
    if end == 1.0:
        return moment(c, shift)
    value = 0.0
    for k in range(TERMS - 1, -1, -1):
        value = value * end + RECIPROCAL[k + shift] * c[k]
    return value * end if shift == 1 else value * end * end


@inlined
def mean_of(c: Floats, speed: float, bend: float, width: float) -> float:
    """Return the mean in time of a polynomial on a piece of length `width`, with phase - phase_from = speed x + bend x^2 (s)."""
    return (speed * moment(c, 1) + 2.0 * bend * moment(c, 2)) / width


@kernel
def _falling_root(c: Floats, low: float) -> float:
    """Return the root in [low, 1] of a polynomial that falls through zero in it, by Newton's method kept inside a bracket."""
    high, x = 1.0, -c[0] / c[1] if c[1] != 0.0 else low
    if not low < x < high:
        x = 0.5 * (low + high)
    for _ in range(100):
        value, slope = c[TERMS - 1], 0.0
        for k in range(TERMS - 2, -1, -1):
            slope = slope * x + value
            value = value * x + c[k]
        if value > 0.0:
            low = x
        elif value < 0.0:
            high = x
        else:
            return x
        step = x - value / slope if slope < 0.0 else low
        if slope < 0.0 and abs(step - x) <= CONVERGED * abs(step):
            return min(max(step, low), high)
        if not low < step < high:
            step = 0.5 * (low + high)
        if step == x or high - low < 1e-17:
            return x
        x = step
    return x


@inlined
def differentiate(c: Floats, factor: float, out: Floats) -> None:
    """Write into `out` the coefficients of `factor` times the derivative of p."""
    for k in range(TERMS - 1):
        out[k] = factor * (k + 1) * c[k + 1]
    out[TERMS - 1] = 0.0


@inlined
def write_bernstein(c: Floats, lead: int, out: Floats) -> None:
    """Write into `out` the Bernstein coefficients on [0, 1] of p(x) / x^lead, for a p without terms below that of order `lead`."""
    for j in range(TERMS):
        out[j] = c[lead]
    for k in range(lead + 1, TERMS):
        for j in range(TERMS):
            out[j] += BERNSTEIN[k - lead, j] * c[k]


@inlined
def bound_below(c: Floats) -> float:
    """Return a bound that proves p > 0 on [0, 1] if it and p(0) are above zero.

    It is the least Bernstein coefficient of the first LOW terms, without that at 0, minus the magnitude of the other terms.
    """
    least = c[0] + LOW_BERNSTEIN[1, 1] * c[1]
    for j in range(2, LOW):
        coefficient = c[0]
        for k in range(1, j + 1):
            coefficient += LOW_BERNSTEIN[k, j] * c[k]
        least = min(least, coefficient)
    return least - sizes_from(c, LOW)


@kernel
def first_descent(c: Floats, spare: Floats) -> float:
    """Return the first x in [0, 1] where p falls below zero; NONE if it does not, 0 if it is negative right after 0.

    A zero at x = 0 does not count if p rises from it: leading zero coefficients are divided out. Most calls end at a bound on the
    coefficients or at the signs of the Bernstein coefficients; `spare` is room for these.
    """
    lead = 0
    while lead < TERMS - 1 and c[lead] == 0.0:
        lead += 1
    if c[lead] < 0.0:
        return 0.0
    if c[lead] == 0.0:
        return NONE
    bound = 0.0
    for k in range(lead + 1, TERMS):
        bound += abs(c[k])
    if c[lead] > bound:
        return NONE
    if lead == 0 and bound_below(c) > 0.0:
        return NONE
    write_bernstein(c, lead, spare)
    lowest = spare[0]
    for j in range(1, TERMS):
        lowest = min(lowest, spare[j])
    if lowest > 0.0:
        return NONE
    q, first = room_for(TERMS), room_for(1)
    fill(q, 0.0)
    for k in range(lead, TERMS):
        q[k - lead] = c[k]
    if _bisect(q, 1.0, spare, first, 1) == 1:
        return first[0]
    return 1.0 if total(q) == 0.0 else NONE


@kernel
def _next_interval(start: float, width: float) -> tuple[float, float]:
    """Return start and width of the next interval of a bisection of [0, 1], which is the widest that begins where this one ends."""
    start += width
    for _ in range(DOUBLINGS):
        if not (start < 1.0 and math.floor(start / (2.0 * width)) * 2.0 * width == start):
            break
        width *= 2.0
    return start, width


@kernel
def extremes(c: Floats) -> tuple[float, float]:
    """Return the least and the largest value of p on [0, 1], to rounding, from both ends and where the slope changes its sign.

    If p is not finite, or its slope changes its sign too often, the sum of the coefficients' magnitudes bounds p on both sides.
    """
    end, bound, slope = total(c), abs(c[0]) + magnitude(c), room_for(TERMS)
    if not bound < math.inf:
        return -bound, bound
    least, largest = min(c[0], end), max(c[0], end)
    differentiate(c, -1.0 if c[1] < 0.0 else 1.0, slope)
    if degree(c) <= 1 or (slope[0] > 0.0 and bound_below(slope) > SIGN_ROUNDING * slope[0]):
        return least, largest
    places, spare = room_for(MOST_CROSSINGS), room_for(TERMS)
    found = crossings(slope, places, spare)
    if found >= MOST_CROSSINGS:
        return -bound, bound
    for n in range(found):
        value = evaluate(c, places[n])
        least, largest = min(least, value), max(largest, value)
    return least, largest


@kernel
def sign_changes(c: Floats, spare: Floats) -> int:
    """Return the number of sign changes in the Bernstein coefficients of p on [0, 1], or UNCLEAR if rounding may hide one.

    p has at most as many roots in (0, 1), and exactly one if the number is 1 (Descartes' rule of signs). `spare` is room.
    """
    write_bernstein(c, 0, spare)
    rounding, changes, last = max(SIGN_ROUNDING * (abs(c[0]) + magnitude(c)), NEGLIGIBLE_POLYNOMIAL), 0, c[0]
    for j in range(1, TERMS):
        if not abs(spare[j]) > rounding:
            return UNCLEAR
        if (last < 0.0) != (spare[j] < 0.0) and last != 0.0:
            changes += 1
        last = spare[j]
    return changes


@inlined
def falls_through_zero(c: Floats, way: float, slope: Floats) -> bool:
    """Return True if `way` times p clearly starts above zero and ends below it, and a bound proves that it only falls on [0, 1].

    `slope` is room.
    """
    if not (way * c[0] > 0.0 and way * total(c) < -SIGN_ROUNDING * way * c[0]):
        return False
    differentiate(c, -way, slope)
    return slope[0] > 0.0 and bound_below(slope) > SIGN_ROUNDING * slope[0]


@entry
def crossings(c: Floats1, out: Floats1, part: Floats1) -> int:
    """Write every x in (0, 1) where p changes sign into `out`, ascending, up to MOST_CROSSINGS; return their number.

    A polynomial that is not finite has none. Most calls end at a bound, or at the signs of Bernstein coefficients. `part` is room.
    """
    sign = 0.0
    for k in range(TERMS - 1, -1, -1):
        sign = c[k] if c[k] != 0.0 else sign  # just right of 0 p has the sign of its lowest term
    if sign == 0.0:
        return 0
    way = math.copysign(1.0, sign)
    changes = 1 if falls_through_zero(c, way, part) else sign_changes(c, part)
    if changes == 1:
        for k in range(TERMS):
            part[k] = way * c[k]
        out[0] = _falling_root(part, 0.0)
    return _bisect(c, sign, part, out, MOST_CROSSINGS) if changes == UNCLEAR or changes > 1 else changes


@kernel
def _bisect(c: Floats, sign: float, part: Floats, out: Floats, most: int) -> int:
    """Do what `crossings` does by bisection from the left, up to `most` crossings; `part` is room.

    p has the given sign just right of 0. The sign is carried from interval to interval, so that a root on the border between two is
    found once. If MOST_INTERVALS do not decide, the place that they reach counts as a crossing: beyond it nothing is known.
    """
    found, start, width = 0, 0.0, 1.0
    for _ in range(MOST_INTERVALS):
        if start >= 1.0 or found >= most:
            return found
        restrict(c, start + 0.5 * width, 0.5 * width, part)
        tail = magnitude(part)
        if not abs(part[0]) + tail < math.inf:
            return found
        if abs(part[0]) + tail < NEGLIGIBLE_POLYNOMIAL:
            start, width = _next_interval(start, width)
            continue
        definite = abs(part[0]) > tail
        if not definite and abs(part[1]) <= bound_of_slope(part, 1.0) and width >= SMALLEST_INTERVAL:
            width *= 0.5
            continue
        before, after = evaluate(part, -1.0), total(part)
        if after != 0.0 and math.copysign(1.0, after) != math.copysign(1.0, sign):
            place = start
            if not definite and before != 0.0 and math.copysign(1.0, before) != math.copysign(1.0, after):
                if after > 0.0:
                    turn_over(part)
                place = start + 0.5 * width * (1.0 + _falling_root(part, -1.0))
            if place > 0.0:
                out[found] = place
                found += 1
        sign = after if after != 0.0 else sign
        start, width = _next_interval(start, width)
    if found < most:
        out[found], found = start, found + 1
    return found
