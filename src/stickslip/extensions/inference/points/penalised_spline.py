"""The smoothing spline of points for every strength of smoothing: its values and degrees of freedom.

The spline f on x in [0, 1] minimises mean((y - f(x))^2) + strength * integral of f''^2 (Reinsch 1967, Numer. Math. 10, 177). It is
the natural cubic spline through its own values at the places of the points, so that these are all that has to be found. One
singular value decomposition gives them for all strengths (Demmler & Reinsch 1975, Numer. Math. 24, 375).
`scipy.interpolate.make_smoothing_spline` is the same spline, but gives neither the strength that it chooses nor degrees of freedom,
and loses all digits if the curve is nearly a straight line.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from stickslip.foundation.arrays import Floats

BINS = 256
"""Points in each of this many equal parts of [0, 1] are replaced by their mean: a curve does not follow shorter features."""
WEAKEST, STRONGEST = 1e-14, 1e3
"""Range of strengths among which cross-validation chooses: from interpolation in rounding to a straight line."""
INFLATION = 1.4
"""Weight of the degrees of freedom in cross-validation; with 1 it follows noise too often (Kim & Gu 2004, J. R. Stat. Soc. B 66,
337)."""


@dataclass(frozen=True, eq=False)
class PenalisedSpline:
    """The smoothing splines of all strengths for the same points, at k ascending places in [0, 1].

    `roots` are square roots of the share of the points that each place stands for. `modes` are combinations of the values that bend
    independently of each other, one in each row; `bent` is the integral of f''^2 for each, and `data` is what the points say about
    it. `within` is the mean squared difference of the `count` points from the means that replace them.
    """

    places: Floats
    roots: Floats
    modes: Floats
    bent: Floats
    data: Floats
    within: float
    count: int

    @classmethod
    def of(cls, places: Floats, values: Floats) -> PenalisedSpline:
        """Return the splines for points with places x in [0, 1], in any order and with repetitions."""
        part = _parts(places)
        number = np.bincount(part).astype(float)
        middle, roots = np.bincount(part, places) / number, np.sqrt(number / len(places))
        second = _through(middle, np.eye(len(middle)))(middle, 2)
        root = np.sqrt(np.diff(middle))[:, None]  # f'' is straight from place to place: its squares integrate exactly
        bending = np.vstack((root * (second[1:] + second[:-1]) / 2.0, root * np.diff(second, axis=0) / math.sqrt(12.0)))
        _, sizes, modes = np.linalg.svd(bending / roots, full_matrices=False)
        sizes[-2:] = 0.0  # straight lines
        found, trend = cls(middle, roots, modes, sizes**2, modes[0], 0.0, len(places)), np.zeros_like
        for _ in range(3):  # from the second time on without the trend of points that share a place, which is no noise
            rest = values - trend(places)
            mean = np.bincount(part, rest) / number
            data, within = modes @ (roots * (mean + trend(middle))), float(np.mean((rest - mean[part]) ** 2))
            found = replace(found, data=data, within=within)
            trend = found.curve(found.cross_validated())
        return found

    def freedom(self, strength: float) -> float:
        """Return the effective number of degrees of freedom, from 2 (a straight line) to that of interpolation."""
        return float(np.sum(self._followed(strength)))

    def curve(self, strength: float) -> Any:
        """Return the spline, a function of x."""
        return _through(self.places, self.modes.T @ (self._followed(strength) * self.data) / self.roots)

    def score(self, strength: float, inflation: float = INFLATION) -> float:
        """Return the score of generalised cross-validation: the mean squared error of predicting a point that is left out."""
        followed = self._followed(strength)
        left = 1.0 - inflation * float(np.sum(followed)) / self.count
        missed = self.within + float(np.sum(((1.0 - followed) * self.data) ** 2))
        return missed / left**2 if left > 0.0 else math.inf

    def cross_validated(self, inflation: float = INFLATION) -> float:
        """Return the strength with the smallest `score`."""
        from scipy.optimize import minimize_scalar

        grid = np.linspace(np.log(WEAKEST), np.log(STRONGEST), 69)
        best = int(np.argmin([self.score(np.exp(one), inflation) for one in grid]))
        around = grid[max(best - 1, 0)], grid[min(best + 1, len(grid) - 1)]
        found = minimize_scalar(lambda one: self.score(np.exp(one), inflation), bounds=around, method="bounded")
        return float(np.exp(found.x))

    def _followed(self, strength: float) -> Floats:
        """Return the share of each combination in the points that the spline follows."""
        return np.asarray(1.0 / (1.0 + strength * self.bent))


def _parts(places: Floats) -> NDArray[np.intp]:
    """Return the part of [0, 1] that holds each place, counted over the parts that are not empty.

    Two neighbouring parts whose mean places are too close to each other, because both lie at their common end, are one.
    """
    _, part = np.unique(np.minimum(np.floor(places * BINS), BINS - 1), return_inverse=True)
    middle = np.bincount(part, places) / np.bincount(part)
    apart = np.diff(middle, prepend=-1.0) > 0.5 / BINS
    return np.asarray(np.cumsum(apart)[part] - 1)


def _through(places: Floats, values: Floats) -> Any:
    """Return the natural cubic splines through values, shape (k,) or (k, number of splines)."""
    from scipy.interpolate import CubicSpline

    return CubicSpline(places, values, bc_type="natural")
