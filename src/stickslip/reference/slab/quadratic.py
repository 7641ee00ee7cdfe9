"""Slip rate of a massless contact under the hyperbolic rate law (15), as the root of a quadratic equation.

Let e be the load minus S muS, and drop = S (muS - muD). Then Z v - drop alpha v / (1 + alpha v) = e is equivalent to
alpha Z v^2 + (Z - alpha drop - alpha e) v - e = 0.
"""

from __future__ import annotations

import math

from stickslip.friction import HyperbolicRate
from stickslip.problem.problem import Problem


def _coefficients(problem: Problem, excess: float) -> tuple[float, float, float]:
    """Return alpha Z, minus the linear coefficient, and the discriminant of the quadratic."""
    law, body = problem.friction, problem.body
    assert isinstance(law, HyperbolicRate)
    square = law.alpha * body.damping
    linear = law.alpha * problem.normal * (law.static - law.dynamic) - body.damping + law.alpha * excess
    return square, linear, linear**2 + 4.0 * square * excess


def fast_rate(problem: Problem, excess: float) -> float:
    """Return the stable (larger) root (m/s) at an excess (Pa), or the rate of the fold if there is no root, but not below 0."""
    square, linear, discriminant = _coefficients(problem, excess)
    root = math.sqrt(max(discriminant, 0.0))
    if linear <= 0.0:
        return max(2.0 * excess, 0.0) / (root - linear) if root > linear else 0.0
    return 0.5 * (linear + root) / square


def fast_room(problem: Problem, excess: float) -> float:
    """Return a number that is positive while a positive stable root exists, and passes 0 where it ends: at the fold or excess 0."""
    _, linear, discriminant = _coefficients(problem, excess)
    return discriminant if linear > 0.0 else excess
