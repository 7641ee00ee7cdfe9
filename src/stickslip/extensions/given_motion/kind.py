"""What the core asks of given motions: their solver."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from stickslip.foundation.errors import InputError
from stickslip.foundation.show import number
from stickslip.run import SolverKind

if TYPE_CHECKING:
    from stickslip.extensions.given_motion.along import FrictionAlongMotion
    from stickslip.problem.scenarios import Scenario
    from stickslip.run import CallOptions


def _solves(what: Any) -> bool:
    from stickslip.extensions.given_motion.moved import MovedContact

    return isinstance(what, MovedContact)


def follow_motion(source: Any, options: CallOptions) -> FrictionAlongMotion:
    """Find friction along the motion of a `MovedContact`, or of a scenario with a [motion]. Raises InputError."""
    from stickslip.extensions.given_motion.along import FrictionAlongMotion

    moved = getattr(source, "to_solve", source)
    if options.duration is None:
        raise InputError("simulate: a MovedContact needs a duration, in s or with a unit")
    checked, report = options.checked("simulate"), options.progress
    duration = float(checked.duration)

    def tell(time: float) -> None:
        assert report is not None
        report(f"{number(time, 4)} s of {number(duration, 4)} s")

    return FrictionAlongMotion.solved(moved, duration, checked.rtol, checked.title, None if report is None else tell)


def _examine(scenario: Scenario) -> Any:
    from stickslip.extensions.given_motion.examine import MotionExamination

    return MotionExamination(scenario)


MOVED = SolverKind(
    _solves,
    follow_motion,
    frozenset({"duration", "rtol", "title", "progress"}),
    "a MovedContact has no {}: leave it out",
    examine=_examine,
    what="a MovedContact",
)
"""The solver of contacts whose motion is given, and of scenarios with a [motion]."""
