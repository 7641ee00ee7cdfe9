"""The hyperbolic rate law (15) on a massless contact, solved as the quadratic that it is.

With e the load minus S muS, Z v - S (muS - muD) alpha v / (1 + alpha v) = e is alpha Z v^2 + (Z - alpha drop - alpha e) v - e = 0.
"""

from __future__ import annotations

import math

from stickslip.bodies import ElasticSlab
from stickslip.friction import HyperbolicRate
from stickslip.problem.problem import Problem


def _coefficients(problem: Problem, excess: float) -> tuple[float, float, float]:
    """alpha Z, minus the linear coefficient, and the discriminant."""
    law, body = problem.friction, problem.body
    assert isinstance(law, HyperbolicRate)
    assert isinstance(body, ElasticSlab)
    square = law.alpha * body.impedance
    linear = law.alpha * problem.normal * (law.static - law.dynamic) - body.impedance + law.alpha * excess
    return square, linear, linear**2 + 4.0 * square * excess


def fast_rate(problem: Problem, excess: float) -> float:
    """The stable (larger) root in m/s for an excess in Pa, or the fold's rate where there is none (0 at the smallest)."""
    square, linear, discriminant = _coefficients(problem, excess)
    root = math.sqrt(max(discriminant, 0.0))
    if linear <= 0.0:
        return max(2.0 * excess, 0.0) / (root - linear) if root > linear else 0.0
    return 0.5 * (linear + root) / square


def fast_room(problem: Problem, excess: float) -> float:
    """Positive where the stable root exists and is positive, falling through 0 where it ends: at the fold, or at excess 0."""
    _, linear, discriminant = _coefficients(problem, excess)
    return discriminant if linear > 0.0 else excess
