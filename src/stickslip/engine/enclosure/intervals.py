"""Interval arithmetic in compiled code, rounded outwards: each function returns the low and the high end of an interval.

An infinite end means that nothing is known on that side; it is never reached, so that 0 times such an end is 0. Every result is
moved outwards by more than its rounding error can be.

Source: Moore, Kearfott & Cloud 2009, Introduction to Interval Analysis, SIAM.
"""

from __future__ import annotations

import math

from stickslip.engine.codegen.compiler import inlined, kernel

Interval = tuple[float, float]

ONE_STEP = 2.3e-16
"""Relative rounding error (1) of a sum, product or quotient, with room to spare: it is 1.2e-16 at most."""
LIBRARY = 1.8e-15
"""Relative error (1) assumed for functions of the library of mathematics: eight units in the last place."""
SMALLEST = 1e-307
"""Absolute error assumed for every operation: smaller results may lose digits or become 0."""
TURN = 2.0 * math.pi
"""One period of sin and cos (rad)."""


@inlined
def widened(low: float, high: float, error: float) -> Interval:
    """Move both ends outwards by a relative error; where an end is no number, nothing is known."""
    low, high = low - (abs(low) * error + SMALLEST), high + (abs(high) * error + SMALLEST)
    return (low if low < math.inf else -math.inf), (high if high > -math.inf else math.inf)


@kernel
def add(a: float, b: float, c: float, d: float) -> Interval:
    """Return [a, b] + [c, d]."""
    low, high = widened(a + c, b + d, ONE_STEP)
    return (max(low, 0.0) if a + c >= 0.0 else low), (min(high, 0.0) if b + d <= 0.0 else high)


@kernel
def subtract(a: float, b: float, c: float, d: float) -> Interval:
    """Return [a, b] - [c, d]."""
    return add(a, b, -d, -c)


@kernel
def multiply(a: float, b: float, c: float, d: float) -> Interval:
    """Return [a, b] [c, d]: the hull of the four products of the ends."""
    if (a == 0.0 and b == 0.0) or (c == 0.0 and d == 0.0):
        return 0.0, 0.0
    p, q, r, s = a * c, a * d, b * c, b * d
    if p != p or q != q or r != r or s != s:  # 0 times infinity is 0
        p, q = (0.0 if p != p else p), (0.0 if q != q else q)
        r, s = (0.0 if r != r else r), (0.0 if s != s else s)
    low, high = widened(min(min(p, q), min(r, s)), max(max(p, q), max(r, s)), ONE_STEP)
    return (max(low, 0.0) if a >= 0.0 and c >= 0.0 else low), high


@kernel
def square(a: float, b: float) -> Interval:
    """Return [a, b]**2, which is never negative."""
    low, high = widened(a * a, b * b, ONE_STEP) if a >= 0.0 else widened(b * b, a * a, ONE_STEP)
    if a < 0.0 < b:
        return 0.0, widened(0.0, max(a * a, b * b), ONE_STEP)[1]
    return max(low, 0.0), high


@kernel
def reciprocal(a: float, b: float) -> Interval:
    """Return 1 / [a, b]; nothing is known if the interval holds 0."""
    if a <= 0.0 <= b or a == -math.inf or b == math.inf:
        if a > 0.0:
            return 0.0, widened(0.0, 1.0 / a, ONE_STEP)[1]
        if b < 0.0:
            return widened(1.0 / b, 0.0, ONE_STEP)[0], 0.0
        return -math.inf, math.inf
    return widened(1.0 / b, 1.0 / a, ONE_STEP)


@kernel
def exponential(a: float, b: float) -> Interval:
    """Return e**[a, b], which is never negative."""
    low, high = widened(math.exp(a) if a < 709.0 else 8e307, math.exp(b) if b < 709.0 else math.inf, LIBRARY)
    return max(low, 0.0), high


@kernel
def exponential_less_one(a: float, b: float) -> Interval:
    """Return e**[a, b] - 1, which is never below -1."""
    low, high = widened(math.expm1(a) if a < 709.0 else 8e307, math.expm1(b) if b < 709.0 else math.inf, LIBRARY)
    return max(low, -1.0), high


@kernel
def logarithm(a: float, b: float) -> Interval:
    """Return the logarithm of the positive part of [a, b]; nothing is known if there is none."""
    if not b > 0.0:
        return -math.inf, math.inf
    return widened(math.log(a) if a > 0.0 else -math.inf, math.log(b), LIBRARY)


@kernel
def logarithm_of_one_and(a: float, b: float) -> Interval:
    """Return the logarithm of the positive part of 1 + [a, b]; nothing is known if there is none."""
    if not b > -1.0:
        return -math.inf, math.inf
    return widened(math.log1p(a) if a > -1.0 else -math.inf, math.log1p(b), LIBRARY)


