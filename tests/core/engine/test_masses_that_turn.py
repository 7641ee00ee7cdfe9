"""Masses under rate and state that are pulled to and fro: they turn, and a slip rate of 1e-40 m/s has all of friction."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import stickslip as ss
from stickslip.friction.laws.rate_and_state import TwoStateRateAndState

F = ss.friction


def drawn(seed: int) -> tuple[ss.Problem, float]:
    """A random block under rate and state or flash heating, pulled to and fro by 0.5 to 16 times what loads it up."""
    rng = np.random.default_rng([99, seed])
    mu, a = float(rng.uniform(0.3, 0.8)), float(rng.uniform(0.003, 0.02))
    b, distance = float(a * rng.uniform(0.5, 2)), float(10 ** rng.uniform(-5, -1))
    kind, rate = rng.choice(["one", "two", "flash"]), float(10 ** rng.uniform(-7, -3))
    law: Any
    if kind == "one":
        law = F.RateAndState(mu, a, b, distance, rate=rate, evolution=str(rng.choice(["ageing", "slip"])))
    elif kind == "two":
        second = float(b * rng.uniform(-0.5, 0.5))
        law = TwoStateRateAndState(mu, a=a, b=b, distance=distance, second_b=second, second_distance=5.0 * distance, rate=rate)
    else:
        law = F.FlashHeating(mu, a, b, distance, rate, 0.3 * mu, float(10 ** rng.uniform(-2, -0.3)))
    mass, stiffness, normal = (float(10 ** rng.uniform(*ends)) for ends in ((-1, 2), (0, 3), (0, 2)))
    body = (ss.SpringBlock if rng.random() < 0.7 else ss.RotatingBlock)(mass, stiffness, normal)
    way = float(normal * mu / stiffness * 10 ** rng.uniform(-0.3, 1.2))
    period = float(np.sqrt(mass / stiffness) * 10 ** rng.uniform(0.3, 2))
    fastest = 2.0 * np.pi * way / period
    pull = ss.loading.Sinusoidal(mean=float(fastest * rng.choice([0, 0, 0.3])), amplitude=fastest, period=period)
    return ss.Problem(body, law, pull_rate=pull, initial_rate=float(way / period * 10 ** rng.uniform(-2, 0))), 3.0 * period


@pytest.mark.sampled(every=8)
@pytest.mark.parametrize("seed", [1, 2, 4, 12, 14, 36, 42, 51])
def test_a_mass_that_is_pulled_to_and_fro_turns_every_time(seed: int) -> None:
    """Slip to 1e-9 of its range, to rtol 1e-11; the contact misses 1e-3 of the normal load. All of these ended in event storms."""
    problem, duration = drawn(seed)
    run, fine = ss.simulate(problem, duration, 1e-8), ss.simulate(problem, duration, 1e-11)
    assert run.status.ok
    assert fine.status.ok
    times = np.linspace(0.0, duration, 501)
    assert np.abs(run.slip(times) - fine.slip(times)).max() < 1e-9 * np.ptp(fine.slip(times))
    assert run.proven.unproven == 0
    assert run.proven.relative < 1e-3
