"""Define friction that changes with slip alone."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

from typing_extensions import override

from stickslip.foundation.conversion import Number
from stickslip.foundation.quantities import quantity
from stickslip.friction.contract import Formula
from stickslip.friction.formula.functions import exp, sin
from stickslip.friction.law import RemembersSlip, SlipWeakening, hull


@dataclass(frozen=True)
class ExponentialSlipWeakening(SlipWeakening):
    """mu(d) = dynamic + (static - dynamic) exp(-d / distance), with d the slip path.

    The slip-weakening distance D_w of the source is the slip at 95 % of the decrease: `distance` times ln 20.
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


@dataclass(frozen=True)
class PowerSlipWeakening(SlipWeakening):
    """mu(d) = dynamic + (static - dynamic) (1 + d / distance)^(-exponent), with d the slip path.

    Exponent 1/3 is the proxy of thermal pressurisation of Herrera et al., in which the work of weakening grows as d^(2/3). Exponent
    0.4 is that of Chambon et al. for thick gouge. Where friction is written with an initial slope (static - dynamic) / Dc, as
    (1 + d / (exponent Dc))^(-exponent), give `distance` = exponent Dc.
    """

    kind = "power-slip-weakening"
    source = (
        "Chambon, Schmittbuhl & Corfdir 2006, J. Geophys. Res. 111, B09309 (gouge); Herrera, Ampuero & Crempien 2024, Geophys. J. "
        "Int., a proxy implementation of thermal pressurization (exponent 1/3, as a law of slip in SeisSol)"
    )
    many = True
    example: ClassVar = {"static": 0.6, "dynamic": 0.2, "distance": "0.1 m", "exponent": 0.333}

    exponent: float = quantity("1", "how fast friction falls beyond `distance`: as slip to the power -exponent", above=0)

    @staticmethod
    @override
    def formula(law: Any, u: Any, v: Any) -> Any:
        return law.dynamic + (law.static - law.dynamic) * (1.0 + u / law.distance) ** (-law.exponent)


@dataclass(frozen=True)
class LinearSlipWeakening(SlipWeakening):
    """mu falls linearly from static to dynamic over a slip path `distance`, and is constant after that."""

    kind = "linear-slip-weakening"
    source = "Ida 1972, J. Geophys. Res. 77, 3796; Andrews 1976, J. Geophys. Res. 81, 5679"
    many = True
    example: ClassVar = {"static": 0.677, "dynamic": 0.525, "distance": "0.4 m"}

    dynamic: float = quantity("1", "friction coefficient after `distance` of slip", at_least=0)

    @staticmethod
    @override
    def formula(law: Any, u: Any, v: Any) -> Any:
        return law.static - (law.static - law.dynamic) / law.distance * u

    @property
    @override
    def pieces(self) -> tuple[Formula, ...]:
        return (self.formula, self.weakened)

    @property
    @override
    def knots(self) -> tuple[float, ...]:
        return (self.distance,)  # type: ignore[return-value] # mypy reads an inherited field of a frozen class as it is given


@dataclass(frozen=True)
class ParabolicSlipWeakening(SlipWeakening):
    """mu = static - (static - dynamic) ((d - onset) / distance)^2 up to slip onset + distance (d1 + d2), then dynamic.

    d is the slip path. With an onset above 0 friction begins below `static` and rises to it. Beyond the onset it falls ever more
    steeply.
    """

    kind = "parabolic-slip-weakening"
    source = (
        "Bolotskaya 2023, doctoral thesis, Massachusetts Institute of Technology, parabolic cohesive zone as in its code "
        "PyLith_custom_friction, doi:10.5281/zenodo.14047393"
    )
    many = True
    example: ClassVar = {"static": 0.6, "dynamic": 0.4, "distance": "0.4 m", "onset": 0.0}

    static: float = quantity("1", "friction coefficient at the onset", at_least=0)
    dynamic: float = quantity("1", "friction coefficient after onset + distance of slip", at_least=0)
    distance: Number = quantity("m", "slip d2 over which friction falls", above=0)
    onset: Number = quantity("m", "slip d1 at which it begins to fall", at_least=0, default=0.0)

    @staticmethod
    @override
    def formula(law: Any, u: Any, v: Any) -> Any:
        return law.static - (law.static - law.dynamic) * ((u - law.onset) / law.distance) ** 2

    @property
    @override
    def pieces(self) -> tuple[Formula, ...]:
        return (self.formula, self.weakened)

    @property
    @override
    def knots(self) -> tuple[float, ...]:
        return (self.onset + self.distance,)

    @override
    def range(self) -> tuple[float, float]:
        return hull(self.static, self.dynamic, self.formula(self, 0.0, 0.0))


@dataclass(frozen=True)
class ExponentialCohesiveZone(SlipWeakening):
    """mu(d) = dynamic + (static - dynamic) y exp(1 - y), y = (d + offset) / distance (d2), with d the slip path.

    Friction equals `static` at y = 1: it is largest there if `static` exceeds `dynamic`, and smallest otherwise. If the offset (d1)
    is less than the distance, friction rises while d < distance - offset.
    """

    kind = "exponential-cohesive-zone"
    source = (
        "Bolotskaya 2023, doctoral thesis, Massachusetts Institute of Technology, exponential cohesive zone as in its code "
        "PyLith_custom_friction, doi:10.5281/zenodo.14047393; shape of Xu & Needleman 1994, J. Mech. Phys. Solids 42, 1397"
    )
    many = True
    example: ClassVar = {"static": 0.6, "dynamic": 0.4, "distance": "0.2 m", "offset": "0.1 m"}

    static: float = quantity("1", "largest friction coefficient, at y = 1", at_least=0)
    distance: Number = quantity("m", "slip d2, counted from -offset, at which friction is largest", above=0)
    offset: Number = quantity("m", "slip d1 by which the curve is shifted back", at_least=0, default=0.0)

    @staticmethod
    @override
    def formula(law: Any, u: Any, v: Any) -> Any:
        y = (u + law.offset) / law.distance
        return law.dynamic + (law.static - law.dynamic) * y * exp(1.0 - y)


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
