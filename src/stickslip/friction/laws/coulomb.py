"""Define Coulomb friction with a static and a dynamic coefficient."""

from dataclasses import dataclass
from typing import Any, ClassVar

from typing_extensions import override

from stickslip.foundation.errors import InputError
from stickslip.foundation.quantities import quantity
from stickslip.friction.law import FrictionLaw


@dataclass(frozen=True)
class Coulomb(FrictionLaw):
    """|tau| <= static S at rest, |tau| = dynamic S in slip: the limit alpha -> infinity of the hyperbolic rate law."""

    kind = "coulomb"
    source = "Campillo et al. 1996, section 4 (limit of eq. 15)"
    many = True
    example: ClassVar = {"static": 0.6, "dynamic": 0.5}

    static: float = quantity("1", "friction coefficient at rest", at_least=0)
    dynamic: float = quantity("1", "friction coefficient in slip", at_least=0)

    @override
    def check(self) -> None:
        if self.static < self.dynamic:
            raise InputError(f"Coulomb: static must be at least dynamic, got static {self.static:g} < dynamic {self.dynamic:g}")

    @staticmethod
    @override
    def formula(law: Any, u: Any, v: Any) -> Any:
        return law.dynamic + 0.0 * v

    @property
    @override
    def static_excess(self) -> float:
        return self.static - self.dynamic

    @override
    def range(self) -> tuple[float, float]:
        return self.dynamic, self.static

    @override
    def critical_value(self, impedance: float, normal: float) -> tuple[str, float] | None:
        """Return static_c = dynamic: any step down in friction gives several solutions, under every normal stress."""
        return "static", self.dynamic

    @property
    @override
    def bends_one_way(self) -> bool:
        return True
