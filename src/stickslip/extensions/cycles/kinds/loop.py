"""Bodies in a position loop: their cycles start with load, states and the lag that the controller integrates."""

from __future__ import annotations

from stickslip.engine import History
from stickslip.extensions.cycles.asked import not_steady
from stickslip.extensions.cycles.kinds.rigid import CyclesOfRigid
from stickslip.extensions.cycles.lag import is_wound
from stickslip.extensions.cycles.orbit import Orbit
from stickslip.foundation.errors import InputError
from stickslip.problem import Problem
from stickslip.problem.bodies import as_on_spring


class CyclesOfLoop(CyclesOfRigid):
    """Answers of a body in a position loop."""

    may_be_held = True

    def refusal(self, problem: Problem) -> str:
        """Return why no cycle is looked for."""
        if why := not_steady(problem):
            return why.replace(
                "the pull rate must be a number", "the reference must be a set point or a ramp (pull_rate, a number)"
            )
        if problem.first_pull_rate == 0.0 and not is_wound(problem):
            return "without an integral gain a set point at rest brings the axis to rest: give integral_gain, or a ramp (pull_rate)"
        if problem.first_pull_rate != 0.0 and as_on_spring(problem.body).has_stops:
            return "a ramp carries the axis to its stop, where it stays, or away from it: give a set point at rest (pull_rate 0)"
        return ""

    def near_end(self, history: History, problem: Problem, rtol: float) -> Orbit:
        """Return the cycle near the end of a run. Raises InputError if there is none."""
        try:
            return super().near_end(history, problem, rtol)
        except InputError as error:
            if problem.first_pull_rate != 0.0:
                raise
            raise InputError(f"{error}; an axis that comes to its set point does not hunt") from None


ANSWERS = CyclesOfLoop()