@kernel
def root(a: float, b: float) -> Interval:
    """Return the square root of the part of [a, b] that is not negative; nothing is known if there is none."""
    if b < 0.0:
        return -math.inf, math.inf
    low, high = widened(math.sqrt(max(a, 0.0)), math.sqrt(b), LIBRARY)
    return max(low, 0.0), high


@kernel
def tangent(a: float, b: float) -> Interval:
    """Return the hyperbolic tangent of [a, b], which stays between -1 and 1."""
    low, high = widened(math.tanh(a), math.tanh(b), LIBRARY)
    return max(low, -1.0), min(high, 1.0)


@kernel
def tangent_slope(a: float, b: float) -> Interval:
    """Return 1 / cosh**2 of [a, b], which falls with the magnitude."""
    least, most = sizes(a, b)
    low, high = widened(one_over_cosh_squared(most), one_over_cosh_squared(least), 4.0 * LIBRARY)
    return max(low, 0.0), min(high, 1.0)


@kernel
def one_over_cosh_squared(x: float) -> float:
    """Return 1 / cosh(x)**2 for x >= 0."""
    e = math.exp(-2.0 * min(x, 1e3))
    return 4.0 * e / ((1.0 + e) * (1.0 + e))


@kernel
def logistic(a: float, b: float) -> Interval:
    """Return 1 / (1 + e**[a, b]), which falls from 1 to 0."""
    low, high = widened(one_over_one_and_exp(b), one_over_one_and_exp(a), 2.0 * LIBRARY)
    return max(low, 0.0), min(high, 1.0)


@kernel
def one_over_one_and_exp(x: float) -> float:
    """Return 1 / (1 + e**x)."""
    return 1.0 / (1.0 + math.exp(x)) if x < 700.0 else 0.0


@kernel
def inverse_sine(a: float, b: float) -> Interval:
    """Return arcsinh of [a, b]."""
    return widened(math.asinh(a), math.asinh(b), LIBRARY)


@kernel
def inverse_sine_slope(a: float, b: float) -> Interval:
    """Return 1 / sqrt(1 + [a, b]**2), which falls with the magnitude."""
    least, most = sizes(a, b)
    low, high = widened(1.0 / math.hypot(1.0, most), 1.0 / math.hypot(1.0, least), 2.0 * LIBRARY)
    return max(low, 0.0), min(high, 1.0)


@kernel
def cosine(a: float, b: float) -> Interval:
    """Return cos of [a, b]."""
    if not (abs(a) < 1e15 and abs(b) < 1e15 and b - a < TURN):
        return -1.0, 1.0
    first, last = math.cos(a), math.cos(b)
    low, high = min(first, last) - LIBRARY, max(first, last) + LIBRARY
    return (-1.0 if holds_a_turn(a, b, 0.5) else max(low, -1.0)), (1.0 if holds_a_turn(a, b, 0.0) else min(high, 1.0))


@kernel
def sine(a: float, b: float) -> Interval:
    """Return sin of [a, b]."""
    if not (abs(a) < 1e15 and abs(b) < 1e15 and b - a < TURN):
        return -1.0, 1.0
    first, last = math.sin(a), math.sin(b)
    low, high = min(first, last) - LIBRARY, max(first, last) + LIBRARY
    return (-1.0 if holds_a_turn(a, b, 0.75) else max(low, -1.0)), (1.0 if holds_a_turn(a, b, 0.25) else min(high, 1.0))


@kernel
def holds_a_turn(a: float, b: float, offset: float) -> bool:
    """Return True if `offset` plus a whole number of turns may lie in [a, b] (rad), rounding included."""
    first, last = a / TURN - offset, b / TURN - offset
    slack = LIBRARY * (2.0 + max(abs(first), abs(last)))
    return math.floor(last + slack) >= math.ceil(first - slack)


@kernel
def power(a: float, b: float, c: float, d: float) -> Interval:
    """Return [a, b]**[c, d]; nothing is known if a base may be negative."""
    if a < 0.0 or not b > 0.0:
        return -math.inf, math.inf
    low, high = math.inf, 0.0
    for base in (a, b):
        for exponent in (c, d):
            value = raised(base, exponent)
            low, high = min(low, value), max(high, value)
    low, high = widened(low, high, 2.0 * LIBRARY)
    return max(low, 0.0), high


@kernel
def raised(base: float, exponent: float) -> float:
    """Return base**exponent for a base that is not negative; infinite where it is too large."""
    if exponent == 0.0:
        return 1.0
    if base == 0.0 or base == math.inf:
        return 0.0 if (base == 0.0) == (exponent > 0.0) else math.inf
    logarithm = exponent * math.log(base)
    if not abs(logarithm) < 709.0:
        return math.inf if logarithm > 0.0 else 0.0
    return base**exponent


@kernel
def sizes(a: float, b: float) -> Interval:
    """Return the smallest and the largest magnitude in [a, b]."""
    return max(max(a, -b), 0.0), max(-a, b)
