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
from typing import Any

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

MOST_INTERVALS = 64
"""Largest number of intervals between knots: a curve with more features is not what smoothing is for."""
WEAKEST, STRONGEST = 1e-14, 1e3
"""Range of strengths among which cross-validation chooses: from interpolation in rounding to a straight line."""
INFLATION = 1.4
"""Weight of the degrees of freedom in cross-validation; with 1 it follows noise too often (Kim & Gu 2004, J. R. Stat. Soc. B 66,
337)."""


@dataclass(frozen=True, eq=False)
class Basis:
    """The equations of the spline: B-splines at the points, the penalty, and the values.

    Parameters
    ----------
    knots
        Knots of the cubic B-splines, the outer ones fourfold, shape (k + 4,).
    design
        Values of the k B-splines at the n points, a sparse array.
    penalty
        Integrals of products of second derivatives, shape (k, k).
    values
        The values y of the points, shape (n,).
    """

    knots: Floats
    design: Any
    penalty: Floats
    values: Floats

    @classmethod
    def of(cls, places: Floats, values: Floats) -> Basis:
        """Return the equations for points with places x in [0, 1], in any order and with repetitions."""
        from scipy.interpolate import BSpline

        distinct = np.unique(places)
        if len(distinct) > MOST_INTERVALS + 1:
            distinct = np.unique(np.quantile(distinct, np.linspace(0.0, 1.0, MOST_INTERVALS + 1)))
        knots = np.concatenate((np.repeat(distinct[0], 3), distinct, np.repeat(distinct[-1], 3)))
        middle, half = (distinct[1:] + distinct[:-1]) / 2.0, np.diff(distinct) / 2.0
        gauss = half / np.sqrt(3.0)  # two points integrate the square of a straight line exactly
        at, weight = np.concatenate((middle - gauss, middle + gauss)), np.tile(half, 2)
        second = np.column_stack([BSpline(knots, unit, 3).derivative(2)(at) for unit in np.eye(len(knots) - 4)])
        return cls(knots, BSpline.design_matrix(places, knots, 3), second.T @ (weight[:, None] * second), values)

    @cached_property
    def normal(self) -> Floats:
        """Products of the B-splines summed over the points, shape (k, k)."""
        return np.asarray((self.design.T @ self.design).toarray())

    @cached_property
    def right(self) -> Floats:
        """Products of the B-splines with the values, summed over the points, shape (k,)."""
        return np.asarray(self.design.T @ self.values)

    def equations(self, strength: float) -> Floats:
        """Return the matrix of the linear equations for the coefficients, shape (k, k)."""
        return self.normal + len(self.values) * strength * self.penalty

    def freedom(self, strength: float) -> float:
        """Return the effective number of degrees of freedom, from 2 (a straight line) to that of interpolation."""
        return float(np.trace(np.linalg.solve(self.equations(strength), self.normal)))

    def solved(self, strength: float) -> Floats:
        """Return the coefficients without a condition, shape (k,)."""
        return np.asarray(np.linalg.solve(self.equations(strength), self.right))

    def monotone(self, strength: float, rises: int) -> Floats:
        """Return the coefficients under the condition that each is at least the one before, or at most if `rises` is -1.

        The spline then only rises, or only falls.
        """
        from scipy.linalg import cholesky, solve_triangular
        from scipy.optimize import lsq_linear

        root = cholesky(self.equations(strength))
        steps = np.tril(np.ones_like(root)) * np.where(np.arange(len(root)) == 0, 1.0, float(rises))
        lower = np.where(np.arange(len(root)) == 0, -np.inf, 0.0)
        found = lsq_linear(root @ steps, solve_triangular(root, self.right, trans="T"), (lower, np.inf), method="bvls")
        return np.asarray(steps @ found.x)

    def sum_of_squares(self, coefficients: Floats) -> float:
        """Return the sum of the squared differences between the points and the spline."""
        return float(np.sum((self.values - self.design @ coefficients) ** 2))

    def score(self, strength: float, inflation: float = INFLATION) -> float:
        """Return the score of generalised cross-validation: the mean squared error of predicting a point that is left out."""
        n = len(self.values)
        left = 1.0 - inflation * self.freedom(strength) / n
        return self.sum_of_squares(self.solved(strength)) / n / left**2 if left > 0.0 else math.inf

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

        at = BSpline.design_matrix(np.clip(places, 0.0, 1.0).ravel(), self.knots, 3).toarray()
        spread = np.sum(at * np.linalg.solve(self.equations(strength), at.T).T, axis=1)
        return np.asarray(residual * np.sqrt(np.maximum(spread, 0.0))).reshape(np.shape(places))
