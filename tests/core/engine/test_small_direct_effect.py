"""Rate-and-state friction whose direct effect a is so small that its exponential would overflow: runs from event to event."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import stickslip as ss

BLOCK = ss.SpringBlock(mass=1.6e6, stiffness=2e7, normal_force=5e7, damping=4.9e6)
LAW = ss.friction.RateAndState(0.6, 5e-4, 0.03, 5e-3, 1e-6)
PLATE = 0.05 / ss.YEAR


def problem_of(law: Any, body: Any = BLOCK) -> ss.Problem:
    """A contact in half of the state of steady sliding, under the load of that, which is far too much for it."""
    load = body.normal_load * float(law.steady_coefficient(PLATE))
    return ss.Problem(body, law, pull_rate=PLATE, initial_load=load, initial_state=0.5 * float(law.steady_state(PLATE)))


def friction_by_logarithm(law: Any, log_rate: float, w: float) -> float:
    """The law's friction, x + ln(v / (2 rate)) and a remainder: without the package's formula."""
    z = (law.reference + law.b * w) / law.a + log_rate - np.log(2.0 * law.rate)
    return float(law.a * (z + np.log1p(np.sqrt(1.0 + np.exp(-2.0 * z)))) if z > 0.0 else law.a * np.arcsinh(np.exp(z)))


@pytest.mark.sampled(every=2)
@pytest.mark.parametrize("a", [1e-4, 5e-4])
def test_an_earthquake_agrees_with_radau_on_the_logarithm_of_the_slip_rate(a: float) -> None:
    """Slip to 1e-10 of it, ln v to 1e-8, from the start at 0.1 m/s almost to the arrest."""
    law = replace(LAW, a=a)
    problem = problem_of(law)
    run, end = ss.simulate(problem, 2.0), 1.0

    def derivative(t: float, y: Any) -> list[float]:
        rate = np.exp(y[1])
        force = problem.load + BLOCK.stiffness * (PLATE * t - y[0]) - BLOCK.damping * rate
        force -= BLOCK.normal_load * friction_by_logarithm(law, y[1], y[2])
        return [rate, force / (BLOCK.mass * rate), law.rate / law.distance * np.exp(-y[2]) - rate / law.distance]

    times = np.linspace(0.0, end, 30)
    first = [0.0, np.log(problem.rate), problem.states[0]]
    theirs = solve_ivp(derivative, (0.0, end), first, method="Radau", rtol=1e-11, atol=1e-13, t_eval=times)
    assert run.slip(times) == pytest.approx(theirs.y[0], abs=1e-10 * theirs.y[0][-1])
    assert np.log(run.slip_rate(times)) == pytest.approx(theirs.y[1], abs=1e-8)
    assert float(run.slip_rate(2.0)) < 1e-80


@pytest.mark.slow
def test_earthquakes_repeat_and_pay_for_their_slip() -> None:
    """Each slips what the driver has moved since the last one, within 2e-3; the energy balance closes to 1e-9 of the heat."""
    run = ss.simulate(problem_of(replace(LAW, a=1e-4)), "160 years", rtol=1e-8)
    assert run.status.name == "finished"
    quakes = run.catalogue(event_rate=1e-3)
    assert len(quakes) == 4
    between = quakes.start.diff().to_numpy()[2:]
    assert between * PLATE == pytest.approx(quakes.slip.to_numpy()[2:], rel=2e-3)
    energy = run.energy(run.duration)
    assert abs(energy.balance.item()) < 1e-9 * energy.heat.item()


def test_a_slab_without_mass_follows_its_load() -> None:
    """Z v + S mu = load in either direction, with mu by the logarithm, to 1e-9 of S; echoes also bring it to rest."""
    slab = ss.ElasticSlab(2800.0, 3500.0, 1e3, 5e7)
    law = replace(LAW, a=1e-3)
    problem = ss.Problem(slab, law, pull_rate=1e-3, initial_load=3.2e7, initial_state=1e3)
    run = ss.simulate(problem, 30.0)
    times = np.linspace(0.01, 30.0, 400)
    rates = run.slip_rate(times)
    seen = np.abs(rates) > 1e-80
    assert 20 < seen.sum() < 400
    for t, rate in zip(times[seen], rates[seen], strict=True):
        w, load = law.inner_state(float(run.state(t))), float(run.load(t))
        resisted = slab.impedance * abs(rate) + slab.normal_stress * friction_by_logarithm(law, np.log(abs(rate)), w)
        assert np.copysign(resisted, rate) == pytest.approx(load, abs=1e-9 * slab.normal_stress)


@pytest.mark.slow
def test_two_states_and_flash_heating_run_with_a_small_a_as_well() -> None:
    two = ss.friction.TwoStateRateAndState(0.6, 1e-3, 0.02, 5e-3, 0.01, 5e-2)
    start = dict(zip(("initial_state", "initial_second_state"), two.steady_state(PLATE) * 0.5, strict=True))
    load = BLOCK.normal_load * float(two.steady_coefficient(PLATE))
    run = ss.simulate(ss.Problem(BLOCK, two, pull_rate=PLATE, initial_load=load, **start), 3.0)
    assert (run.status.name, len(run.events)) == ("finished", 1)
    flash = ss.friction.FlashHeating(0.6, 5e-4, 0.01, 0.1, 0.2, 0.1)
    load = BLOCK.normal_load * 0.75
    run = ss.simulate(ss.Problem(BLOCK, flash, pull_rate=PLATE, initial_load=load, initial_state=0.74), 3.0)
    energy = run.energy(3.0)
    assert run.status.name == "finished"
    assert abs(energy.balance.item()) < 1e-9 * energy.heat.item()
