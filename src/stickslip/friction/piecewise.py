"""Define laws that are given by points, and recognise noise in points that are to be joined exactly."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar, NamedTuple

import numpy as np
from numpy.typing import NDArray
from typing_extensions import override

from stickslip.foundation.errors import InputError, warn
from stickslip.friction.contract import Formula
from stickslip.friction.law import FrictionLaw


def _line(law: Any, step: Any) -> Any:
    return law.value + law.first * step


def _cubic(law: Any, step: Any) -> Any:
    return law.value + step * (law.first + step * (law.second + step * law.third))


_LINE, _CUBIC = ("start", "value", "first"), ("start", "value", "first", "second", "third")
"""Parameters of the formulas: where the piece starts, and the coefficients in ascending order."""
_FORMULAS: dict[tuple[tuple[str, ...], str], Formula] = {
    (_LINE, "slip"): lambda law, u, v: _line(law, u - law.start),
    (_LINE, "rate"): lambda law, u, v: _line(law, v - law.start),
    (_CUBIC, "slip"): lambda law, u, v: _cubic(law, u - law.start),
    (_CUBIC, "rate"): lambda law, u, v: _cubic(law, v - law.start),
}
"""Formula of a piece by its parameters and its variable."""


LARGEST_COEFFICIENT, LARGEST_PERCENTAGE = 2.0, 200.0
"""Coefficients that are all above the first number look like percentages, if none is above the second, or like forces."""


@dataclass(frozen=True)
class PiecewiseLaw(FrictionLaw):
    """A law given by points; all its pieces share one formula, each with its own `start` and its own coefficients."""

    coefficient_names: ClassVar[tuple[str, ...]] = _CUBIC
    """Parameters of the formula of every piece."""
    least_distance: ClassVar[float] = 1e-100
    """Least distance of two points (m or m/s) that keeps all coefficients finite: the last one is divided by its third power."""

    @property
    @abstractmethod
    def points(self) -> tuple[Sequence[float], Sequence[float]]:
        """The ascending slips (m) or slip rates (m/s) of the points, and the friction coefficients there."""

    @abstractmethod
    def polynomials(self) -> NDArray[np.float64]:
        """Return polynomial coefficients in ascending order, one row for each interval between neighbouring points.

        The variable of the polynomial is the distance from the lower end of the interval.
        """

    @override
    def check(self) -> None:
        places, values = self.points
        if len(places) != len(values):
            raise InputError(f"{type(self).__name__}: {len(places)} places but {len(values)} friction coefficients")
        self._check_coefficients()
        note_percent(values, type(self).__name__)
        noise = noise_in(places, values)
        if noise is not None:
            warn(f"{type(self).__name__}: {noise.warning()}")

    def _check_coefficients(self) -> None:
        """Refuse points so close to each other that the polynomial between them has a coefficient beyond all floats."""
        with np.errstate(all="ignore"):
            finite = np.isfinite(self.rows).all(axis=1)
        if not finite.all():
            first = int(np.argmin(finite)) - self._before
            unit, near = "m" if self.knot_variable == "slip" else "m/s", self.points[0][first : first + 2]
            raise InputError(
                f"{type(self).__name__}: the points at {near[0]:g} and {near[1]:g} {unit} are too close together: the curve between"
                f" them is too steep for floating-point numbers; a distance of {self.least_distance:g} {unit} is allowed"
            )

    @property
    def _before(self) -> bool:
        """True if a piece is needed below the first point: net slip may be negative, path and slip rate may not."""
        return self.points[0][0] > 0.0 or (self.counts == "net" and self.knot_variable == "slip")

    @cached_property
    def rows(self) -> NDArray[np.float64]:
        """The values of the parameters, one row for each piece."""
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
    @override
    def pieces(self) -> tuple[Formula, ...]:
        return (_FORMULAS[self.coefficient_names, self.knot_variable],) * len(self.rows)

    @property
    @override
    def knots(self) -> tuple[float, ...]:
        return tuple(self.points[0] if self._before else self.points[0][1:])

    @override
    def parameters(self) -> tuple[str, ...]:
        return self.coefficient_names

    @override
    def piece_values(self, i: int) -> tuple[float, ...]:
        return tuple(self.rows[i].tolist())

    @override
    def range(self) -> tuple[float, float]:
        values = self.points[1]
        return min(values), max(values)


@dataclass(frozen=True)
class PiecewiseLinearLaw(PiecewiseLaw):
    """A law that runs straight from point to point."""

    coefficient_names = _LINE
    least_distance = 1e-300

    @override
    def polynomials(self) -> NDArray[np.float64]:
        places, values = self.points
        return np.column_stack((values[:-1], np.diff(values) / np.diff(places)))


def note_percent(friction: Sequence[float] | NDArray[np.float64], where: str) -> None:
    """Issue an `InputWarning`, beginning with `where`, for friction coefficients that look like percentages or forces."""
    if not len(friction) or not np.min(np.abs(friction)) > LARGEST_COEFFICIENT:
        return
    most = float(np.max(np.abs(friction)))
    cure = "divide a percentage by 100, and " if most <= LARGEST_PERCENTAGE else ""
    cure += "name a force shear_force (a torque torque) and give its normal force: `--normal-force '100 N'`"
    warn(f"{where}: friction reaches {most:g}: it is shear over normal stress, hardly ever above 2; {cure}")


MOST_CHANGES = 0.55
"""Points look noisy if more than this share (no unit) of neighbouring differences change sign.

