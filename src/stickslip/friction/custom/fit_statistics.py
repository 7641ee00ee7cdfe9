"""What a least-squares fit says about its parameters: standard uncertainties, correlations, and what the points leave open."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

UNSEEN = 1e-9
"""Singular value, as a share of the largest, below which the points do not see a combination of parameters."""
PART = 0.05
"""Component in an unseen combination (all components: 1) from which a parameter is part of it."""
CORRELATED = 0.99
"""Correlation of two parameters from which the points hardly tell them apart."""
SERIAL = 5.0
"""Number of standard deviations by which neighbouring residuals may be more alike than chance makes them."""


@dataclass(frozen=True, eq=False)
class Spread:
    """Covariance of the parameters that were fitted, in the order of `names`, and the sets that the points do not determine.

    The covariance of a parameter in such a set is NaN.
    """

    names: list[str]
    covariance: Floats
    unseen: list[list[str]]

    @classmethod
    def of(cls, names: list[str], slopes: Floats, variance: float) -> Spread:
        """Return the spread from the derivatives (n, number of names) at the best fit and the variance of the points about it."""
        sizes = np.linalg.norm(slopes, axis=0)
        lost = sizes <= UNSEEN**2 * max(float(sizes.max(initial=0.0)), 1e-300)
        scaled = slopes / np.where(lost, 1.0, sizes)
        _, values, rows = np.linalg.svd(scaled, full_matrices=False)
        seen = values > UNSEEN * values.max(initial=0.0)
        covariance = variance * (rows[seen].T / values[seen] ** 2) @ rows[seen]
        open_sets = [[name] for name, gone in zip(names, lost, strict=True) if gone]
        for row in rows[~seen]:
            part = [name for name, size, gone in zip(names, np.abs(row), lost, strict=True) if size > PART and not gone]
            open_sets += [part] if part else []
        covariance = covariance / np.outer(np.where(lost, 1.0, sizes), np.where(lost, 1.0, sizes))
        unknown = np.array([any(name in part for part in open_sets) for name in names], bool)
        covariance[unknown] = covariance[:, unknown] = np.nan
        return cls(names, covariance, open_sets)

    @property
    def uncertainty(self) -> dict[str, float]:
        """The standard uncertainty of each parameter, infinite where the points do not determine it."""
        with np.errstate(invalid="ignore"):
            sizes = np.sqrt(np.diag(self.covariance))
        return dict(zip(self.names, np.where(np.isnan(sizes), np.inf, sizes).tolist(), strict=True))

    @property
    def correlation(self) -> Floats:
        """The correlations of the parameters, shape (number of names, number of names)."""
        with np.errstate(invalid="ignore", divide="ignore"):
            sizes = np.sqrt(np.diag(self.covariance))
            return np.asarray(self.covariance / np.outer(sizes, sizes))

    def notes(self, values: dict[str, float]) -> Iterator[str]:
        """Yield a sentence on each set of parameters that the points do not determine, or hardly."""
        for part in self.unseen:
            if len(part) == 1:
                yield f"the points do not determine {part[0]}: any value fits alike; choose it and fix it"
            else:
                yield f"the points do not determine {', '.join(part[:-1])} and {part[-1]} separately: fix one of them"
        for name, size in self.uncertainty.items():
            if np.isfinite(size) and size > abs(values[name]) > 0.0:
                yield f"the points do not determine {name}: its uncertainty exceeds its value"
        correlation = self.correlation
        for i, j in zip(*np.triu_indices(len(self.names), 1), strict=True):
            if abs(correlation[i, j]) > CORRELATED:
                yield (
                    f"{self.names[i]} and {self.names[j]} can hardly be told apart (correlation {correlation[i, j]:.4f}): "
                    "the points determine a combination of them"
                )


def misses_trend(residuals: Floats) -> bool:
    """Return True if neighbouring residuals are more alike than chance makes them (von Neumann 1941, Ann. Math. Stat. 12, 367).

    The ratio of the mean squared successive difference to the mean square is 2 with standard deviation 2/sqrt(n) in white noise.
    """
    n, total = len(residuals), float(np.sum(residuals**2))
    if n < 10 or total == 0.0:
        return False
    ratio = float(np.sum(np.diff(residuals) ** 2)) / total
    return (2.0 - ratio) * math.sqrt(n) / 2.0 > SERIAL
