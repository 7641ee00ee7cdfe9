"""Define the hyperbolic slip-rate law, paper eq. (15)."""

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
from typing_extensions import override

from stickslip.foundation.conversion import Number
from stickslip.foundation.quantities import quantity
from stickslip.friction.families import hull
from stickslip.friction.law import FrictionLaw


@dataclass(frozen=True)
class HyperbolicRate(FrictionLaw):
    """mu(v) = dynamic + (static - dynamic) / (1 + alpha v): the paper's muD + (muS - muD) / (1 + alpha v)."""

    kind = "hyperbolic-rate"
    source = "Campillo et al. 1996, eq. (15)"
    many = True
    example: ClassVar = {"static": 0.8, "dynamic": 0.3, "alpha": "1 s/m"}

    static: float = quantity("1", "friction coefficient muS at rest", at_least=0)
    dynamic: float = quantity("1", "friction coefficient muD at high slip rate", at_least=0)
    alpha: Number = quantity("s/m", "weakening parameter alpha: inverse of the slip rate at half of the change", at_least=0)

    @staticmethod
    @override
    def formula(law: Any, u: Any, v: Any) -> Any:
        return law.dynamic + (law.static - law.dynamic) / (1.0 + law.alpha * v)

    @override
    def range(self) -> tuple[float, float]:
        return hull(self.static, self.dynamic)

    @override
    def critical_value(self, impedance: float, normal: float) -> tuple[str, float] | None:
        """Return alpha_c = Z / (S (muS - muD)), paper section 3; None unless muS > muD."""
        fall = normal * (self.static - self.dynamic)
        return ("alpha", impedance / fall) if fall > 0.0 else None

    @override
    def rate_at_slope(self, slope: Any) -> Any:
        """Return the root v (m/s) of -(muS - muD) alpha / (1 + alpha v)^2 = slope."""
        return (np.sqrt((self.dynamic - self.static) * self.alpha / slope) - 1.0) / self.alpha

    @property
    @override
    def bends_one_way(self) -> bool:
        return True
