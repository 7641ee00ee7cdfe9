"""What a fit asks of rigid bodies: a block shows its stiffness and its mass."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import Any

from stickslip.extensions.inference.fit.asked import FittedKind
from stickslip.extensions.inference.fit.at_drive import doubts_of_rate
from stickslip.extensions.inference.fit.free import Free
from stickslip.extensions.inference.fit.part import Part, StickSlip
from stickslip.extensions.inference.fit.starting import friction_of, has_events, stick_slip
from stickslip.extensions.inference.record.record import Record
from stickslip.foundation.show import brief
from stickslip.problem import LoadingHistory, Problem
from stickslip.problem.bodies import BodyOnCharacteristics

COSINE = math.sqrt(math.pi**2 - 8.0)
"""Twice the standard deviation, in time, of the fall of a spring force along half a cosine of angular frequency 1."""
CREEPS, STIFFER = 0.8, 1.1
"""If the slope of shear between events is outside this range, relative to the stiffness of the problem, the stiffness is doubted.
The range reaches farther down, because creep makes the slope smaller."""


class _FittedRigid(FittedKind):
    def check_sensor(self, body: BodyOnCharacteristics, sensor: str) -> None:
        """Do nothing: a block has a spring, with a load cell behind it."""

    def is_away(self, record: Record, sensor: str) -> bool:
        return False

    def doubts_of_rate(self, problem: Problem, rate: LoadingHistory | float) -> Iterator[str]:
        return doubts_of_rate(problem, rate)

    def swing(self, body: BodyOnCharacteristics, cycles: StickSlip, names: set[str]) -> float:
        """Return 1 without damping, and less with it, if the record shows the stiffness and that of the problem is not free."""
        if "body.stiffness" in names or not math.isfinite(cycles.rise):
            return 1.0
        ratio = min(body.total_damping / (2.0 * math.sqrt(body.inertia * cycles.rise)), 0.99)
        return math.exp(-math.pi * ratio / math.sqrt(1.0 - ratio**2))

    def shown(self, problem: Problem, part: Part, cycles: StickSlip, names: set[str]) -> Iterator[tuple[str, float]]:
        """Yield stiffness and mass of a block: the rise between events, and the time of half a swing."""
        body: Any = problem.body
        stiffness = body.stiffness
        if "body.stiffness" in names and math.isfinite(cycles.rise):
            stiffness = cycles.rise
            yield "body.stiffness", stiffness
        if math.isfinite(cycles.duration):
            yield f"body.{body.mass_field}", stiffness * (cycles.duration / (COSINE if part.sensor == "spring" else math.pi)) ** 2

    def doubts_of_stiffness(self, problem: Problem, part: Part, free: Sequence[Free]) -> Iterator[str]:
        """Yield a question if a fixed stiffness differs from that of the record."""
        if part.record.shear is None or any(one.name == "body.stiffness" for one in free):
            return
        if not has_events(friction_of(problem, part)):
            return
        cycles, body = stick_slip(problem, part), problem.body
        stiffness = float(getattr(body, "stiffness", math.nan))
        if cycles is not None and not (CREEPS < cycles.rise / stiffness < STIFFER or math.isnan(cycles.rise / stiffness)):
            rises, has = (brief(one, problem.unit_of("stiffness"), 3) for one in (cycles.rise, stiffness))
            yield (
                f"between slip events of {part.record.name} shear rises by {rises} of load point, "
                f"and the stiffness of the problem is {has}: should it be free?"
            )


ANSWERS = _FittedRigid()
