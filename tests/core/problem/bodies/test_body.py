"""What a body says about itself, in place of tests of its class."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import pytest

import stickslip as ss
from stickslip.problem.bodies import BODIES, Body, as_block, as_slab

SLAB = ss.ElasticSlab(2800.0, 3500.0, 1e4, 1e8)
BLOCK = ss.SpringBlock(2.8e12, 3.43e13, 1e14, damping=3e12)


def test_every_body_has_all_that_a_body_is_asked_for() -> None:
    asked = [name for name in vars(Body) if not name.startswith("_")] + ["kind", "load_unit", "has_waves"]
    for body in (SLAB, BLOCK):
        assert BODIES[body.kind] is type(body)
        assert all(getattr(body, name) is not None for name in asked)


def test_a_slab_resists_slip_by_radiation_and_a_block_by_viscosity() -> None:
    assert (SLAB.damping, SLAB.impedance) == (9.8e6, 9.8e6)
    assert BLOCK.damping == 3e12
    assert BLOCK.impedance == pytest.approx(math.sqrt(2.8e12) * math.sqrt(3.43e13), rel=1e-15)


def test_only_a_massless_slab_has_no_inertia() -> None:
    assert not SLAB.has_inertia
    assert replace(SLAB, contact_mass=1e5).has_inertia
    assert BLOCK.has_inertia
    assert BLOCK.inertia == BLOCK.mass


def test_a_block_is_driven_rigidly_and_sends_no_waves() -> None:
    assert math.isinf(BLOCK.driver_impedance)
    assert BLOCK.is_driven_rigidly
    assert not BLOCK.has_waves
    assert not replace(SLAB, driver_impedance=9.8e6).is_driven_rigidly


def test_as_slab_and_as_block_return_the_body_or_refuse_it() -> None:
    assert as_slab(SLAB) is SLAB
    assert as_block(BLOCK) is BLOCK
    with pytest.raises(ss.InputError, match="run: needs a slab"):
        as_slab(BLOCK, "run: needs a slab")
    with pytest.raises(ss.InputError, match="needs a spring-block"):
        as_block(SLAB)


@pytest.mark.parametrize(("pull", "days"), [(1e-9, 1.0), (ss.loading.Sinusoidal(1e-9, 1e-10, 3600.0), 1.0 / 24.0)])
def test_a_round_trip_of_a_block_that_never_sticks_lasts_a_day_or_a_period_of_its_loading(pull: Any, days: float) -> None:
    law = ss.friction.RateAndState(0.6, 0.01, 0.015, 1e-3, 1e-6)
    creeping = ss.Problem(BLOCK, law, pull_rate=pull, initial_load=6e13, initial_state=1.0)
    assert creeping.round_trip_time == pytest.approx(86_400.0 * days, rel=1e-12)
    sticking = ss.Problem(BLOCK, ss.friction.Coulomb(0.8, 0.3), pull_rate=pull, initial_load=6e13)
    assert sticking.round_trip_time == BLOCK.period
