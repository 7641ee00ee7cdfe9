"""Define the sinusoidal slip law, paper eq. (14)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

from stickslip.foundation.quantities import quantity
from stickslip.friction.formula.expression import sin
from stickslip.friction.memory import RemembersSlip


@dataclass(frozen=True)
class SinusoidalSlip(RemembersSlip):
    """mu(u) = mean + amplitude sin(wavenumber u): the paper's mu0 + a sin(omega u). Counts net slip.

    Parameters
    ----------
    mean
        Mean friction coefficient mu0 (no unit).
    amplitude
        Amplitude a of the oscillation (no unit), of either sign, in magnitude at most `mean`.
    wavenumber
        Wavenumber omega of the oscillation along slip (1/m).
    memory
        Slip that friction remembers, "all" or "since-arrest" (see `RemembersSlip`).

    Notes
    -----
    Source: Campillo et al. 1996, eq. (14).
    """

    kind: ClassVar[str] = "sinusoidal-slip"
    source: ClassVar[str] = "Campillo et al. 1996, eq. (14)"
    many: ClassVar[bool] = True
    example: ClassVar[dict[str, Any]] = {"mean": 1.0, "amplitude": 0.5, "wavenumber": "5 / m"}

    mean: float = quantity("1", "mean friction coefficient mu0", at_least=0)
    amplitude: float = quantity("1", "amplitude a of the oscillation")
    wavenumber: float = quantity("1/m", "wavenumber omega of the oscillation along slip")

    @staticmethod
    def formula(law: Any, u: Any, v: Any) -> Any:
        return law.mean + law.amplitude * sin(law.wavenumber * u)

    def range(self) -> tuple[float, float]:
        return self.mean - abs(self.amplitude), self.mean + abs(self.amplitude)
