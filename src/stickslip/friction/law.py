"""Define the base class of all friction laws, and the common parts of families of laws."""

from __future__ import annotations

from dataclasses import dataclass
from functools import reduce
from typing import Any, Literal

import numpy as np
from typing_extensions import override

from stickslip.foundation.conversion import Number
from stickslip.foundation.errors import InputError
from stickslip.foundation.quantities import Choice, declare, quantity
from stickslip.friction.values import LawValues, stated_range


@dataclass(frozen=True)
class FrictionLaw(LawValues):
    """A friction law: the coefficient mu(u, v) of a contact that slips, and the static coefficient at rest.

    Subclass this to add a law; `stickslip.friction.contract` lists what a law states about itself.
    """

    def __post_init__(self) -> None:
        super().__post_init__()
        if not is_known(self):
            from stickslip.friction.statements import check_statements  # the package's own laws are tested instead

            check_statements(self)
        if self.states_range and (low := stated_range(self)[0]) < 0:
            raise InputError(f"{type(self).__name__}: friction must not be negative anywhere it slips, its minimum here is {low:g}")


def hull(*values: Any) -> tuple[Any, Any]:
    """Return the smallest and the largest of some numbers, or of arrays entry by entry: the range of a law between them."""
    return reduce(np.minimum, values), reduce(np.maximum, values)


@dataclass(frozen=True, kw_only=True)
class RemembersSlip(FrictionLaw):
    """A law of slip that lets users choose from when slip is counted, by its field `memory`.

    "all" counts slip from the start of the run, initial slip included. "since-arrest" counts slip from the last arrest; the contact
    heals at once when it is arrested. The class attribute `counts` says which slip is counted: net slip with its sign, or the path.

    An arrest is rest for a positive time: the contact can stay at rest under the friction that it has at that moment, before it
    heals. The counted slip is then set back to 0. If the healed strength is below the load, the contact slips again at once.

    Passing through v = 0 directly into slip in the other direction is not an arrest. Nor is a touch of v = 0: with inertia, rest
    counts as a touch if without healing it would end within sqrt(rtol) times the period or the round trip.

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


@dataclass(frozen=True)
class SlipWeakening(RemembersSlip):
    """A law whose friction changes from `static` to `dynamic` over a `distance` of slip path.

    The slip path d is the accumulated length of slip in both directions.
    """

    counts = "path"

    static: float = quantity("1", "friction coefficient before slip", at_least=0)
    dynamic: float = quantity("1", "friction coefficient after much slip", at_least=0)
    distance: Number = quantity("m", "slip over which friction falls (often Dc)", above=0)

    @staticmethod
    def weakened(law: Any, u: Any, v: Any) -> Any:
        """Return the constant mu of the piece after complete weakening."""
        return law.dynamic + 0.0 * u

    @override
    def range(self) -> tuple[float, float]:
        return hull(self.static, self.dynamic)


@dataclass(frozen=True)
class Stribeck(FrictionLaw):
    """A law that falls from `static` to `dynamic` around the slip rate `rate`, and rises again with `viscosity`.

    The exponent must be whole: otherwise the curve has no derivatives at v = 0, where every slip begins.
    """

    critical = "rate"

    static: float = quantity("1", "friction coefficient at rest", at_least=0)
    dynamic: float = quantity("1", "friction coefficient at high slip rate, without the viscous term", at_least=0)
    rate: Number = quantity("m/s", "slip rate v_s over which friction falls", above=0)
    exponent: float = quantity("1", "exponent of v / rate; whole", at_least=1, whole=True)
    viscosity: Number = quantity("s/m", "increase of friction with slip rate", at_least=0, default=0.0)


def is_known(law: LawValues) -> bool:
    """Return True for a law of the package, which is tested there."""
    return type(law).__module__.partition(".")[0] == "stickslip"


def rises_with_rate(law: LawValues) -> bool:
    """Return what `statements.rises_with_rate` does, which few problems ask."""
    from stickslip.friction import statements

    return statements.rises_with_rate(law)
