"""Define slip memory: the part of the past slip that a law of slip takes into account."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from stickslip.foundation.errors import InputError
from stickslip.friction.law import FrictionLaw
from stickslip.friction.parameters import Choice, declare


@dataclass(frozen=True, kw_only=True)
class RemembersSlip(FrictionLaw):
    """A law of slip that lets users choose from when slip is counted.

    Parameters
    ----------
    memory
        "all" counts slip from the start of the run, initial slip included. "since-arrest" counts slip from the last arrest, at
        which the contact heals at once.

    Raises
    ------
    InputError
        If `memory` is "since-arrest" and friction does not depend on slip.

    Notes
    -----
    The class attribute `counts` says which slip is counted: net slip with its sign, or the path.

    An arrest is rest for a positive time: the contact can stay at rest under the friction that it has at that moment, before it
    heals. The counted slip is then set back to 0. If the healed strength is below the load, the contact slips again at once.

    Passing through v = 0 directly into slip in the other direction is not an arrest. Touching v = 0 is not one either: with
    inertia, a touch is rest that, without healing, would end within sqrt(rtol) times the period or the round trip.

    The start of the run counts as an arrest: with "since-arrest" the initial slip does not enter friction.
    """

    memory: Literal["all", "since-arrest"] = declare(  # type: ignore[misc] # a class attribute in the base, a field here
        Choice("slip that friction remembers", ("all", "since-arrest")), "all"
    )

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.memory == "since-arrest" and not self.depends_on_slip:
            name = type(self).__name__
            raise InputError(f"{name}: memory 'since-arrest' needs friction that depends on slip; allowed here: all")
