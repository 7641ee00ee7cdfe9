"""Rate-and-state friction, regularised at small slip rates."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stickslip.foundation.errors import InputError
from stickslip.foundation.quantities import quantity
from stickslip.friction.formula.expression import arcsinh, exp, log
from stickslip.friction.law import Formula, FrictionLaw, StateVariable
from stickslip.friction.parameters import Choice, declare

LARGEST_EXPONENT = 600.0
"""Of e^((reference + b w) / a), which must stay a number for every w that a contact can reach."""
FARTHEST_STATE = 60.0
"""ln(rate theta / distance) of a contact healed for longer than the Earth is old."""
SLOWEST = 1e-24
"""Square of the slip rate, in units of `rate`, below which the slip law's logarithm no longer falls: it has no value at rest."""


@dataclass(frozen=True)
class RateAndState(FrictionLaw):
    """mu(v, theta) = a arcsinh(v / (2 rate) exp((reference + b ln(rate theta / distance)) / a)), theta by `evolution`.

    Ageing: d theta/dt = 1 - y; slip: -y ln y; PRZ: 1 - (y/2)^2, with y = v theta / distance. It never sticks.
    """

    kind: ClassVar[str] = "rate-and-state"
    source: ClassVar[str] = (
        "Dieterich 1979, J. Geophys. Res. 84, 2161 (ageing); Ruina 1983, J. Geophys. Res. 88, 10359 (slip); Perrin, Rice & Zheng "
        "1995, J. Mech. Phys. Solids 43, 1461 (PRZ); Rice & Ben-Zion 1996, Proc. Natl. Acad. Sci. 93, 3811 (arcsinh)"
    )
    state: ClassVar[StateVariable | None] = StateVariable("theta", "s", "state theta (distance / v in steady sliding)", scale=1.0)
    sticks: ClassVar[bool] = False
    start: ClassVar[dict[str, Any]] = {"coefficient": 0.65, "state": "1 year"}
    example: ClassVar[dict[str, Any]] = {"reference": 0.6, "a": 0.01, "b": 0.015, "distance": "1 mm", "rate": "1e-6 m/s"}

    reference: float = quantity("1", "friction coefficient of steady sliding at `rate`", above=0)
    a: float = quantity("1", "direct effect: friction gained at once per factor e of slip rate", above=0)
    b: float = quantity("1", "evolution effect: friction lost with the state per factor e", at_least=0)
    distance: float = quantity("m", "slip over which the state renews itself (Dc)", above=0)
    rate: float = quantity("m/s", "reference slip rate", above=0, default=1e-6)
    evolution: str = declare(Choice("how the state changes", ("ageing", "slip", "prz")), "ageing")

    def check(self) -> None:
        largest = (self.reference + FARTHEST_STATE * self.b) / self.a
        if largest > LARGEST_EXPONENT:
            least = (self.reference + FARTHEST_STATE * self.b) / LARGEST_EXPONENT
            raise InputError(f"RateAndState: a must be at least {least:.3g} with this reference and b, got {self.a:g}")

    @property
    def pieces(self) -> tuple[Formula, ...]:
        return (_friction,)

    @property
    def state_rate(self) -> Formula:
        return _EVOLUTIONS[self.evolution]

    def inner_state(self, value: float) -> float:
        return math.log(self.rate * value / self.distance)

    def outer_state(self, w: NDArray[np.float64]) -> NDArray[np.float64]:
        return self.distance / self.rate * np.exp(w)

    def range(self) -> tuple[float, float]:
        return 0.0, math.inf

    @property
    def variation(self) -> float:
        """The direct effect: what friction changes at once when the slip rate changes by a factor e."""
        return self.a

    def steady_state(self, v: ArrayLike) -> NDArray[np.float64]:
        """State theta (s) of steady sliding at slip rates v > 0 (m/s)."""
        return (2.0 if self.evolution == "prz" else 1.0) * self.distance / np.asarray(v, float)

    def steady_coefficient(self, v: ArrayLike) -> NDArray[np.float64]:
        """mu of steady sliding at slip rates v > 0 (m/s): reference + (a - b) ln(v / rate), and b ln 2 more for PRZ."""
        rate = np.asarray(v, float)
        return self.coefficient(0.0, rate, np.log(self.rate * self.steady_state(rate) / self.distance))


def _friction(law: Any, u: Any, v: Any, w: Any) -> Any:
    """mu with w = ln(rate theta / distance)."""
    return law.a * arcsinh(v / (2.0 * law.rate) * exp((law.reference + law.b * w) / law.a))


def _ageing(law: Any, u: Any, v: Any, w: Any) -> Any:
    return (law.rate * exp(-w) - v) / law.distance


def _slip(law: Any, u: Any, v: Any, w: Any) -> Any:
    y = v / law.rate
    return -(v / law.distance) * (w + 0.5 * log(y * y + SLOWEST))


def _prz(law: Any, u: Any, v: Any, w: Any) -> Any:
    y = v / law.rate
    return law.rate / law.distance * (exp(-w) - 0.25 * y * y * exp(w))


_EVOLUTIONS: dict[str, Formula] = {"ageing": _ageing, "slip": _slip, "prz": _prz}
