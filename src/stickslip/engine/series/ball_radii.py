"""Functions that the ball arithmetic of formulas calls (see `engine.formula_code.balls`): radii of elementary functions on a disc.

Each returns an upper bound, which may exceed the exact radius by some per cent: `engine.contact_step.certificate` takes the root of
order 19 of their sum. If the disc reaches a singularity, the result is huge, infinite or not a number. None of the functions
contains a decision, so they work on lanes, too.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from stickslip.foundation.kernels.memory.simd import power_of_two
from stickslip.foundation.kernels.uncompiled import MATHS, UNCOMPILED

maths: Any = MATHS if UNCOMPILED else math

TO_TWO = 1.0 / math.log(2.0)
"""log2(e)."""
LARGEST_EXPONENT = 1000.0
"""`exp_above` is infinite above 2 to this power (1)."""
TINIEST = 1e-300
"""Number that replaces zero where a disc reaches a singularity, or where a value underflows."""
MARGIN_OF_PARABOLA = 1.005
"""Factor (1) by which the parabola for 2^x on [0, 1] is raised to lie above it; it is accurate to 0.3 %."""


def exp_above(x: float) -> float:
    """Return a number between exp(x) and 1.01 exp(x); above 2^LARGEST_EXPONENT it is infinite, or soon becomes so."""
    y = max(TO_TWO * x, -LARGEST_EXPONENT)
    over = 1e308 * max(y - LARGEST_EXPONENT, 0.0)
    y = min(y, LARGEST_EXPONENT)
    whole = np.floor(y)
    part = y - whole
    return MARGIN_OF_PARABOLA * power_of_two(whole) * (1.0 + part * (0.6565 + 0.3435 * part)) + over


def exp_radius(argument: float, value: float, radius: float) -> float:
    """Return the radius of exp: exp(a) (exp(r) - 1) <= min(exp(a + r), exp(a) r (1 + exp(r)) / 2), for tanh(y) <= y.

    A value that underflows is replaced by TINIEST, which is larger.
    """
    return min(exp_above(argument + radius), 0.5 * (value + TINIEST) * radius * (1.0 + exp_above(radius)))


def sine_radius(own: float, other: float, radius: float) -> float:
    """Return the radius of sin or cos, |own| (cosh(r) - 1) + |other| sinh(r), from their magnitudes at the centre.

    Compared term by term: cosh(r) - 1 <= r^2 (5 + cosh(r)) / 12, and sinh(r) <= r (2 + cosh(r)) / 3.
    """
    cosh = 0.5 + 0.5 * exp_above(radius)
    return own * radius * radius * (5.0 + cosh) * (1.0 / 12.0) + other * radius * (2.0 + cosh) * (1.0 / 3.0)


def log_radius(size: float, radius: float) -> float:
    """Return an upper bound of -log(1 - r / size), huge from r = size on: x (1 - x / 2) / (1 - x), with x = r / size."""
    x = radius / max(size, TINIEST)
    return x * max(1.0 - 0.5 * x, 0.5) / max(1.0 - x, TINIEST)


def power_radius(size: float, exponent: float, logarithm: float) -> float:
    """Return the radius of a power, |value| (exp(|p| l) - 1), with l >= |log(base / centre of the base)|."""
    growth = exponent * logarithm
    return 0.5 * (size + TINIEST) * growth * (1.0 + exp_above(growth))


def arcsinh_radius(size: float, radius: float) -> float:
    """Return the radius of arcsinh: that of a logarithm whose singularities are at the distance of i from the centre."""
    least = min(size, 1e150)
    return log_radius(max(maths.sqrt(1.0 + least * least), size), radius)


STRIP = 1.2
"""Half-width (1) of a strip around the real axis with |cosh| >= COS_STRIP; the zeros of cosh are at i pi / 2."""
COS_STRIP = 0.362
"""A lower bound of cos(STRIP)."""


def tanh_radius(size: float, radius: float) -> float:
    """Return the radius of tanh, from |sinh(z - m)| / (|cosh z| |cosh m|), or from 2 / |exp(2 z) + 1| far from the imaginary axis.

    |cosh z|^2 = sinh(x)^2 + cos(y)^2 is bounded from below by cos(y) inside a strip and by |sinh(x)| outside it.
    """
    apart = size - radius
    beside = size - maths.sqrt(max(radius * radius - STRIP * STRIP, 0.0))
    least = max(max(1.0 - 0.5 * radius * radius, sinh_below(apart)), min(COS_STRIP, sinh_below(beside)))
    cosh = 0.5 + 0.5 * exp_above(radius)
    near = radius * (2.0 + cosh) * (1.0 / 3.0) / (max(least, TINIEST) * max(1.0, 0.49 * exp_above(min(size, 300.0))))
    far = 4.0 / max(0.98 * exp_above(2.0 * min(apart, 300.0)) - 1.0, TINIEST)
    return min(far, near)


def sinh_below(x: float) -> float:
    """Return a lower bound of sinh(x) for x >= 0, and a number below 0 for x < 0: the larger of x and (exp(x) - 1) / 2."""
    return max(x, 0.495 * exp_above(min(x, 300.0)) - 0.5)
