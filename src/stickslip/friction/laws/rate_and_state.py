"""Define rate-and-state friction, regularised at small slip rates: with one state, with two, and with flash heating."""

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
from stickslip.friction.formula.functions import arcsinh, exp, expm1, log, sqrt, tanh
from stickslip.friction.law import FrictionLaw

LARGEST_EXPONENT = 600.0
"""Largest exponent (reference + b w) / a in an exponential, which overflows at 709; a law that may reach more has another form."""
QUARTER = math.exp(-50.0)
"""Fourth root (1) of the smallest v / (2 rate) that this other form resolves: 1e-93 m/s for a `rate` of 1e-6 m/s, which is rest."""
LOWEST = 2800.0
"""That other form holds for exponents above minus this (1)."""
FASTEST_CONTACT = 1e3
"""A slip rate (m/s) that no contact exceeds."""
FARTHEST_STATE = 60.0
"""Largest w = ln(rate theta / distance) allowed for: that of a contact that has healed for longer than the age of the Earth."""
SQUARE_AT_REST = 1e-24
"""Number added to (v / rate)^2 in the logarithm of the slip law, which would otherwise be infinite at rest."""


@dataclass(frozen=True)
class DirectEffect(FrictionLaw):
    """A law whose friction grows at once by `a` if the slip rate grows by a factor e; the contact never sticks."""

    sticks = False
    effects: ClassVar[tuple[str, ...]] = ("b",)
    """Fields with the changes of friction by the states."""

    reference: float = quantity("1", "friction coefficient of steady sliding at `rate`", above=0)
    a: float = quantity("1", "direct effect a: immediate increase of friction per factor e of slip rate", above=0)

    @property
    def overflows(self) -> bool:
        """True if a is so small that an exponential could overflow in a state within reach."""
        largest: float = self.reference + FARTHEST_STATE * sum(abs(getattr(self, name)) for name in self.effects)
        return largest / self.a > LARGEST_EXPONENT

    @override
    def range(self) -> tuple[float, float]:
        return 0.0, math.inf

    @property
    def variation(self) -> float:
        """The direct effect a: the change of friction at once when the slip rate changes by a factor e (no unit)."""
        return self.a


def _direct(law: Any, v: Any, x: Any) -> Any:
    """Return a arcsinh(v / (2 rate) exp(x))."""
    return law.a * arcsinh(v / (2.0 * law.rate) * exp(x))


def _direct_of_small_a(law: Any, v: Any, x: Any) -> Any:
    """Return a arcsinh(v / (2 rate) exp(x)), where exp(x) may overflow."""
    return law.a * _arcsinh(v / (2.0 * law.rate), x)


def _arcsinh(y: Any, x: Any) -> Any:
    """Return arcsinh(y exp(x)) for x > -2800, in two terms without overflow.

    With l = (exp(-x/4) + QUARTER)^4 it is arcsinh(y / l) + (x + ln l) tanh(y / QUARTER^4). Where exp(x) is not large, l is exp(-x),
    and the second term is rounding. Where y exp(x) is large, the sum is x + ln(2 y). It differs from the function for y of about
    QUARTER^4 and below, through which it passes smoothly to zero, and where y is below 1e-22 although its value is about 1.
    """
    root = exp(-0.25 * x) + QUARTER
    return arcsinh(y / root**4) + (x + 4.0 * log(root)) * tanh(y / QUARTER**4)


@dataclass(frozen=True)
class RateAndState(DirectEffect):
    """mu(v, theta) = a arcsinh(v / (2 rate) exp((reference + b ln(rate theta / distance)) / a)), theta by `evolution`.

    With y = v theta / distance, d theta/dt is 1 - y for the ageing law, -y ln y for the slip law and 1 - (y/2)^2 for the PRZ law.
    The contact never sticks: friction passes smoothly through v = 0. For an `a` so small that the exponential could overflow,
    friction is computed from ln v, and slip rates below e^-200 times `rate` are not resolved.

    Under a normal load S(t) that varies, d theta/dt gains -alpha theta S'/(b S), with alpha = `normal_stress_coupling`. A jump from
    S- to S+ multiplies theta by (S-/S+)^(alpha/b).

    The formulas use the state w = ln(rate theta / distance); users give and see theta (s).
    """

    kind = "rate-and-state"
    source = (
        "Dieterich 1979, J. Geophys. Res. 84, 2161 (ageing); Ruina 1983, J. Geophys. Res. 88, 10359 (slip); Perrin, Rice & Zheng "
        "1995, J. Mech. Phys. Solids 43, 1461 (PRZ); Rice & Ben-Zion 1996, Proc. Natl. Acad. Sci. 93, 3811 (arcsinh); "
        "Linker & Dieterich 1992, J. Geophys. Res. 97, 4923 (normal_stress_coupling)"
    )
    state = StateVariable("theta", "s", "state theta (distance / v in steady sliding)", scale=1.0)
    start: ClassVar = {"coefficient": 0.65, "state": "1 year"}
    example: ClassVar = {"reference": 0.6, "a": 0.01, "b": 0.015, "distance": "1 mm", "rate": "1e-6 m/s"}

    b: float = quantity("1", "evolution effect b: decrease of friction as the state falls by a factor e", at_least=0)
    distance: Number = quantity("m", "slip over which the state renews itself (Dc)", above=0)
    rate: Number = quantity("m/s", "reference slip rate", above=0, default=1e-6)
    evolution: str = declare(Choice("how the state changes", ("ageing", "slip", "prz")), "ageing")
    normal_stress_coupling: float = quantity(
        "1",
        "coupling alpha to the normal load: friction falls by alpha as that grows by a factor e at once, and recovers with slip",
        at_least=0,
        default=0.0,
    )

    @override
    def check(self) -> None:
        if self.normal_stress_coupling > 0.0 and self.b == 0.0:
            raise InputError("RateAndState: normal_stress_coupling needs b > 0: it acts through the state")

    @property
    @override
    def normal_coupling(self) -> float:
        return self.normal_stress_coupling / self.b if self.b else 0.0

    @property
    @override
    def pieces(self) -> tuple[Formula, ...]:
        return (_friction_of_small_a if self.overflows else _friction,)

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
    return _direct(law, v, (law.reference + law.b * w) / law.a)


