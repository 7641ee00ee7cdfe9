"""Define the parabolic cohesive zone: friction follows a concave parabola and is constant after that."""

from dataclasses import dataclass
from typing import Any, ClassVar

from typing_extensions import override

from stickslip.foundation.conversion import Number
from stickslip.foundation.quantities import quantity
from stickslip.friction.contract import Formula
from stickslip.friction.families import SlipWeakening, hull


@dataclass(frozen=True)
class ParabolicSlipWeakening(SlipWeakening):
    """mu = static - (static - dynamic) ((d - onset) / distance)^2 up to slip onset + distance (d1 + d2), then dynamic.

    d is the slip path. With an onset above 0 friction begins below `static` and rises to it. Beyond the onset it falls ever more
    steeply.
    """

    kind = "parabolic-slip-weakening"
    source = (
        "Bolotskaya 2023, doctoral thesis, Massachusetts Institute of Technology, parabolic cohesive zone as in its code "
        "PyLith_custom_friction, doi:10.5281/zenodo.14047393"
    )
    many = True
    example: ClassVar = {"static": 0.6, "dynamic": 0.4, "distance": "0.4 m", "onset": 0.0}

    static: float = quantity("1", "friction coefficient at the onset", at_least=0)
    dynamic: float = quantity("1", "friction coefficient after onset + distance of slip", at_least=0)
    distance: Number = quantity("m", "slip d2 over which friction falls", above=0)
    onset: Number = quantity("m", "slip d1 at which it begins to fall", at_least=0, default=0.0)

    @staticmethod
    @override
    def formula(law: Any, u: Any, v: Any) -> Any:
        return law.static - (law.static - law.dynamic) * ((u - law.onset) / law.distance) ** 2

    @property
    @override
    def pieces(self) -> tuple[Formula, ...]:
        return (self.formula, self.weakened)

    @property
    @override
    def knots(self) -> tuple[float, ...]:
        return (self.onset + self.distance,)

    @override
    def range(self) -> tuple[float, float]:
        return hull(self.static, self.dynamic, self.formula(self, 0.0, 0.0))
