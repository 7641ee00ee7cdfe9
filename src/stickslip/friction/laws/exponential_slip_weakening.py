"""Define exponential slip weakening."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar, Literal

import numpy as np

from stickslip.foundation.quantities import quantity
from stickslip.friction.formula.expression import exp
from stickslip.friction.memory import RemembersSlip


@dataclass(frozen=True)
class ExponentialSlipWeakening(RemembersSlip):
    """mu(d) = dynamic + (static - dynamic) exp(-d / distance).
    d is the slip path, the accumulated length of slip in both directions.

    Parameters
    ----------
    static
        Friction coefficient before slip (no unit).
    dynamic
        Friction coefficient after much slip (no unit).
    distance
        Slip (m) over which the excess of friction over `dynamic` falls by a factor e.
    memory
        Slip that friction remembers, "all" or "since-arrest" (see `RemembersSlip`).

    Notes
    -----
    The slip-weakening distance D_w of the source, at which 95 % of the decrease is complete, is `distance` times ln 20.
    Source: Mizoguchi, Hirose, Shimamoto & Fukuyama 2007, Geophys. Res. Lett. 34, L01308.
    """

    kind: ClassVar[str] = "exponential-slip-weakening"
    source: ClassVar[str] = "Mizoguchi, Hirose, Shimamoto & Fukuyama 2007, Geophys. Res. Lett. 34, L01308"
    counts: ClassVar[Literal["net", "path"]] = "path"
    many: ClassVar[bool] = True
    example: ClassVar[dict[str, Any]] = {"static": 0.7, "dynamic": 0.2, "distance": "0.5 m"}

    static: float = quantity("1", "friction coefficient before slip", at_least=0)
    dynamic: float = quantity("1", "friction coefficient after much slip", at_least=0)
    distance: float = quantity("m", "slip over which the excess over dynamic falls by a factor e", above=0)

    @staticmethod
    def formula(law: Any, u: Any, v: Any) -> Any:
        return law.dynamic + (law.static - law.dynamic) * exp(-u / law.distance)

    def range(self) -> tuple[float, float]:
        return np.minimum(self.static, self.dynamic), np.maximum(self.static, self.dynamic)
