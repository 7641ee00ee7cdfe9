"""Define the exponential cohesive zone, in which friction first rises with slip and then falls."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar, Literal

import numpy as np

from stickslip.foundation.quantities import quantity
from stickslip.friction.formula.expression import exp
from stickslip.friction.memory import RemembersSlip


@dataclass(frozen=True)
class ExponentialCohesiveZone(RemembersSlip):
    """mu(d) = dynamic + (static - dynamic) y exp(1 - y), y = (d + offset) / distance (d2).
    d is the slip path, the accumulated length of slip in both directions.

    Friction equals `static` at y = 1. If the offset (d1) is less than the distance, friction rises while d < distance - offset.

    Parameters
    ----------
    static
        Largest friction coefficient (no unit), at y = 1.
    dynamic
        Friction coefficient after much slip (no unit).
    distance
        Slip d2 (m), counted from -offset, at which friction is largest.
    offset
        Slip d1 (m) by which the curve is shifted back.
    memory
        Slip that friction remembers, "all" or "since-arrest" (see `RemembersSlip`).

    Notes
    -----
    Friction is largest at y = 1 if `static` exceeds `dynamic`; otherwise it is smallest there.

    Source: Bolotskaya 2023, doctoral thesis, Massachusetts Institute of Technology, exponential cohesive zone as in its code
    PyLith_custom_friction, doi:10.5281/zenodo.14047393; shape of Xu & Needleman 1994, J. Mech. Phys. Solids 42, 1397.
    """

    kind: ClassVar[str] = "exponential-cohesive-zone"
    source: ClassVar[str] = (
        "Bolotskaya 2023, doctoral thesis, Massachusetts Institute of Technology, exponential cohesive zone as in its code "
        "PyLith_custom_friction, doi:10.5281/zenodo.14047393; shape of Xu & Needleman 1994, J. Mech. Phys. Solids 42, 1397"
    )
    counts: ClassVar[Literal["net", "path"]] = "path"
    many: ClassVar[bool] = True
    example: ClassVar[dict[str, Any]] = {"static": 0.6, "dynamic": 0.4, "distance": "0.2 m", "offset": "0.1 m"}

    static: float = quantity("1", "largest friction coefficient, at y = 1", at_least=0)
    dynamic: float = quantity("1", "friction coefficient after much slip", at_least=0)
    distance: float = quantity("m", "slip d2, counted from -offset, at which friction is largest", above=0)
    offset: float = quantity("m", "slip d1 by which the curve is shifted back", at_least=0, default=0.0)

    @staticmethod
    def formula(law: Any, u: Any, v: Any) -> Any:
        y = (u + law.offset) / law.distance
        return law.dynamic + (law.static - law.dynamic) * y * exp(1.0 - y)

    def range(self) -> tuple[float, float]:
        return np.minimum(self.static, self.dynamic), np.maximum(self.static, self.dynamic)
