"""Define friction that is piecewise linear in slip rate."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from typing_extensions import override

from stickslip.foundation.conversion import Numbers
from stickslip.foundation.quantities import Quantity, Series, declare
from stickslip.friction.piecewise import PiecewiseLinearLaw


@dataclass(frozen=True)
class PiecewiseLinearRate(PiecewiseLinearLaw):
    """mu(v) runs straight from point to point, and is constant below the first and beyond the last."""

    kind = "piecewise-linear-rate"
    source = "a polyline through the user's points"
    knot_variable = "rate"
    example: ClassVar = {"rates": [0.0, "1 cm/s", "1 m/s"], "coefficients": [0.6, 0.5, 0.3]}
    columns: ClassVar = {"slip_rate": "rates", "friction": "coefficients"}

    rates: Numbers = declare(Series(Quantity("m/s", "slip rates of the points", at_least=0), ascending=True))
    coefficients: Sequence[float] = declare(Series(Quantity("1", "friction coefficients at the points", at_least=0)))

    @property
    @override
    def points(self) -> tuple[Sequence[float], Sequence[float]]:
        return self.rates, self.coefficients

    @override
    def critical_value(self, impedance: float, normal: float) -> tuple[str, float] | None:
        """Return S_c = Z / (steepest decrease of mu with v), the critical normal stress (Pa).

        No single parameter of the law has a critical value, hence the normal stress. None if mu never falls.
        """
        steepest = -float(np.min(self.polynomials()[:, 1]))
        return ("normal_stress", impedance / steepest) if steepest > 0.0 else None
