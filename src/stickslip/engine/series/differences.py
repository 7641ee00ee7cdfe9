"""Functions that the code of formulas calls: f(now) - f(reference), where now = reference + step.

Near the reference they have no cancellation, and far from it they take the values. All numbers are those of a node of a formula and
have its unit.
"""

from __future__ import annotations

import math
from typing import Any

from numba import njit

from stickslip.engine.codegen.uncompiled import MATHS, UNCOMPILED

maths: Any = MATHS if UNCOMPILED else math


@njit(error_model="numpy")
def exp_difference(value: float, now: float, step: float, largest: float) -> float:
    """Return exp(now), which no longer grows beyond an exponent, minus its value at the reference."""
    if abs(step) < 1.0:
        return value * maths.expm1(step)
    return maths.exp(min(now, largest)) - value


@njit(error_model="numpy")
def log_difference(reference: float, now: float, step: float) -> float:
    """Return log(now) - log(reference)."""
    if abs(step) < 0.5 * abs(reference):
        return maths.log1p(step / reference)
    return maths.log(now / reference)


@njit(error_model="numpy")
def tanh_difference(value: float, now: float, step: float) -> float:
    """Return tanh(now) minus its value at the reference."""
    if abs(step) < 1.0 or (abs(step) < 300.0 and now * value > 0.0):  # on one side both may be 1 but for their last digits
        return maths.sinh(step) / maths.cosh(now - step) / maths.cosh(now)
    return maths.tanh(now) - value


@njit(error_model="numpy")
def power_difference(reference: float, now: float, step: float, exponent: float) -> float:
    """Return now**exponent - reference**exponent."""
    if abs(step) < 0.5 * reference:
        return reference**exponent * maths.expm1(exponent * maths.log1p(step / reference))
    return now**exponent - reference**exponent


@njit(error_model="numpy")
def arcsinh_difference(reference: float, now: float, step: float) -> float:
    """Return arcsinh(now) - arcsinh(reference) = arcsinh(step (1 + p q - x y) / (p + q)), p^2 = 1 + x^2, q^2 = 1 + y^2."""
    if abs(reference) > 1e150 or abs(now) > 1e150:  # their squares are no numbers
        return maths.asinh(now) - maths.asinh(reference)
    p, q, xy = maths.sqrt(1.0 + now * now), maths.sqrt(1.0 + reference * reference), now * reference
    gap = (1.0 + now * now + reference * reference) / (p * q + xy) if xy > 0.0 else p * q - xy
    return maths.asinh(step * (1.0 + gap) / (p + q))


@njit(error_model="numpy")
def exp_value(reference: float, difference: float, step: float, argument: float, largest: float) -> float:
    """Return exp(argument). Far from the reference it may be so small that nothing of it is left in reference + difference."""
    return reference + difference if abs(step) < 1.0 else maths.exp(min(argument, largest))


@njit(error_model="numpy")
def power_value(reference: float, difference: float, base: float, exponent: float) -> float:
    """Return base**exponent. Far from the reference nothing of it may be left in reference + difference."""
    return reference + difference if abs(difference) < 0.5 * abs(reference) else base**exponent
