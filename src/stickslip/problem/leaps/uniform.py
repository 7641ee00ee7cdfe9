"""Leaps of a uniform body with waves, which creeps from round trip to round trip."""

from __future__ import annotations

from typing import ClassVar

from stickslip.problem.drivers.driver import DRIVERS
from stickslip.problem.leaps.asked import LeapsOfBody, Over, what_changes
from stickslip.problem.problem import Problem


class LeapsOfUniform(LeapsOfBody):
    """Answers of a uniform body with waves."""

    creep: ClassVar[Over] = "creep"

    def missing_for_creep(self, problem: Problem) -> str:
        """Return what a slab or a string lacks for leaps over creep, besides a pull rate; empty if it lacks nothing."""
        body, law = problem.body, problem.friction
        if missing := DRIVERS[body.driver_kind].missing_for_creep:
            return missing
        if body.has_inertia:
            return f"a contact without mass (no {body.mass_field})"
        if body.dashpot:
            return "a contact that waves alone damp (no contact_damping)"
        if law.states or law.depends_on_rate:
            return f"a friction law of slip alone, or one without slip ({type(law).__name__} is neither)"
        if law.memory != "all":
            return "a friction law that remembers all slip (no memory of its own)"
        if problem.ground is not None or problem.one_way:
            return "ground at rest, and slip in both directions"
        return what_changes(problem)

    def averages(self, problem: Problem) -> bool:
        """Return True under a rigid driver, if waves alone damp the contact."""
        return problem.body.is_driven_rigidly and not problem.body.dashpot

    def why_not_lumped(self, problem: Problem) -> str:
        """Return whether the driver gives way or the loading varies."""
        if DRIVERS[problem.body.driver_kind].missing_for_creep:
            return "only with waves and a rigid driver do echoes get ever shorter"
        return "events are lumped under a constant pull and normal load only" if problem.varies else ""

    def lumps_by_itself(self, problem: Problem) -> bool:
        """Return True if echoes come back whole, and the loading does not vary."""
        return not problem.varies and problem.body.is_driven_rigidly


ANSWERS = LeapsOfUniform()
