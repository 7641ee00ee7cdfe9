"""Define friction that is piecewise linear in slip, such as initial strengthening or double slip weakening."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar, Literal

import numpy as np
from numpy.typing import NDArray

from stickslip.foundation.quantities import Quantity
from stickslip.friction.law import Formula
from stickslip.friction.memory import RemembersSlip
from stickslip.friction.parameters import Series, declare
from stickslip.friction.piecewise import PiecewiseLaw, line_along_slip, lines


@dataclass(frozen=True)
class PiecewiseLinearSlip(RemembersSlip, PiecewiseLaw):
    """mu(d) runs straight from point to point, and is constant before the first and beyond the last.
    d is the slip path, the accumulated length of slip in both directions.

    Parameters
    ----------
    slips
        Slips of the points (m), ascending, shape (n,) with n >= 2.
    coefficients
        Friction coefficients at the points (no unit), shape (n,).
    memory
        Slip that friction remembers, "all" or "since-arrest" (see `RemembersSlip`).

    Raises
    ------
    InputError
        If the numbers of slips and coefficients differ, or the slips do not ascend.

    Notes
    -----
    Source: Bolotskaya & Hager 2022, Bull. Seismol. Soc. Am., doi:10.1785/0120220052 (double slip weakening with initial
    strengthening).
    """

    kind: ClassVar[str] = "piecewise-linear-slip"
    source: ClassVar[str] = (
        "Bolotskaya & Hager 2022, Bull. Seismol. Soc. Am., doi:10.1785/0120220052 (double slip weakening with initial "
        "strengthening)"
    )
    counts: ClassVar[Literal["net", "path"]] = "path"
    example: ClassVar[dict[str, Any]] = {"slips": [0.0, "5 cm", "0.2 m", "0.5 m"], "coefficients": [0.55, 0.6, 0.45, 0.4]}
    columns: ClassVar[dict[str, str]] = {"slip": "slips", "friction": "coefficients"}

    slips: tuple[float, ...] = declare(Series(Quantity("m", "slips of the points", at_least=0), ascending=True))
    coefficients: tuple[float, ...] = declare(Series(Quantity("1", "friction coefficients at the points", at_least=0)))

    @property
    def points(self) -> tuple[tuple[float, ...], tuple[float, ...]]:
        return self.slips, self.coefficients

    @property
    def shape(self) -> tuple[Formula, tuple[str, ...]]:
        return line_along_slip, ("start", "value", "first")

    def polynomials(self) -> NDArray[np.float64]:
        return lines(*self.points)
