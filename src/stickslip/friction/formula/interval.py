"""Provide interval arithmetic with outward rounding on whole arrays of intervals.

An interval [low, high] is stored as the pair (-low, high) along the axis before the last: shape (..., 2, n). Both entries are then
rounded the same way, upwards, and the sum of two intervals is one addition. A low end is never +inf and a high end never -inf,
so that no sum is undefined. An infinite end is never reached: 0 times such an end is 0. The interval is (-inf, inf), called
unbounded below, where nothing is known about a value.

Source: Moore, Kearfott & Cloud 2009, Introduction to Interval Analysis, SIAM.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

LIBRARY_ERROR = 8.0 * float(np.finfo(float).eps)
"""Relative error assumed for exp, expm1, log, log1p, tanh, arcsinh and powers: twice the 4 units in the last place that numpy
states."""
WAVE_ERROR = 8.0 * float(np.finfo(float).eps)
"""Absolute error assumed for sin and cos, whose values are at most 1."""
_UNDERFLOW = float(np.finfo(float).tiny)
"""Absolute error assumed for a library function: smaller results may be flushed to 0."""
_TURN = 2.0 * math.pi
"""One period of sin and cos (rad)."""


def interval(low: Array, high: Array) -> Array:
    """Return the intervals between two arrays of numbers, which are taken as exact."""
    return np.stack(np.broadcast_arrays(-np.asarray(low, float), np.asarray(high, float)), axis=-2)


def exact(value: float | Array) -> Array:
    """Return intervals that contain only the given number each."""
    number = np.atleast_1d(np.asarray(value, float))
    return interval(number, number)


def ends(a: Array) -> tuple[Array, Array]:
    """Return the low and the high ends."""
    return -a[..., 0, :], a[..., 1, :]


def everything(a: Array) -> Array:
    """Return unbounded intervals in the shape of `a`."""
    return np.full(a.shape, np.inf)


def outward(a: Array) -> Array:
    """Move both ends outwards to the next floating-point number."""
    return np.asarray(np.nextafter(a, np.inf))


def add(a: Array, b: Array) -> Array:
    """Return a + b."""
    return outward(a + b)


def negative(a: Array) -> Array:
    """Return -a, which is exact."""
    return a[..., ::-1, :]


def subtract(a: Array, b: Array) -> Array:
    """Return a - b."""
    return outward(a + negative(b))


def multiply(a: Array, b: Array) -> Array:
    """Return a * b: the hull of the four products of the ends."""
    products = a[..., :, None, :] * b[..., None, :, :]  # low ends are stored negated: a low times a high end has the wrong sign
    odd = np.isnan(products)
    if odd.any():
        products[odd] = 0.0
    ones, others = (products[..., 0, 0, :], products[..., 1, 1, :]), (products[..., 0, 1, :], products[..., 1, 0, :])
    result = np.empty((*products.shape[:-3], 2, products.shape[-1]))
    np.maximum(np.maximum(*others), -np.minimum(*ones), out=result[..., 0, :])
    np.maximum(np.maximum(*ones), -np.minimum(*others), out=result[..., 1, :])
    return outward(result)


def scale(a: Array, factor: float) -> Array:
    """Return a times a positive number."""
    return outward(a * factor)


def square(a: Array) -> Array:
    """Return a**2, which is never negative."""
    least, most = sizes(a)
    return np.minimum(outward(interval(least * least, most * most)), [[0.0], [np.inf]])


def reciprocal(a: Array) -> Array:
    """Return 1 / a, unbounded where a contains 0."""
    low, high = ends(a)
    inside = (low <= 0.0) & (high >= 0.0)
    with np.errstate(divide="ignore"):
        found = outward(interval(1.0 / high, 1.0 / low))
    return np.where(inside[..., None, :], np.inf, found)


def sizes(a: Array) -> tuple[Array, Array]:
    """Return the smallest and the largest magnitude in each interval."""
    low, high = ends(a)
    return np.maximum(np.maximum(low, -high), 0.0), np.maximum(-low, high)


def _widened(a: Array, error: float = LIBRARY_ERROR) -> Array:
    """Move both ends outwards by a relative error, and by the absolute error of a library function whose result underflows."""
    return outward(a * (1.0 + np.copysign(error, a)) + _UNDERFLOW)


def _rising(function: Callable[[Array], Array], a: Array) -> Array:
    """Return the range of an increasing function, from its values at the ends."""
    low, high = ends(a)
    return _widened(interval(function(low), function(high)))


def exp(a: Array) -> Array:
    """Return e**a, which is never negative."""
    return np.minimum(_rising(np.exp, a), [[0.0], [np.inf]])


def expm1(a: Array) -> Array:
    """Return e**a - 1, which is never below -1."""
    return np.minimum(_rising(np.expm1, a), [[1.0], [np.inf]])


def log1p(a: Array) -> Array:
    """Return the logarithm of the positive part of 1 + a, unbounded where it has none."""
    return np.where(a[..., 1:, :] > -1.0, _rising(np.log1p, np.minimum(a, [[1.0], [np.inf]])), np.inf)


def log(a: Array) -> Array:
    """Return the logarithm of the positive part of a, unbounded where a has none."""
    return _above_zero(a, _rising(np.log, np.minimum(a, [[0.0], [np.inf]])))


def sqrt(a: Array) -> Array:
    """Return the square root of the part of a that is not negative, unbounded where a has no positive part."""
    return _above_zero(a, np.minimum(_rising(np.sqrt, np.minimum(a, [[0.0], [np.inf]])), [[0.0], [np.inf]]))


def _above_zero(a: Array, found: Array) -> Array:
    return np.where(a[..., 1:, :] > 0.0, found, np.inf)


def tanh(a: Array) -> Array:
    """Return tanh(a), which stays between -1 and 1."""
    return np.minimum(_rising(np.tanh, a), 1.0)


def sech_squared(a: Array) -> Array:
    """Return 1 / cosh(a)**2, which decreases with the magnitude of a."""
    least, most = sizes(a)
    with np.errstate(over="ignore"):
        found = _widened(interval(1.0 / np.cosh(most) ** 2, 1.0 / np.cosh(least) ** 2), 4.0 * LIBRARY_ERROR)
    return np.minimum(found, [[0.0], [1.0]])


def logistic(a: Array) -> Array:
    """Return 1 / (1 + e**a), which decreases from 1 to 0."""
    low, high = ends(a)
    with np.errstate(over="ignore"):
        found = _widened(interval(1.0 / (1.0 + np.exp(high)), 1.0 / (1.0 + np.exp(low))), 2.0 * LIBRARY_ERROR)
    return np.minimum(found, [[0.0], [1.0]])


def arcsinh(a: Array) -> Array:
    """Return arcsinh(a)."""
    return _rising(np.arcsinh, a)


def arcsinh_slope(a: Array) -> Array:
    """Return 1 / sqrt(1 + a**2), which decreases with the magnitude of a."""
    least, most = sizes(a)
    found = _widened(interval(1.0 / np.hypot(1.0, most), 1.0 / np.hypot(1.0, least)), 2.0 * LIBRARY_ERROR)
    return np.minimum(found, [[0.0], [1.0]])


def sin(a: Array) -> Array:
    """Return sin(a)."""
    return _wave(np.sin, a, 0.25)


def cos(a: Array) -> Array:
    """Return cos(a)."""
    return _wave(np.cos, a, 0.0)


def _wave(function: Callable[[Array], Array], a: Array, peak: float) -> Array:
    """Return sin or cos, with maxima at `peak` plus any whole number of turns, and minima half a turn later."""
    low, high = ends(a)
    with np.errstate(invalid="ignore"):
        at_low, at_high = function(low), function(high)
    highest = np.where(_holds_a_whole_number(low, high, peak), 1.0, np.maximum(at_low, at_high) + WAVE_ERROR)
    lowest = np.where(_holds_a_whole_number(low, high, peak + 0.5), -1.0, np.minimum(at_low, at_high) - WAVE_ERROR)
    found = outward(interval(lowest, highest))
    return np.minimum(np.where(np.isnan(found), 1.0, found), 1.0)


def _holds_a_whole_number(low: Array, high: Array, offset: float) -> NDArray[np.bool_]:
    """Return True where `offset` plus a whole number of turns may lie between low and high (rad), rounding included."""
    first, last = low / _TURN - offset, high / _TURN - offset
    slack = LIBRARY_ERROR * (2.0 + np.maximum(np.abs(first), np.abs(last)))
    with np.errstate(invalid="ignore"):
        return ~(np.floor(last + slack) < np.ceil(first - slack))


def power(a: Array, exponent: Array) -> Array:
    """Return a**exponent, unbounded where a is not entirely above 0."""
    low, high = ends(a)
    bases = np.where(low > 0.0, np.stack((low, high)), 1.0)
    with np.errstate(over="ignore", under="ignore"):
        corners = [base**e for base in bases for e in ends(exponent)]
    lowest, highest = np.minimum.reduce(corners), np.maximum.reduce(corners)
    found = np.minimum(_widened(interval(lowest, highest), 2.0 * LIBRARY_ERROR), [[0.0], [np.inf]])
    return np.where((low > 0.0)[..., None, :], found, np.inf)
