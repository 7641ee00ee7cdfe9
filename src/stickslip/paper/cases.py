"""The paper's cases under their bundled names, what each reading is, and runs that are made once."""

from __future__ import annotations

import stickslip as ss
from stickslip.problem.problem import Problem
from stickslip.scenarios import load_scenario
from stickslip.solution.solution import Solution

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
"""Bundled scenario: under which reading of the printed constants it stands."""

REFERENCE = "Campillo, Ionescu, Paumier & Renard (1996), Phys. Earth Planet. Inter. 96"


def problem(name: str) -> Problem:
    """The problem of a bundled case."""
    return load_scenario(name).problem


class Runs:
    """Runs at one tolerance, each made once: figures, tables and claims share them."""

    def __init__(self, rtol: float = 1e-10) -> None:
        self.rtol = rtol
        self._made: dict[tuple[Problem, float], Solution] = {}

    def case(self, name: str) -> Solution:
        """A bundled case, for as long as its scenario says."""
        scenario = load_scenario(name)
        return self(scenario.problem, scenario.duration)

    def __call__(self, problem: Problem, duration: float) -> Solution:
        """A problem for `duration` s. Raises RuntimeError where the engine gives up: no verdict is drawn from half a run."""
        key = (problem, duration)
        if key not in self._made:
            solution = ss.simulate(problem, duration, rtol=self.rtol)
            if not solution.status.ok:
                raise RuntimeError(f"{problem}: {solution.status}")
            self._made[key] = solution
        return self._made[key]
