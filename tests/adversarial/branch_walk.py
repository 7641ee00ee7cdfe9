"""Truth for a massless slab under a law of slip rate: the contact equation followed along its branches on a fine grid.

Under a load that rises (falls) steadily, perfect delay takes the first rate above (below) the present one at which Z v + S mu(v)
reaches the load: the running maximum (minimum) of the resistance, turned round.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq, minimize_scalar

Floats = NDArray[np.float64]
Resistance = Callable[[float], float]
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(12)


def fine_grid(top: float, centres: Sequence[float], details: Sequence[float], per_detail: int = 12) -> Floats:
    """Rates from 0 to `top` (m/s) that resolve features at centres, of given size of their details."""
    parts = [np.linspace(0.0, top, 1500)]
    for centre, detail in zip(centres, details, strict=True):
        near = np.arange(-45 * per_detail, 45 * per_detail + 1) / per_detail
        far = np.geomspace(45.0, max(top / detail, 46.0), 400)
        parts += [centre + detail * near, centre + detail * far, centre - detail * far]
    grid = np.unique(np.concatenate(parts))
    return grid[(grid >= 0.0) & (grid <= top)]


@dataclass(frozen=True)
class Branch:
    """Rates from `begin` to `end` along which the resistance goes the way of the load."""

    begin: float
    end: float


@dataclass(frozen=True)
class RateTruth:
    """Slip and slip rate under load(t) = start + ramp t, all of it minus the static strength, up to `flat` s and constant after."""

    g: Resistance
    start: float
    ramp: float
    flat: float
    grid: Floats
    branches: tuple[Branch, ...]
    arrest: float | None
    """Time of the fold off which the contact comes to rest, s."""

    def _time(self, rate: float) -> float:
        return (self.g(rate) - self.start) / self.ramp

    def slip_and_rate(self, times: Sequence[float]) -> tuple[Floats, Floats]:
        """Slip (m) and slip rate (m/s) at ascending times."""
        slips, rates = [], []
        for time in times:
            t = min(time, self.flat)
            slip, rate = self._until(t)
            slips.append(slip + rate * (time - t))
            rates.append(rate)
        return np.array(slips), np.array(rates)

    def _until(self, t: float) -> tuple[float, float]:
        if self.ramp == 0.0:
            return self.branches[0].begin * t, self.branches[0].begin
        slip, since = 0.0, 0.0
        for branch in self.branches:
            over = self._time(branch.end)
            if over >= t:
                rate = self._rate_on(branch, t)
                return slip + self._integral(branch.begin, rate, since, t), rate
            slip += self._integral(branch.begin, branch.end, since, over)
            since = over
        return slip, 0.0

    def _rate_on(self, branch: Branch, t: float) -> float:
        def missing(rate: float) -> float:
            return self._time(rate) - t

        if missing(branch.begin) >= 0.0:
            return branch.begin
        if missing(branch.end) <= 0.0:
            return branch.end
        return float(brentq(missing, branch.begin, branch.end, xtol=1e-300, rtol=1e-15, maxiter=500))

    def _integral(self, begin: float, end: float, since: float, until: float) -> float:
        """Integral of v dt along a branch, by parts: v t - integral of t dv."""
        low, high = min(begin, end), max(begin, end)
        inside = self.grid[(self.grid > low) & (self.grid < high)]
        edges = np.concatenate(([low], inside, [high]))
        width, middle = 0.5 * np.diff(edges), 0.5 * (edges[1:] + edges[:-1])
        places = middle[:, None] + width[:, None] * _NODES
        held = np.array([self._time(v) for v in places.ravel()]).reshape(places.shape) - since
        area = float(((held * _WEIGHTS).sum(axis=1) * width).sum()) * (1.0 if end >= begin else -1.0)
        return end * (until - since) - area


def follow(g: Resistance, start: float, ramp: float, until: float, flat: float, grid: Floats) -> RateTruth:
    """The branches taken under a load that begins at `start` > 0 above the strength: g(0) is 0."""
    values = np.array([g(v) for v in grid.tolist()])
    first = int(np.argmax(values >= start))
    if values[first] < start:
        raise ValueError("the grid ends below the load")
    rate = float(brentq(lambda v: g(v) - start, grid[max(first - 1, 0)], grid[first], xtol=1e-300, rtol=1e-15))
    last = start + ramp * min(until, flat)
    if ramp == 0.0:
        return RateTruth(g, start, 0.0, flat, grid, (Branch(rate, rate),), None)
    sign = 1.0 if ramp > 0.0 else -1.0
    ahead = grid[grid > rate] if ramp > 0.0 else grid[grid < rate][::-1]
    branches, arrest = _branches(g, rate, ahead, last, sign)
    time = None if arrest is None else (arrest - start) / ramp
    return RateTruth(g, start, ramp, flat, grid, branches, time)


def _branches(g: Resistance, rate: float, ahead: Floats, last: float, sign: float) -> tuple[tuple[Branch, ...], float | None]:
    """Stretches from `rate` on where sign g reaches new heights, to the load `last`; and the load at which slip ends, or None."""
    found, begin, height, before = [], rate, sign * g(rate), rate
    falling = False
    points = [rate, *ahead.tolist()]
    for i, v in enumerate(points[1:], start=1):
        value = sign * g(v)
        if not falling and value < height:
            top = _top(g, sign, points[max(i - 2, 0)], v)
            found.append(Branch(begin, top))
            height, falling = sign * g(top), True
        elif falling and value >= height:
            begin = float(brentq(lambda x, h=height: sign * g(x) - h, before, v, xtol=1e-300, rtol=1e-15))
            falling = False
        if not falling:
            height = max(height, value)
            if value > sign * last:
                return (*found, Branch(begin, v)), None
        before = v
    if falling:
        return tuple(found), sign * height
    found.append(Branch(begin, points[-1]))
    return tuple(found), (sign * height if sign < 0 else None)


def _top(g: Resistance, sign: float, low: float, high: float) -> float:
    """The rate between two at which sign g is largest."""
    low, high = min(low, high), max(low, high)
    found = minimize_scalar(lambda v: -sign * g(v), bounds=(low, high), method="bounded", options={"xatol": 1e-12 * high})
    return max((low, float(found.x), high), key=lambda v: sign * g(v))
