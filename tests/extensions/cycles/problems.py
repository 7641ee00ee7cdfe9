"""Problems whose cycles are known: a block under Coulomb friction, under a Stribeck law, and under rate and state."""

from __future__ import annotations

from typing import Any

import stickslip as ss

MASS, STIFFNESS, NORMAL, PULL = 1.0, 1e3, 10.0, 0.1
STATIC, DYNAMIC = 0.6, 0.4
FALL, LOWEST, OVER, DAMPING = 0.2, 0.3, 0.05, 2.0
A, B, DISTANCE, REFERENCE, SLOW = 0.01, 0.015, 1e-5, 0.6, 1e-6
HEAVY = 3.0 * NORMAL * A * DISTANCE / SLOW**2
SOFT = 0.9 * (1.0 + 3.0) * NORMAL * (B - A) / DISTANCE
"""A mass and a stiffness (0.9 of the critical one, Gu et al. 1984) with which a cycle stays within one decade of slip rates."""
BRAKE = """
[body]
kind = "spring-block"
mass = 1.0
stiffness = 1000.0
normal_force = 10.0
damping = 2.0

[friction]
kind = "exponential-stribeck"
static = 0.5
dynamic = 0.3
rate = "50 mm/s"

[loading]
pull_rate = "0.28 m/s"

[initial]
load = 0.0

[run]
duration = "10 s"
"""
"""A scenario file of the block under a Stribeck law."""


def coulomb(pull: float = PULL, **changes: Any) -> ss.Problem:
    block = ss.SpringBlock(MASS, STIFFNESS, NORMAL, **changes)
    return ss.Problem(block, ss.friction.Coulomb(STATIC, DYNAMIC), pull_rate=pull, initial_load=0.0)


def stribeck(pull: float, **start: float) -> ss.Problem:
    law = ss.friction.FromExpression("0.3 + 0.2*exp(-v/v1)", {"v1": "50 mm/s"})
    return ss.Problem(ss.SpringBlock(MASS, STIFFNESS, NORMAL, damping=DAMPING), law, pull_rate=pull, **start)


def rate_and_state(evolution: str = "ageing") -> ss.Problem:
    law = ss.friction.RateAndState(reference=REFERENCE, a=A, b=B, distance=DISTANCE, evolution=evolution)
    return ss.Problem(ss.SpringBlock(HEAVY, SOFT, NORMAL), law, pull_rate=SLOW)
