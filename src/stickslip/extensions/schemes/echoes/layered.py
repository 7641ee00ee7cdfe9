"""A body of layers sends waves back where layers meet, and from its drivers."""

from __future__ import annotations

from typing import cast

from stickslip.extensions.schemes.echoes.asked import Echoes, EchoesOfKind, SideOfWaves
from stickslip.problem import Problem
from stickslip.problem.bodies import OfLayers


class EchoesOfLayered(EchoesOfKind):
    """Answers of a body of layers."""

    def echoes(self, problem: Problem) -> Echoes | None:
        """Return its cells on both sides; None if drag acts in between."""
        body = cast(OfLayers, problem.body)
        if body.has_drag:
            return None
        sides = tuple(SideOfWaves.of(one.cell_impedances, -one.reflection) for one in body.stacks)
        return Echoes(sides, body.cells.time, len(sides) > 1 and not body.is_joined)


ANSWERS = EchoesOfLayered()
