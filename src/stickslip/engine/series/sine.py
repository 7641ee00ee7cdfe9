"""sin e and 1 - cos e of a difference of angles: a few multiplications, the same for a float and for lanes, and no call.

Both have the period 2 pi, so that half the angle may be taken to [-pi/2, pi/2] by whole multiples of pi, even or odd. There the
series of sin and cos end below rounding after the terms kept here. 1 - cos e keeps the digits of small angles.
"""

from __future__ import annotations

import math
from fractions import Fraction

from stickslip.engine.codegen.compiler import inlined

PI = Fraction("3.14159265358979323846264338327950288419716939937510582097494459230781640629")
BITS = 33
"""Of each part of pi: times whole numbers of 20 bits it is exact."""
ROUNDER = 1.5 * 2.0**52
"""Added and taken away again it leaves the nearest whole number."""
MANY = 2.0**20


def _parts(number: Fraction, count: int) -> tuple[float, ...]:
    """A number as a sum of floats of so few bits, the largest first, the last one whole."""
    if count == 1:
        return (float(number),)
    unit = Fraction(2) ** (math.frexp(float(number))[1] - BITS)
    first = unit * int(number / unit)
    return (float(first), *_parts(number - first, count - 1))


PI_1, PI_2, PI_3 = _parts(PI, 3)
SIN = tuple((-1.0) ** k / math.factorial(2 * k + 1) for k in range(1, 11))
COS = tuple((-1.0) ** k / math.factorial(2 * k) for k in range(1, 12))
"""Coefficients of the series behind the first term."""


@inlined
def _nearest(x: float) -> float:
    return (x + ROUNDER) - ROUNDER


@inlined
def half_angle(e: float) -> float:
    """e / 2, less a whole multiple of pi, to rounding while |e| < 1e12."""
    half = 0.5 * e
    times = _nearest(half * (1.0 / math.pi))
    many = _nearest(times * (1.0 / MANY)) * MANY
    few = times - many
    rest = half - many * PI_1 - few * PI_1
    rest = rest - many * PI_2 - few * PI_2
    return rest - times * PI_3


@inlined
def _sine_of_half(x: float) -> float:
    """sin x, for an angle from `half_angle`. Every second term by itself, so that none waits long; the first term comes last."""
    y = x * x
    z = y * y
    ones = SIN[0] + z * (SIN[2] + z * (SIN[4] + z * (SIN[6] + z * SIN[8])))
    twos = SIN[1] + z * (SIN[3] + z * (SIN[5] + z * (SIN[7] + z * SIN[9])))
    return x + x * (y * (ones + y * twos))


@inlined
def _cosine_of_half(x: float) -> float:
    """cos x, likewise."""
    y = x * x
    z = y * y
    ones = COS[0] + z * (COS[2] + z * (COS[4] + z * (COS[6] + z * (COS[8] + z * COS[10]))))
    twos = COS[1] + z * (COS[3] + z * (COS[5] + z * (COS[7] + z * COS[9])))
    return 1.0 + y * (ones + y * twos)


@inlined
def sine(e: float) -> float:
    """sin e."""
    x = half_angle(e)
    return 2.0 * _sine_of_half(x) * _cosine_of_half(x)


@inlined
def versine(e: float) -> float:
    """1 - cos e."""
    s = _sine_of_half(half_angle(e))
    return 2.0 * s * s