It lies between 0.73 +- 0.07 (noise, 50 points) and 0.4 (a sine with five points in each wavelength).
"""
FEWEST_REVERSALS = 5
"""Noise matters if friction turns from rise to fall, or back, at least this often."""
IGNORED_NOISE = 1e-6
"""Noise with a smaller standard deviation (no unit) is ignored: no apparatus resolves it, and single precision rounds by more."""


class Noise(NamedTuple):
    """Noise in points: its standard deviation (no unit), and how often friction turns from rise to fall or back."""

    size: float
    reversals: int

    def warning(self, makes: str = "") -> str:
        """Return the warning for users; `makes` says what the points make, by default how often friction turns."""
        makes = makes or f"friction turns {self.reversals} times"
        return (
            f"the points look noisy (about {self.size:.1g} in friction): interpolated exactly, {makes}; "
            "smooth them or fit a law with `stickslip fit`"
        )


def noise_in(places: Sequence[float], values: Sequence[float]) -> Noise | None:
    """Return the noise in points with ascending places, or None if they look smooth or turn hardly ever.

    The value at each inner point is compared with the straight line between its two neighbours. Along a smooth curve these
    differences keep their sign for many points; in noise that differs from point to point, neighbouring differences have a
    correlation of -2/3 and change sign in 73 % of all cases.
    """
    x, y = np.asarray(places, float), np.asarray(values, float)
    turns = reversals(y)
    if turns < FEWEST_REVERSALS:
        return None
    left = (x[2:] - x[1:-1]) / (x[2:] - x[:-2])
    differences = y[1:-1] - left * y[:-2] - (1.0 - left) * y[2:]
    size = float(np.sqrt(np.mean(differences**2 / (1.0 + left**2 + (1.0 - left) ** 2))))
    changes = float(np.mean(differences[1:] * differences[:-1] < 0.0))
    return Noise(size, turns) if changes > MOST_CHANGES and size > IGNORED_NOISE else None


def reversals(values: Sequence[float] | NDArray[np.float64]) -> int:
    """Return how often a sequence turns from rise to fall or back; equal neighbours are passed over."""
    steps = np.diff(np.asarray(values, float))
    signs = np.sign(steps[steps != 0.0])
    return int(np.count_nonzero(signs[1:] != signs[:-1]))
