"""Fit a penalised cubic spline to points, with or without the condition that it only rises or only falls.

The spline f on x in [0, 1] minimises mean((y - f(x))^2) + strength * integral of f''^2 (Reinsch 1967, Numer. Math. 10, 177). With
up to `MOST_INTERVALS` intervals the knots are the places of the points, and f is the exact smoothing spline; with more points the
knots are quantiles of their places, which loses nothing that the penalty would not smooth away (Eilers & Marx 1996, Stat. Sci. 11,
89).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

MOST_INTERVALS = 64
"""Largest number of intervals between knots: a curve with more features is not what smoothing is for."""
WEAKEST, STRONGEST = 1e-14, 1e3
"""Range of strengths among which cross-validation chooses: from interpolation in rounding to a straight line."""
ROWS = 10_000
"""Number of points that are reduced at a time, which limits memory."""
INFLATION = 1.4
"""Weight of the degrees of freedom in cross-validation; with 1 it follows noise too often (Kim & Gu 2004, J. R. Stat. Soc. B 66,
337)."""


class _Modes(NamedTuple):
    """Combinations of the coefficients in which points and bending do not mix (generalised singular values)."""

    seen: Floats
    """How strongly the points see each combination, shape (k,)."""
    bent: Floats
    """How strongly each is bent, shape (k,): seen^2 + bent^2 = 1."""
    of_coefficients: Floats
    """Matrix that makes the combinations from coefficients, shape (k, k)."""
    data: Floats
    """What the points say about each, shape (k,)."""
    unit: float
    """Weight of bending at strength 1."""

    def weights(self, strength: float) -> Floats:
        """Return the diagonal of the equations for the combinations."""
        return self.seen**2 + self.unit * strength * self.bent**2


@dataclass(frozen=True, eq=False)
class Basis:
    """The least-squares problem of the spline: B-splines at the points, the penalty, and the values.

    It is solved by orthogonal transformations, because the normal equations lose half of all digits where points are close.

    Parameters
    ----------
    knots
        Knots of the cubic B-splines, the outer ones fourfold, shape (k + 4,).
    design
        Values of the k B-splines at the n points, a sparse array.
    bending
        Matrix whose product with the coefficients has the integral of f''^2 as its sum of squares, shape (2 k - 6, k).
    values
        The values y of the points, shape (n,).
    """

    knots: Floats
    design: Any
    bending: Floats
    values: Floats

    @classmethod
    def of(cls, places: Floats, values: Floats) -> Basis:
        """Return the problem for points with places x in [0, 1], in any order and with repetitions."""
        from scipy.interpolate import BSpline

        distinct = np.unique(places)
        if len(distinct) > MOST_INTERVALS + 1:
            distinct = np.unique(np.quantile(distinct, np.linspace(0.0, 1.0, MOST_INTERVALS + 1)))
        knots = np.concatenate((np.repeat(distinct[0], 3), distinct, np.repeat(distinct[-1], 3)))
        middle, half = (distinct[1:] + distinct[:-1]) / 2.0, np.diff(distinct) / 2.0
        gauss = half / np.sqrt(3.0)  # two points integrate the square of a straight line exactly
        at, weight = np.concatenate((middle - gauss, middle + gauss)), np.sqrt(np.tile(half, 2))
        second = np.column_stack([BSpline(knots, unit, 3).derivative(2)(at) for unit in np.eye(len(knots) - 4)])
        return cls(knots, BSpline.design_matrix(places, knots, 3), weight[:, None] * second, values)

    @cached_property
    def _reduced(self) -> tuple[Floats, Floats, float]:
        """A matrix (., k) and a right-hand side that stand for all points, and the sum of squares that no spline can remove."""
        k = self.design.shape[1]
        rows = np.zeros((0, k + 1))
        for first in range(0, len(self.values), ROWS):
            part = slice(first, first + ROWS)
            more = np.column_stack((self.design[part].toarray(), self.values[part]))
            rows = np.asarray(np.linalg.qr(np.vstack((rows, more)), mode="r"))
        return rows[:k, :k], rows[:k, k], float(np.sum(rows[k:, k] ** 2))

    @cached_property
    def _modes(self) -> _Modes:
        """The combinations of coefficients in which points and bending do not mix."""
        from scipy.linalg import svd

        matrix, right, _ = self._reduced
        balance = float(np.linalg.norm(matrix) / np.linalg.norm(self.bending))
        q, root = np.linalg.qr(np.vstack((matrix, balance * self.bending)))
        upper, lower = q[: len(matrix)], q[len(matrix) :]
        left, sizes, modes = svd(upper)
        seen = np.pad(sizes, (0, len(modes) - len(sizes)))
        data = np.pad(left.T @ right, (0, len(modes) - len(right)))
        return _Modes(seen, np.linalg.norm(lower @ modes.T, axis=0), modes @ root, data, len(self.values) / balance**2)

    def freedom(self, strength: float) -> float:
        """Return the effective number of degrees of freedom, from 2 (a straight line) to that of interpolation."""
        modes = self._modes
        return float(np.sum(modes.seen**2 / modes.weights(strength)))

    def solved(self, strength: float) -> Floats:
        """Return the coefficients without a condition, shape (k,)."""
        modes = self._modes
        return np.asarray(np.linalg.solve(modes.of_coefficients, modes.seen * modes.data / modes.weights(strength)))

    def monotone(self, strength: float, rises: int) -> Floats:
        """Return the coefficients under the condition that each is at least the one before, or at most if `rises` is -1.

        The spline then only rises, or only falls.
        """
        from scipy.optimize import lsq_linear

        modes, root = self._modes, np.sqrt(self._modes.weights(strength))
        matrix, first = root[:, None] * modes.of_coefficients, np.arange(len(root)) == 0
        steps = np.tril(np.ones_like(matrix)) * np.where(first, 1.0, float(rises))
        bounds = np.where(first, -np.inf, 0.0), np.inf
        found = lsq_linear(matrix @ steps, modes.seen * modes.data / root, bounds, method="bvls")
        return np.asarray(steps @ found.x)

    def sum_of_squares(self, coefficients: Floats) -> float:
        """Return the sum of the squared differences between the points and the spline."""
        return float(np.sum((self.values - self.design @ coefficients) ** 2))

    def score(self, strength: float, inflation: float = INFLATION) -> float:
        """Return the score of generalised cross-validation: the mean squared error of predicting a point that is left out."""
        modes, n = self._modes, len(self.values)
        left = 1.0 - inflation * self.freedom(strength) / n
        rest = modes.data * (1.0 - modes.seen**2 / modes.weights(strength))
        return (self._reduced[2] + float(np.sum(rest**2))) / n / left**2 if left > 0.0 else math.inf

    def cross_validated(self, inflation: float = INFLATION) -> float:
        """Return the strength with the smallest `score`."""
        from scipy.optimize import minimize_scalar

        grid = np.linspace(np.log(WEAKEST), np.log(STRONGEST), 69)
        best = int(np.argmin([self.score(np.exp(one), inflation) for one in grid]))
        around = grid[max(best - 1, 0)], grid[min(best + 1, len(grid) - 1)]
        found = minimize_scalar(lambda one: self.score(np.exp(one), inflation), bounds=around, method="bounded")
        return float(np.exp(found.x))

    def values_at(self, places: Floats, coefficients: Floats) -> Floats:
        """Return the spline at places x in [0, 1], of any shape."""
        from scipy.interpolate import BSpline

        return np.asarray(BSpline(self.knots, coefficients, 3)(places))

    def standard_error(self, places: Floats, strength: float, residual: float) -> Floats:
        """Return the standard error of the spline at places x in [0, 1], from the standard deviation of the points about it.

        It is Wahba's (1983, J. R. Stat. Soc. B 45, 133), which includes the bias of smoothing, on average over the places.
        """
        from scipy.interpolate import BSpline

        modes = self._modes
        at = BSpline.design_matrix(np.clip(places, 0.0, 1.0).ravel(), self.knots, 3).toarray()
        parts = np.linalg.solve(modes.of_coefficients.T, at.T) / np.sqrt(modes.weights(strength))[:, None]
        return np.asarray(residual * np.linalg.norm(parts, axis=0)).reshape(np.shape(places))
