"""Fit a law to points of both directions of slip: one law for both, or one for each if the points show that they differ."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from stickslip.extensions.inference.points.fit_one_way import EXACT_POINTS, Fit, fit_one_way
from stickslip.foundation.arrays import Floats
from stickslip.foundation.show import with_uncertainty
from stickslip.friction import LAWS, Points

DECISIVE = 10.0
"""A law for each direction is taken if its BIC is below that of one law by more than this."""


@dataclass(frozen=True, eq=False, repr=False)
class FitBothWays(Fit):
    """The result of `fit` for points of both directions of slip that differ: a law of `BothWays`, and the fit of each direction."""

    ways: tuple[Fit, Fit]

    @property
    def fitted(self) -> str:
        """What was fitted."""
        return f"{self.ways[0].law.kind}, both ways"

    def band(self, u: ArrayLike = 0.0, v: ArrayLike = 0.0) -> tuple[Floats, Floats]:
        """Return friction of the law, with the sign of the slip rate, and its standard error: see `Fit.band`."""
        slip, rate = np.broadcast_arrays(np.asarray(u, float), np.asarray(v, float))
        ahead, behind = (one.band(slip, np.abs(rate)) for one in self.ways)
        return np.where(rate < 0.0, -behind[0], ahead[0]), np.where(rate < 0.0, behind[1], ahead[1])


def fit_both_ways(points: Points, law: Any, start: Mapping[str, Any] | None, fixed: Mapping[str, Any] | None) -> Fit:
    """Fit a law to points of both directions, as `fit` does, with a note on how far the directions differ."""
    ahead, behind = (
        fit_one_way(one, law, start, fixed, way=way) for one, way in zip(points.ways, (" forwards", " backwards"), strict=True)
    )
    one = fit_one_way(_joined(ahead.points, behind.points), law, start, fixed)
    n, fits = len(one.points), (ahead, behind)
    freedom = [max(len(fit.points) - _parameters(fit), 1) for fit in fits]
    total = sum(fit.residual**2 * free for fit, free in zip(fits, freedom, strict=True))
    bic = n * math.log(max(total / n, EXACT_POINTS**2)) + (sum(map(_parameters, fits)) + 1) * math.log(n)
    residual = math.sqrt(total / sum(freedom))
    apart = ahead.law.coefficient(*one.points.variables) - behind.law.coefficient(*one.points.variables)
    sure = residual * math.sqrt(1.0 / len(ahead.points) + 1.0 / len(behind.points))
    differs = f"friction forwards is on average {with_uncertainty(float(np.mean(apart)), sure)} above that backwards"
    if one.bic - bic <= DECISIVE:
        said = f"one law for both directions, {len(ahead.points)} points forwards and {len(behind.points)} backwards: {differs}"
        return replace(one, notes=[*one.notes, f"{said}, too little to tell two laws (BIC {bic - one.bic:+.1f} with two)"])
    notes = [f"{differs}: one law for both directions has a BIC that is {one.bic - bic:.1f} higher"]
    named = [(way, fit) for way, fit in zip(("forward", "backward"), fits, strict=True)]
    return FitBothWays(
        law=LAWS["both-ways"](forward=ahead.law, backward=behind.law),
        points=replace(ahead.points, backward=behind.points),
        residual=residual,
        values={f"{way}.{name}": value for way, fit in named for name, value in fit.values.items()},
        uncertainty={f"{way}.{name}": value for way, fit in named for name, value in fit.uncertainty.items()},
        correlation=_blocks(ahead.correlation, behind.correlation),
        bic=bic,
        notes=[*notes, *(f"{way}: {note}" for way, fit in named for note in fit.notes)],
        _covariance=_blocks(ahead._covariance, behind._covariance),
        _how={f"{way}.{name}": how for way, fit in named for name, how in fit._how.items()},
        ways=fits,
    )


def _parameters(fit: Fit) -> int:
    """Return the number of parameters that a fit has taken from the points."""
    return sum(fit._how.get(name) != "fixed" for name in fit.values)


def _joined(ahead: Points, behind: Points) -> Points:
    """Return the points of both directions as points of one."""
    slip, rate = (
        None if one is None or other is None else np.concatenate((one, other))
        for one, other in ((ahead.slip, behind.slip), (ahead.slip_rate, behind.slip_rate))
    )
    return replace(ahead, friction=np.concatenate((ahead.friction, behind.friction)), slip=slip, slip_rate=rate)


def _blocks(one: Floats, other: Floats) -> Floats:
    """Return a matrix with two matrices along its diagonal."""
    found = np.zeros((len(one) + len(other), len(one) + len(other)))
    found[: len(one), : len(one)], found[len(one) :, len(one) :] = one, other
    return found
