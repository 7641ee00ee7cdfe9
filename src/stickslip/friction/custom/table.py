"""Make a friction law from measured points, joined by a monotone cubic."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any, ClassVar, Literal

import numpy as np
from numpy.typing import NDArray
from typing_extensions import override

from stickslip.foundation.conversion import OptionalNumbers
from stickslip.foundation.errors import InputError
from stickslip.foundation.quantities import Choice, Quantity, Series, declare
from stickslip.friction.custom.measured import read_table
from stickslip.friction.families import RemembersSlip
from stickslip.friction.piecewise import PiecewiseLaw


@dataclass(frozen=True, init=False)
class FromTable(RemembersSlip, PiecewiseLaw):
    """mu through measured points of slip or of slip rate: monotone cubic between them, constant outside (no extrapolation).

    Give the points as a CSV file, a DataFrame or `Points`, as in `FromTable("data.csv")`; `Points.read` says what is understood. Or
    give either `slip` or `rate`, with as many points as `friction`. `along` names the column, slip or slip_rate, that counts where
    a source has both. Slips must not be negative where the path is counted.

    The cubic passes through the points without overshoot. Its slope is continuous between the first and the last point. Through
    noisy points it turns at almost every one of them, and an `InputWarning` says so: see `smooth` and `fit`.
    """

    kind = "table"
    source = "the user's points; Fritsch & Carlson 1980, SIAM J. Numer. Anal. 17, 238; slopes: `monotone_slopes`"
    example: ClassVar = {"friction": [0.7, 0.62, 0.45, 0.4], "slip": [0.0, "0.1 m", "0.3 m", "1 m"]}
    columns: ClassVar = {"slip": "slip", "slip_rate": "rate", "friction": "friction"}

    friction: Sequence[float] = declare(Series(Quantity("1", "friction coefficients at the points", at_least=0)))
    slip: OptionalNumbers = declare(Series(Quantity("m", "slips of the points; give either slip or rate"), ascending=True), None)
    rate: OptionalNumbers = declare(
        Series(Quantity("m/s", "slip rates of the points; give either slip or rate", at_least=0), ascending=True), None
    )
    counts: Literal["net", "path"] = declare(Choice("slip that a table of slip sees", ("path", "net")), "path")  # type: ignore[misc] # here a choice of the user

    def __init__(
        self,
        source: Any = None,
        /,
        *,
        friction: Iterable[Any] | None = None,
        slip: Iterable[Any] | None = None,
        rate: Iterable[Any] | None = None,
        along: Literal["slip", "slip_rate"] | None = None,
        counts: Literal["net", "path"] = "path",
        memory: Literal["all", "since-arrest"] = "all",
    ) -> None:
        if source is not None:
            if not (friction is slip is rate is None):
                raise InputError("FromTable: give a source of points or lists of numbers, not both")
            slip, rate, friction = _read(source, along)
        elif along is not None:
            raise InputError("FromTable: along chooses a column of a source: lists are given as slip or as rate")
        elif friction is None:
            raise InputError("FromTable: friction is missing: give a file, a DataFrame, or friction with slip or rate")
        given = {"friction": friction, "slip": slip, "rate": rate, "counts": counts, "memory": memory}
        for name, value in given.items():
            object.__setattr__(self, name, value)
        self.__post_init__()

    @override
    def check(self) -> None:
        if (self.slip is None) == (self.rate is None):
            raise InputError(f"FromTable: give either slip or rate, got {'neither' if self.slip is None else 'both'}")
        if self.slip is not None and self.counts == "path" and self.slip[0] < 0.0:
            raise InputError(f"FromTable: slip[0] must be at least 0 where the path is counted, got {self.slip[0]:g}")
        super().check()

    @property
    @override
    def knot_variable(self) -> Literal["slip", "rate"]:  # type: ignore[override] # depends on the columns here
        return "slip" if self.rate is None else "rate"

    @property
    @override
    def points(self) -> tuple[Sequence[float], Sequence[float]]:
        return self.slip or self.rate or (), self.friction

    @override
    def polynomials(self) -> NDArray[np.float64]:
        """Return the coefficients of Hermite cubics with the slopes of `monotone_slopes`, in ascending order."""
        places, values = (np.array(one) for one in self.points)
        width, slope = np.diff(places), monotone_slopes(places, values)
        secant, left, right = np.diff(values) / width, slope[:-1], slope[1:]
        second = (3.0 * secant - 2.0 * left - right) / width
        third = (left + right - 2.0 * secant) / width**2
        return np.column_stack((values[:-1], left, second, third))


def _read(source: Any, along: str | None) -> tuple[Any, Any, Any]:
    """Return slips or None, slip rates or None, and friction coefficients of a source of points. Raises InputError."""
    try:
        variable, places, friction = read_table(source, along)
    except InputError as error:
        raise InputError(f"FromTable: {error}") from None
    return (places, None, friction) if variable == "slip" else (None, places, friction)


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
