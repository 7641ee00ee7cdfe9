"""Define linear slip weakening."""

from dataclasses import dataclass
from typing import Any, ClassVar

from typing_extensions import override

from stickslip.foundation.quantities import quantity
from stickslip.friction.contract import Formula
from stickslip.friction.families import SlipWeakening


@dataclass(frozen=True)
class LinearSlipWeakening(SlipWeakening):
    """mu falls linearly from static to dynamic over a slip path `distance`, and is constant after that."""

    kind = "linear-slip-weakening"
    source = "Ida 1972, J. Geophys. Res. 77, 3796; Andrews 1976, J. Geophys. Res. 81, 5679"
    many = True
    example: ClassVar = {"static": 0.677, "dynamic": 0.525, "distance": "0.4 m"}

    dynamic: float = quantity("1", "friction coefficient after `distance` of slip", at_least=0)

    @staticmethod
    @override
    def formula(law: Any, u: Any, v: Any) -> Any:
        return law.static - (law.static - law.dynamic) / law.distance * u

    @property
    @override
    def pieces(self) -> tuple[Formula, ...]:
        return (self.formula, self.weakened)

    @property
    @override
    def knots(self) -> tuple[float, ...]:
        return (self.distance,)  # type: ignore[return-value] # mypy reads an inherited field of a frozen class as it is given
