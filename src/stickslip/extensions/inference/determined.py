"""What measured points determine of the parameters that were fitted to them, and what they leave open."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping

import numpy as np

from stickslip.foundation.arrays import Floats

UNSEEN_CHANGE = 1e-9
"""Points do not see a combination of parameters that changes friction by less than this share of the largest change."""
PART = 0.05
"""A parameter is part of an unseen combination (of length 1) if its component is larger than this."""
CORRELATED = 0.99
"""The points hardly distinguish two parameters with a larger correlation than this."""
SERIAL = 5.0
"""Neighbouring residuals may be more alike than by chance by this many standard deviations."""


def covariance_of(slopes_by: Floats, variance: float, unseen_below: float = UNSEEN_CHANGE) -> tuple[Floats, list[list[int]]]:
    """Return the covariance of parameters, and the sets of those that the points do not determine, by their indices.

    `slopes_by` are the derivatives at the best fit, shape (n, number of parameters), and `variance` is that of the points about it.
    A combination whose effect is less than the share `unseen_below` of the largest counts as without effect. The covariance of a
    parameter in such a set is NaN.
    """
    from scipy.linalg import null_space

    sizes = np.linalg.norm(slopes_by, axis=0)
    seen = np.flatnonzero(sizes > unseen_below**2 * sizes.max(initial=0.0))
    upper = np.linalg.qr(slopes_by[:, seen] / sizes[seen], mode="r")
    inverse = np.linalg.pinv(upper, rcond=unseen_below) / sizes[seen, None]
    unseen = [[i] for i in range(len(sizes)) if i not in seen]
    unseen += [seen[np.abs(row) > PART].tolist() for row in null_space(upper, rcond=unseen_below).T]
    covariance = np.full((len(sizes), len(sizes)), np.nan)
    covariance[np.ix_(seen, seen)] = variance * inverse @ inverse.T
    unknown = sorted({i for part in unseen for i in part})
    covariance[unknown] = covariance[:, unknown] = np.nan
    return covariance, unseen


def sizes_and_correlation(covariance: Floats) -> tuple[Floats, Floats]:
    """Return the standard uncertainties, infinite for parameters that are not determined, and the correlations."""
    with np.errstate(invalid="ignore", divide="ignore"):
        sizes = np.sqrt(np.diag(covariance))
        return np.where(np.isnan(sizes), np.inf, sizes), np.asarray(covariance / np.outer(sizes, sizes))


def undetermined(
    values: Mapping[str, float], uncertainty: Mapping[str, float], correlation: Floats, unseen: list[list[str]]
) -> Iterator[str]:
    """Yield a sentence on each set of parameters that the points do not determine, or hardly."""
    for part in unseen:
        if len(part) == 1:
            yield f"the points do not determine {part[0]}: any value fits alike; choose it and fix it"
        else:
            yield f"the points do not determine {', '.join(part[:-1])} and {part[-1]} separately: fix one of them"
    for name, size in uncertainty.items():
        if np.isfinite(size) and size > abs(values[name]) > 0.0:
            yield f"the points do not determine {name}: its uncertainty exceeds its value"
    names = list(uncertainty)
    for i, j in np.argwhere(np.abs(np.triu(correlation, 1)) > CORRELATED).tolist():
        yield (
            f"{names[i]} and {names[j]} can hardly be told apart (correlation {correlation[i, j]:.4f}): "
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
