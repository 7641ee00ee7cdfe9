"""A sweep tells which of its members friction would drive."""

from __future__ import annotations

import math

import numpy as np

import stickslip as ss
from stickslip.extensions.sweeps.execution.chunk import MEANINGS

SLAB = ss.ElasticSlab(2800.0, 3500.0, 1e4, 1e8)


def dipping(amplitude: float, width: float, depth: float) -> tuple[ss.friction.FrictionLaw, float]:
    """Return a law that falls `depth` of its amplitude below zero, and the path (m) at which it is zero for the first time."""
    mean = amplitude * (1.0 - depth)
    law = ss.friction.FromExpression("m + a*sin(u/w)", {"m": mean, "a": amplitude, "w": width}, counts="path")
    return law, width * (math.pi + math.asin(mean / amplitude))


def test_a_sweep_tells_which_members_friction_would_drive() -> None:
    law, _ = dipping(0.3, 5.0, 1e-3)
    means = np.array([0.3 * (1.0 - 1e-3), 0.3 * (1.0 + 1e-3)])
    problem = ss.Problem(SLAB, law, initial_excess=1e8)
    found = ss.sweep(problem, {"m": means}, duration=60.0)
    assert [MEANINGS[code] for code in found["status"].values.tolist()] == ["negative_friction", "locked_for_ever"]
