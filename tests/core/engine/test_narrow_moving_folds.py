"""A narrow ridge of friction that moves with slip, under perfect delay, against roots in closed form.

Friction is 0.6 - 0.02 u + 0.03 exp(-x**2) with x = (v - 0.7 - 0.04 u) / w, under a slab whose driver sends no echoes back, so that
the load is constant and the slip rate a function of slip alone. Without the ridge it is v = (load + 0.02 S u) / Z.
"""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest
from scipy.optimize import brentq

import stickslip as ss

Z, S, EXCESS, DURATION = 2800.0 * 3500.0, 1e8, 4e6, 6.0
WIDTHS = [1e-2, 1e-3, 1e-4]


def ridge(u: float) -> float:
    """Slip rate of the ridge's crest, m/s."""
    return 0.7 + 0.04 * u


def plain(u: float) -> float:
    """Slip rate without the ridge, m/s."""
    return (EXCESS + 0.02 * S * u) / Z


def miss(u: float, x: float, w: float) -> float:
    """g - load (Pa) at x widths from the crest."""
    return Z * (ridge(u) + w * x - plain(u)) + 0.03 * S * math.exp(-x * x)


def left_root(u: float, w: float) -> float:
    """The smallest root, m/s; NaN if it is gone. Beyond 20 widths the ridge adds nothing that a float shows."""
    if plain(u) < ridge(u) - 20.0 * w:
        return plain(u)
    crest = brentq(lambda x: Z * w - 0.06 * S * x * math.exp(-x * x), 0.0, math.sqrt(0.5), xtol=1e-15)
    if miss(u, crest, w) <= 0.0:
        return ridge(u) + w * crest if miss(u, crest, w) > -1e-3 else math.nan  # Pa: rounding of the slip at which it goes
    return ridge(u) + w * float(brentq(lambda x: miss(u, x, w), -25.0, crest, xtol=1e-15, rtol=1e-15))


def right_root(u: float, w: float) -> float:
    """The largest root beyond the crest, m/s; NaN if there is none."""
    foot = brentq(lambda x: Z * w - 0.06 * S * x * math.exp(-x * x), math.sqrt(0.5), 30.0, xtol=1e-14)
    if miss(u, foot, w) > 0.0:
        return math.nan
    top = max(20.0, (plain(u) - ridge(u)) / w + 1.0)
    return ridge(u) + w * float(brentq(lambda x: miss(u, x, w), foot, top, xtol=1e-15, rtol=1e-15))


def leaves_at(w: float) -> float:
    """Slip (m) at which the smallest root ends."""

    def fold(u: float) -> float:
        x = brentq(lambda x: Z * w - 0.06 * S * x * math.exp(-x * x), 0.0, math.sqrt(0.5), xtol=1e-15)
        return miss(u, x, w)

    return float(brentq(fold, 1.5, 5.0, xtol=1e-15, rtol=1e-15))


def time_to(u: float, w: float, jump: float) -> float:
    """Time (s) in which the contact slips so far, from 1 / v by Gauss's rule on panels that narrow where the ridge is met."""
    met = 1.5 / 0.82  # plain(u) = ridge(u) to a few per cent; the edges below are dense around the true place
    met = float(brentq(lambda s: plain(s) - ridge(s), 0.5 * met, 2.0 * met))
    near = np.concatenate(([0.0], np.geomspace(1e-4 * w, 4.0, 400)))
    edges = np.unique(
        np.clip(np.concatenate((met - near, met + near, met - 125.0 * w + near, [jump - 1e-15, jump, u, 0.0])), 0.0, u)
    )
    nodes, weights = np.polynomial.legendre.leggauss(8)
    whole = 0.0
    for low, high in pairwise(edges.tolist()):
        root = left_root if high <= jump else right_root
        half = 0.5 * (high - low)
        whole += half * sum(k / root(low + half * (1.0 + x), w) for x, k in zip(nodes, weights, strict=True))
    return float(whole)


@pytest.mark.sampled(every=3)
@pytest.mark.parametrize("w", WIDTHS[::-1])
def test_perfect_delay_follows_folds_that_move(w: float) -> None:
    """The time of the slip after 6 s to 5e-8; the slip of the jump to 1e-6."""
    law = ss.friction.FromExpression(f"0.6 - 0.02*u + 0.03*exp(-((v - 0.7 - 0.04*u)/{w})**2)")
    slab = ss.ElasticSlab(2800.0, 3500.0, 1e4, S, driver_impedance=Z)
    run = ss.simulate(ss.Problem(slab, law, initial_excess=EXCESS), DURATION)
    assert run.status.name == "finished"
    assert list(run.shocks.cause) == ["start", "fold"]
    jump = leaves_at(w)
    assert float(run.slip(run.shocks.time[1])) == pytest.approx(jump, rel=1e-6, abs=0.0)
    assert time_to(float(run.slip(DURATION)), w, jump) == pytest.approx(DURATION, rel=5e-8, abs=0.0)
