"""Define the Stribeck curve that falls with a power of slip rate; a viscous term may make friction rise again."""

from dataclasses import dataclass
from typing import Any, ClassVar

from typing_extensions import override

from stickslip.foundation.conversion import Number
from stickslip.foundation.quantities import quantity
from stickslip.friction.families import Stribeck


@dataclass(frozen=True)
class PowerStribeck(Stribeck):
    """mu(v) = dynamic + (static - dynamic) / (1 + (v / rate)^exponent) + viscosity v.

    With exponent 1 and no viscosity this is the hyperbolic law, paper eq. (15), with alpha = 1 / rate.
    """

    kind = "power-stribeck"
    source = (
        "Hess & Soom 1990, J. Tribol. 112, 147 (exponent 2); Armstrong-Helouvry, Dupont & Canudas de Wit 1994, Automatica 30, 1083"
    )
    many = True
    example: ClassVar = {"static": 0.6, "dynamic": 0.4, "rate": "0.1 m/s", "exponent": 2}

    rate: Number = quantity("m/s", "slip rate v_s at which half of the decrease is complete", above=0)
    exponent: float = quantity("1", "exponent of v / rate; whole", at_least=1, whole=True, default=2.0)

    @staticmethod
    @override
    def formula(law: Any, u: Any, v: Any) -> Any:
        return law.dynamic + (law.static - law.dynamic) / (1.0 + (v / law.rate) ** law.exponent) + law.viscosity * v

    @override
    def steepness(self) -> float:
        """Return k = n y^((n-1)/n) / (1 + y)^2 with y = (n-1)/(n+1) and exponent n.

        Friction falls most steeply at (v / rate)^n = y, which is at rest for n = 1, the law of paper eq. (15).
        """
        n, y = self.exponent, (self.exponent - 1.0) / (self.exponent + 1.0)
        return float(n * y ** ((n - 1.0) / n) / (1.0 + y) ** 2)
