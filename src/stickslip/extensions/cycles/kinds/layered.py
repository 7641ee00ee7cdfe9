"""Bodies of layers: their cycles start with the waves in all cells, and waves must fade between one period and the next."""

from __future__ import annotations

from typing import cast

from stickslip.extensions.cycles.kinds.uniform import CyclesOfUniform, not_repeated
from stickslip.problem import Problem
from stickslip.problem.bodies import OfLayers


class CyclesOfLayered(CyclesOfUniform):
    """Answers of a body of layers."""

    def refusal(self, problem: Problem) -> str:
        """Return why no cycle is looked for."""
        body = cast(OfLayers, problem.body)
        if why := not_repeated(problem):
            return why
        if all(one.reflection == 1.0 for one in body.stacks):
            return "a dead load holds the body nowhere"
        if body.has_inertia and any(abs(one.reflection) == 1.0 and one.drag is None for one in body.stacks):
            where = "the driver sends" if len(body.stacks) == 1 else "a driver sends"
            return (
                f"{where} sharp waves back whole, and so does the {body.what_is_heavy}: they never fade, and no run comes"
                " to a cycle; give the driver a finite impedance, or its layers drag"
            )
        return ""


ANSWERS = CyclesOfLayered()
