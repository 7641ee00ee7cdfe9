"""sin e and 1 - cos e of a difference of angles e (rad), in a few multiplications that are the same for a float and for lanes.

No library function is called. Both values are products of the sine and the cosine of e / 2, which change sign together if e / 2
is shifted by pi, so that e / 2 may be reduced to [-pi/2, pi/2] by any whole multiple of pi. There the terms of the series of sin
and cos that are left out are below rounding. 1 - cos e keeps the digits of small angles.
"""

from __future__ import annotations

import math
from fractions import Fraction

from stickslip.foundation.kernels.kernels import inlined

PI = Fraction("3.14159265358979323846264338327950288419716939937510582097494459230781640629")
"""pi to 75 digits."""
BITS = 33
"""Bits (1) of each part of pi but the last: its product with a whole number of 20 bits is then exact."""
ROUNDER = 1.5 * 2.0**52
"""Number (1) that rounds a float to the nearest whole number if it is added and subtracted again."""
SPLIT = 2.0**20
"""Split the number of multiples of pi by this unit (1) into a high and a low part: products with parts of pi are exact."""


def _parts(number: Fraction, count: int) -> tuple[float, ...]:
    """Return a number as a sum of `count` floats, the largest first: BITS bits each, all bits of a float in the last one."""
    if count == 1:
        return (float(number),)
    unit = Fraction(2) ** (math.frexp(float(number))[1] - BITS)
    first = unit * int(number / unit)
    return (float(first), *_parts(number - first, count - 1))


PI_1, PI_2, PI_3 = _parts(PI, 3)
"""pi as a sum of three floats, the largest first."""
SIN = tuple((-1.0) ** k / math.factorial(2 * k + 1) for k in range(1, 11))
COS = tuple((-1.0) ** k / math.factorial(2 * k) for k in range(1, 12))
"""Coefficients of the series of sin x / x and cos x in x^2, after the first term."""


@inlined
def _nearest(x: float) -> float:
    """Return the whole number nearest to x."""
    return (x + ROUNDER) - ROUNDER


@inlined
def half_angle(e: float) -> float:
    """Return e / 2 minus a whole multiple of pi (rad), in [-pi/2, pi/2], to rounding for |e| < 1e12 rad."""
    half = 0.5 * e
    times = _nearest(half * (1.0 / math.pi))
    many = _nearest(times * (1.0 / SPLIT)) * SPLIT
    few = times - many
    rest = half - many * PI_1 - few * PI_1
    rest = rest - many * PI_2 - few * PI_2
    return rest - times * PI_3


@inlined
def _sine_of_half(x: float) -> float:
    """Return sin x, for an angle (rad) from `half_angle`.

    Odd and even terms are summed apart, which shortens the chain of operations; the first and largest term is added last.
    """
    y = x * x
    z = y * y
    ones = SIN[0] + z * (SIN[2] + z * (SIN[4] + z * (SIN[6] + z * SIN[8])))
    twos = SIN[1] + z * (SIN[3] + z * (SIN[5] + z * (SIN[7] + z * SIN[9])))
    return x + x * (y * (ones + y * twos))


@inlined
def _cosine_of_half(x: float) -> float:
    """Return cos x, for an angle (rad) from `half_angle`, summed in the same way."""
    y = x * x
    z = y * y
    ones = COS[0] + z * (COS[2] + z * (COS[4] + z * (COS[6] + z * (COS[8] + z * COS[10]))))
    twos = COS[1] + z * (COS[3] + z * (COS[5] + z * (COS[7] + z * COS[9])))
    return 1.0 + y * (ones + y * twos)


@inlined
def sine(e: float) -> float:
    """Return sin e, for an angle e (rad)."""
    x = half_angle(e)
    return 2.0 * _sine_of_half(x) * _cosine_of_half(x)


@inlined
def versine(e: float) -> float:
    """Return 1 - cos e, for an angle e (rad), as 2 sin^2(e / 2)."""
    s = _sine_of_half(half_angle(e))
    return 2.0 * s * s
