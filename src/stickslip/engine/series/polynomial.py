"""Polynomials on a piece of the history: TERMS coefficients, ascending, in the piece's own variable, usually on [0, 1].

Coefficients come as pointers (in the engine) or as arrays (in tables made from a history): both are indexed alike. What decides
nothing serves several polynomials side by side, too (pointers to `codegen.simd`). Sums are taken in four parts, always the same
ones: no term waits long for the one before, and lanes add as floats do.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from stickslip.engine.codegen.compiler import inlined, kernel
from stickslip.engine.state.layout import TERMS

Floats = NDArray[np.float64]

NONE = math.inf
RECIPROCAL = np.array([0.0, *(1.0 / k for k in range(1, 2 * TERMS))])
LOW = 9
"""Terms of the first, cheap test for a root."""


def _bernstein(terms: int) -> Floats:
    """Row k: what the power x^k contributes to each Bernstein coefficient of a polynomial of so many terms on [0, 1]."""
    return np.array([[math.comb(j, k) / math.comb(terms - 1, k) for j in range(terms)] for k in range(terms)])


BERNSTEIN = _bernstein(TERMS)
LOW_BERNSTEIN = _bernstein(LOW)
SMALLEST_INTERVAL = 1e-15
NEGLIGIBLE = 1e-300
"""A polynomial that stays below this on an interval has no roots there that anybody could tell: near the smallest normal number
its coefficients lose their digits, or vanish one after the other, and no bisection would ever come to an end."""


@inlined
def copy(source: Floats, target: Floats, n: int) -> None:
    for k in range(n):
        target[k] = source[k]


@inlined
def fill(target: Floats, value: float) -> None:
    for k in range(TERMS):
        target[k] = value


@inlined
def powers_of(x: float, out: Floats) -> None:
    """1, x, x^2, ...: each from two of half its order, so that none waits long."""
    out[0], out[1] = 1.0, x
    for k in range(2, TERMS):
        out[k] = out[k >> 1] * out[(k + 1) >> 1]


@inlined
def multiply(c: Floats, powers: Floats, out: Floats) -> None:
    """p(x y) in terms of y, by the powers of x."""
    for k in range(TERMS):
        out[k] = c[k] * powers[k]


@kernel
def evaluate(c: Floats, x: float) -> float:
    """p(x), by Horner's rule."""
    value = c[TERMS - 1]
    for k in range(TERMS - 2, -1, -1):
        value = value * x + c[k]
    return value


@kernel
def degree(c: Floats) -> int:
    """Index of the last coefficient that is not zero."""
    n = TERMS - 1
    while n > 0 and c[n] == 0.0:
        n -= 1
    return n


@kernel
def restrict(c: Floats, start: float, width: float, out: Floats) -> None:
    """Coefficients of y -> p(start + width y) into `out`: exact but for rounding."""
    n = degree(c)
    for k in range(n + 1, TERMS):
        out[k] = 0.0
    restrict_low(c, n, start, width, out)


@kernel
def restrict_low(c: Floats, n: int, start: float, width: float, out: Floats) -> None:
    """As `restrict`, for a polynomial of degree n; leaves the coefficients of `out` beyond as they are."""
    for k in range(n + 1):
        out[k] = c[k]
    if start != 0.0:
        for j in range(n):
            for k in range(n - 1, j - 1, -1):
                out[k] += start * out[k + 1]
    power = width
    for k in range(1, n + 1):
        out[k] *= power
        power *= width


@kernel
def scale(c: Floats, width: float) -> None:
    """Turn p(y) into p(width y), in place."""
    power = width
    for k in range(1, TERMS):
        c[k] *= power
        power *= width


@inlined
def magnitude(c: Floats, first: int = 1) -> float:
    """Sum of |c_k| for k >= 1 (or later): how far p can be from c_0 on [-1, 1]."""
    a, b, d, e = abs(c[first]), abs(c[first + 1]), abs(c[first + 2]), abs(c[first + 3])
    for k in range(first + 4, TERMS - 3, 4):
        a, b, d, e = a + abs(c[k]), b + abs(c[k + 1]), d + abs(c[k + 2]), e + abs(c[k + 3])
    for k in range(TERMS - (TERMS - first) % 4, TERMS):
        a += abs(c[k])
    return (a + b) + (d + e)


