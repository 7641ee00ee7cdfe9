"""Intervals that are rounded outwards, and the Taylor coefficients of operations as such intervals.

The coefficients of a formula in the slip rate are its value, its first derivative and half its second one. Those of many cells are
one array: low and high ends along the first axis, orders along the second, as many as are not zero, and cells along the last.

An infinite end means that nothing is known on that side; it is never reached, so that 0 times such an end is 0.

Sources: Moore, Kearfott & Cloud 2009, Introduction to Interval Analysis; Griewank & Walther 2008, Evaluating Derivatives, ch. 13.
"""

from __future__ import annotations

from collections.abc import Callable
from itertools import product
from typing import Any

import numpy as np

from stickslip.foundation.arrays import Floats
from stickslip.friction.formula.expression import Expression
from stickslip.friction.formula.operations.sets import EVERYTHING, Interval, multiplied, squared

ORDERS = 3
"""Number of Taylor coefficients: value, first derivative and half the second one."""
ONE_STEP = 2.3e-16
"""Relative rounding error (1) of a sum, product or quotient, with room to spare: it is 1.2e-16 at most."""
LIBRARY = 1.8e-15
"""Relative error (1) assumed for functions of the library of mathematics: eight units in the last place."""
SMALLEST = 1e-307
"""Absolute error assumed for all operations but sums: smaller results may lose digits or become 0."""
_HUGE = 1.7e308
"""A number that is smaller than what overflows."""
_OUT = np.array([-1.0, 1.0]).reshape(2, 1, 1)

Rule = Callable[..., Floats]
"""What returns the Taylor coefficients of a node from the node and those of its arguments."""


def outward(ends: Floats, error: float, smallest: float = SMALLEST, positive: Any = None) -> Floats:
    """Move ends, which are overwritten, outwards by a relative error; where an end is not a number, nothing is known.

    Low ends stay at least 0 where the values are `positive`, by default where they were.
    """
    size = np.abs(ends)
    if not size.max(initial=0.0) < np.inf:
        ends[0] = np.nan_to_num(ends[0], nan=-np.inf, posinf=_HUGE, neginf=-np.inf)
        ends[1] = np.nan_to_num(ends[1], nan=np.inf, posinf=np.inf, neginf=-_HUGE)
        size = np.abs(ends)
    size *= error
    if not smallest:
        size *= _OUT
        ends += size
        return ends
    if positive is None:
        positive = ends[0] >= 0.0
    size += smallest
    size *= _OUT
    ends += size
    np.maximum(ends[0], 0.0, out=ends[0], where=positive)
    return ends


def negative(a: Floats) -> Floats:
    """Return -a."""
    return -a[::-1]


def add(a: Floats, b: Floats) -> Floats:
    """Return a + b."""
    return outward(a + b, ONE_STEP, 0.0)


def multiply(a: Floats, b: Floats) -> Floats:
    """Return a b."""
    return outward(multiplied(a, b), ONE_STEP, positive=np.minimum(a[0], b[0]) >= 0.0)


def square(a: Floats) -> Floats:
    """Return a**2, which is never negative."""
    return outward(squared(a), ONE_STEP)


def reciprocal(a: Floats) -> Floats:
    """Return 1 / a; nothing is known if the interval holds 0."""
    holds_zero = (a[0] <= 0.0) & (a[1] >= 0.0)
    found = outward(1.0 / a[::-1], ONE_STEP)
    return np.where(holds_zero, np.reshape(EVERYTHING, (2, 1, 1)), found) if holds_zero.any() else found


def of_positive(a: Floats) -> Floats:
    """Return 1 / a; nothing is known where a may not be positive."""
    return reciprocal(np.where(a[0] > 0.0, a, _OUT))


# ---- sums, products and quotients of Taylor series ----------------------------------------------------------------------------


