"""A double-direct-shear record, integrated by LSODA: steps of a servo, a trend, a normal load that wobbles."""

from __future__ import annotations

import math
from functools import cache
from itertools import pairwise
from typing import Any

import numpy as np
from scipy.integrate import solve_ivp

import stickslip as ss
from tests.problems import Floats

NORMAL, MASS, STIFFNESS, A, B, DISTANCE, REFERENCE = 5e4, 20.0, 1.5e8, 0.009, 0.0125, 15e-6, 0.62
RATE, TREND, SERVO, WOBBLE = 1e-6, -2.0, 0.08, 1e-4
TIMES, RATES = (0.0, 30.03, 55.07, 80.02, 105.06, 130.09), (1e-5, 3e-5, 1e-5, 3e-5, 1e-5, 3e-5)
CLOCK = np.linspace(0.0, 149.99, 15_000)
TRUTH = {
    "friction.a": A,
    "friction.b": B,
    "friction.distance": DISTANCE,
    "body.stiffness": STIFFNESS,
    "friction.reference": REFERENCE,
    "record.trend": TREND,
    "record.servo": SERVO,
}
GUESS = ss.Problem(ss.SpringBlock(MASS, 1.3e8, NORMAL), ss.friction.RateAndState(0.6, 0.01, 0.013, 1.2e-5), pull_rate=1e-5)


def normal(time: Any) -> Any:
    return NORMAL * (1.0 + WOBBLE * np.sin(2.0 * np.pi * time / 1.7))


def pull(time: float) -> float:
    """The rate of the load point, which approaches each new value as exp(-t/SERVO)."""
    changes = zip(TIMES[1:], pairwise(RATES), strict=True)
    return RATES[0] - sum((after - before) * math.expm1(-max(time - at, 0.0) / SERVO) for at, (before, after) in changes)


def moved(time: Any) -> Any:
    found = RATES[0] * time
    for at, (before, after) in zip(TIMES[1:], pairwise(RATES), strict=True):
        since = np.maximum(time - at, 0.0)
        found = found + (after - before) * (since + SERVO * np.expm1(-since / SERVO))
    return found


@cache
def spring() -> Floats:
    """Return the spring force at the times of the clock: m dv/dt = F - N mu, dF/dt = K (V - v), the ageing law."""

    def mu(log_rate: float, log_state: float) -> float:
        exponent = (REFERENCE + B * (math.log(RATE / DISTANCE) + log_state)) / A
        return A * math.asinh(math.exp(log_rate + exponent) / (2.0 * RATE))

    def change(time: float, y: Floats) -> list[float]:
        force, log_rate, log_state, slip = y.tolist()
        rate = math.exp(log_rate)
        net = force - normal(time) * (mu(log_rate, log_state) + TREND * slip)
        return [STIFFNESS * (pull(time) - rate), net / (MASS * rate), math.exp(-log_state) - rate / DISTANCE, rate]

    state = np.array(
        [NORMAL * (REFERENCE + (A - B) * math.log(RATES[0] / RATE)), math.log(RATES[0]), math.log(DISTANCE / RATES[0]), 0.0]
    )
    found = []
    for begin, end in pairwise((*TIMES, float(CLOCK[-1]) + 0.01)):
        inside = CLOCK[(begin <= CLOCK) & (end > CLOCK)]
        run = solve_ivp(change, (begin, end), state, "LSODA", t_eval=np.union1d(inside, end), rtol=1e-9, atol=1e-11)
        state = run.y[:, -1]
        found.append(run.y[0][: len(inside)])
    return np.concatenate(found)


def record(every: int, first: int, seed: int) -> dict[str, Any]:
    """Each so many-th sample of the record, with noise of 3e-4 of friction and of 0.05 um of the load point."""
    random, chosen = np.random.default_rng(seed), slice(first, None, every)
    time = CLOCK[chosen]
    shear, load, point = random.standard_normal((3, len(time)))
    return {
        "time (s)": time,
        "shear force (kN)": (spring()[chosen] + 3e-4 * NORMAL * shear) / 1e3,
        "normal force (kN)": normal(time) * (1.0 + 1e-4 * load) / 1e3,
        "load point (um)": 1e6 * moved(time) + 0.05 * point,
    }