@inlined
def slope_magnitude(c: Floats) -> float:
    """Sum of k |c_k| for k >= 2: how far the slope can be from c_1 on [-1, 1]."""
    even, odd = 0.0, 0.0
    for k in range(2, TERMS - 1, 2):
        even, odd = even + k * abs(c[k]), odd + (k + 1) * abs(c[k + 1])
    return even + odd + (TERMS - 1) * abs(c[TERMS - 1])


@inlined
def total(c: Floats) -> float:
    """p(1)."""
    a, b, d, e = c[0], c[1], c[2], c[3]
    for k in range(4, TERMS - 3, 4):
        a, b, d, e = a + c[k], b + c[k + 1], d + c[k + 2], e + c[k + 3]
    for k in range(TERMS - TERMS % 4, TERMS):
        a += c[k]
    return (a + b) + (d + e)


@inlined
def moment(c: Floats, shift: int) -> float:
    """Integral of x^(shift - 1) p(x) over [0, 1], for a shift of 1 or 2."""
    a, b = RECIPROCAL[shift] * c[0], RECIPROCAL[shift + 1] * c[1]
    d, e = RECIPROCAL[shift + 2] * c[2], RECIPROCAL[shift + 3] * c[3]
    for k in range(4, TERMS - 3, 4):
        a, b = a + RECIPROCAL[k + shift] * c[k], b + RECIPROCAL[k + shift + 1] * c[k + 1]
        d, e = d + RECIPROCAL[k + shift + 2] * c[k + 2], e + RECIPROCAL[k + shift + 3] * c[k + 3]
    for k in range(TERMS - TERMS % 4, TERMS):
        a += RECIPROCAL[k + shift] * c[k]
    return (a + b) + (d + e)


@inlined
def integral(c: Floats, end: float, shift: int) -> float:
    """Integral of x^(shift - 1) p(x) from 0 to `end`, for a shift of 1 or 2."""
    if end == 1.0:
        return moment(c, shift)
    value = 0.0
    for k in range(TERMS - 1, -1, -1):
        value = value * end + RECIPROCAL[k + shift] * c[k]
    return value * end if shift == 1 else value * end * end


@inlined
def mean_of(c: Floats, speed: float, bend: float, width: float) -> float:
    """Mean in time of a polynomial on a piece so wide (s), of which theta = speed x + bend x^2."""
    return (speed * moment(c, 1) + 2.0 * bend * moment(c, 2)) / width


@kernel
def _falling_root(c: Floats) -> float:
    """The root in [-1, 1] of a polynomial that falls there through zero: Newton's method kept inside its bracket."""
    low, high, x = -1.0, 1.0, 0.0
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
        step = x - value / slope if slope < 0.0 else 0.5 * (low + high)
        if not low < step < high:
            step = 0.5 * (low + high)
        if step == x or high - low < 1e-17:
            return x
        x = step
    return x


@inlined
def bound_below(c: Floats) -> float:
    """If above zero p > 0 on [0, 1], if it is at 0: the least Bernstein coefficient of the first terms but for that at 0, less what
    the rest can take away."""
    least = c[0] + LOW_BERNSTEIN[1, 1] * c[1]
    for j in range(2, LOW):
        coefficient = c[0]
        for k in range(1, j + 1):
            coefficient += LOW_BERNSTEIN[k, j] * c[k]
        least = min(least, coefficient)
    return least - magnitude(c, LOW)


@kernel
def clearly_positive(c: Floats) -> bool:
    """Whether p > 0 on [0, 1] is seen at a glance."""
    return bound_below(c) > 0.0


