"""Define the Stribeck curve that falls with a power of slip rate; a viscous term may make friction rise again."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from stickslip.foundation.quantities import quantity
from stickslip.friction.law import FrictionLaw


@dataclass(frozen=True)
class PowerStribeck(FrictionLaw):
    """mu(v) = dynamic + (static - dynamic) / (1 + (v / rate)^exponent) + viscosity v.

    The exponent must be whole: with any other the curve has no derivatives at v = 0, where every slip begins. With exponent 1
    and no viscosity this is the hyperbolic law, paper eq. (15), with alpha = 1 / rate.

    Parameters
    ----------
    static
        Friction coefficient at rest (no unit).
    dynamic
        Friction coefficient at high slip rate, without the viscous term (no unit).
    rate
        Slip rate v_s (m/s) at which half of the decrease from `static` to `dynamic` is complete.
    exponent
        Exponent of v / rate, a whole number.
    viscosity
        Increase of friction with slip rate (s/m).

    Notes
    -----
    Sources: Hess & Soom 1990, J. Tribol. 112, 147 (exponent 2); Armstrong-Helouvry, Dupont & Canudas de Wit 1994, Automatica 30,
    1083.
    """

    kind: ClassVar[str] = "power-stribeck"
    source: ClassVar[str] = (
        "Hess & Soom 1990, J. Tribol. 112, 147 (exponent 2); Armstrong-Helouvry, Dupont & Canudas de Wit 1994, Automatica 30, 1083"
    )
    many: ClassVar[bool] = True
    example: ClassVar[dict[str, Any]] = {"static": 0.6, "dynamic": 0.4, "rate": "0.1 m/s", "exponent": 2}

    static: float = quantity("1", "friction coefficient at rest", at_least=0)
    dynamic: float = quantity("1", "friction coefficient at high slip rate, without the viscous term", at_least=0)
    rate: float = quantity("m/s", "slip rate v_s at which half of the decrease is complete", above=0)
    exponent: float = quantity("1", "exponent of v / rate; whole", at_least=1, whole=True, default=2.0)
    viscosity: float = quantity("s/m", "increase of friction with slip rate", at_least=0, default=0.0)

    @staticmethod
    def formula(law: Any, u: Any, v: Any) -> Any:
        return law.dynamic + (law.static - law.dynamic) / (1.0 + (v / law.rate) ** law.exponent) + law.viscosity * v

    def critical_value(self, impedance: float, normal: float) -> tuple[str, float] | None:
        """Return rate_c = k S (static - dynamic) / (Z + S viscosity), with k = n y^((n-1)/n) / (1 + y)^2 and y = (n-1)/(n+1).

        n is the exponent. The problem is irregular for smaller rates. Friction falls most steeply at (v / rate)^n = y, which is
        at rest for n = 1, the law of paper eq. (15).
        """
        n, y = self.exponent, (self.exponent - 1.0) / (self.exponent + 1.0)
        fall = n * y ** ((n - 1.0) / n) / (1.0 + y) ** 2 * normal * (self.static - self.dynamic)
        return ("rate", fall / (impedance + normal * self.viscosity)) if fall > 0.0 else None

    def range(self) -> tuple[float, float]:
        high = math.inf if self.viscosity > 0.0 else np.maximum(self.static, self.dynamic)
        return np.minimum(self.static, self.dynamic), high

    @property
    def bends_one_way(self) -> bool:
        return self.exponent == 1.0
