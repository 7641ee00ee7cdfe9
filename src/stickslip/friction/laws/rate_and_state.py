"""Define rate-and-state friction, regularised at small slip rates."""

import math
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray
from typing_extensions import override

from stickslip.foundation.conversion import Number
from stickslip.foundation.errors import InputError
from stickslip.foundation.quantities import Choice, declare, quantity
from stickslip.friction.contract import Formula, StateVariable
from stickslip.friction.formula.functions import arcsinh, exp, log
from stickslip.friction.law import FrictionLaw

LARGEST_EXPONENT = 600.0
"""Largest exponent (reference + b w) / a: the exponential, which overflows at 709, must be finite for every state w in reach."""
FARTHEST_STATE = 60.0
"""Largest w = ln(rate theta / distance) allowed for: that of a contact that has healed for longer than the age of the Earth."""
SLOWEST = 1e-24
"""Number added to (v / rate)^2 in the logarithm of the slip law, which would otherwise be infinite at rest."""


@dataclass(frozen=True)
class DirectEffect(FrictionLaw):
    """A law whose friction grows at once by `a` if the slip rate grows by a factor e; the contact never sticks."""

    sticks = False
    effects: ClassVar[tuple[str, ...]] = ("b",)
    """Fields with the changes of friction by the states, which must not make an exponential overflow."""

    reference: float = quantity("1", "friction coefficient of steady sliding at `rate`", above=0)
    a: float = quantity("1", "direct effect a: immediate increase of friction per factor e of slip rate", above=0)

    @override
    def check(self) -> None:
        largest = self.reference + FARTHEST_STATE * sum(abs(getattr(self, name)) for name in self.effects)
        if largest / self.a > LARGEST_EXPONENT:
            known = " and ".join(", ".join(("reference", *self.effects)).rsplit(", ", 1))
            least = largest / LARGEST_EXPONENT
            raise InputError(f"{type(self).__name__}: a must be at least {least:.3g} with this {known}, got {self.a:g}")

    @override
    def range(self) -> tuple[float, float]:
        return 0.0, math.inf

    @property
    def variation(self) -> float:
        """The direct effect a: the change of friction at once when the slip rate changes by a factor e (no unit)."""
        return self.a


@dataclass(frozen=True)
class RateAndState(DirectEffect):
    """mu(v, theta) = a arcsinh(v / (2 rate) exp((reference + b ln(rate theta / distance)) / a)), theta by `evolution`.

    With y = v theta / distance, d theta/dt is 1 - y for the ageing law, -y ln y for the slip law and 1 - (y/2)^2 for the PRZ law.
    The contact never sticks: friction passes smoothly through v = 0. `a` must not be so small that the exponential could overflow.

    The formulas use the state w = ln(rate theta / distance); users give and see theta (s).
    """

    kind = "rate-and-state"
    source = (
        "Dieterich 1979, J. Geophys. Res. 84, 2161 (ageing); Ruina 1983, J. Geophys. Res. 88, 10359 (slip); Perrin, Rice & Zheng "
        "1995, J. Mech. Phys. Solids 43, 1461 (PRZ); Rice & Ben-Zion 1996, Proc. Natl. Acad. Sci. 93, 3811 (arcsinh)"
    )
    state = StateVariable("theta", "s", "state theta (distance / v in steady sliding)", scale=1.0)
    start: ClassVar = {"coefficient": 0.65, "state": "1 year"}
    example: ClassVar = {"reference": 0.6, "a": 0.01, "b": 0.015, "distance": "1 mm", "rate": "1e-6 m/s"}

    b: float = quantity("1", "evolution effect b: decrease of friction as the state falls by a factor e", at_least=0)
    distance: Number = quantity("m", "slip over which the state renews itself (Dc)", above=0)
    rate: Number = quantity("m/s", "reference slip rate", above=0, default=1e-6)
    evolution: str = declare(Choice("how the state changes", ("ageing", "slip", "prz")), "ageing")

    @property
    @override
    def pieces(self) -> tuple[Formula, ...]:
        return (_friction,)

    @property
    @override
    def state_rate(self) -> Formula:
        return _EVOLUTIONS[self.evolution]

    @override
    def inner_state(self, value: float) -> float:
        return math.log(self.rate * value / self.distance)

    @override
    def outer_state(self, w: NDArray[np.float64]) -> NDArray[np.float64]:
        return self.distance / self.rate * np.exp(w)

    @override
    def steady_state(self, v: ArrayLike) -> NDArray[np.float64]:
        """Return the state theta (s) of steady sliding at slip rates v > 0 (m/s): distance / v, or twice that for the PRZ law."""
        return (2.0 if self.evolution == "prz" else 1.0) * self.distance / np.asarray(v, float)

    def steady_coefficient(self, v: ArrayLike) -> NDArray[np.float64]:
        """Return the friction coefficient (no unit) of steady sliding at slip rates v > 0 (m/s).

        It is reference + (a - b) ln(v / rate), and b ln 2 more for the PRZ law, except for the regularisation at small slip rates.
        """
        rate = np.asarray(v, float)
        return self.coefficient(0.0, rate, np.log(self.rate * self.steady_state(rate) / self.distance))


def _friction(law: Any, u: Any, v: Any, w: Any) -> Any:
    """Return mu at slip rate v (m/s) and state w = ln(rate theta / distance)."""
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
