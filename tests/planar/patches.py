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
