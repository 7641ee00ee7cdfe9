"""Define rate-and-state friction with two states, which renew themselves over a short and over a long slip."""

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray
from typing_extensions import override

from stickslip.foundation.conversion import Number
from stickslip.foundation.quantities import Choice, declare, quantity
from stickslip.friction.contract import Formula, StateVariable
from stickslip.friction.formula.functions import arcsinh, exp, log
from stickslip.friction.laws.rate_and_state import SLOWEST, DirectEffect


@dataclass(frozen=True)
class TwoStateRateAndState(DirectEffect):
    """mu(v, theta_1, theta_2) = a arcsinh(v / (2 rate) exp((reference + b w_1 + second_b w_2) / a)), w_i = ln(rate theta_i / L_i).

    L_1 is `distance` and L_2 is `second_distance`. With y = v theta_i / L_i, d theta_i/dt is 1 - y for the ageing law and -y ln y
    for the slip law. After a step of the slip rate friction settles over both distances, as in many experiments, which also find a
    negative `second_b`. The contact never sticks.

    The formulas use the states w_i; users give and see theta_i (s).
    """

    kind = "two-state-rate-and-state"
    effects = ("b", "second_b")
    source = (
        "Ruina 1983, J. Geophys. Res. 88, 10359 (two states); Gu, Rice, Ruina & Tse 1984, J. Mech. Phys. Solids 32, 167; "
        "Rice & Ben-Zion 1996, Proc. Natl. Acad. Sci. 93, 3811 (arcsinh)"
    )
    state = (
        StateVariable("theta_1", "s", "state theta_1 (distance / v in steady sliding)", scale=1.0),
        StateVariable("theta_2", "s", "state theta_2 (second_distance / v in steady sliding)", scale=1.0),
    )
    start: ClassVar = {"coefficient": 0.65, "state": "1 year", "second_state": "1 year"}
    example: ClassVar = {
        **{"reference": 0.6, "a": 0.01, "b": 0.01, "distance": "1 mm"},
        **{"second_b": 0.006, "second_distance": "2 cm", "rate": "1e-6 m/s"},
    }

    b: float = quantity("1", "decrease of friction as the first state falls by a factor e", at_least=0)
    distance: Number = quantity("m", "slip over which the first state renews itself (L_1)", above=0)
    second_b: float = quantity("1", "decrease of friction as the second state falls by a factor e; may be negative")
    second_distance: Number = quantity("m", "slip over which the second state renews itself (L_2)", above=0)
    rate: Number = quantity("m/s", "reference slip rate", above=0, default=1e-6)
    evolution: str = declare(Choice("how the states change", ("ageing", "slip")), "ageing")

    @property
    @override
    def pieces(self) -> tuple[Formula, ...]:
        return (_friction,)

    @property
    @override
    def state_rate(self) -> tuple[Formula, ...]:
        return _EVOLUTIONS[self.evolution]

    @override
    def inner_state(self, value: NDArray[np.float64]) -> NDArray[np.float64]:
        return np.log(value / self._renewal(np.ndim(value)))

    @override
    def outer_state(self, w: NDArray[np.float64]) -> NDArray[np.float64]:
        return np.asarray(np.exp(w) * self._renewal(np.ndim(w)))

    def _renewal(self, axes: int) -> NDArray[np.float64]:
        """Return the times L_i / rate (s) as an array of so many axes, the first of which counts the states."""
        return np.reshape([self.distance / self.rate, self.second_distance / self.rate], (2,) + (1,) * (axes - 1))

    @override
    def steady_state(self, v: ArrayLike) -> NDArray[np.float64]:
        """Return the states theta_1 and theta_2 (s) of steady sliding at slip rates v > 0 (m/s): distance / v for each."""
        rate = np.asarray(v, float)
        return np.array([self.distance / rate, self.second_distance / rate])

    def steady_coefficient(self, v: ArrayLike) -> NDArray[np.float64]:
        """Return the friction coefficient (no unit) of steady sliding at slip rates v > 0 (m/s).

        It is reference + (a - b - second_b) ln(v / rate), except for the regularisation at small slip rates.
        """
        rate = np.asarray(v, float)
        return self.coefficient(0.0, rate, self.inner_state(self.steady_state(rate)))


def _friction(law: Any, u: Any, v: Any, w: Any, w2: Any) -> Any:
    return law.a * arcsinh(v / (2.0 * law.rate) * exp((law.reference + law.b * w + law.second_b * w2) / law.a))


def _ageing(law: Any, u: Any, v: Any, w: Any, w2: Any) -> Any:
    return (law.rate * exp(-w) - v) / law.distance


def _second_ageing(law: Any, u: Any, v: Any, w: Any, w2: Any) -> Any:
    return (law.rate * exp(-w2) - v) / law.second_distance


def _slip(law: Any, u: Any, v: Any, w: Any, w2: Any) -> Any:
    return -(v / law.distance) * (w + _logarithm(law, v))


def _second_slip(law: Any, u: Any, v: Any, w: Any, w2: Any) -> Any:
    return -(v / law.second_distance) * (w2 + _logarithm(law, v))


def _logarithm(law: Any, v: Any) -> Any:
    """Return ln(v / rate), finite at rest."""
    y = v / law.rate
    return 0.5 * log(y * y + SLOWEST)


_EVOLUTIONS: dict[str, tuple[Formula, ...]] = {"ageing": (_ageing, _second_ageing), "slip": (_slip, _second_slip)}
