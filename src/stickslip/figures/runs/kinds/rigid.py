"""How rigid bodies are drawn: a block has no inside."""

from __future__ import annotations

from typing import ClassVar

from stickslip.figures.runs.asked import DrawnKind
from stickslip.problem.bodies import BodyOnCharacteristics


class _DrawnRigid(DrawnKind):
    has_inside: ClassVar[bool] = False

    def accelerates_for(self, body: BodyOnCharacteristics) -> float:
        return body.round_trip_time

    def echoes_after(self, body: BodyOnCharacteristics) -> tuple[float, ...]:
        return ()


ANSWERS = _DrawnRigid()
