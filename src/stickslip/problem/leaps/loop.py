"""Leaps of an axis in a position loop: none while its integral winds up."""

from __future__ import annotations

from stickslip.problem.leaps.rigid import LeapsOfRigid
from stickslip.problem.problem import Problem

NO_INTEGRAL = "a loop without an integral gain"


class LeapsOfLoop(LeapsOfRigid):
    """Answers of an axis in a position loop."""

    def missing_for_creep(self, problem: Problem) -> str:
        """Return that the integral winds up, or what a block lacks."""
        return NO_INTEGRAL if problem.body.has_machine else super().missing_for_creep(problem)

    def missing_for_steady(self, problem: Problem) -> str:
        """Return that the integral winds up, or what a block lacks."""
        return NO_INTEGRAL if problem.body.has_machine else super().missing_for_steady(problem)


ANSWERS = LeapsOfLoop()
