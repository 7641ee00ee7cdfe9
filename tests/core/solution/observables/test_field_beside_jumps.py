"""Both limits of the field at the contact, at moments when the slip rate jumps or bends, are those of the contact itself."""

from __future__ import annotations

from typing import Literal

import numpy as np
import pytest

import stickslip as ss

SLAB = ss.ElasticSlab(2800.0, 3500.0, 1e4, 1e8)
CREEPING = ss.Problem(
    SLAB, ss.friction.RateAndState(0.01, 0.015, 0.05, 0.6, 1e-6), pull_rate=0.3, initial_load=65e6, initial_state=1e4
)
JUMPING = ss.Problem(SLAB, ss.friction.HyperbolicRate(0.8, 0.3, 1.0), pull_rate=0.1, initial_excess=0.0)


@pytest.mark.sampled(every=2)
@pytest.mark.parametrize("side", ["left", "right"])
@pytest.mark.parametrize("problem", [CREEPING, JUMPING])
def test_limits_at_the_contact_are_those_of_the_run(problem: ss.Problem, side: Literal["left", "right"]) -> None:
    run = ss.simulate(problem, 60.0)
    breaks = run.history.breaks
    chosen = np.append(breaks[:: max(len(breaks) // 40, 1)], 50.0)
    alone = [run.field(0.0, float(t), side=side) for t in chosen]  # each is the first and the last moment of its own evaluation
    np.testing.assert_allclose([float(one.velocity) for one in alone], run.slip_rate(chosen, side=side), atol=1e-9)
    np.testing.assert_allclose([float(one.stress) for one in alone], run.traction(chosen, side=side), rtol=1e-9, atol=1e-3)
    together = run.field(0.0, chosen, side=side)
    np.testing.assert_allclose(together.velocity, run.slip_rate(chosen, side=side), atol=1e-9)
