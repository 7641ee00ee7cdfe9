"""Define the parabolic cohesive zone: friction follows a concave parabola and is constant after that."""

from __future__ import annotations

from dataclasses import dataclass
from functools import reduce
from typing import Any, ClassVar, Literal

import numpy as np

from stickslip.foundation.quantities import quantity
from stickslip.friction.law import Formula
from stickslip.friction.memory import RemembersSlip


@dataclass(frozen=True)
class ParabolicSlipWeakening(RemembersSlip):
    """mu = static - (static - dynamic) ((d - onset) / distance)^2 up to slip onset + distance (d1 + d2), then dynamic.

    Parameters
    ----------
    static
        Friction coefficient at the onset (no unit).
    dynamic
        Friction coefficient after onset + distance of slip (no unit).
    distance
        Slip d2 (m) over which friction falls.
    onset
        Slip d1 (m) at which friction begins to fall.
    memory
        Slip that friction remembers, "all" or "since-arrest" (see `RemembersSlip`).

    Notes
    -----
    d is the slip path: the accumulated length of slip in both directions. With an onset above 0 friction begins below `static`
    and rises to it. Beyond the onset it falls at a growing rate.

    Source: Bolotskaya 2023, doctoral thesis, Massachusetts Institute of Technology, parabolic cohesive zone as in its code
    PyLith_custom_friction, doi:10.5281/zenodo.14047393.
    """

    kind: ClassVar[str] = "parabolic-slip-weakening"
    source: ClassVar[str] = (
        "Bolotskaya 2023, doctoral thesis, Massachusetts Institute of Technology, parabolic cohesive zone as in its code "
        "PyLith_custom_friction, doi:10.5281/zenodo.14047393"
    )
    counts: ClassVar[Literal["net", "path"]] = "path"
    many: ClassVar[bool] = True
    example: ClassVar[dict[str, Any]] = {"static": 0.6, "dynamic": 0.4, "distance": "0.4 m", "onset": 0.0}

    static: float = quantity("1", "friction coefficient at the onset", at_least=0)
    dynamic: float = quantity("1", "friction coefficient after onset + distance of slip", at_least=0)
    distance: float = quantity("m", "slip d2 over which friction falls", above=0)
    onset: float = quantity("m", "slip d1 at which it begins to fall", at_least=0, default=0.0)

    @staticmethod
    def formula(law: Any, u: Any, v: Any) -> Any:
        return law.static - (law.static - law.dynamic) * ((u - law.onset) / law.distance) ** 2

    @staticmethod
    def after(law: Any, u: Any, v: Any) -> Any:
        """Return mu at slips beyond onset + distance."""
        return law.dynamic + 0.0 * u

    @property
    def pieces(self) -> tuple[Formula, ...]:
        return (self.formula, self.after)

    @property
    def knots(self) -> tuple[float, ...]:
        return (self.onset + self.distance,)

    def range(self) -> tuple[float, float]:
        values = (self.static, self.dynamic, self.formula(self, 0.0, 0.0))
        return reduce(np.minimum, values), reduce(np.maximum, values)
