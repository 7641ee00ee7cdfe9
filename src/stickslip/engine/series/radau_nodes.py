"""Collocation at Radau's points: what turns values at the stages of an implicit step into derivatives, integrals and polynomials.

A step is [0, 1]; point 0 is its start, points 1 to STAGES are Radau's, the last one its end. Implicit steps over them are stable
however stiff the contact is, and solve it also where it has no mass (Hairer & Wanner 1996, Solving ODEs II, sections IV.5, VI.1).
"""

from __future__ import annotations

import numpy as np
from numpy.polynomial import legendre
from numpy.typing import NDArray

from stickslip.engine.codegen.compiler import kernel
from stickslip.engine.state.layout import TERMS, Floats

STAGES = 9
"""Order 17 at the ends of steps, 10 between them."""
POINTS = STAGES + 1


def _radau() -> NDArray[np.float64]:
    """0, and the zeros of P_s - P_(s-1) on [0, 1], which end at 1."""
    series = np.zeros(STAGES + 1)
    series[-2:] = -1.0, 1.0
    zeros = np.sort(legendre.legroots(series).real)
    for _ in range(3):
        slope = legendre.legval(zeros, legendre.legder(series))
        zeros -= legendre.legval(zeros, series) / slope
    zeros[-1] = 1.0
    return np.append(0.0, 0.5 * (1.0 + zeros))


def _barycentric() -> NDArray[np.float64]:
    gaps = POINT[:, None] - POINT + np.eye(POINTS)
    return np.asarray(1.0 / gaps.prod(axis=1))


def _derivatives() -> NDArray[np.float64]:
    """Row i: what the values at the points contribute to the derivative at point i of the polynomial through them."""
    gaps = POINT[:, None] - POINT + np.eye(POINTS)
    matrix = _WEIGHT / _WEIGHT[:, None] / gaps
    np.fill_diagonal(matrix, 0.0)
    np.fill_diagonal(matrix, -matrix.sum(axis=1))
    return matrix


def _values(places: NDArray[np.float64]) -> NDArray[np.float64]:
    """Row i: the same for the value at a place that is none of the points."""
    basis = _WEIGHT / (places[:, None] - POINT)
    return np.asarray(basis / basis.sum(axis=1, keepdims=True))


def _integrals(ends: NDArray[np.float64]) -> NDArray[np.float64]:
    """Row i: the same for the integral from 0 to end i, by Gauss's rule on each."""
    nodes, weights = legendre.leggauss(POINTS)
    matrix = np.zeros((len(ends), POINTS))
    for i, end in enumerate(ends):
        if end > 0.0:
            matrix[i] = 0.5 * end * weights @ _values(0.5 * end * (1.0 + nodes))
    return matrix


POINT = _radau()
_WEIGHT = _barycentric()
DERIVATIVE, INTEGRAL = _derivatives(), _integrals(POINT)
MIDDLE = 0.5 * (POINT[1:] + POINT[:-1])
"""Places halfway between the points, where a step is verified: what it misses of the equation is largest near them."""
VALUE_IN_MIDDLE, INTEGRAL_TO_MIDDLE = _values(MIDDLE), _integrals(MIDDLE)
DERIVATIVE_IN_MIDDLE = VALUE_IN_MIDDLE @ DERIVATIVE
_VANDERMONDE = np.vander(POINT, increasing=True)
TO_POWERS = np.linalg.inv(_VANDERMONDE)
TO_POWERS_SUM = abs(TO_POWERS).sum(axis=1)
"""Factors by which rounding of the values at the points is larger in the coefficients."""


@kernel
def interpolate(values: Floats, out: Floats, rest: Floats) -> None:
    """Coefficients of the polynomial through values at the points; `rest` is room for POINTS numbers.

    Twice: the second pass takes back the rounding of the first, which large factors of opposite sign have made larger.
    """
    for k in range(TERMS):
        out[k] = 0.0
    for _ in range(2):
        for i in range(POINTS):
            value = out[POINTS - 1]
            for k in range(POINTS - 2, -1, -1):
                value = value * POINT[i] + out[k]
            rest[i] = values[i] - value
        for k in range(POINTS):
            for i in range(POINTS):
                out[k] += TO_POWERS[k, i] * rest[i]


@kernel
def last_terms(c: Floats) -> float:
    """Size of the last two Chebyshev terms of a polynomial of degree STAGES on [0, 1]: what more points would still change.

    The one before the last counts a tenth: it is what a last term that vanishes by symmetry hides.
    """
    half = 2.0 ** (1 - 2 * STAGES)
    last = half * c[STAGES]
    before = 4.0 * half * c[STAGES - 1] + 2.0 * STAGES * last
    return max(abs(last), 0.1 * abs(before))