def sum_of_series(_: Expression, a: Floats, b: Floats) -> Floats:
    """Return the coefficients of a + b."""
    more, less = (a, b) if a.shape[1] >= b.shape[1] else (b, a)
    both = less.shape[1]
    found = add(more[:, :both], less)
    if more.shape[1] == both:
        return found
    return _stacked([found, more[:, both:]])


def difference_of_series(node: Expression, a: Floats, b: Floats) -> Floats:
    """Return the coefficients of a - b."""
    return sum_of_series(node, a, negative(b))


def product_of_series(_: Expression, a: Floats, b: Floats) -> Floats:
    """Return the coefficients of a b; a square is narrower than a product of two factors that vary independently."""
    p, q = a.shape[1], b.shape[1]
    if a is b:
        return _square_of_series(a)
    if p == 1 or q == 1:
        return multiply(a, b)
    pairs = sorted((pair for pair in product(range(p), range(q)) if sum(pair) < ORDERS), key=sum)
    i, j = zip(*pairs, strict=True)
    found = multiply(a[:, i], b[:, j])
    orders = [found[:, :1], add(found[:, 1:2], found[:, 2:3])]
    second = [found[:, k : k + 1] for k in range(3, len(pairs))]
    for one in second[1:]:
        second[0] = add(second[0], one)
    return _stacked(orders + second[:1])


def _square_of_series(a: Floats) -> Floats:
    orders = [square(a[:, :1])]
    if a.shape[1] > 1:
        twice = 2.0 * multiply(a[:, :1], a[:, 1:])
        bent = square(a[:, 1:2])
        orders += [twice[:, :1], add(twice[:, 1:], bent) if a.shape[1] > 2 else bent]
    return _stacked(orders)


def quotient_of_series(_: Expression, a: Floats, b: Floats) -> Floats:
    """Return the coefficients of a / b."""
    share = reciprocal(b[:, :1])
    if b.shape[1] == 1:
        return multiply(a, share)
    orders = [multiply(a[:, :1], share)]
    known = negative(multiply(orders[0], b[:, 1:]))
    first = add(a[:, 1:2], known[:, :1]) if a.shape[1] > 1 else known[:, :1]
    orders.append(multiply(first, share))
    left = negative(multiply(orders[1], b[:, 1:2]))
    for row in (known[:, 1:], a[:, 2:]):
        left = add(row, left) if row.shape[1] else left
    return _stacked([*orders, multiply(left, share)])


def chain(value: Floats, slopes: Callable[[], tuple[Floats, Floats]], a: Floats) -> Floats:
    """Return the coefficients of f(a) from those of a, f(a), and what returns bounds of f' and f''/2 there."""
    if a.shape[1] == 1:
        return value
    first, second = slopes()
    orders = a.shape[1]
    factors = _stacked([*(first,) * (orders - 1), second])
    found = multiply(factors, _stacked([a[:, 1:], square(a[:, 1:2])]))
    return _stacked([value, found[:, :1], add(found[:, 1:2], found[:, 2:]) if orders > 2 else found[:, 1:]])


def function(
    values: Callable[[Any, Floats], Floats],
    slopes: Callable[[Floats, Floats], tuple[Floats, Floats]],
    error: float = LIBRARY,
    within: Interval = EVERYTHING,
) -> Rule:
    """Return the rule of a function from that of its values, and from bounds of f' and f''/2 by those of f(a) and of a."""
    ends = np.reshape(within, (2, 1, 1))

    def rule(node: Expression, a: Floats) -> Floats:
        here = a[:, :1]
        value = outward(values(node, here), error)
        if within is not EVERYTHING:
            value = np.clip(value, ends[0], ends[1])
        return chain(value, lambda: slopes(value, here), a)

    return rule


def _stacked(orders: list[Floats]) -> Floats:
    """Return coefficients as one array."""
    counts = {one.shape[2] for one in orders}
    if len(counts) > 1:
        orders = [np.broadcast_to(one, (*one.shape[:2], max(counts))) for one in orders]
    return np.concatenate(orders, axis=1)
