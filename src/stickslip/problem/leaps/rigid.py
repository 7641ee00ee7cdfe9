"""Leaps of a rigid body on a spring, which swings as it creeps."""

from __future__ import annotations

from typing import ClassVar

from typing_extensions import override

from stickslip.problem.bodies import as_on_spring
from stickslip.problem.leaps.asked import LeapsOfBody, Over
from stickslip.problem.problem import Problem


def what_stops_or_winds(problem: Problem) -> str:
    """Return what a body would have to be without for leaps, in words; empty if it is."""
    if problem.body.has_stops or problem.body.has_play:
        return "no hard stops" if problem.body.has_stops else "no backlash"
    return "no integral gain" if as_on_spring(problem.body).integral_gain else ""


class LeapsOfRigid(LeapsOfBody):
    """Answers of a rigid body."""

    creep: ClassVar[Over] = "swinging creep"

    def missing_for_creep(self, problem: Problem) -> str:
        """Return what a block lacks for leaps over creep: it swings there."""
        law = problem.friction
        if not law.depends_on_slip or law.depends_on_rate or law.states:
            return f"a friction law of slip alone ({type(law).__name__} is not one)"
        if law.memory != "all":
            return "a friction law that remembers all slip (no memory of its own)"
        if not law.sticks or law.static_excess != 0.0:
            return "a friction law under which slip begins at the friction of rest"
        if problem.ground is not None or problem.one_way:
            return "ground at rest, and slip in both directions"
        return self.missing_for_steady(problem)

    @override
    def missing_for_steady(self, problem: Problem) -> str:
        """Return what ends it or winds up, that nothing pulls it, or what changes."""
        if missing := what_stops_or_winds(problem):
            return missing
        if problem.body.is_free:
            return "a spring (a stiffness above 0)"
        return "no force in time" if problem.force is not None else super().missing_for_steady(problem)

    def why_not_lumped(self, problem: Problem) -> str:
        """Return that there are no echoes."""
        return "only with waves and a rigid driver do echoes get ever shorter"

    def lumps_by_itself(self, problem: Problem) -> bool:
        """Return False: there are no echoes."""
        return False


ANSWERS = LeapsOfRigid()
