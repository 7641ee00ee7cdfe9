"""A rigid driver of a planar slab."""

from __future__ import annotations

import math

import numpy as np

from stickslip.extensions.planar.asked import PlanarDriver
from stickslip.foundation.arrays import Floats
from stickslip.problem import LoadingHistory, Problem


class _PlanarRigidDriver(PlanarDriver):
    def reflects_at_first(self, problem: Problem) -> bool:
        return isinstance(problem.pull_rate, LoadingHistory)

    def entering(self, problem: Problem, sent: Floats) -> Floats:
        return np.asarray(2.0 * problem.body.impedance * problem.pull_rate_at(np.maximum(sent, 0.0)), float)

    def impedance(self, problem: Problem) -> float:
        return math.inf

    def damping(self, problem: Problem) -> float:
        return 0.0  # it moves as it is pulled


ANSWERS = _PlanarRigidDriver()
