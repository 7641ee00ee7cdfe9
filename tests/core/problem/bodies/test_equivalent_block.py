"""The block of the slab's slow limit: from the slab's own dynamic stiffness, its kinetic energy, and events that get slower."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest
from mpmath import cot, mp, mpf

import stickslip as ss
from stickslip.problem.equivalent_block import block_for

mp.dps = 40
SLAB = ss.ElasticSlab(density=2800, wave_speed=3500, thickness=1e4, normal_stress=1e8)


def test_the_block_is_the_slow_limit_of_the_slabs_dynamic_stiffness() -> None:
    """Load per displacement at the frequency w is G k cot(k h), k = w/c: K - m w^2 with an error of (k h)^4/45 of K."""
    block = SLAB.equivalent_block()
    stiffness = mpf(SLAB.shear_modulus) / mpf(SLAB.thickness)
    for slow in ("1e-2", "1e-3"):
        angle = mpf(slow)  # k h
        frequency = angle * SLAB.wave_speed / SLAB.thickness
        mass = (stiffness - stiffness * angle * cot(angle)) / frequency**2
        assert block.mass == pytest.approx(float(mass), rel=float(angle) ** 2 / 14, abs=0.0)
    assert block.stiffness == float(stiffness)
    assert (block.normal_force, block.damping) == (1e8, 0.0)


def test_the_block_swings_faster_than_the_slab() -> None:
    """sqrt(3) c / (2 pi h) against c / 4h: said in the docstring."""
    swing = 1.0 / SLAB.equivalent_block().period
    assert swing == pytest.approx(math.sqrt(3.0) * 3500 / (2e4 * math.pi), rel=1e-14, abs=0.0)
    assert swing / (3500 / 4e4) == pytest.approx(1.1027, rel=1e-4, abs=0.0)


def test_mass_on_the_contact_moves_with_it() -> None:
    assert replace(SLAB, contact_mass=5e6).equivalent_block().mass == pytest.approx(SLAB.equivalent_block().mass + 5e6, rel=1e-15)


@pytest.mark.parametrize("impedance", [0.0, 9.8e6, 1e9])
def test_a_slab_without_a_rigid_driver_has_no_equivalent_block(impedance: float) -> None:
    with pytest.raises(ss.InputError, match="needs a rigid driver"):
        replace(SLAB, driver_impedance=impedance).equivalent_block()


@pytest.fixture(scope="module")
def slower() -> dict[float, tuple[float, float, float]]:
    """Slip, duration (both slab over block, minus 1) and duration in round trips of events close to neutral stability.

    Friction falls (1 + e) times as fast as the slab unloads, at its steepest; the excess goes with e^1.5, so that the events
    are alike and last longer as 1/sqrt(e).
    """
    found = {}
    for beyond in (0.1, 0.05, 0.025):
        wavenumber = (1.0 + beyond) * SLAB.stiffness / (0.25 * SLAB.normal_stress)
        law = ss.friction.SinusoidalSlip(0.5, 0.25, wavenumber)
        slab = ss.Problem(SLAB, law, initial_slip=math.pi / wavenumber, initial_excess=2e6 * beyond**1.5)
        a, b = (ss.simulate(one, 2e4, 1e-9, max_events=1).events.iloc[0] for one in (slab, block_for(slab)))
        found[beyond] = a.slip / b.slip - 1.0, a.duration / b.duration - 1.0, a.duration / SLAB.two_way_time
    return found


def test_slower_events_of_the_slab_are_nearer_to_those_of_the_block(slower: dict[float, tuple[float, float, float]]) -> None:
    """Slip differs by 0.104 e, duration by less than 3e-4 however slow: with m = rho h / 2 it would be 22 % off."""
    assert slower[0.025][2] > 1.9 * slower[0.1][2] > 8.0
    for beyond, (slip, duration, _) in slower.items():
        assert slip == pytest.approx(-0.104 * beyond, rel=0.03, abs=0.0)
        assert abs(duration) < 3e-4
