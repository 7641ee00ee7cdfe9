"""Search for the parameters of a law that fit points best, from many starts that follow from the points."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import product
from typing import Any

import numpy as np

from stickslip.foundation.arrays import Floats
from stickslip.foundation.errors import InputError
from stickslip.friction.custom.fit_parameters import Leaf, leaves, rebuilt, slopes
from stickslip.friction.custom.measured import Points
from stickslip.friction.law import FrictionLaw

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


class _Model:
    """A law with some free parameters, and the points that they are to fit.

    The search works on logarithms of parameters that must be positive, such as slip rates.
    """

    def __init__(self, law: FrictionLaw, free: list[str], points: Points) -> None:
        known = leaves(law)
        self.law, self.free, self.points = law, free, points
        self.leaves = [known[name] for name in free]
        self.sizes = [_sizes(leaf, points) for leaf in self.leaves]
        self.logarithmic = np.array([leaf.is_scale for leaf in self.leaves], bool)
        ends = [_ends(leaf, sizes) for leaf, sizes in zip(self.leaves, self.sizes, strict=True)]
        self.bounds = self.searched([low for low, _ in ends]), self.searched([high for _, high in ends])

    def searched(self, natural: Sequence[float]) -> Floats:
        return np.log(natural, where=self.logarithmic, out=np.array(natural, float))

    def natural(self, searched: Floats) -> Floats:
        return np.exp(searched, where=self.logarithmic, out=searched.copy())

    def at(self, searched: Floats) -> FrictionLaw:
        return rebuilt(self.law, dict(zip(self.free, self.natural(searched).tolist(), strict=True)), checked=False)

    def differences(self, searched: Floats) -> Floats:
        """Return the law minus the points, shape (n,)."""
        return np.asarray(self.at(searched).coefficient(*self.points.variables)) - self.points.friction

    def jacobian(self, searched: Floats) -> Floats:
        """Return the derivatives of `differences` with respect to the searched numbers, shape (n, number of free parameters)."""
        plain = slopes(self.at(searched), self.free, *self.points.variables)
        return np.nan_to_num(plain) * np.where(self.logarithmic, self.natural(searched), 1.0)

    def solved(self, start: Floats, **options: Any) -> Any:
        from scipy.optimize import least_squares

        return least_squares(self.differences, start, self.jacobian, self.bounds, x_scale="jac", **options)


def search(law: FrictionLaw, free: list[str], points: Points, start: Mapping[str, float]) -> tuple[float, dict[str, float]]:
    """Return the smallest sum of squares that was found, and the free parameters there.

    `start` has values of some free parameters with which all searches begin; the others begin at values that follow from points.
    Raises InputError if the law is not finite at any start.
    """
    model, thin = _Model(law, free, points), _Model(law, free, _thinned(points))
    begun = [_with_linear_part(thin, one) for one in _starts(thin, start)]
    begun = sorted((one for one in begun if np.isfinite(one[0])), key=lambda one: one[0])
    if not begun:
        raise InputError(f"fit: {law.kind} is not a finite number where the search begins: give other values with start")
    best = min((thin.solved(one, xtol=1e-6, max_nfev=60) for _, one in begun[:FOLLOWED]), key=lambda found: found.cost)
    found = model.solved(np.clip(best.x, *model.bounds), xtol=1e-13, ftol=1e-13, gtol=1e-13, max_nfev=200)
    idle = ~np.any(found.jac, axis=0)  # these have no effect, and may have gone anywhere
    values = model.natural(np.where(idle, begun[0][1], found.x))
    return 2.0 * float(found.cost), dict(zip(free, values.tolist(), strict=True))


def _with_linear_part(model: _Model, searched: Floats) -> tuple[float, Floats]:
    """Return the sum of squares at a start, and the start, after one step that solves for friction coefficients and viscosities.

    Most laws are linear in these, so that they follow from slips and slip rates of the law.
    """
    linear = np.array([not leaf.is_scale and (leaf.declared.unit == "1" or leaf.optional) for leaf in model.leaves])
    with np.errstate(all="ignore"):
        before, columns = model.differences(searched), model.jacobian(searched)[:, linear]
        if linear.any() and np.isfinite(before).all() and np.isfinite(columns).all():
            improved = searched.copy()
            improved[linear] -= np.linalg.lstsq(columns, before, rcond=1e-12)[0]
            searched = np.clip(improved, *model.bounds)
        return float(np.sum(model.differences(searched) ** 2)), searched


def _thinned(points: Points) -> Points:
    every = slice(None, None, -(-len(points) // FEW))
    slip, rate = (None if one is None else one[every] for one in (points.slip, points.slip_rate))
    return Points(points.friction[every], slip, rate, points.name)


def _starts(model: _Model, given: Mapping[str, float]) -> Iterator[Floats]:
    """Yield searched numbers at which searches begin: all combinations of sizes that slips and slip rates of the law may have."""
    choices = [[given[name]] if name in given else sizes for name, sizes in zip(model.free, model.sizes, strict=True)]
    combined = list(product(*choices))
    for one in combined[:: -(-len(combined) // MOST_STARTS)]:
        yield np.clip(model.searched(one), *model.bounds)


def _ends(leaf: Leaf, sizes: Sequence[float]) -> tuple[float, float]:
    """Return the smallest and the largest value of a parameter for which a search may begin with some sizes."""
    if leaf.is_scale:
        return min(sizes) / FARTHEST, max(sizes) * FARTHEST
    least = leaf.declared.at_least
    return -np.inf if least is None else least, np.inf


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
