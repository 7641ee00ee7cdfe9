"""Define friction that grows with slip rate."""

import math
from dataclasses import dataclass
from typing import Any, ClassVar

from typing_extensions import override

from stickslip.foundation.conversion import Number
from stickslip.foundation.quantities import quantity
from stickslip.friction.formula.expression import log
from stickslip.friction.law import FrictionLaw


@dataclass(frozen=True)
class VelocityStrengthening(FrictionLaw):
    """mu(v) = static + a ln(1 + v / rate) + viscosity v: logarithmic, linear or both. Every load has exactly one slip rate."""

    kind = "velocity-strengthening"
    source = "Marone, Scholz & Bilham 1991, J. Geophys. Res. 96, 8441 (logarithm, here with 1 + v / rate for v / rate)"
    example: ClassVar = {"static": 0.6, "a": 0.01, "rate": "1e-6 m/s"}

    static: float = quantity("1", "friction coefficient at rest", at_least=0)
    a: float = quantity("1", "increase of friction per factor e of slip rate beyond `rate`", at_least=0, default=0.0)
    rate: Number = quantity("m/s", "slip rate at which the logarithm sets in", above=0, default=1e-6)
    viscosity: Number = quantity("s/m", "increase of friction with slip rate", at_least=0, default=0.0)

    @staticmethod
    @override
    def formula(law: Any, u: Any, v: Any) -> Any:
        return law.static + law.a * log(1.0 + v / law.rate) + law.viscosity * v

    @override
    def range(self) -> tuple[float, float]:
        return self.static, math.inf if self.a > 0.0 or self.viscosity > 0.0 else self.static
