"""The length of a Taylor step: as long as the last terms of its series stay below the tolerance."""

from __future__ import annotations

import math

import numpy as np

from stickslip.engine.state.layout import TERMS, Floats
from stickslip.foundation.kernels.kernels import inlined, kernel
from stickslip.foundation.kernels.memory.simd import bits_as_number, power_of_two

STEPS_OF_FLOATS = 2.0**52
"""Steps of a float's bits (1) from one power of two to the next."""
BIAS = 1023.0
"""Offset of the exponent in the bits of a float (1)."""
FAR_FROM_GUESS = 0.2
"""For a step shorter than this, in units (1), the size of the slip rate is determined again: the unit was far too long."""


@inlined
def quick_log2(x: float) -> float:
    """Return log2 |x| to 0.09, straight from its bits; -1023 for zero.

    That is accurate enough: the length of a step takes this logarithm divided by the order of its last terms.
    """
    return bits_as_number(abs(x)) * (1.0 / STEPS_OF_FLOATS) - BIAS


@inlined
def quick_exp2(x: float) -> float:
    """Return 2^x to 0.3 %, limited to between 2^-1000 and 2^1000."""
    x = min(max(x, -1000.0), 1000.0)
    whole = np.floor(x)
    part = x - whole
    return power_of_two(whole) * (1.0 + part * (0.6565 + 0.3435 * part))


@inlined
def usable_length(jet: Floats, tolerance: float) -> float:
    """Return the longest step (in units) whose last two terms stay below the tolerance, relative to the slip rate over the step.

    The unit is usually twice the step. If it is much longer (for a first step, or after a fold), the slip rate over the unit
    may be larger by orders of magnitude than over the step: the length is then calculated again with the rate over the step.
    """
    if jet[TERMS - 1] == 0.0 and jet[TERMS - 2] == 0.0:
        return length_with_gaps(jet, tolerance)
    length = length_at(jet, tolerance, 0.5)
    if length < FAR_FROM_GUESS:
        for _ in range(3):
            length = length_at(jet, tolerance, length)
    return length


@kernel
def length_with_gaps(jet: Floats, tolerance: float) -> float:
    """Return the usable length (in units) if the last two terms are zero: the series is a polynomial, or has gaps.

    Under a law in u^n only every n-th term differs from zero at u = 0. With gaps of up to half the length of the series, a term
    of its upper half remains, and bounds the terms that follow. A polynomial of lower degree holds at any length: inf.
    """
    for n in range(TERMS - 3, TERMS // 2 - 1, -1):
        if jet[n] != 0.0:
            size = max(abs(jet[0]), max(abs(jet[1]), max(abs(jet[2]), abs(jet[3]))))
            return quick_exp2((quick_log2(tolerance * size) - quick_log2(jet[n])) / n)
    return math.inf


@inlined
def length_at(jet: Floats, tolerance: float, expected: float) -> float:
    """Return the usable length (in units) if the slip rate is as large as over a step of the expected length. Works on lanes."""
    slow = max(abs(jet[0]), expected * abs(jet[1]))
    size = max(slow, expected * expected * max(abs(jet[2]), expected * abs(jet[3])))
    n = TERMS - 1
    allowed = quick_log2(tolerance * size)
    last, before = allowed - quick_log2(jet[n]), allowed - quick_log2(jet[n - 1])
    return quick_exp2(min(last * (1.0 / n), before * (1.0 / (n - 1))))
