"""Define rate-and-state friction that falls sharply at the slip rates of earthquakes, by flash heating of asperities."""

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray
from typing_extensions import override

from stickslip.foundation.conversion import Number
from stickslip.foundation.quantities import quantity
from stickslip.friction.contract import Formula, StateVariable
from stickslip.friction.formula.functions import arcsinh, exp, expm1, log, sqrt
from stickslip.friction.laws.rate_and_state import SLOWEST, DirectEffect


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
    weakened: float = quantity("1", "friction coefficient of steady sliding far above the weakening rate", above=0)
    weakening_rate: Number = quantity("m/s", "slip rate above which asperities melt", above=0)
    rate: Number = quantity("m/s", "reference slip rate", above=0, default=1e-6)

    @property
    @override
    def pieces(self) -> tuple[Formula, ...]:
        return (_friction,)

    @property
    @override
    def state_rate(self) -> Formula:
        return _renewal

    def steady_coefficient(self, v: ArrayLike) -> NDArray[np.float64]:
        """Return the friction coefficient mu_ss (no unit) of steady sliding at slip rates v > 0 (m/s)."""
        return np.asarray(self.a * _steady(self, np.asarray(v, float))[0])

    @override
    def steady_state(self, v: ArrayLike) -> NDArray[np.float64]:
        """Return the state psi (no unit) of steady sliding at slip rates v > 0 (m/s)."""
        x, logarithm = _steady(self, np.asarray(v, float))
        return np.asarray(self.a * (x + np.log(-np.expm1(-2.0 * x)) - logarithm))


def _friction(law: Any, u: Any, v: Any, psi: Any) -> Any:
    return law.a * arcsinh(v / (2.0 * law.rate) * exp(psi / law.a))


def _renewal(law: Any, u: Any, v: Any, psi: Any) -> Any:
    """Return dpsi/dt (1/s); the logarithm of the slip rate is finite at rest, where it is multiplied by zero."""
    x, logarithm = _steady(law, v)
    return -(v / law.distance) * (psi - law.a * (x + log(-expm1(-2.0 * x)) - logarithm))


def _steady(law: Any, v: Any) -> tuple[Any, Any]:
    """Return mu_ss / a (no unit), which is above zero, and ln(v / rate)."""
    y = v / law.rate
    logarithm = 0.5 * log(y * y + SLOWEST)
    low = arcsinh(0.5 * exp((law.reference - (law.b - law.a) * logarithm) / law.a))
    share = 1.0 / sqrt(sqrt(sqrt(1.0 + (v / law.weakening_rate) ** 8)))
    return share * low + (1.0 - share) * law.weakened / law.a, logarithm
