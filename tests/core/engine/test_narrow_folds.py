"""A run meets the folds of a feature that is too narrow for a grid of slip rates."""

from __future__ import annotations

import math

import numpy as np
import pytest

import stickslip as ss

Z, S = 9.8e6, 1e8
HEIGHT, START, LOADING = 0.05, 55e6, 2e6


@pytest.mark.parametrize("width", [1e-2, 1e-4])
def test_the_load_carries_the_contact_over_a_bump_and_the_rate_jumps(width):
    """The load rises past the fold on the near side of the bump at 1 m/s; the grid finds that of the wide bump only."""
    law = ss.friction.FromExpression(f"0.5 + {HEIGHT}*exp(-((v-1)/w)**2)", {"w": width})
    slab = ss.ElasticSlab(2800.0, 3500.0, 1e4, S, driver_impedance=Z)
    run = ss.simulate(ss.Problem(slab, law, initial_load=START, far_stress=START, far_stress_rate=LOADING), 12.0)
    x = Z * width / (2.0 * S * HEIGHT)
    for _ in range(50):
        x = Z * width / (2.0 * S * HEIGHT) * math.exp(x * x)
    fold, load = 1.0 + width * x, Z * (1.0 + width * x) + S * (0.5 + HEIGHT * math.exp(-x * x))
    (jump,) = run.shocks[run.shocks.cause == "fold"].itertuples()
    assert jump.rate_before == pytest.approx(fold, rel=1e-6, abs=0)  # the load passes the fold: the rate there goes as its root
    assert jump.rate_after == pytest.approx((load - 0.5 * S) / Z, rel=1e-11, abs=0)
    assert jump.time == pytest.approx(slab.thickness / slab.wave_speed + (load - START) / LOADING, rel=1e-11, abs=0)


def test_rising_load_reaches_a_fold_in_one_step() -> None:
    """The last step before the jump spans 0.05 s; steps in time itself would halve 40 times on the way."""
    law = ss.friction.FromExpression("0.6 + 0.1*exp(-((v - 1)/0.3)**2)")
    run = ss.simulate(ss.Problem(ss.ElasticSlab(2e3, 1e3, 1e3, 1e8), law, pull_rate=2.0, initial_excess=0.0), 4.0)
    (jump,) = run.shocks[run.shocks.cause == "fold"].itertuples()
    store = run.history.store
    before = int(np.searchsorted(run.history.start, jump.time)) - 1
    assert store.bend[before] < 0.0
    assert jump.time - run.history.start[before] > 0.01
    assert before < 60
    slowness = 2e6 / (1e8 * 0.1) * 0.3 / 2.0  # at the fold x exp(-x^2) is this, with v = 1 + 0.3 x
    x = slowness
    for _ in range(50):
        x = slowness * math.exp(x * x)
    assert jump.rate_before == pytest.approx(1.0 + 0.3 * x, rel=1e-7, abs=0)
