"""Rigid bodies on a spring: their cycles start with load and states."""

from __future__ import annotations

from collections.abc import Callable

from stickslip.engine import History
from stickslip.extensions.cycles.asked import CycleKind, not_steady
from stickslip.extensions.cycles.disturbed.growth_of_pair import growth_of_pair
from stickslip.extensions.cycles.exponent import MeasuredGrowth
from stickslip.extensions.cycles.growth_along_returns import growth_of_rigid
from stickslip.extensions.cycles.near import near_end
from stickslip.extensions.cycles.orbit import Orbit
from stickslip.extensions.cycles.path import Path, path_of
from stickslip.extensions.cycles.settling import settled
from stickslip.problem import Problem
from stickslip.problem.bodies import as_on_spring
from stickslip.problem.scenarios import ParameterPath, Scenario
from stickslip.run import TextProgress


class CyclesOfRigid(CycleKind):
    """Answers of a rigid body."""

    def refusal(self, problem: Problem) -> str:
        """Return why no cycle is looked for."""
        if problem.body.is_free:
            return "without a spring nothing brings the body back"
        if as_on_spring(problem.body).has_stops:
            return "a steady pull carries the body to its stop, where it stays, or away from it, so that nothing repeats itself"
        return not_steady(problem)

    def settled(self, problem: Problem, times: tuple[float, float], rtol: float, tell: TextProgress) -> Orbit | None:
        """Return the cycle to which a run settles early; None if it takes long."""
        return settled(problem, times, rtol, tell)

    def near_end(self, history: History, problem: Problem, rtol: float) -> Orbit:
        """Return the cycle near the end of a run. Raises InputError if there is none."""
        return near_end(history, problem, rtol)

    def path(self, orbit: Orbit, scenario: Scenario, parameter: ParameterPath, span: float) -> Path:
        """Return the path of a cycle along a number of its scenario, over a span (SI) of it."""
        return path_of(orbit, scenario, parameter, span)

    def growth(self, problem: Problem, rtol: float) -> Callable[..., MeasuredGrowth]:
        """Return how disturbances of a run are followed: by the equation for them where it returns to a section."""
        returns = problem.first_pull_rate > 0.0 or self.may_be_held
        return growth_of_rigid if returns and not self.refusal(problem) else growth_of_pair


ANSWERS = CyclesOfRigid()
