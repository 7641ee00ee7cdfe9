"""Leaps of a body of layers: it makes none, because its waves differ from one round trip to the next; its echoes get shorter."""

from __future__ import annotations

from typing import ClassVar

from stickslip.problem.leaps.asked import LeapsOfBody, Over
from stickslip.problem.problem import Problem


class LeapsOfLayered(LeapsOfBody):
    """Answers of a body of layers."""

    creep: ClassVar[Over] = ""

    def missing_for_creep(self, problem: Problem) -> str:
        """Return that it has more than one layer."""
        return "a body of one layer"

    def missing_for_steady(self, problem: Problem) -> str:
        """Return that it has more than one layer."""
        return "a body of one layer"

    def why_not_lumped(self, problem: Problem) -> str:
        """Return whether a mass smooths the waves."""
        return "a contact with mass smooths the waves that come through layers" if problem.body.has_inertia else ""

    def lumps_by_itself(self, problem: Problem) -> bool:
        """Return True if the loading does not vary, or if it is a machine, by which the load at rest is no ramp."""
        return problem.body.has_machine or not problem.varies


ANSWERS = LeapsOfLayered()
