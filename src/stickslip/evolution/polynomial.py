"""Polynomials on a piece of the history: coefficients ascending, in the piece's own variable, usually on [0, 1]."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from stickslip.evolution.compiled import kernel
from stickslip.evolution.layout import TERMS

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


@kernel
def copy(source: Floats, target: Floats) -> None:
    """Plain loop: for such short arrays it beats slice assignment, which checks shapes and overlap."""
    for k in range(min(len(source), len(target))):
        target[k] = source[k]


@kernel
def fill(target: Floats, value: float) -> None:
    for k in range(len(target)):
        target[k] = value


@kernel
def evaluate(c: Floats, x: float) -> float:
    """p(x), by Horner's rule."""
    value = c[-1]
    for k in range(len(c) - 2, -1, -1):
        value = value * x + c[k]
    return value


@kernel
def degree(c: Floats) -> int:
    """Index of the last coefficient that is not zero."""
    n = len(c) - 1
    while n > 0 and c[n] == 0.0:
        n -= 1
    return n


@kernel
def restrict(c: Floats, start: float, width: float, out: Floats) -> None:
    """Coefficients of y -> p(start + width y) into `out`: exact but for rounding."""
    n = degree(c)
    for k in range(len(c)):
        out[k] = c[k]
    if start != 0.0:
        for j in range(n):
            for k in range(n - 1, j - 1, -1):
                out[k] += start * out[k + 1]
    scale(out, width)


@kernel
def scale(c: Floats, width: float) -> None:
    """Turn p(y) into p(width y), in place."""
    power = width
    for k in range(1, len(c)):
        c[k] *= power
        power *= width


@kernel
def _tail(c: Floats) -> float:
    """Sum of |c_k| for k >= 1: how far p can be from c_0 on [-1, 1]."""
    total = 0.0
    for k in range(1, len(c)):
        total += abs(c[k])
    return total


@kernel
def _slope_tail(c: Floats) -> float:
    """Sum of k |c_k| for k >= 2: how far the slope can be from c_1 on [-1, 1]."""
    total = 0.0
    for k in range(2, len(c)):
        total += k * abs(c[k])
    return total


@kernel
def _falling_root(c: Floats) -> float:
    """The root in [-1, 1] of a polynomial that falls there through zero: Newton's method kept inside its bracket."""
    low, high, x = -1.0, 1.0, 0.0
    for _ in range(100):
        value, slope = c[-1], 0.0
        for k in range(len(c) - 2, -1, -1):
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


@kernel
def _clearly_positive(c: Floats) -> bool:
    """Whether the first terms, by their Bernstein coefficients, stay above anything that the rest can take away on [0, 1]."""
    rest = 0.0
    for k in range(LOW, TERMS):
        rest += abs(c[k])
    for j in range(1, LOW):
        coefficient = c[0]
        for k in range(1, j + 1):
            coefficient += LOW_BERNSTEIN[k, j] * c[k]
        if coefficient <= rest:
            return False
    return True


@kernel
def first_descent(c: Floats, scratch: Floats) -> float:
    """First x in [0, 1] at which p, positive before, falls below zero; NONE if there is none; 0 if it starts by falling.

    A zero at x = 0 does not count where p rises from it: leading zero coefficients are divided out. Most calls end at a bound
    on the coefficients or at the signs of the Bernstein coefficients (for which `scratch` is).
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
    if lead == 0 and _clearly_positive(c):
        return NONE
    for j in range(TERMS):
        scratch[j] = c[lead]
    for k in range(lead + 1, TERMS):
        for j in range(TERMS):
            scratch[j] += BERNSTEIN[k - lead, j] * c[k]
    lowest = scratch[0]
    for j in range(1, TERMS):
        lowest = min(lowest, scratch[j])
    if lowest > 0.0:
        return NONE
    return _isolate(c[lead:].copy())


@kernel
def _isolate(q: Floats) -> float:
    """First descent through zero on [0, 1] of a polynomial that is positive at 0, by bisection of intervals left to right."""
    starts, widths = np.empty(128), np.empty(128)
    starts[0], widths[0], waiting = 0.0, 1.0, 1
    part = np.empty_like(q)
    while waiting > 0:
        waiting -= 1
        start, width = starts[waiting], widths[waiting]
        restrict(q, start + 0.5 * width, 0.5 * width, part)
        if part[0] > _tail(part):
            continue
        if -part[1] > _slope_tail(part):
            if part.sum() > 0.0:
                continue
            return start + 0.5 * width * (1.0 + _falling_root(part))
        if part[0] < -_tail(part) or (width < SMALLEST_INTERVAL and part[0] < 0.0):
            return start
        if part[1] > _slope_tail(part) and evaluate(part, -1.0) >= 0.0:
            continue
        if width >= SMALLEST_INTERVAL:
            starts[waiting], widths[waiting] = start + 0.5 * width, 0.5 * width
            starts[waiting + 1], widths[waiting + 1] = start, 0.5 * width
            waiting += 2
    return NONE


@kernel
def maximum(c: Floats) -> float:
    """Largest value of p on [0, 1], to rounding, by branch and bound."""
    best = max(c[0], c.sum())
    if degree(c) <= 1:
        return best
    starts, widths = np.empty(128), np.empty(128)
    starts[0], widths[0], waiting = 0.0, 1.0, 1
    part = np.empty_like(c)
    while waiting > 0:
        waiting -= 1
        start, width = starts[waiting], widths[waiting]
        restrict(c, start + 0.5 * width, 0.5 * width, part)
        best = max(best, part[0])
        if part[0] + _tail(part) <= best + 4e-16 * abs(best) or abs(part[1]) > _slope_tail(part) or width < SMALLEST_INTERVAL:
            best = max(best, part.sum(), evaluate(part, -1.0))
            continue
        starts[waiting], widths[waiting] = start, 0.5 * width
        starts[waiting + 1], widths[waiting + 1] = start + 0.5 * width, 0.5 * width
        waiting += 2
    return best


@kernel
def crossings(c: Floats, out: Floats) -> int:
    """Every x in (0, 1) at which p changes sign, ascending into `out` (as many as fit); returns how many.

    The sign is carried from interval to interval, so that a root on the border between two is found once.
    """
    found, sign = 0, 0.0
    for k in range(len(c) - 1, -1, -1):
        sign = c[k] if c[k] != 0.0 else sign  # just right of 0 the lowest term decides
    if sign == 0.0:
        return 0
    starts, widths = np.empty(128), np.empty(128)
    starts[0], widths[0], waiting = 0.0, 1.0, 1
    part = np.empty_like(c)
    while waiting > 0 and found < len(out):
        waiting -= 1
        start, width = starts[waiting], widths[waiting]
        restrict(c, start + 0.5 * width, 0.5 * width, part)
        definite = abs(part[0]) > _tail(part)
        if not definite and abs(part[1]) <= _slope_tail(part) and width >= SMALLEST_INTERVAL:
            starts[waiting], widths[waiting] = start + 0.5 * width, 0.5 * width
            starts[waiting + 1], widths[waiting + 1] = start, 0.5 * width
            waiting += 2
            continue
        before, after = evaluate(part, -1.0), part.sum()
        if math.copysign(1.0, after) != math.copysign(1.0, sign) and after != 0.0:
            if definite or before == 0.0 or math.copysign(1.0, before) == math.copysign(1.0, after):
                place = start
            else:
                if after > 0.0:
                    for k in range(len(part)):
                        part[k] = -part[k]
                place = start + 0.5 * width * (1.0 + _falling_root(part))
            if place > 0.0:
                out[found] = place
                found += 1
        sign = after if after != 0.0 else sign
    return found
