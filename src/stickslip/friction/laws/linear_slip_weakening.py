"""Define linear slip weakening."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar, Literal

import numpy as np

from stickslip.foundation.quantities import quantity
from stickslip.friction.memory import RemembersSlip


@dataclass(frozen=True)
class LinearSlipWeakening(RemembersSlip):
    """mu falls linearly from static to dynamic over a slip `distance`, and is constant after that.
    The slip is the slip path, the accumulated length of slip in both directions.

    Parameters
    ----------
    static
        Friction coefficient before slip (no unit).
    dynamic
        Friction coefficient after `distance` of slip (no unit).
    distance
        Slip (m) over which friction falls, often called Dc.
    memory
        Slip that friction remembers, "all" or "since-arrest" (see `RemembersSlip`).

    Notes
    -----
    Sources: Ida 1972, J. Geophys. Res. 77, 3796; Andrews 1976, J. Geophys. Res. 81, 5679.
    """

    kind: ClassVar[str] = "linear-slip-weakening"
    source: ClassVar[str] = "Ida 1972, J. Geophys. Res. 77, 3796; Andrews 1976, J. Geophys. Res. 81, 5679"
    counts: ClassVar[Literal["net", "path"]] = "path"
    many: ClassVar[bool] = True
    example: ClassVar[dict[str, Any]] = {"static": 0.677, "dynamic": 0.525, "distance": "0.4 m"}

    static: float = quantity("1", "friction coefficient before slip", at_least=0)
    dynamic: float = quantity("1", "friction coefficient after `distance` of slip", at_least=0)
    distance: float = quantity("m", "slip over which friction falls (often Dc)", above=0)

    @staticmethod
    def formula(law: Any, u: Any, v: Any) -> Any:
        return law.static - (law.static - law.dynamic) / law.distance * u

    @staticmethod
    def weakened(law: Any, u: Any, v: Any) -> Any:
        """Return mu at slips beyond `distance`."""
        return law.dynamic + 0.0 * u

    @property
    def pieces(self) -> tuple[Any, ...]:
        return (self.formula, self.weakened)

    @property
    def knots(self) -> tuple[float, ...]:
        return (self.distance,)

    def range(self) -> tuple[float, float]:
        return np.minimum(self.static, self.dynamic), np.maximum(self.static, self.dynamic)
