"""A disturbed start keeps the state of the undisturbed one."""

from __future__ import annotations

from dataclasses import replace

import pytest

import stickslip as ss
from stickslip.extensions.studies.separation import disturbed

NORMAL, SPEED = 1e8, 1e-4


LAW = ss.friction.RateAndState(0.6, 0.01, 0.015, 1e-5, 1e-6)


BLOCK = ss.SpringBlock(1e3, 1e10, NORMAL, damping=1e6)


SLAB = ss.ElasticSlab(2800, 3500, 3.0, NORMAL, contact_mass=2e3)


IMPEDANCE = SLAB.impedance


BODIES = {
    "block": BLOCK,
    "slab, rigid": SLAB,
    "slab, half-space": replace(SLAB, driver_impedance=0.3 * IMPEDANCE),
    "slab, matched": replace(SLAB, driver_impedance=IMPEDANCE),
    "slab, dead load": replace(SLAB, driver_impedance=0.0),
}


def test_a_disturbed_start_has_the_state_of_the_undisturbed_one() -> None:
    for body in (BLOCK, BODIES["slab, half-space"]):
        steady = ss.Problem(body, LAW, pull_rate=SPEED)
        pushed = disturbed(steady, 1.0)
        assert pushed.load == steady.load + 1.0
        assert pushed.states == pytest.approx(steady.states, rel=1e-14)
        assert pushed.rate == pytest.approx(steady.rate * (1.0 + 1.0 / (NORMAL * LAW.a)), rel=1e-9)
