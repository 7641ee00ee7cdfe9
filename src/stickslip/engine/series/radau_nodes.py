"""Collocation at Radau's points: matrices that turn values at the points of an implicit step into derivatives and integrals.

A step is [0, 1]. Point 0 is its start, points 1 to STAGES are Radau's, and the last one is its end. Implicit steps over these
points are stable for contacts of any stiffness, and also solve contacts without mass (Hairer & Wanner 1996, Solving ODEs II,
sections IV.5, VI.1).
"""

from __future__ import annotations

import numpy as np
from numpy.polynomial import legendre
from numpy.typing import NDArray

from stickslip.engine.state.layout import TERMS, Floats
from stickslip.foundation.kernels.kernels import kernel

STAGES = 9
"""Number of Radau points in a step (1), which gives order 17 at the ends of steps and 10 between them."""
NODES_OF_STEP = STAGES + 1
"""Number of points with the start of the step (1)."""
LEADING = 2.0 ** (1 - 2 * STAGES)
"""The last Chebyshev term on [0, 1] over the coefficient of x^STAGES (1)."""


def _radau() -> NDArray[np.float64]:
    """Return 0 and the zeros of P_s - P_(s-1), mapped to [0, 1] (s is STAGES, P a Legendre polynomial); the last one is 1."""
    series = np.zeros(STAGES + 1)
    series[-2:] = -1.0, 1.0
    zeros = np.sort(legendre.legroots(series).real)
    for _ in range(3):
        slope = legendre.legval(zeros, legendre.legder(series))
        zeros -= legendre.legval(zeros, series) / slope
    zeros[-1] = 1.0
    return np.append(0.0, 0.5 * (1.0 + zeros))


def _barycentric() -> NDArray[np.float64]:
    """Return the barycentric weights of interpolation at the points."""
    gaps = POINT[:, None] - POINT + np.eye(NODES_OF_STEP)
    return np.asarray(1.0 / gaps.prod(axis=1))


def _derivatives() -> NDArray[np.float64]:
    """Return a matrix whose row i gives the derivative at point i of the polynomial through values at the points."""
    gaps = POINT[:, None] - POINT + np.eye(NODES_OF_STEP)
    matrix = _WEIGHT / _WEIGHT[:, None] / gaps
    np.fill_diagonal(matrix, 0.0)
    np.fill_diagonal(matrix, -matrix.sum(axis=1))
    return matrix


def _values(places: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return a matrix whose row i gives the value of that polynomial at place i, which must not be one of the points."""
    basis = _WEIGHT / (places[:, None] - POINT)
    return np.asarray(basis / basis.sum(axis=1, keepdims=True))


def _integrals(ends: NDArray[np.float64], twice: bool = False) -> NDArray[np.float64]:
    """Return a matrix whose row i gives the integral of that polynomial from 0 to end i, by Gauss's rule, or its integral."""
    nodes, weights = legendre.leggauss(NODES_OF_STEP)
    matrix = np.zeros((len(ends), NODES_OF_STEP))
    for i, end in enumerate(ends):
        if end > 0.0:
            until = 0.5 * end * (1.0 - nodes) if twice else 1.0  # the time left is the weight of a rate in the integral of slip
            matrix[i] = 0.5 * end * weights * until @ _values(0.5 * end * (1.0 + nodes))
    return matrix


POINT = _radau()
"""The points of a step, from 0 to 1 (1)."""
_WEIGHT = _barycentric()
DERIVATIVE, INTEGRAL = _derivatives(), _integrals(POINT)
"""Matrices from values at the points to derivatives at the points and to integrals from 0 to each of them."""
INTEGRAL_TWICE = _integrals(POINT, twice=True)
"""Matrix from values at the points to the integral of the integral from 0 to each of them."""
MIDDLE = 0.5 * (POINT[1:] + POINT[:-1])
"""Places halfway between the points (1), where a step is verified: its defect in the governing equation is largest near them."""
VALUE_IN_MIDDLE, INTEGRAL_TO_MIDDLE = _values(MIDDLE), _integrals(MIDDLE)
"""Matrices from values at the points to values at these places and to integrals from 0 to each of them."""
DERIVATIVE_IN_MIDDLE = VALUE_IN_MIDDLE @ DERIVATIVE
"""Matrix from values at the points to derivatives at the places halfway between them."""
_VANDERMONDE = np.vander(POINT, increasing=True)
TO_POWERS = np.linalg.inv(_VANDERMONDE)
"""Matrix from values at the points to the coefficients of the polynomial through them."""
TO_POWERS_SUM = abs(TO_POWERS).sum(axis=1)
"""In each coefficient, rounding of the values at the points grows by at most this factor (1)."""


@kernel
def interpolate(values: Floats, out: Floats, rest: Floats) -> None:
    """Write into `out` the coefficients of the polynomial through values at the points; `rest` is room for NODES_OF_STEP numbers.

    A second pass corrects the rounding of the first, which large factors of opposite sign have amplified.
    """
    for k in range(TERMS):
        out[k] = 0.0
    for _ in range(2):
        for i in range(NODES_OF_STEP):
            value = out[NODES_OF_STEP - 1]
            for k in range(NODES_OF_STEP - 2, -1, -1):
                value = value * POINT[i] + out[k]
            rest[i] = values[i] - value
        for k in range(NODES_OF_STEP):
            for i in range(NODES_OF_STEP):
                out[k] += TO_POWERS[k, i] * rest[i]


@kernel
def last_terms(c: Floats) -> float:
    """Return the size of the last two Chebyshev terms on [0, 1] of a polynomial of degree STAGES, an estimate of its error.

    The last but one counts a tenth: it still shows an error if the last term vanishes by symmetry.
    """
    last = LEADING * c[STAGES]
    before = 4.0 * LEADING * c[STAGES - 1] + 2.0 * STAGES * last
    return max(abs(last), 0.1 * abs(before))
