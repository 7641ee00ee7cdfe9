"""Make a friction law from measured points, joined by a monotone cubic."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any, ClassVar, Literal

import numpy as np
from numpy.typing import NDArray

from stickslip.foundation.errors import InputError
from stickslip.foundation.quantities import Quantity
from stickslip.friction.law import Formula
from stickslip.friction.memory import RemembersSlip
from stickslip.friction.parameters import Choice, Series, declare
from stickslip.friction.piecewise import PiecewiseLaw, along_rate, along_slip


@dataclass(frozen=True, kw_only=True)
class TableLaw(RemembersSlip, PiecewiseLaw):
    """mu through measured points of slip or of slip rate: monotone cubic between them, constant outside (no extrapolation).

    Parameters
    ----------
    friction
        Friction coefficients at the points (no unit), shape (n,) with n >= 2.
    slip
        Slips of the points (m), ascending, shape (n,). Give either `slip` or `rate`.
    rate
        Slip rates of the points (m/s), ascending, shape (n,).
    counts
        Slip that a table of slip sees: "path" for its accumulated length in both directions, "net" for signed slip.
    memory
        Slip that friction remembers, "all" or "since-arrest" (see `RemembersSlip`).

    Raises
    ------
    InputError
        If neither or both of `slip` and `rate` are given, their number differs from that of `friction`, they do not ascend, or
        slips are negative where the path is counted.

    Notes
    -----
    The cubic passes through the points without overshoot. Its slope is continuous between the first and the last point.

    Sources: Fritsch & Carlson 1980, SIAM J. Numer. Anal. 17, 238; for the slopes see `monotone_slopes`.
    """

    kind: ClassVar[str] = "table"
    source: ClassVar[str] = "the user's points; Fritsch & Carlson 1980, SIAM J. Numer. Anal. 17, 238; slopes: `monotone_slopes`"
    example: ClassVar[dict[str, Any]] = {"friction": [0.7, 0.62, 0.45, 0.4], "slip": [0.0, "0.1 m", "0.3 m", "1 m"]}
    columns: ClassVar[dict[str, str]] = {"slip": "slip", "slip_rate": "rate", "friction": "friction"}

    friction: tuple[float, ...] = declare(Series(Quantity("1", "friction coefficients at the points", at_least=0)))
    slip: tuple[float, ...] | None = declare(
        Series(Quantity("m", "slips of the points; give either slip or rate"), ascending=True), None
    )
    rate: tuple[float, ...] | None = declare(
        Series(Quantity("m/s", "slip rates of the points; give either slip or rate", at_least=0), ascending=True), None
    )
    counts: Literal["net", "path"] = declare(Choice("slip that a table of slip sees", ("path", "net")), "path")  # type: ignore[misc] # here a choice of the user

    def check(self) -> None:
        if (self.slip is None) == (self.rate is None):
            raise InputError(f"TableLaw: give either slip or rate, got {'neither' if self.slip is None else 'both'}")
        if self.slip is not None and self.counts == "path" and self.slip[0] < 0.0:
            raise InputError(f"TableLaw: slip[0] must be at least 0 where the path is counted, got {self.slip[0]:g}")
        super().check()

    @property
    def knot_variable(self) -> Literal["slip", "rate"]:  # type: ignore[override] # depends on the columns here
        return "slip" if self.rate is None else "rate"

    @property
    def points(self) -> tuple[tuple[float, ...], tuple[float, ...]]:
        return self.slip or self.rate or (), self.friction

    @property
    def shape(self) -> tuple[Formula, tuple[str, ...]]:
        return along_slip if self.rate is None else along_rate, ("start", "value", "first", "second", "third")

    def polynomials(self) -> NDArray[np.float64]:
        """Return the coefficients of Hermite cubics with the slopes of `monotone_slopes`, in ascending order."""
        places, values = (np.array(one) for one in self.points)
        width, slope = np.diff(places), monotone_slopes(places, values)
        secant, left, right = np.diff(values) / width, slope[:-1], slope[1:]
        second = (3.0 * secant - 2.0 * left - right) / width
        third = (left + right - 2.0 * secant) / width**2
        return np.column_stack((values[:-1], left, second, third))


def FromTable(  # noqa: N802 - reads as the law it makes
    *,
    friction: Iterable[float],
    slip: Iterable[float] | None = None,
    rate: Iterable[float] | None = None,
    counts: Literal["net", "path"] = "path",
    memory: Literal["all", "since-arrest"] = "all",
) -> TableLaw:
    """Make a friction law through measured points.

    Parameters
    ----------
    friction
        Friction coefficients at the points (no unit), shape (n,) with n >= 2.
    slip
        Slips of the points (m), ascending, shape (n,). Give either `slip` or `rate`.
    rate
        Slip rates of the points (m/s), ascending, shape (n,).
    counts
        Slip that a table of slip sees: "path" for its accumulated length in both directions, "net" for signed slip.
    memory
        Slip that friction remembers: "all", or "since-arrest" if the contact heals at each arrest.

    Returns
    -------
    TableLaw
        The law: a monotone cubic between the points, constant outside them.

    Raises
    ------
    InputError
        If the points cannot be used; the message is one line that says why.
    """
    given: dict[str, Any] = {"slip": slip, "rate": rate}
    return TableLaw(friction=friction, counts=counts, memory=memory, **given)  # type: ignore[arg-type] # checked and made tuples there


def monotone_slopes(places: NDArray[np.float64], values: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return slopes at the points with which Hermite cubics preserve every rise, fall and extremum of the data.

    At an inner point the slope is the weighted harmonic mean of the two secants, or 0 if they differ in sign or one is 0 (Fritsch
    & Butland 1984, SIAM J. Sci. Stat. Comput. 5, 300). At the two ends it comes from a three-point formula, limited to preserve
    the shape.
    """
    width, secant = np.diff(places), np.diff(values) / np.diff(places)
    if len(secant) == 1:
        return np.repeat(secant, 2)
    slopes = np.zeros(len(places))
    w1, w2 = 2.0 * width[1:] + width[:-1], width[1:] + 2.0 * width[:-1]
    same = secant[:-1] * secant[1:] > 0.0
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        mean = (w1 + w2) / (w1 / secant[:-1] + w2 / secant[1:])
    slopes[1:-1][same] = mean[same]
    slopes[0] = _end_slope(width[0], width[1], secant[0], secant[1])
    slopes[-1] = _end_slope(width[-1], width[-2], secant[-1], secant[-2])
    return slopes


def _end_slope(near: float, far: float, first: float, second: float) -> float:
    """Return the end slope of the parabola through the first three points, limited where the cubic would overshoot.

    The limited slope is 0 if it would differ in sign from the first secant. Where the data turn, its size is at most three times
    that of the first secant.
    """
    slope = ((2.0 * near + far) * first - near * second) / (near + far)
    if slope * first <= 0.0:
        return 0.0
    return 3.0 * first if first * second < 0.0 and abs(slope) > 3.0 * abs(first) else slope
