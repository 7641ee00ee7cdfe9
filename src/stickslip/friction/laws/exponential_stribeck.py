"""Define the exponential Stribeck curve: friction falls with slip rate, and a viscous term may make it rise again."""

import math
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
from typing_extensions import override

from stickslip.foundation.quantities import quantity
from stickslip.friction.families import Stribeck
from stickslip.friction.formula.expression import exp


@dataclass(frozen=True)
class ExponentialStribeck(Stribeck):
    """mu(v) = dynamic + (static - dynamic) exp(-(v / rate)^exponent) + viscosity v."""

    kind = "exponential-stribeck"
    source = (
        "Tustin 1947, J. Inst. Electr. Eng. 94, 143 (exponent 1); Bo & Pavelescu 1982, Wear 82, 277; "
        "Armstrong-Helouvry, Dupont & Canudas de Wit 1994, Automatica 30, 1083"
    )
    many = True
    example: ClassVar = {"static": 0.6, "dynamic": 0.4, "rate": "0.1 m/s", "exponent": 1}

    exponent: float = quantity("1", "exponent of v / rate: 1 exponential, 2 Gaussian; whole", at_least=1, whole=True, default=1.0)

    @staticmethod
    @override
    def formula(law: Any, u: Any, v: Any) -> Any:
        return law.dynamic + (law.static - law.dynamic) * exp(-((v / law.rate) ** law.exponent)) + law.viscosity * v

    @override
    def steepness(self) -> float:
        """Return k = n y^((n-1)/n) exp(-y) with y = (n-1)/n and exponent n.

        Friction falls most steeply at (v / rate)^n = y, which is at rest for n = 1.
        """
        n, y = self.exponent, (self.exponent - 1.0) / self.exponent
        return float(n * y**y * math.exp(-y))

    @override
    def rate_at_slope(self, slope: Any) -> Any:
        """Return the root v (m/s) of viscosity - (static - dynamic) exp(-v / rate) / rate = slope, if the exponent is 1."""
        if self.exponent != 1.0:
            return None
        return self.rate * np.log((self.static - self.dynamic) / (self.rate * (self.viscosity - slope)))
