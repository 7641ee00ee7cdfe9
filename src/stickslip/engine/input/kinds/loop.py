"""What the engine is told of an axis in a position loop: a step of its reference at the start is felt at once."""

from __future__ import annotations

from stickslip.engine.input.first_pieces import pieces_of
from stickslip.engine.input.kinds.rigid import InputOfRigid
from stickslip.engine.state import layout as at
from stickslip.problem import Problem
from stickslip.problem.bodies import as_in_loop


class InputOfLoop(InputOfRigid):
    """Answers of an axis in a position loop."""

    def first_load(self, problem: Problem) -> at.Floats:
        """Return one straight piece."""
        return _straight(problem, problem.body.stiffness * problem.first_pull_rate)

    def first_load_varying(self, problem: Problem) -> at.Floats:
        """Return one piece that does not grow: all growth is inflow or the integral."""
        return _straight(problem, 0.0)


def _straight(problem: Problem, growth: float) -> at.Floats:
    load = problem.excess + problem.body.stiffness * as_in_loop(problem.body).reference_step
    return pieces_of([0.0, problem.round_trip_time], [load], [growth])


ANSWERS = InputOfLoop()