def _friction_of_small_a(law: Any, u: Any, v: Any, w: Any) -> Any:
    return _direct_of_small_a(law, v, (law.reference + law.b * w) / law.a)


def _ageing(law: Any, u: Any, v: Any, w: Any, *_: Any) -> Any:
    return (law.rate * exp(-w) - v) / law.distance


def _slip(law: Any, u: Any, v: Any, w: Any, *_: Any) -> Any:
    return -(v / law.distance) * (w + _logarithm(law, v))


def _prz(law: Any, u: Any, v: Any, w: Any) -> Any:
    y = v / law.rate
    return law.rate / law.distance * (exp(-w) - 0.25 * y * y * exp(w))


def _logarithm(law: Any, v: Any) -> Any:
    """Return ln(v / rate), finite at rest."""
    y = v / law.rate
    return 0.5 * log(y * y + SQUARE_AT_REST)


_EVOLUTIONS: dict[str, Formula] = {"ageing": _ageing, "slip": _slip, "prz": _prz}


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
        return (_two_state_friction_of_small_a if self.overflows else _two_state_friction,)

    @property
    @override
    def state_rate(self) -> tuple[Formula, ...]:
        return _TWO_EVOLUTIONS[self.evolution]

    @override
    def inner_state(self, value: NDArray[np.float64]) -> NDArray[np.float64]:
        return np.log(value / self._renewal(np.ndim(value)))

    @override
    def outer_state(self, w: NDArray[np.float64]) -> NDArray[np.float64]:
        return np.asarray(np.exp(w) * self._renewal(np.ndim(w)))

    def _renewal(self, axes: int) -> NDArray[np.float64]:
        """Return the times L_i / rate (s) as an array with `axes` axes; the first counts the states."""
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


def _two_state_friction(law: Any, u: Any, v: Any, w: Any, w2: Any) -> Any:
    return _direct(law, v, (law.reference + law.b * w + law.second_b * w2) / law.a)


def _two_state_friction_of_small_a(law: Any, u: Any, v: Any, w: Any, w2: Any) -> Any:
    return _direct_of_small_a(law, v, (law.reference + law.b * w + law.second_b * w2) / law.a)


def _second_ageing(law: Any, u: Any, v: Any, w: Any, w2: Any) -> Any:
    return (law.rate * exp(-w2) - v) / law.second_distance


def _second_slip(law: Any, u: Any, v: Any, w: Any, w2: Any) -> Any:
    return -(v / law.second_distance) * (w2 + _logarithm(law, v))


_TWO_EVOLUTIONS: dict[str, tuple[Formula, ...]] = {"ageing": (_ageing, _second_ageing), "slip": (_slip, _second_slip)}


