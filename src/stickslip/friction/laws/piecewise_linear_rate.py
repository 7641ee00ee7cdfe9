"""Define friction that is piecewise linear in slip rate."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar, Literal

import numpy as np
from numpy.typing import NDArray

from stickslip.foundation.quantities import Quantity
from stickslip.friction.law import Formula
from stickslip.friction.parameters import Series, declare
from stickslip.friction.piecewise import PiecewiseLaw, line_along_rate, lines


@dataclass(frozen=True)
class PiecewiseLinearRate(PiecewiseLaw):
    """mu(v) runs straight from point to point, and is constant below the first and beyond the last.

    Parameters
    ----------
    rates
        Slip rates of the points (m/s), ascending, shape (n,) with n >= 2.
    coefficients
        Friction coefficients at the points (no unit), shape (n,).

    Raises
    ------
    InputError
        If the numbers of slip rates and coefficients differ, or the slip rates do not ascend.
    """

    kind: ClassVar[str] = "piecewise-linear-rate"
    source: ClassVar[str] = "a polyline through the user's points"
    knot_variable: ClassVar[Literal["slip", "rate"]] = "rate"
    example: ClassVar[dict[str, Any]] = {"rates": [0.0, "1 cm/s", "1 m/s"], "coefficients": [0.6, 0.5, 0.3]}
    columns: ClassVar[dict[str, str]] = {"slip_rate": "rates", "friction": "coefficients"}

    rates: tuple[float, ...] = declare(Series(Quantity("m/s", "slip rates of the points", at_least=0), ascending=True))
    coefficients: tuple[float, ...] = declare(Series(Quantity("1", "friction coefficients at the points", at_least=0)))

    @property
    def points(self) -> tuple[tuple[float, ...], tuple[float, ...]]:
        return self.rates, self.coefficients

    @property
    def shape(self) -> tuple[Formula, tuple[str, ...]]:
        return line_along_rate, ("start", "value", "first")

    def critical_value(self, impedance: float, normal: float) -> tuple[str, float] | None:
        """Return S_c = Z / (steepest decrease of mu with v), the critical normal stress (Pa).

        No single parameter of the law has a critical value, hence the normal stress. None if mu never falls.
        """
        steepest = -float(np.min(self.polynomials()[:, 1]))
        return ("normal_stress", impedance / steepest) if steepest > 0.0 else None

    def polynomials(self) -> NDArray[np.float64]:
        return lines(*self.points)
