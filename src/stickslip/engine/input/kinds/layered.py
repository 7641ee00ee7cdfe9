"""What the engine is told of a body of layers: a ladder of cells, through which waves run step by step."""

from __future__ import annotations

from typing import Any

from stickslip.engine.input.asked import CellCounts, InputOfBody, Shaken
from stickslip.engine.input.kinds.uniform import smallest_jump, steady_numbers
from stickslip.engine.input.ladder import first_pieces, ladder_of, layers_of
from stickslip.engine.state import layout as at
from stickslip.problem import Problem, driver_of


class InputOfLayered(InputOfBody):
    """Answers of a body of layers."""

    def numbers(self, problem: Problem) -> dict[str, Any]:
        """Return the smallest jump of the slip rate (m/s), and when the inflow is heard first (s)."""
        return {"smallest_jump": smallest_jump(problem), "inflow_from": problem.body.inflow_delay}

    def steady_numbers(self, problem: Problem) -> dict[str, Any]:
        """Return the growth of the load at rest in a round trip of two cells; inflow comes through the cells."""
        return steady_numbers(problem)

    def first_load(self, problem: Problem) -> at.Floats:
        """Return the load of the start, or NaN from when on a driver is heard."""
        return first_pieces(problem)

    def first_load_varying(self, problem: Problem) -> at.Floats:
        """Return the same: what drivers send is added in the cells."""
        return first_pieces(problem)

    def on_ground(self, problem: Problem) -> Shaken:
        """Return the velocity of the ground, whose echoes the engine follows."""
        from stickslip.engine.input.shaking import GroundUnderLayers  # here, because few runs move the ground

        return GroundUnderLayers.of(problem)

    def ladder(self, problem: Problem) -> at.Floats:
        """Return its cells."""
        return ladder_of(problem)

    def cells(self, problem: Problem) -> CellCounts:
        """Return how many cells it has on both sides."""
        body = layers_of(problem)
        cells = [sum(one.counts) for one in body.stacks]
        return CellCounts(sum(cells), cells[0], body.is_joined, sum(cells) + driver_of(problem).moves)


ANSWERS = InputOfLayered()