@kernel
def first_descent(c: Floats, spare: Floats) -> float:
    """First x in [0, 1] at which p, positive before, falls below zero; NONE if there is none; 0 if it starts by falling.

    A zero at x = 0 does not count where p rises from it: leading zero coefficients are divided out. Most calls end at a bound
    on the coefficients or at the signs of the Bernstein coefficients (for which `spare` is).
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
    if lead == 0 and clearly_positive(c):
        return NONE
    for j in range(TERMS):
        spare[j] = c[lead]
    for k in range(lead + 1, TERMS):
        for j in range(TERMS):
            spare[j] += BERNSTEIN[k - lead, j] * c[k]
    lowest = spare[0]
    for j in range(1, TERMS):
        lowest = min(lowest, spare[j])
    if lowest > 0.0:
        return NONE
    q = np.zeros(TERMS)
    for k in range(lead, TERMS):
        q[k - lead] = c[k]
    return _isolate(q)


@kernel
def _next_interval(start: float, width: float) -> tuple[float, float]:
    """The next interval of a bisection of [0, 1] from left to right: the widest that starts where the last one ended."""
    start += width
    while start < 1.0 and math.floor(start / (2.0 * width)) * 2.0 * width == start:
        width *= 2.0
    return start, width


@kernel
def _isolate(q: Floats) -> float:
    """First descent through zero on [0, 1] of a polynomial that is positive at 0, by bisection of intervals left to right."""
    part, start, width = np.empty(TERMS), 0.0, 1.0
    while start < 1.0:
        restrict(q, start + 0.5 * width, 0.5 * width, part)
        tail, slope_tail = magnitude(part), slope_magnitude(part)
        if part[0] < -tail or (width < SMALLEST_INTERVAL and part[0] < 0.0):
            return start
        if -part[1] > slope_tail and total(part) <= 0.0:
            return start + 0.5 * width * (1.0 + _falling_root(part))
        clear = part[0] > tail or -part[1] > slope_tail or (part[1] > slope_tail and evaluate(part, -1.0) >= 0.0)
        if clear or width < SMALLEST_INTERVAL or abs(part[0]) + tail < NEGLIGIBLE:
            start, width = _next_interval(start, width)
        else:
            width *= 0.5
    return NONE


@kernel
def maximum(c: Floats, sign: float = 1.0) -> float:
    """Largest value of sign p on [0, 1], to rounding, by branch and bound."""
    best = max(sign * c[0], sign * total(c))
    if degree(c) <= 1:
        return best
    q, part, start, width = np.empty(TERMS), np.empty(TERMS), 0.0, 1.0
    for k in range(TERMS):
        q[k] = sign * c[k]
    while start < 1.0:
        restrict(q, start + 0.5 * width, 0.5 * width, part)
        best, tail = max(best, part[0]), magnitude(part)
        below = part[0] + tail <= best + 4e-16 * abs(best) or abs(part[0]) + tail < NEGLIGIBLE
        if below or abs(part[1]) > slope_magnitude(part) or width < SMALLEST_INTERVAL:
            best = max(best, total(part), evaluate(part, -1.0))
            start, width = _next_interval(start, width)
        else:
            width *= 0.5
    return best


@kernel
def crossings(c: Floats, out: Floats) -> int:
    """Every x in (0, 1) at which p changes sign, ascending into `out` (as many as fit); returns how many.

    The sign is carried from interval to interval, so that a root on the border between two is found once.
    """
    found, sign = 0, 0.0
    for k in range(TERMS - 1, -1, -1):
        sign = c[k] if c[k] != 0.0 else sign  # just right of 0 the lowest term decides
    if sign == 0.0:
        return 0
    part, start, width = np.empty(TERMS), 0.0, 1.0
    while start < 1.0 and found < len(out):
        restrict(c, start + 0.5 * width, 0.5 * width, part)
        tail = magnitude(part)
        if abs(part[0]) + tail < NEGLIGIBLE:
            start, width = _next_interval(start, width)
            continue
        definite = abs(part[0]) > tail
        if not definite and abs(part[1]) <= slope_magnitude(part) and width >= SMALLEST_INTERVAL:
            width *= 0.5
            continue
        before, after = evaluate(part, -1.0), total(part)
        if after != 0.0 and math.copysign(1.0, after) != math.copysign(1.0, sign):
            place = start
            if not definite and before != 0.0 and math.copysign(1.0, before) != math.copysign(1.0, after):
                if after > 0.0:
                    for k in range(TERMS):
                        part[k] = -part[k]
                place = start + 0.5 * width * (1.0 + _falling_root(part))
            if place > 0.0:
                out[found] = place
                found += 1
        sign = after if after != 0.0 else sign
        start, width = _next_interval(start, width)
    return found
