"""Define the base class of all friction laws: its own statements, what follows from them, and their check."""

from __future__ import annotations

from dataclasses import dataclass

from stickslip.foundation.errors import InputError
from stickslip.friction.statements import check_statements, is_known, stated_range
from stickslip.friction.values import LawValues


@dataclass(frozen=True)
class FrictionLaw(LawValues):
    """A friction law: the coefficient mu(u, v) of a contact that slips, and the static coefficient at rest.

    Subclass this to add a law; `stickslip.friction.contract` lists what a law states about itself.
    """

    def __post_init__(self) -> None:
        super().__post_init__()
        if not is_known(self):
            check_statements(self)
        if self.states_range and (low := stated_range(self)[0]) < 0:
            raise InputError(f"{type(self).__name__}: friction must not be negative anywhere it slips, its minimum here is {low:g}")
