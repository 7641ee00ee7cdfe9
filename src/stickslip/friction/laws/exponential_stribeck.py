"""Define the exponential Stribeck curve: friction falls with slip rate, and a viscous term may make it rise again."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from stickslip.foundation.quantities import quantity
from stickslip.friction.formula.expression import exp
from stickslip.friction.law import FrictionLaw


@dataclass(frozen=True)
class ExponentialStribeck(FrictionLaw):
    """mu(v) = dynamic + (static - dynamic) exp(-(v / rate)^exponent) + viscosity v.

    The exponent must be whole: with any other the curve has no derivatives at v = 0, where every slip begins.

    Parameters
    ----------
    static
        Friction coefficient at rest (no unit).
    dynamic
        Friction coefficient at high slip rate, without the viscous term (no unit).
    rate
        Slip rate v_s (m/s) over which friction falls.
    exponent
        Exponent of v / rate, a whole number: 1 is exponential, 2 is Gaussian.
    viscosity
        Increase of friction with slip rate (s/m).

    Notes
    -----
    Sources: Tustin 1947, J. Inst. Electr. Eng. 94, 143 (exponent 1); Bo & Pavelescu 1982, Wear 82, 277; Armstrong-Helouvry,
    Dupont & Canudas de Wit 1994, Automatica 30, 1083.
    """

    kind: ClassVar[str] = "exponential-stribeck"
    source: ClassVar[str] = (
        "Tustin 1947, J. Inst. Electr. Eng. 94, 143 (exponent 1); Bo & Pavelescu 1982, Wear 82, 277; "
        "Armstrong-Helouvry, Dupont & Canudas de Wit 1994, Automatica 30, 1083"
    )
    many: ClassVar[bool] = True
    example: ClassVar[dict[str, Any]] = {"static": 0.6, "dynamic": 0.4, "rate": "0.1 m/s", "exponent": 1}

    static: float = quantity("1", "friction coefficient at rest", at_least=0)
    dynamic: float = quantity("1", "friction coefficient at high slip rate, without the viscous term", at_least=0)
    rate: float = quantity("m/s", "slip rate v_s over which friction falls", above=0)
    exponent: float = quantity("1", "exponent of v / rate: 1 exponential, 2 Gaussian; whole", at_least=1, whole=True, default=1.0)
    viscosity: float = quantity("s/m", "increase of friction with slip rate", at_least=0, default=0.0)

    @staticmethod
    def formula(law: Any, u: Any, v: Any) -> Any:
        return law.dynamic + (law.static - law.dynamic) * exp(-((v / law.rate) ** law.exponent)) + law.viscosity * v

    def critical_value(self, impedance: float, normal: float) -> tuple[str, float] | None:
        """Return rate_c = k S (static - dynamic) / (Z + S viscosity), with k = n y^((n-1)/n) exp(-y), y = (n-1)/n and exponent n.

        The problem is irregular for smaller rates. Friction falls most steeply at (v / rate)^n = y, which is at rest for n = 1.
        """
        n, y = self.exponent, (self.exponent - 1.0) / self.exponent
        fall = n * y**y * math.exp(-y) * normal * (self.static - self.dynamic)
        return ("rate", fall / (impedance + normal * self.viscosity)) if fall > 0.0 else None

    def range(self) -> tuple[float, float]:
        high = math.inf if self.viscosity > 0.0 else np.maximum(self.static, self.dynamic)
        return np.minimum(self.static, self.dynamic), high

    def rate_at_slope(self, slope: Any) -> Any:
        """Return the root v (m/s) of viscosity - (static - dynamic) exp(-v / rate) / rate = slope, if the exponent is 1."""
        if self.exponent != 1.0:
            return None
        return self.rate * np.log((self.static - self.dynamic) / (self.rate * (self.viscosity - slope)))

    @property
    def bends_one_way(self) -> bool:
        return self.exponent == 1.0
