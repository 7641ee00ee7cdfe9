"""What the core asks of given motions: their solver."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from stickslip.run import ALL_TAKE, SolverKind

if TYPE_CHECKING:
    from stickslip.cli.kinds import KindOfRun
    from stickslip.extensions.given_motion.along import FrictionAlongMotion
    from stickslip.problem.scenarios import Scenario
    from stickslip.run import CallOptions


def _solves(what: Any) -> bool:
    from stickslip.extensions.given_motion.moved import MovedContact

    return isinstance(what, MovedContact)


def _run(source: Any, options: CallOptions) -> FrictionAlongMotion:
    from stickslip.extensions.given_motion.run import follow_motion

    return follow_motion(source, options)


def _on_command_line() -> KindOfRun:
    from stickslip.extensions.given_motion.command_line import MotionKindOfRun

    return MotionKindOfRun()


def _examine(scenario: Scenario) -> Any:
    from stickslip.extensions.given_motion.examine import MotionExamination

    return MotionExamination(scenario)


MOVED = SolverKind(
    _solves,
    _run,
    ALL_TAKE | {"rtol", "title"},
    "a MovedContact has no {}: leave it out",
    _on_command_line,
    _examine,
    what="a MovedContact",
)
"""The solver of contacts whose motion is given, and of scenarios with a [motion]."""
