"""How bodies of layers are drawn: their waves are replayed in cells."""

from __future__ import annotations

from typing import ClassVar

from stickslip.figures.runs.asked import DrawnKind
from stickslip.problem.bodies import BodyOnCharacteristics


class _DrawnLayered(DrawnKind):
    coarser: ClassVar[int] = 2

    def stress_per_strain(self, body: BodyOnCharacteristics) -> float | None:
        """Return None: the modulus changes from layer to layer."""
        return None


ANSWERS = _DrawnLayered()
