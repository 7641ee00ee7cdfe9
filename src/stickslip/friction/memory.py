"""Slip memory: which part of the slip behind it a law of slip knows."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from stickslip.foundation.errors import InputError
from stickslip.friction.law import FrictionLaw
from stickslip.friction.parameters import Choice, declare


@dataclass(frozen=True, kw_only=True)
class RemembersSlip(FrictionLaw):
    """A law of slip, with the choice of how far back its slip is counted.

    `memory` "all" counts from the start of the run, initial slip included. "since-arrest" counts from the last arrest: the
    contact heals at once. What is counted is what `counts` says: net slip, signed, or the path. An arrest is rest for a positive
    time: the contact can stay where it is under the friction it has then, not yet healed. Then the counted slip is 0 again, and
    where the healed strength is below the load the contact slips again at once. Passing through rest straight into slip the other
    way is no arrest, nor is touching it: with inertia, rest that would be over, unhealed, within the root of `rtol` of a period or
    round trip. The start is an arrest: with "since-arrest" initial slip does not enter friction.
    """

    memory: Literal["all", "since-arrest"] = declare(  # type: ignore[misc] # here a choice of the user
        Choice("slip that friction remembers", ("all", "since-arrest")), "all"
    )

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.memory == "since-arrest" and not self.depends_on_slip:
            name = type(self).__name__
            raise InputError(f"{name}: memory 'since-arrest' needs friction that depends on slip; allowed here: all")
