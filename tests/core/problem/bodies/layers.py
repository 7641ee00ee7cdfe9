"""Layers, and runs on them, that several files test."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import stickslip as ss

DENSITY, SPEED, THICKNESS, NORMAL = 2800.0, 3500.0, 1e4, 1e8
T = THICKNESS / (10 * SPEED)
RATE_LAW = ss.friction.HyperbolicRate(0.8, 0.3, 1.0)
COULOMB = ss.friction.Coulomb(0.8, 0.3)
SOFT = {"thickness": [1e3, 8e3], "density": [DENSITY] * 2, "wave_speed": [SPEED / 2, SPEED]}
"""Two of ten parts of the paper's slab, those at the contact, with half the impedance and the same travel time."""


def layered(*shares: float, **numbers: Any) -> ss.LayeredSlab:
    """Return the paper's slab cut into layers of one kind, which have these shares of its thickness."""
    count = len(shares)
    return ss.LayeredSlab([THICKNESS * share for share in shares], [DENSITY] * count, [SPEED] * count, NORMAL, **numbers)


CASES: dict[str, tuple[dict[str, Any], dict[str, Any], float]] = {
    "rate law": ({}, {"friction": RATE_LAW, "pull_rate": 0.05 / ss.YEAR, "initial_excess": 0.0}, 12.0),
    "slip law": (
        {},
        {"friction": ss.friction.SinusoidalSlip(1.0, 0.5, 5.0), "pull_rate": 1e-9, "initial_excess": 0.0, "initial_slip": 0.5},
        8.0,
    ),
    "contact mass": (
        {"contact_mass": 1e5},
        {"friction": ss.friction.LinearSlipWeakening(0.677, 0.525, 0.4), "pull_rate": 0.1, "initial_excess": 0.0},
        40.0,
    ),
    "fold and dead load": ({"driver_impedance": 0.0}, {"friction": RATE_LAW, "pull_rate": 2.6, "initial_load": 60e6}, 9.0),
    "lossy driver": (
        {"driver_impedance": 4.9e6},
        {"friction": COULOMB, "pull_rate": 0.0, "far_stress_rate": 3.0, "initial_load": 60e6},
        20e6 / 3.0 + 40.0,
    ),
    "states": (
        {},
        {
            "friction": ss.friction.RateAndState(0.01, 0.015, 0.05, 0.6, 1e-6),
            "pull_rate": 0.3,
            "initial_load": 65e6,
            "initial_state": 1e4,
        },
        60.0,
    ),
    "pull in steps": (
        {},
        {
            "friction": replace(RATE_LAW, alpha=0.1),
            "pull_rate": ss.loading.Steps([0.0, 3.0, 20.0], [0.5, 0.1, 0.7]),
            "initial_excess": 0.0,
        },
        100.0,
    ),
    "far stress in steps": (
        {"driver_impedance": 2e7},
        {
            "friction": RATE_LAW,
            "far_stress": ss.loading.Steps([0.0, 3.0, 20.0, 1e7], [70e6, 85e6, 20e6, 90e6]),
            "initial_load": 70e6,
        },
        1e7 + 30.0,
    ),
}


ONE = ([THICKNESS], [DENSITY], [SPEED])
TWO: dict[str, dict[str, Any]] = {
    "rate law": {"friction": RATE_LAW, "pull_rate": 0.1, "initial_excess": 0.0},
    "Coulomb": {"friction": COULOMB, "pull_rate": ss.loading.Steps([0.0, 3.0, 20.0], [0.5, 0.1, 0.7]), "initial_excess": 0.0},
    "normal load": {
        "friction": COULOMB,
        "pull_rate": 0.3,
        "normal_load": ss.loading.Steps([0.0, 10.0, 23.0], [NORMAL, 0.9 * NORMAL, 1.1 * NORMAL]),
        "initial_excess": 0.0,
    },
    "lossy": {"friction": COULOMB, "far_stress": 85e6, "initial_load": 70e6},
}
