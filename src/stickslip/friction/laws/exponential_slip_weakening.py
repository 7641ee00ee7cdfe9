"""Define exponential slip weakening."""

from dataclasses import dataclass
from typing import Any, ClassVar

from typing_extensions import override

from stickslip.foundation.conversion import Number
from stickslip.foundation.quantities import quantity
from stickslip.friction.families import SlipWeakening
from stickslip.friction.formula.expression import exp


@dataclass(frozen=True)
class ExponentialSlipWeakening(SlipWeakening):
    """mu(d) = dynamic + (static - dynamic) exp(-d / distance), with d the slip path.

    The slip-weakening distance D_w of the source, at which 95 % of the decrease is complete, is `distance` times ln 20.
    """

    kind = "exponential-slip-weakening"
    source = "Mizoguchi, Hirose, Shimamoto & Fukuyama 2007, Geophys. Res. Lett. 34, L01308"
    many = True
    example: ClassVar = {"static": 0.7, "dynamic": 0.2, "distance": "0.5 m"}

    distance: Number = quantity("m", "slip over which the excess over dynamic falls by a factor e", above=0)

    @staticmethod
    @override
    def formula(law: Any, u: Any, v: Any) -> Any:
        return law.dynamic + (law.static - law.dynamic) * exp(-u / law.distance)
