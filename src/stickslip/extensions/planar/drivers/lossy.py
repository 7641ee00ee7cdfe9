"""A driver of finite impedance: a half-space beyond a planar slab."""

from __future__ import annotations

import numpy as np

from stickslip.extensions.planar.asked import PlanarDriver
from stickslip.foundation.arrays import Floats
from stickslip.problem import LoadingHistory, Problem


class _PlanarLossyDriver(PlanarDriver):
    def reflects_at_first(self, problem: Problem) -> bool:
        return True

    def entering(self, problem: Problem, sent: Floats) -> Floats:
        body, far, pulled = problem.body, problem.far_stress, problem.pull_rate_at(np.maximum(sent, 0.0))
        stress = far.at(np.maximum(sent, 0.0)) if isinstance(far, LoadingHistory) else problem.load if far is None else far
        stress = stress + problem.far_stress_rate * sent
        share = 2.0 * body.impedance / (body.impedance + body.driver_impedance)
        return np.asarray(share * (body.driver_impedance * pulled + stress), float)

    def impedance(self, problem: Problem) -> float:
        return problem.body.driver_impedance

    def damping(self, problem: Problem) -> float:
        return problem.body.driver_impedance


ANSWERS = _PlanarLossyDriver()
