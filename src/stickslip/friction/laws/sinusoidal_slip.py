"""Define the sinusoidal slip law, paper eq. (14)."""

from dataclasses import dataclass
from typing import Any, ClassVar

from typing_extensions import override

from stickslip.foundation.conversion import Number
from stickslip.foundation.quantities import quantity
from stickslip.friction.families import RemembersSlip
from stickslip.friction.formula.expression import sin


@dataclass(frozen=True)
class SinusoidalSlip(RemembersSlip):
    """mu(u) = mean + amplitude sin(wavenumber u): the paper's mu0 + a sin(omega u). Counts net slip.

    The amplitude may have either sign; in magnitude it is at most `mean`.
    """

    kind = "sinusoidal-slip"
    source = "Campillo et al. 1996, eq. (14)"
    many = True
    example: ClassVar = {"mean": 1.0, "amplitude": 0.5, "wavenumber": "5 / m"}

    mean: float = quantity("1", "mean friction coefficient mu0", at_least=0)
    amplitude: float = quantity("1", "amplitude a of the oscillation")
    wavenumber: Number = quantity("1/m", "wavenumber omega of the oscillation along slip")

    @staticmethod
    @override
    def formula(law: Any, u: Any, v: Any) -> Any:
        return law.mean + law.amplitude * sin(law.wavenumber * u)

    @override
    def range(self) -> tuple[float, float]:
        return self.mean - abs(self.amplitude), self.mean + abs(self.amplitude)
