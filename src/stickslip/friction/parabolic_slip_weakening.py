"""Parabolic slip weakening."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar, Literal

from stickslip.friction.contract import Formula, FrictionLaw
from stickslip.quantities import quantity


@dataclass(frozen=True)
class ParabolicSlipWeakening(FrictionLaw):
    """mu = static up to slip `onset` (d1), then static - (static - dynamic) ((d - onset) / distance)^2, then dynamic.

    d is the path walked, in both directions; friction has fallen to dynamic at d = onset + distance (d1 + d2). It falls ever
    faster until there: the parabola stands on its head.
    """

    kind: ClassVar[str] = "parabolic-slip-weakening"
    source: ClassVar[str] = (
        "Bolotskaya, Hager & Ampuero, Effects of failure parameterization on pre- and co-seismic earthquake rupture "
        "(parabolic cohesive zone)"
    )
    counts: ClassVar[Literal["net", "path"]] = "path"
    example: ClassVar[dict[str, Any]] = {"static": 0.6, "dynamic": 0.4, "distance": "0.4 m", "onset": 0.0}

    static: float = quantity("1", "friction coefficient before slip", at_least=0)
    dynamic: float = quantity("1", "friction coefficient after onset + distance of slip", at_least=0)
    distance: float = quantity("m", "slip d2 over which friction changes", above=0)
    onset: float = quantity("m", "slip d1 at which it begins to change", at_least=0, default=0.0)

    @staticmethod
    def formula(law: Any, u: Any, v: Any) -> Any:
        return law.static - (law.static - law.dynamic) * ((u - law.onset) / law.distance) ** 2

    @staticmethod
    def before(law: Any, u: Any, v: Any) -> Any:
        """mu before the onset."""
        return law.static + 0.0 * u

    @staticmethod
    def after(law: Any, u: Any, v: Any) -> Any:
        """mu once onset + distance are walked."""
        return law.dynamic + 0.0 * u

    @property
    def pieces(self) -> tuple[Formula, ...]:
        falling: tuple[Formula, ...] = (self.formula, self.after)
        return (self.before, *falling) if self.onset > 0.0 else falling

    @property
    def knots(self) -> tuple[float, ...]:
        end = self.onset + self.distance
        return (self.onset, end) if self.onset > 0.0 else (end,)

    def range(self) -> tuple[float, float]:
        return min(self.static, self.dynamic), max(self.static, self.dynamic)