@dataclass(frozen=True)
class FlashHeating(DirectEffect):
    """mu(v, psi) = a arcsinh(v / (2 rate) exp(psi / a)), with dpsi/dt = -(v / distance) (psi - psi_ss(v)).

    psi_ss = a ln(2 rate / v sinh(mu_ss / a)) is the state of steady sliding, whose friction is
    mu_ss = weakened + (mu_low - weakened) / (1 + (v / weakening_rate)^8)^(1/8), with mu_low = reference - (b - a) ln(v / rate).
    Where a > b this mu_low is negative at the slowest slip rates; a arcsinh(exp(mu_low / a) / 2), which differs from it by less
    than rounding where mu_low > 19 a, goes to zero there, as the friction of rate-and-state laws does.

    Below `weakening_rate` this is rate-and-state friction with the slip law; far above it friction falls to `weakened`. The contact
    never sticks.
    """

    kind = "flash-heating"
    source = (
        "Rice 2006, J. Geophys. Res. 111, B05311 (flash heating); Dunham, Belanger, Cong & Kozdon 2011, Bull. Seismol. Soc. Am. "
        "101, 2296; SCEC/USGS rupture code verification, TPV103 and TPV104 (this form)"
    )
    state = StateVariable("psi", "1", "state psi, a friction coefficient")
    start: ClassVar = {"coefficient": 0.6, "state": 0.6}
    example: ClassVar = {
        **{"reference": 0.6, "a": 0.01, "b": 0.014, "distance": "0.4 m", "rate": "1e-6 m/s"},
        **{"weakened": 0.2, "weakening_rate": "0.1 m/s"},
    }

    reference: float = quantity("1", "friction coefficient of steady sliding at `rate`, far below the weakening rate", above=0)
    b: float = quantity("1", "evolution effect b: decrease of friction as slip renews the contact, per factor e", at_least=0)
    distance: Number = quantity("m", "slip over which the state renews itself (L)", above=0)
    weakened: float = quantity("1", "friction coefficient far above the weakening rate", above=0)
    weakening_rate: Number = quantity("m/s", "slip rate above which asperities melt", above=0)
    rate: Number = quantity("m/s", "reference slip rate", above=0, default=1e-6)

    @override
    def check(self) -> None:
        lowest = self.reference - (self.b - self.a) * math.log(FASTEST_CONTACT / self.rate)
        if self.overflows and lowest < -LOWEST * self.a:
            least = -lowest / LOWEST
            raise InputError(f"FlashHeating: a must be at least {least:.3g} with this reference, b and rate, got {self.a:g}")

    @property
    @override
    def pieces(self) -> tuple[Formula, ...]:
        return (_flash_friction_of_small_a if self.overflows else _flash_friction,)

    @property
    @override
    def state_rate(self) -> Formula:
        return _flash_renewal_of_small_a if self.overflows else _flash_renewal

    def _steady(self, v: ArrayLike) -> tuple[Any, Any]:
        return (_flash_steady_of_small_a if self.overflows else _flash_steady)(self, np.asarray(v, float))

    def steady_coefficient(self, v: ArrayLike) -> NDArray[np.float64]:
        """Return the friction coefficient mu_ss (no unit) of steady sliding at slip rates v > 0 (m/s)."""
        return np.asarray(self.a * self._steady(v)[0])

    @override
    def steady_state(self, v: ArrayLike) -> NDArray[np.float64]:
        """Return the state psi (no unit) of steady sliding at slip rates v > 0 (m/s)."""
        x, logarithm = self._steady(v)
        return np.asarray(self.a * (x + np.log(-np.expm1(-2.0 * x)) - logarithm))


def _flash_friction(law: Any, u: Any, v: Any, psi: Any) -> Any:
    return _direct(law, v, psi / law.a)


def _flash_friction_of_small_a(law: Any, u: Any, v: Any, psi: Any) -> Any:
    return _direct_of_small_a(law, v, psi / law.a)


def _flash_renewal(law: Any, u: Any, v: Any, psi: Any) -> Any:
    """Return dpsi/dt (1/s); the logarithm of the slip rate is finite at rest, where it is multiplied by zero."""
    return _towards(law, v, psi, *_flash_steady(law, v))


def _flash_renewal_of_small_a(law: Any, u: Any, v: Any, psi: Any) -> Any:
    return _towards(law, v, psi, *_flash_steady_of_small_a(law, v))


def _towards(law: Any, v: Any, psi: Any, x: Any, logarithm: Any) -> Any:
    return -(v / law.distance) * (psi - law.a * (x + log(-expm1(-2.0 * x)) - logarithm))


def _flash_steady(law: Any, v: Any) -> tuple[Any, Any]:
    """Return mu_ss / a (no unit), which is above zero, and ln(v / rate)."""
    logarithm = _logarithm(law, v)
    return _melted(law, v, arcsinh(0.5 * exp(_low(law, logarithm)))), logarithm


def _flash_steady_of_small_a(law: Any, v: Any) -> tuple[Any, Any]:
    logarithm = _logarithm(law, v)
    return _melted(law, v, _arcsinh(0.5, _low(law, logarithm))), logarithm


def _low(law: Any, logarithm: Any) -> Any:
    """Return mu_low / a from ln(v / rate)."""
    return (law.reference - (law.b - law.a) * logarithm) / law.a


def _melted(law: Any, v: Any, low: Any) -> Any:
    """Return mu_ss / a from its value `low` far below the weakening rate."""
    share = 1.0 / sqrt(sqrt(sqrt(1.0 + (v / law.weakening_rate) ** 8)))
    return share * low + (1.0 - share) * law.weakened / law.a
