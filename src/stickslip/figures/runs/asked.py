"""List what figures of runs ask of each kind of body."""

from __future__ import annotations

from typing import ClassVar

from stickslip.foundation.by_kind import ByKind
from stickslip.problem import BODY_KINDS
from stickslip.problem.bodies import BodyOnCharacteristics, as_waves


class DrawnKind:
    """What is asked of a kind of body, with the answers of a uniform one with waves."""

    has_inside: ClassVar[bool] = True
    """True if waves run in it, so that there is something to draw inside."""
    coarser: ClassVar[int] = 1
    """By this factor an image of the inside has fewer cells, where the waves are replayed, which takes longer."""

    def accelerates_for(self, body: BodyOnCharacteristics) -> float:
        """Return the time (s) that a contact under a law that never sticks takes from rest to the rates that follow."""
        return 0.0

    def echoes_after(self, body: BodyOnCharacteristics) -> tuple[float, ...]:
        """Return the two-way travel time (s), if waves run in the body."""
        return (body.round_trip_time,)

    def stress_per_strain(self, body: BodyOnCharacteristics) -> float | None:
        """Return what makes a mean stress (SI) of a mean strain; None where the stress is taken at places instead."""
        return as_waves(body).modulus


DRAWN_KINDS: ByKind[DrawnKind] = ByKind("stickslip.figures.runs.kinds", BODY_KINDS)
