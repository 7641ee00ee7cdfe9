"""The paper's cases under the names of their bundled scenarios, their readings of the constants, and runs that are made once."""

from __future__ import annotations

from typing import TypeVar

import stickslip as ss
from stickslip.problem import Problem
from stickslip.problem.scenarios import load_scenario
from stickslip.solution import Solution

T = TypeVar("T")

READINGS = {
    "fig4-loop": "our run: dead load",
    "fig5-block-printed": "as printed",
    "fig5-block-reconstructed-k": "K = G × 10³ m",
    "fig5-block-reconstructed-omega": "ω = 50 /m",
    "fig5-slab-printed": "as printed",
    "fig5-slab-reconstructed": "ω = 50 /m, 1 mm added to D0",
    "fig5-slab-u0-1e-2": "u0 = uc + 1 cm",
    "fig6-block-printed": "as printed",
    "fig6-block-reconstructed": "K = G × 10³ m",
    "fig6-slab": "as printed",
    "fig7-block-critical": "K = G × 10³ m",
    "fig7-slab-critical": "as printed",
    "second-event-perfect-delay": "as printed",
    "second-event-minimal": "as printed; rule minimal",
    "second-event-maxwell": "as printed; rule maxwell",
    "second-event-maximal": "as printed; rule maximal",
}
"""The reading of the printed constants that each bundled scenario follows."""

REFERENCE = "Campillo, Ionescu, Paumier & Renard (1996), Phys. Earth Planet. Inter. 96"
"""The paper."""


def problem(name: str) -> Problem:
    """Return the problem of a bundled case."""
    return load_scenario(name).problem


def typed(value: object, kind: type[T]) -> T:
    """Return a law of a case, which is known to be of this type."""
    assert isinstance(value, kind)
    return value


class Runs:
    """Runs at one relative tolerance, each made once and shared by figures, tables and claims."""

    def __init__(self, rtol: float = 1e-10) -> None:
        self.rtol = rtol
        self._made: dict[tuple[Problem, float], Solution] = {}

    def case(self, name: str) -> Solution:
        """Return the run of a bundled case over the duration of its scenario."""
        scenario = load_scenario(name)
        return self(scenario.problem, scenario.duration)

    def __call__(self, problem: Problem, duration: float) -> Solution:
        """Return the run of a problem over `duration` (s).

        Raises RuntimeError if the engine gives up: no verdict is drawn from an incomplete run.
        """
        key = (problem, duration)
        if key not in self._made:
            solution = ss.simulate(problem, duration, rtol=self.rtol)
            if not solution.status.ok:
                raise RuntimeError(f"{problem}: {solution.status}")
            self._made[key] = solution
        return self._made[key]
