"""Define laws given by points: a polynomial between neighbouring points of slip or slip rate, constant outside them."""

from __future__ import annotations

from abc import abstractmethod
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from stickslip.foundation.errors import InputError
from stickslip.friction.law import Formula, FrictionLaw


def along_slip(law: Any, u: Any, v: Any) -> Any:
    """Return a cubic in slip, counted from the start of the piece."""
    step = u - law.start
    return law.value + step * (law.first + step * (law.second + step * law.third))


def along_rate(law: Any, u: Any, v: Any) -> Any:
    """Return a cubic in slip rate, counted from the start of the piece."""
    step = v - law.start
    return law.value + step * (law.first + step * (law.second + step * law.third))


def line_along_slip(law: Any, u: Any, v: Any) -> Any:
    """Return a linear function of slip, counted from the start of the piece."""
    return law.value + law.first * (u - law.start)


def line_along_rate(law: Any, u: Any, v: Any) -> Any:
    """Return a linear function of slip rate, counted from the start of the piece."""
    return law.value + law.first * (v - law.start)


@dataclass(frozen=True)
class PiecewiseLaw(FrictionLaw):
    """A law given by points; all its pieces share one formula, each with its own `start` and its own coefficients."""

    @property
    @abstractmethod
    def points(self) -> tuple[tuple[float, ...], tuple[float, ...]]:
        """Return the ascending slips (m) or slip rates (m/s) of the points, and the friction coefficients there."""

    @property
    @abstractmethod
    def shape(self) -> tuple[Formula, tuple[str, ...]]:
        """Return the formula of every piece and the names of its parameters: `start`, then coefficients in ascending order."""

    @abstractmethod
    def polynomials(self) -> NDArray[np.float64]:
        """Return polynomial coefficients in ascending order, one row for each interval between neighbouring points.

        The variable of the polynomial is the distance from the lower end of the interval.
        """

    def check(self) -> None:
        places, values = self.points
        if len(places) != len(values):
            raise InputError(f"{type(self).__name__}: {len(places)} places but {len(values)} friction coefficients")

    @property
    def _before(self) -> bool:
        """Return True if a piece is needed below the first point: net slip may be negative, path and slip rate may not."""
        return self.points[0][0] > 0.0 or (self.counts == "net" and self.knot_variable == "slip")

    @cached_property
    def rows(self) -> NDArray[np.float64]:
        """Return the values of the parameters, one row for each piece."""
        places, values = (np.array(one) for one in self.points)
        rows = np.zeros((len(places), len(self.parameters())))
        rows[:, 0], rows[:, 1] = places, values
        rows[:-1, 1:] = self.polynomials()
        flat = np.zeros_like(rows[:1])
        flat[0, :2] = places[0], values[0]
        rows = np.concatenate((flat, rows)) if self._before else rows
        rows.flags.writeable = False
        return rows

    @property
    def pieces(self) -> tuple[Formula, ...]:
        return (self.shape[0],) * len(self.rows)

    @property
    def knots(self) -> tuple[float, ...]:
        return self.points[0] if self._before else self.points[0][1:]

    def parameters(self) -> tuple[str, ...]:
        return self.shape[1]

    def literals(self) -> dict[str, float]:
        return {}

    def piece_values(self, i: int) -> tuple[float, ...]:
        return tuple(self.rows[i].tolist())

    def range(self) -> tuple[float, float]:
        values = self.points[1]
        return min(values), max(values)


def lines(places: tuple[float, ...], values: tuple[float, ...]) -> NDArray[np.float64]:
    """Return the value at the lower end, and the slope, of the straight line between each two neighbouring points."""
    return np.column_stack((values[:-1], np.diff(values) / np.diff(places)))
