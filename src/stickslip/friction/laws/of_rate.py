"""Define friction that changes with slip rate alone."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

from typing_extensions import override

from stickslip.foundation.conversion import Number
from stickslip.foundation.errors import InputError
from stickslip.foundation.quantities import quantity
from stickslip.friction.formula.functions import exp, log
from stickslip.friction.law import FrictionLaw, Stribeck


@dataclass(frozen=True)
class Coulomb(FrictionLaw):
    """|tau| <= static S at rest, |tau| = dynamic S in slip: the limit alpha -> infinity of the hyperbolic rate law."""

    kind = "coulomb"
    source = "Campillo et al. 1996, section 4 (limit of eq. 15)"
    many = True
    critical = "static"
    example: ClassVar = {"static": 0.6, "dynamic": 0.5}

    static: float = quantity("1", "friction coefficient at rest", at_least=0)
    dynamic: float = quantity("1", "friction coefficient in slip", at_least=0)

    @override
    def check(self) -> None:
        if self.static < self.dynamic:
            raise InputError(f"Coulomb: static must be at least dynamic, got static {self.static:g} < dynamic {self.dynamic:g}")

    @staticmethod
    @override
    def formula(law: Any, u: Any, v: Any) -> Any:
        return law.dynamic + 0.0 * v

    @property
    @override
    def static_excess(self) -> float:
        return self.static - self.dynamic


@dataclass(frozen=True)
class HyperbolicRate(FrictionLaw):
    """mu(v) = dynamic + (static - dynamic) / (1 + alpha v): the paper's muD + (muS - muD) / (1 + alpha v)."""

    kind = "hyperbolic-rate"
    source = "Campillo et al. 1996, eq. (15)"
    many = True
    critical = "alpha"
    example: ClassVar = {"static": 0.8, "dynamic": 0.3, "alpha": "1 s/m"}

    static: float = quantity("1", "friction coefficient muS at rest", at_least=0)
    dynamic: float = quantity("1", "friction coefficient muD at high slip rate", at_least=0)
    alpha: Number = quantity("s/m", "weakening parameter alpha: inverse of the slip rate at half of the change", at_least=0)

    @staticmethod
    @override
    def formula(law: Any, u: Any, v: Any) -> Any:
        return law.dynamic + (law.static - law.dynamic) / (1.0 + law.alpha * v)


@dataclass(frozen=True)
class ExponentialStribeck(Stribeck):
    """mu(v) = dynamic + (static - dynamic) exp(-(v / rate)^exponent) + viscosity v."""

    kind = "exponential-stribeck"
    source = (
        "Tustin 1947, J. Inst. Electr. Eng. 94, 143 (exponent 1); Bo & Pavelescu 1982, Wear 82, 277; "
        "Armstrong-Helouvry, Dupont & Canudas de Wit 1994, Automatica 30, 1083"
    )
    many = True
    example: ClassVar = {"static": 0.6, "dynamic": 0.4, "rate": "0.1 m/s", "exponent": 1}

    exponent: float = quantity("1", "exponent of v / rate: 1 exponential, 2 Gaussian; whole", at_least=1, whole=True, default=1.0)

    @staticmethod
    @override
    def formula(law: Any, u: Any, v: Any) -> Any:
        return law.dynamic + (law.static - law.dynamic) * exp(-((v / law.rate) ** law.exponent)) + law.viscosity * v


@dataclass(frozen=True)
class PowerStribeck(Stribeck):
    """mu(v) = dynamic + (static - dynamic) / (1 + (v / rate)^exponent) + viscosity v.

    With exponent 1 and no viscosity this is the hyperbolic law, paper eq. (15), with alpha = 1 / rate.
    """

    kind = "power-stribeck"
    source = (
        "Hess & Soom 1990, J. Tribol. 112, 147 (exponent 2); Armstrong-Helouvry, Dupont & Canudas de Wit 1994, Automatica 30, 1083"
    )
    many = True
    example: ClassVar = {"static": 0.6, "dynamic": 0.4, "rate": "0.1 m/s", "exponent": 2}

    rate: Number = quantity("m/s", "slip rate v_s at which half of the decrease is complete", above=0)
    exponent: float = quantity("1", "exponent of v / rate; whole", at_least=1, whole=True, default=2.0)

    @staticmethod
    @override
    def formula(law: Any, u: Any, v: Any) -> Any:
        return law.dynamic + (law.static - law.dynamic) / (1.0 + (v / law.rate) ** law.exponent) + law.viscosity * v


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
