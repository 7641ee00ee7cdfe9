"""Say what drivers that give way have in common at the start: how they begin, and what the far stress then is."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import ClassVar

from stickslip.foundation.names import KINDS_OF_BODY
from stickslip.foundation.show import brief
from stickslip.problem import LoadingHistory, Problem, far_at_first
from stickslip.run.check.asked import CheckOfDriver

SAME_STRESS = 1e-12
"""Relative difference (1) between two stresses that is rounding."""


class GivesWay(CheckOfDriver):
    """The answers of a driver that gives way: nothing is held, waves leave, and a far stress acts."""

    sends_back: ClassVar[str] = "of waves at the driver"
    not_held: ClassVar[str] = "(a rigid driver holds it below 1, this one is not rigid)"

    def at_start(self, problem: Problem) -> Iterator[str]:
        """Yield what the far stress is, or does, at the start."""
        body, far, unit, inside = problem.body, problem.far_stress, problem.load_unit, problem.stress
        if far is None:
            drag = ", and what drag takes" * any(body.held_at_start(problem.rate, problem.initial_shear))
            held = f"it holds the {KINDS_OF_BODY[unit].loads} in the {body.noun} at the start, {brief(inside, unit)}{drag}"
            yield f"the far stress is not given: {held}"
            return
        first = far.first if isinstance(far, LoadingHistory) else far
        behind = inside if body.drivers > 1 else far_at_first(problem) + problem.strength
        if abs(first - behind) > SAME_STRESS * max(abs(first), abs(behind)):
            does = "accelerates the driver" if body.driver_inertia > 0.0 else "comes to the contact as a jump"
            apart = f"{brief(first, unit)} at first, beside {brief(behind, unit)} in the {body.noun}"
            yield f"the far stress is {apart}: the difference {does}"


def infinite_mass(problem: Problem) -> Iterator[str]:
    """Yield a sentence on a driver that is rigid by its mass."""
    body = problem.body
    if math.isinf(body.driver_inertia) and not math.isinf(body.driver_impedance):
        yield "the driver is rigid, because its mass is infinite: its impedance is not felt"
