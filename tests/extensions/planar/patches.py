"""A patch of contact on which slip begins, shared by the tests of planar slabs."""

from __future__ import annotations

from typing import Any

import numpy as np

import stickslip as ss

SLAB = ss.ElasticSlab(2800.0, 3500.0, 1e4, 1e8)
LAW = ss.friction.LinearSlipWeakening(static=0.7, dynamic=0.5, distance=0.4)


def patch(**grid: Any) -> ss.PlanarSlab:
    """A contact of 18 km length with a nucleus of 8 km in the middle, in which the load exceeds the strength."""

    def load(*at: np.ndarray) -> np.ndarray:
        return np.where(np.hypot(at[0], at[-1] if len(at) > 1 else 0.0) < 4e3, 71e6, 60e6)

    problem = ss.Problem(SLAB, LAW, initial_load=60e6)
    return ss.PlanarSlab(problem, along={"load": load}, barrier=lambda y, *_: np.abs(y) > 9e3, **grid)


def state_patch(distance: float = 1e-2) -> ss.PlanarSlab:
    """A contact of 20 km under rate-and-state friction with a nucleus of 8 km."""
    law = ss.friction.RateAndState(reference=0.6, a=0.01, b=0.015, distance=distance)
    problem = ss.Problem(SLAB, law, pull_rate=1e-3, initial_load=63e6, initial_state=1.0)
    return ss.PlanarSlab(problem, nodes=32, length=2e4, along={"load": lambda y: np.where(np.abs(y) < 4e3, 70e6, 60e6)})
