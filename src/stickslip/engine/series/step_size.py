"""How long a Taylor step may be."""

from __future__ import annotations

import math

import numpy as np

from stickslip.engine.codegen.compiler import inlined, kernel
from stickslip.engine.codegen.simd import bits_as_number, power_of_two
from stickslip.engine.state.layout import TERMS, Floats

UNITS = 2.0**52
BIAS = 1023.0
FAR_FROM_GUESS = 0.2


@inlined
def quick_log2(x: float) -> float:
    """log2 |x| to 0.09, straight from the bits; -1023 for zero. A step's length needs an 18th of that."""
    return bits_as_number(abs(x)) * (1.0 / UNITS) - BIAS


@inlined
def quick_exp2(x: float) -> float:
    """2^x to 0.3 %, between 2^-1000 and 2^1000."""
    x = min(max(x, -1000.0), 1000.0)
    whole = np.floor(x)
    part = x - whole
    return power_of_two(whole) * (1.0 + part * (0.6565 + 0.3435 * part))


@inlined
def usable_length(jet: Floats, tolerance: float) -> float:
    """Longest step (in units of the guess) whose last two terms stay below the tolerance, relative to the rate over the step.

    The guess is usually twice the step. Where it is much longer (a first step, the way from a fold) the rate's size over the
    step is not that over the guess, which may be larger by orders of magnitude: then it is looked at again.
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
    """Return the usable length where the last two terms are zero: the series is a polynomial, or has gaps.

    Under a law of u^n every n-th term alone is there where u = 0. With gaps of up to half its length a term of the upper half
    is left, which then bounds what follows; a polynomial that ends below is right at any length.
    """
    for n in range(TERMS - 3, TERMS // 2 - 1, -1):
        if jet[n] != 0.0:
            size = max(abs(jet[0]), max(abs(jet[1]), max(abs(jet[2]), abs(jet[3]))))
            return quick_exp2((quick_log2(tolerance * size) - quick_log2(jet[n])) / n)
    return math.inf


@inlined
def length_at(jet: Floats, tolerance: float, expected: float) -> float:
    """The usable length if the rate is as large as it is over a step of the expected length. For lanes, too."""
    slow = max(abs(jet[0]), expected * abs(jet[1]))
    size = max(slow, expected * expected * max(abs(jet[2]), expected * abs(jet[3])))
    n = TERMS - 1
    allowed = quick_log2(tolerance * size)
    last, before = allowed - quick_log2(jet[n]), allowed - quick_log2(jet[n - 1])
    return quick_exp2(min(last * (1.0 / n), before * (1.0 / (n - 1))))
