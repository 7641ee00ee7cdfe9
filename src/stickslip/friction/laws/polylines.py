"""Friction laws that run straight from point to point, of slip or of slip rate."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar

from typing_extensions import override

from stickslip.foundation.conversion import Numbers
from stickslip.foundation.quantities import NumberSeries, Quantity, declare
from stickslip.friction.law import RemembersSlip
from stickslip.friction.piecewise import PiecewiseLinearLaw


@dataclass(frozen=True)
class PiecewiseLinearSlip(RemembersSlip, PiecewiseLinearLaw):
    """mu(d) runs straight from point to point, and is constant before the first and beyond the last; d is the slip path."""

    kind = "piecewise-linear-slip"
    source = (
        "Bolotskaya & Hager 2022, Bull. Seismol. Soc. Am., doi:10.1785/0120220052 (double slip weakening with initial "
        "strengthening)"
    )
    counts = "path"
    example: ClassVar = {"slips": [0.0, "5 cm", "0.2 m", "0.5 m"], "coefficients": [0.55, 0.6, 0.45, 0.4]}
    columns: ClassVar = {"slip": "slips", "friction": "coefficients"}

    slips: Numbers = declare(NumberSeries(Quantity("m", "slips of the points", at_least=0), ascending=True))
    coefficients: Sequence[float] = declare(NumberSeries(Quantity("1", "friction coefficients at the points", at_least=0)))

    @property
    @override
    def points(self) -> tuple[Sequence[float], Sequence[float]]:
        return self.slips, self.coefficients


@dataclass(frozen=True)
class PiecewiseLinearRate(PiecewiseLinearLaw):
    """mu(v) runs straight from point to point, and is constant below the first and beyond the last."""

    kind = "piecewise-linear-rate"
    source = "a polyline through the user's points"
    knot_variable = "rate"
    example: ClassVar = {"rates": [0.0, "1 cm/s", "1 m/s"], "coefficients": [0.6, 0.5, 0.3]}
    columns: ClassVar = {"slip_rate": "rates", "friction": "coefficients"}

    rates: Numbers = declare(NumberSeries(Quantity("m/s", "slip rates of the points", at_least=0), ascending=True))
    coefficients: Sequence[float] = declare(NumberSeries(Quantity("1", "friction coefficients at the points", at_least=0)))

    @property
    @override
    def points(self) -> tuple[Sequence[float], Sequence[float]]:
        return self.rates, self.coefficients
