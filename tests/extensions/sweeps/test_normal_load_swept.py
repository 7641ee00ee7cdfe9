"""Numbers of a normal load that varies are swept."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.optimize import brentq

import stickslip as ss
from stickslip.problem.loading import Sinusoidal

STATIC, DYNAMIC, FORCE, STIFFNESS, PULL, LOAD = 0.6, 0.4, 10.0, 100.0, 0.05, 5.0


BODY = ss.SpringBlock(mass=1.0, stiffness=STIFFNESS, normal_force=FORCE)


def block(history: object, **more: object) -> ss.Problem:
    """Return a block under Coulomb friction and a normal force that varies."""
    law = ss.friction.Coulomb(static=STATIC, dynamic=DYNAMIC)
    return ss.Problem(BODY, law, pull_rate=PULL, initial_load=LOAD, normal_load=history, **more)  # type: ignore[arg-type]


def first_event(amplitude: float, period: float) -> tuple[float, float, float]:
    """Return start, end and slip of the first event under S = FORCE + amplitude sin(2 pi t / period), by closed forms.

    While the block slips it is a linear oscillator: u = (load + K V t - mu_d S0)/K - mu_d a sin(w t)/(K - m w^2) + A cos + B sin.
    """
    omega, own = 2.0 * math.pi / period, math.sqrt(STIFFNESS)

    def short(t: float) -> float:
        return STATIC * (FORCE + amplitude * math.sin(omega * t)) - LOAD - STIFFNESS * PULL * t

    begin = next(t for t in np.arange(0.0, 5.0, 1e-4) if short(t + 1e-4) < 0.0)
    start = brentq(short, begin, begin + 1e-4, xtol=1e-15)
    driven = DYNAMIC * amplitude / (STIFFNESS - omega**2)

    def forced(t: float) -> float:
        return (LOAD + STIFFNESS * PULL * t - DYNAMIC * FORCE) / STIFFNESS - driven * math.sin(omega * t)

    a = -forced(start)
    b = -(PULL - driven * omega * math.cos(omega * start)) / own

    def rate(t: float) -> float:
        since = t - start
        free = own * (b * math.cos(own * since) - a * math.sin(own * since))
        return PULL - driven * omega * math.cos(omega * t) + free

    later = next(t for t in start + np.arange(1e-3, 5.0, 1e-4) if rate(t + 1e-4) < 0.0)
    end = brentq(rate, later, later + 1e-4, xtol=1e-15)
    return start, end, forced(end) + a * math.cos(own * (end - start)) + b * math.sin(own * (end - start))


def test_a_number_of_the_history_can_be_swept() -> None:
    problem = block(Sinusoidal(10.0, 3.0, 0.37))
    wanted = ["first_start", "first_slip"]
    found = ss.sweep(problem, {"loading.normal_load.amplitude": [1.0, 3.0]}, duration=1.0, quantities=wanted)
    for n, amplitude in enumerate((1.0, 3.0)):
        start, _, slip = first_event(amplitude, 0.37)
        assert [float(found[name][n]) for name in wanted] == pytest.approx([start, slip], rel=1e-9)
