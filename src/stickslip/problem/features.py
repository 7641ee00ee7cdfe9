"""The features of problems that not every solver follows, and the one sentence with which such a problem is refused."""

from __future__ import annotations

from collections.abc import Mapping
from operator import attrgetter
from typing import Any, NamedTuple

from stickslip.foundation.errors import InputError
from stickslip.problem.bodies import MACHINE


class Feature(NamedTuple):
    """Something that a problem may have: what sentences call it, how a problem is made without it, and how it is recognised."""

    words: str
    cure: str
    attribute: str
    """What a problem has if it has the feature: an attribute that is true, or not None."""

    def is_in(self, problem: Any) -> bool:
        """Return True if a problem, or what has the same attributes, has the feature."""
        return bool(attrgetter(self.attribute)(problem))


DRIVEN_BY_MACHINE = Feature(
    MACHINE, "set driver_inertia and driver_integral_gain (of a loop integral_gain) to 0", "body.has_machine"
)
DRIVER_THAT_CHANGES = Feature("a driver that changes", "leave driver_reflection out", "driver_changes")
NORMAL_LOAD_THAT_VARIES = Feature("a normal_load that varies", "leave it out, or simulate the Problem", "normal_varies")
MOVING_GROUND = Feature("ground that moves", "leave it out", "ground")
DASHPOT = Feature("a dashpot at the contact", "set contact_damping to 0", "body.dashpot")
ONE_WAY = Feature("one_way", "leave it out", "one_way")


def refuse(where: str, problem: Any, not_followed: Mapping[Feature, str]) -> None:
    """Raise InputError for the first feature that a problem has of those that are not followed.

    For each of them `not_followed` says so: "is followed in 1D only". `problem` may be anything that has the attributes by which
    these features are recognised, such as a `body`.
    """
    for feature, why in not_followed.items():
        if feature.is_in(problem):
            raise InputError(f"{where}: {feature.words} {why}: {feature.cure}")
