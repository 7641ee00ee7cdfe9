"""What is asked of each kind of body about leaps over creep and steady sliding, and about slip events that are too short."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import ClassVar, Literal

from stickslip.foundation.by_kind import ByKind
from stickslip.problem.drivers.driver import driver_of
from stickslip.problem.problem import Problem

Over = Literal["creep", "swinging creep", "slow sliding", "steady sliding", ""]
"""What a run may leap over: creep under a law of slip (of a slab, or of a block, which swings), slow or only steady sliding, or
nothing."""


class LeapsOfBody(ABC):
    """The questions; each answer that is a text says what is missing, and is empty if nothing is."""

    creep: ClassVar[Over]
    """What creep under a law of slip is to this kind of body."""

    @abstractmethod
    def missing_for_creep(self, problem: Problem) -> str:
        """Return what a problem lacks for leaps over creep under a law of slip, besides a pull rate."""

    def missing_for_steady(self, problem: Problem) -> str:
        """Return what a problem lacks for leaps over steady sliding, besides a pull rate and a law: what may not change."""
        return what_changes(problem)

    def averages(self, problem: Problem) -> bool:
        """Return True if slow sliding may be averaged over round trips."""
        return False

    @abstractmethod
    def why_not_lumped(self, problem: Problem) -> str:
        """Return why events are not lumped, in words."""

    @abstractmethod
    def lumps_by_itself(self, problem: Problem) -> bool:
        """Return True if its echoes come back whole, or through layers, so that events get ever shorter under rate weakening."""


LEAPS: ByKind[LeapsOfBody] = ByKind("stickslip.problem.leaps")
"""What each kind of body answers, by `Body.structure`."""


def what_changes(problem: Problem) -> str:
    """Return what would have to be constant for leaps, in words; empty if it is."""
    if missing := driver_of(problem).missing_for_leaps:
        return missing
    if problem.ground is not None:
        return "ground at rest"
    if problem.far_stress_varies:
        return "a constant far stress"
    return "a constant pull rate and normal load" if problem.varies else ""
