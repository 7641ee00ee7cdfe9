"""Search for the parameters of a law that fit points best, from many starts that follow from the points."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import product

import numpy as np
from numpy.typing import NDArray

from stickslip.friction.custom.fit_parameters import Leaf, leaves, rebuilt, slopes
from stickslip.friction.custom.measured import Points
from stickslip.friction.law import FrictionLaw

Floats = NDArray[np.float64]

PER_SCALE = 9
"""Number of starts along a slip or a slip rate of the law, evenly spaced in the logarithm over the points and a factor 3 beyond."""
MOST_WAVES = 100
"""Largest number of half waves in the range of the points with which a search begins."""
MOST_STARTS = 600
"""Largest number of starts; of more, every second, third and so on is taken."""
FARTHEST = 1e6
"""Factor by which a slip or a slip rate of the law may lie beyond all starts; farther out it has no effect on the points."""
FOLLOWED = 4
"""Number of starts, the best ones, from which the search is carried to its end."""
FEW = 2000
"""Number of points with which starts are compared."""
WHOLE = (1.0, 2.0, 3.0, 4.0)
"""Exponents that are tried."""


@dataclass(frozen=True)
class Model:
    """A law with some free parameters, and the points that they are to fit.

    The search works on logarithms of parameters that must be positive, such as slip rates.
    """

    law: FrictionLaw
    free: list[str]
    points: Points

    @cached_property
    def known(self) -> dict[str, Leaf]:
        """All parameters of the law."""
        return leaves(self.law)

    @cached_property
    def logarithmic(self) -> NDArray[np.bool_]:
        """Whether the search works on the logarithm of each free parameter."""
        return np.array([self.known[name].is_scale for name in self.free], bool)

    def bounds(self) -> tuple[Floats, Floats]:
        """Return the smallest and the largest values of the searched numbers."""
        low, high = np.full(len(self.free), -np.inf), np.full(len(self.free), np.inf)
        for i, (name, log) in enumerate(zip(self.free, self.logarithmic, strict=True)):
            sizes, least = _sizes(self.known[name], self.points), self.known[name].declared.at_least
            if log:
                low[i], high[i] = math.log(min(sizes) / FARTHEST), math.log(max(sizes) * FARTHEST)
            elif least is not None:
                low[i] = least
        return low, high

    def values(self, searched: Floats) -> dict[str, float]:
        """Return the parameters by name from the searched numbers."""
        natural = np.where(self.logarithmic, np.exp(np.where(self.logarithmic, searched, 0.0)), searched)
        return dict(zip(self.free, natural.tolist(), strict=True))

    def searched(self, values: Mapping[str, float]) -> Floats:
        """Return the searched numbers from parameters by name."""
        return np.array(
            [math.log(values[name]) if log else values[name] for name, log in zip(self.free, self.logarithmic, strict=True)]
        )

    def at(self, searched: Floats) -> FrictionLaw:
        """Return the law, unchecked, at searched numbers."""
        return rebuilt(self.law, self.values(searched), checked=False)

    def differences(self, searched: Floats) -> Floats:
        """Return the law minus the points, shape (n,)."""
        return np.asarray(self.at(searched).coefficient(*self.points.variables)) - self.points.friction

    def jacobian(self, searched: Floats) -> Floats:
        """Return the derivatives of `differences` with respect to the searched numbers, shape (n, number of free parameters)."""
        plain = slopes(self.at(searched), self.free, *self.points.variables)
        return np.nan_to_num(plain) * np.where(self.logarithmic, list(self.values(searched).values()), 1.0)


def search(model: Model, start: Mapping[str, float]) -> tuple[float, dict[str, float]]:
    """Return the smallest sum of squares that was found, and the parameters there.

    `start` has values of some free parameters with which all searches begin; the others begin at values that follow from points.
    """
    from scipy.optimize import least_squares

    thin = _thinned(model)
    begun = [_with_linear_part(thin, one) for one in starts(thin, start)]
    begun = sorted((one for one in begun if np.isfinite(one[0])), key=lambda one: one[0])
    best: tuple[float, Floats] = (math.inf, model.searched({name: leaf.value for name, leaf in model.known.items()}))
    for _, one in begun[:FOLLOWED]:
        found = least_squares(thin.differences, one, thin.jacobian, thin.bounds(), x_scale="jac", xtol=1e-6, max_nfev=60)
        if found.cost < best[0]:
            best = found.cost, found.x
    tight = {"xtol": 1e-13, "ftol": 1e-13, "gtol": 1e-13, "max_nfev": 200}
    found = least_squares(model.differences, best[1], model.jacobian, model.bounds(), x_scale="jac", **tight)
    idle = ~np.any(found.jac, axis=0)  # these have no effect, and may have gone anywhere
    return 2.0 * float(found.cost), model.values(np.where(idle, begun[0][1], found.x))


def _with_linear_part(model: Model, searched: Floats) -> tuple[float, Floats]:
    """Return the sum of squares at a start, and the start, after one step that solves for friction coefficients and viscosities.

    Most laws are linear in these, so that they follow from slips and slip rates of the law.
    """
    low, high = model.bounds()
    known = [model.known[name] for name in model.free]
    linear = np.array([not leaf.is_scale and (leaf.declared.unit == "1" or leaf.optional) for leaf in known])
    with np.errstate(all="ignore"):
        before, columns = model.differences(searched), model.jacobian(searched)[:, linear]
        if linear.any() and np.isfinite(before).all() and np.isfinite(columns).all():
            improved = searched.copy()
            improved[linear] -= np.linalg.lstsq(columns, before, rcond=1e-12)[0]
            searched = np.clip(improved, low, high)
        return float(np.sum(model.differences(searched) ** 2)), searched


def _thinned(model: Model) -> Model:
    points = model.points
    if len(points) <= FEW:
        return model
    every = slice(None, None, -(-len(points) // FEW))
    slip, rate = (None if one is None else one[every] for one in (points.slip, points.slip_rate))
    return Model(model.law, model.free, Points(points.friction[every], slip, rate, points.name))


def starts(model: Model, given: Mapping[str, float]) -> Iterator[Floats]:
    """Yield searched numbers at which searches begin: all combinations of sizes that slips and slip rates of the law may have."""
    choices = [[given[name]] if name in given else _sizes(model.known[name], model.points) for name in model.free]
    combined = list(product(*choices))
    low, high = model.bounds()
    for one in combined[:: -(-len(combined) // MOST_STARTS)]:
        yield np.clip(model.searched(dict(zip(model.free, one, strict=True))), low, high)


def _sizes(leaf: Leaf, points: Points) -> Sequence[float]:
    """Return values at which a search for a parameter may begin, by its unit."""
    slip, rate = points.variables
    unit = leaf.declared.unit
    if unit == "1":
        return [float(points.friction.max()) if leaf.declared.meaning else leaf.value]
    if unit == "m":
        reach = float(np.ptp(slip)) or 1.0
        return np.geomspace(reach / 30.0, 3.0 * reach, PER_SCALE).tolist() if leaf.is_scale else [0.0, 0.1 * reach, 0.3 * reach]
    if unit in ("1/m", "m^-1"):
        waves = np.arange(1.0, 1.0 + min(MOST_WAVES, len(points) // 2))
        return list(np.pi / (float(np.ptp(slip)) or 1.0) * waves)
    if unit in ("m/s", "m s^-1", "s/m", "m^-1 s") and leaf.is_scale:
        moving = rate[rate > 0.0]
        slowest, fastest = (float(moving.min()), float(moving.max())) if len(moving) else (1.0, 1.0)
        sizes = np.geomspace(max(slowest, 1e-9 * fastest) / 3.0, 3.0 * fastest, PER_SCALE)
        return list(sizes if unit in ("m/s", "m s^-1") else 1.0 / sizes)
    return [0.0 if leaf.optional else leaf.value]
