"""Questions about numbers so unusual that a unit or a percent sign may have been mistaken."""

from __future__ import annotations

from stickslip.problem.problem import Problem

LARGE_COEFFICIENT, SMALL_STRESS = 3.0, 10.0
"""Static coefficient above which, and normal stress (Pa) of a slab below which, a question is due."""


def doubts(problem: Problem) -> list[str]:
    """Return the questions about the numbers of a problem, one line each."""
    found, static = [], problem.strength / problem.normal
    if static > LARGE_COEFFICIENT:
        found.append(f"the static friction coefficient is {static:.4g}; that of rock is 0.1 to 1: is it a percentage?")
    if problem.body.has_waves and problem.normal < SMALL_STRESS:
        found.append(f"the normal stress is {problem.normal:.4g} Pa: mPa is a thousandth of a pascal, MPa is a million")
    return found
