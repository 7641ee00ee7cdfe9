"""A contact that can stick and is thrown onto the floor: closed forms of a block, on a spring or nearly free, and of a slab."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import brentq

import stickslip as ss

COULOMB = ss.friction.Coulomb(0.6, 0.4)
WEAKENING = ss.friction.LinearSlipWeakening(0.6, 0.4, 0.1)
BLOCK = ss.SpringBlock(mass=2.0, stiffness=30.0, normal_force=20.0)
NEARLY_FREE = replace(BLOCK, stiffness=1e-12)
SLAB = ss.ElasticSlab(density=2800, wave_speed=3500, thickness=1e4, normal_stress=1e8, contact_mass=1e5)
BOTH_WAYS = pytest.mark.parametrize("way", [1, -1])


@BOTH_WAYS
@pytest.mark.parametrize("rate", [1e-3, 1.0, 50.0])
def test_a_block_thrown_onto_a_floor_stops_after_v_squared_over_2_mu_g(rate: float, way: int) -> None:
    """Its spring is so soft that it counts for less than 1e-12. One event, however far its rate is from those of the spring."""
    deceleration = COULOMB.dynamic * BLOCK.normal_load / BLOCK.mass
    run = ss.simulate(ss.Problem(NEARLY_FREE, COULOMB, initial_load=0.0, initial_rate=way * rate), 100.0)
    (event,) = run.events.itertuples()
    assert float(run.slip(100.0)) == pytest.approx(way * rate**2 / (2.0 * deceleration), rel=1e-10)
    assert (event.start, event.end) == (0.0, pytest.approx(rate / deceleration, rel=1e-10))
    assert event.peak_rate == rate
    early = 0.3 * rate / deceleration
    assert float(run.slip_rate(early)) == pytest.approx(way * (rate - deceleration * early), rel=1e-10)
    assert float(run.slip_rate(0.0, side="left")) == way * rate


@BOTH_WAYS
def test_a_block_thrown_on_its_spring_swings_for_a_quarter_about_the_place_where_friction_balances(way: int) -> None:
    """u = c + A sin(w t + p) about c = (load - S mu)/K: it stops when the phase is a quarter turn, and stays."""
    load, rate = way * 3.0, way * 1.5
    run = ss.simulate(ss.Problem(BLOCK, COULOMB, initial_load=load, initial_rate=rate), 5.0)
    w = math.sqrt(BLOCK.stiffness / BLOCK.mass)
    centre = (3.0 - COULOMB.dynamic * BLOCK.normal_load) / BLOCK.stiffness
    size, phase = math.hypot(centre, 1.5 / w), math.atan2(-centre, 1.5 / w)
    stop = (0.5 * math.pi - phase) / w
    (event,) = run.events.itertuples()
    assert event.end == pytest.approx(stop, rel=1e-9)
    assert float(run.slip(5.0)) == pytest.approx(way * (centre + size), rel=1e-10)
    times = np.linspace(0.0, stop, 40)
    assert run.slip(times) == pytest.approx(way * (centre + size * np.sin(w * times + phase)), abs=1e-10)
    spent = run.energy(np.append(times, 5.0))
    assert np.abs(spent.balance).max() < 1e-10 * float(spent.heat[-1])


LAWS: dict[str, ss.friction.FrictionLaw] = {
    "linear weakening": WEAKENING,
    "weakening that heals": replace(WEAKENING, memory="since-arrest"),
    "power of slip": ss.friction.PowerSlipWeakening(0.6, 0.2, 0.1, 1.0 / 3.0),
    "parabolic": ss.friction.ParabolicSlipWeakening(0.6, 0.4, 0.3),
}


@pytest.mark.sampled(every=4)
@BOTH_WAYS
@pytest.mark.parametrize("name", LAWS)
def test_under_a_law_of_slip_a_thrown_block_stops_where_its_energy_is_spent(name: str, way: int) -> None:
    """m v0^2/2 + load u - K u^2/2 = S times the integral of mu, by quadrature: slip to 1e-9."""
    law, rate, load = LAWS[name], 2.5, 1.0
    run = ss.simulate(ss.Problem(BLOCK, law, initial_load=way * load, initial_rate=way * rate), 1.0, max_events=1)

    def left(slip: float) -> float:
        work = quad(lambda u: float(law.coefficient(u)), 0.0, slip, epsabs=1e-13, points=[min(0.1, slip), min(0.3, slip)])[0]
        return 0.5 * BLOCK.mass * rate**2 + load * slip - 0.5 * BLOCK.stiffness * slip**2 - BLOCK.normal_load * float(work)

    assert run.events.slip[0] == pytest.approx(way * brentq(left, 1e-6, 5.0, xtol=1e-14), rel=1e-9)


@BOTH_WAYS
def test_a_thrown_slab_with_a_contact_mass_decays_to_its_stop(way: int) -> None:
    """m v' = beta - Z v - S mu, beta = load - Z v0 c t/h while only the velocity v0 (1 - x/h) of the start arrives.

    With A = (load - S mu)/Z and B = v0 c/h, v = A - B (t - m/Z) + (v0 - A - B m/Z) exp(-Z t/m).
    """
    rate, load, z = 2.0, 3.9e7, SLAB.impedance
    run = ss.simulate(ss.Problem(SLAB, COULOMB, initial_load=way * load, initial_rate=way * rate), 1.0)
    drive, fall, time = (
        (load - COULOMB.dynamic * SLAB.normal_load) / z,
        rate * SLAB.wave_speed / SLAB.thickness,
        SLAB.contact_mass / z,
    )

    def exact(t: float) -> float:
        return drive - fall * (t - time) + (rate - drive - fall * time) * math.exp(-t / time)

    stop = brentq(exact, 1e-4, 1.0, xtol=1e-16)
    (event,) = run.events.itertuples()
    assert event.end == pytest.approx(stop, rel=1e-9)
    times = np.linspace(0.0, stop, 30)
    assert way * run.slip_rate(times) == pytest.approx([exact(t) for t in times], abs=1e-9 * rate)
    spent = run.energy(np.linspace(0.0, 1.0, 11))
    assert np.abs(spent.balance).max() < 1e-9 * float(spent.heat[-1])
