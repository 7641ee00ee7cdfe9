"""The energy balance closes, and does not close for nonsense."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import stickslip as ss
from tests.core.solution.observables.runs import worst_imbalance
from tests.problems import (
    IMPEDANCE,
    MODULUS,
    RATE_LAW,
    ROUND,
    SLAB,
    THICKNESS,
    rate_law_slab,
    slip_law_block,
    slip_law_slab,
)

RUNS = {
    "slab, slip law": (slip_law_slab(50.0, 1e-3, extra_load=3430.0), 20.0),
    "slab, slip law, printed": (slip_law_slab(5.0, 1e-3), 20.0),
    "slab, rate law": (rate_law_slab(), 20.0),
    "slab, just above critical": (rate_law_slab(alpha=IMPEDANCE / 5e7 + 1e-6), 20.0),
    "block, slip law": (slip_law_block(5.0, MODULUS * 1e3), 5.0),
    "dead load, through both folds": (
        ss.Problem(replace(SLAB, driver_impedance=0.0), RATE_LAW, pull_rate=2.6, initial_load=60e6),
        12.0,
    ),
}


@pytest.mark.sampled(every=3)
@pytest.mark.parametrize("name", RUNS)
def test_energy_balances(name: str) -> None:
    assert worst_imbalance(ss.simulate(*RUNS[name], rtol=1e-12)) < 1e-9


def test_energies_start_at_zero_and_have_units() -> None:
    run = ss.simulate(rate_law_slab(), 2 * ROUND)
    energy = run.energy([0.0, ROUND])
    assert [float(energy[name][0]) for name in ("work", "stored", "heat", "damped", "balance")] == [0.0] * 5
    assert energy.heat.attrs["units"] == "J m-2"
    with pytest.raises(ss.InputError):
        run.energy(100.0)


SPLIT = {
    "slab, slip law": (*RUNS["slab, slip law"], [0.2, 2.3, 5.0, 19.0]),
    "slab, rate law": (*RUNS["slab, rate law"], [1.0, 3.0, 7.0]),
    "slab, contact mass": (
        ss.Problem(replace(SLAB, contact_mass=1e6), ss.friction.Coulomb(0.8, 0.3), pull_rate=1e-3, initial_excess=0.0),
        30.0,
        [0.5, 4.0, 6.0, 20.0],
    ),
    "slab, lossy": (
        ss.Problem(
            replace(SLAB, driver_impedance=3.0 * IMPEDANCE), RATE_LAW, initial_excess=1e5, far_stress=7e7, far_stress_rate=1e3
        ),
        400.0,
        [0.5, 2.0, 3.5, 8.0, 390.0],
    ),
}


@pytest.mark.sampled(every=4)
@pytest.mark.parametrize("name", SPLIT)
def test_elastic_and_kinetic_energy_agree_with_the_field(name: str) -> None:
    """Stress and velocity inside the slab, squared and added up on a fine grid."""
    problem, duration, times = SPLIT[name]
    run = ss.simulate(problem, duration, rtol=1e-12)
    energy, body = run.energy(times), problem.body
    assert isinstance(body, ss.ElasticSlab)
    places = (np.arange(50_000) + 0.5) * THICKNESS / 50_000
    for n, time in enumerate([0.0, *times]):
        field = run.field(places, time)
        elastic = float((field.stress**2).mean()) * THICKNESS / (2 * MODULUS)
        kinetic = float((field.velocity**2).mean()) * THICKNESS * body.density / 2
        kinetic += 0.5 * body.contact_mass * float(run.slip_rate(time)) ** 2 if n else 0.0
        if n == 0:
            start = elastic, kinetic
            continue
        assert kinetic > 0.0
        largest = abs(float(energy.stored[n - 1])) + kinetic
        assert float(energy.elastic[n - 1]) == pytest.approx(elastic - start[0], rel=0.0, abs=1e-4 * largest)
        assert float(energy.kinetic[n - 1]) == pytest.approx(kinetic - start[1], rel=0.0, abs=1e-4 * largest)
        assert float(energy.elastic[n - 1] + energy.kinetic[n - 1]) == pytest.approx(
            float(energy.stored[n - 1]), rel=1e-12, abs=0.0
        )


def test_energy_of_a_slab_that_slides_as_a_whole_splits_as_the_closed_form() -> None:
    """Coulomb friction: the front of the slip is at the driver after h/c; behind it all moves at v under the sliding stress."""
    load, sliding, travel = 8.5e7, 3e7, THICKNESS / SLAB.wave_speed
    run = ss.simulate(ss.Problem(SLAB, ss.friction.Coulomb(0.8, 0.3), initial_load=load), 20.0)
    energy = run.energy(travel * np.array([0.5, 1.0, 1.5, 2.0]))
    moving = 0.5 * SLAB.density * THICKNESS * ((load - sliding) / IMPEDANCE) ** 2
    released = (load**2 - sliding**2) * THICKNESS / (2 * MODULUS)
    rest = (load**2 - (2 * sliding - load) ** 2) * THICKNESS / (2 * MODULUS)
    shares = energy.kinetic.values / moving, -energy.elastic.values
    assert shares[0] == pytest.approx([0.5, 1.0, 0.5, 0.0], rel=1e-12, abs=1e-12)
    assert shares[1] == pytest.approx([released / 2, released, (released + rest) / 2, rest], rel=1e-12, abs=0.0)


def test_energy_of_a_block_splits_into_spring_and_motion() -> None:
    """A block without friction to speak of swings: K (D^2 - (D - u)^2) / 2 out of the spring, m v^2 / 2 in the block."""
    problem = ss.Problem(ss.SpringBlock(2.0, 50.0, 10.0), ss.friction.Coulomb(0.4, 0.3), initial_load=4.5)
    run = ss.simulate(problem, 0.5)
    at, energy = 0.25, run.energy(0.25)
    slip, rate = float(run.slip(at)), float(run.slip_rate(at))
    assert float(energy.kinetic[0]) == pytest.approx(rate**2, rel=1e-12, abs=0.0)
    assert float(energy.elastic[0]) == pytest.approx(((4.5 - 50.0 * slip) ** 2 - 4.5**2) / 100.0, rel=1e-12, abs=0.0)
