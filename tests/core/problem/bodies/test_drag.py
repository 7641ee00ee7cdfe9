"""Viscous drag of layers: against a grid of its own, against closed forms, and as balance of energy."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np
import pytest

import stickslip as ss
from stickslip.contact.layer_response import response_of
from tests.core.problem.bodies.layers import RATE_LAW, SOFT
from tests.messages import refused

NORMAL, DENSITY, SPEED, THICKNESS = 1e7, 2500.0, 2000.0, 1000.0
Z = DENSITY * SPEED
DRAG = 1.5 * DENSITY * SPEED / THICKNESS
"""A drag (Pa s/m^2) against which a front loses half of its height on its way through the layer."""
WEAKENING = ss.friction.ExponentialSlipWeakening(0.7, 0.4, 0.05)


def slab(drag: float, step: float, **more: Any) -> ss.LayeredSlab:
    """Return one layer with drag."""
    return ss.LayeredSlab([THICKNESS], [DENSITY], [SPEED], NORMAL, drag=[drag], drag_step=step, **more)


def slip_on_staggered_grid(parts: int, duration: float, excess: float) -> float:
    """Return the slip (m) of `slab` under WEAKENING and a held driver.

    Velocities are at places and stresses between them, by the leapfrog rule at the Courant number 1, with drag by the trapezoidal
    rule; half a part hangs on the contact.
    """
    step = THICKNESS / (SPEED * parts)
    mass, shares = DENSITY * THICKNESS / parts, np.append(0.5, np.ones(parts - 1))
    rate = np.zeros(parts + 1)
    stress = np.full(parts, 0.7 * NORMAL + excess)
    slip = 0.0
    for _ in range(round(duration / step)):
        force = np.diff(stress, prepend=0.0)
        # the friction at the contact, by the slip half a step later: a contraction
        inert, lost = shares * mass / step, 0.5 * shares * DRAG * THICKNESS / parts
        friction, old = 0.0, rate[:-1].copy()
        for _ in range(12):
            force[0] = stress[0] - friction
            new = ((inert - lost) * old + force) / (inert + lost)
            friction = NORMAL * float(WEAKENING.coefficient(slip + 0.25 * step * (old[0] + new[0]), 0.0))
        slip += 0.5 * step * (old[0] + new[0])
        rate[:-1] = new
        stress += Z * np.diff(rate)
    return slip


def test_a_grid_with_drag_converges_to_the_run_and_the_run_to_the_second_order_in_its_cells() -> None:
    duration = 2.6 * THICKNESS / SPEED
    grid = [slip_on_staggered_grid(parts, duration, 1e5) for parts in (200, 400)]
    known = 2.0 * grid[1] - grid[0]  # the grid is of first order, as its slip starts a part of a step late
    runs = [
        ss.simulate(ss.Problem(slab(DRAG, step), WEAKENING, 0.0, initial_excess=1e5), duration) for step in (0.16, 0.08, 0.04, 0.02)
    ]
    found = [float(run.slip(duration)) for run in runs]
    assert abs(found[-1] / known - 1.0) < 1e-3, (found, known)
    assert abs(slip_without_drag(duration) / known - 1.0) > 0.1
    changes = np.abs(np.diff(found))
    assert all(3.0 < coarse / fine < 5.0 for coarse, fine in pairwise(changes)), changes


def slip_without_drag(duration: float) -> float:
    return float(ss.simulate(ss.Problem(slab(0.0, 0.02), WEAKENING, 0.0, initial_excess=1e5), duration).slip(duration))


def test_a_front_falls_as_exp_of_drag_and_to_the_first_order_in_the_cells() -> None:
    law, x = ss.friction.Coulomb(0.7, 0.6), 0.75 * THICKNESS
    errors = []
    for step in (0.04, 0.02, 0.01):
        parts = [x, THICKNESS - x], [DENSITY] * 2, [SPEED] * 2, NORMAL
        body = ss.LayeredSlab(*parts, drag=[DRAG] * 2, drag_step=step)  # x is where cells meet
        run = ss.simulate(ss.Problem(body, law, 0.0, initial_excess=1e-3), 1.5 * THICKNESS / SPEED)
        front = float(run.field(x, x / SPEED + 1e-6).velocity)
        errors.append(front / float(run.slip_rate(1e-6)) / np.exp(-0.5 * DRAG * x / Z) - 1.0)
    assert 0.0 < errors[-1] < 0.004
    assert all(1.8 < coarse / fine < 2.2 for coarse, fine in pairwise(errors)), errors


SIDES: dict[str, dict[str, Any]] = {"one": {}, "apart": {"sides": "apart"}, "joined": {"sides": "joined"}}
FIRST = {"thickness": [500.0, 800.0], "density": [2500.0, 2800.0], "wave_speed": [1000.0, 2000.0], "drag": [2000.0, 500.0]}
OTHER = {"other_thickness": [600.0], "other_density": [2600.0], "other_wave_speed": [1500.0], "other_drag": [300.0]}


def with_drag(kind: str, **more: Any) -> Any:
    """Return layers with drag on one side or on two."""
    if kind == "one":
        return ss.LayeredSlab(**FIRST, normal_stress=NORMAL, **more)
    return ss.TwoSlabs(**FIRST, **OTHER, normal_stress=NORMAL, **SIDES[kind], **more)


@pytest.mark.sampled(every=9)
@pytest.mark.parametrize("driver", [np.inf, 4e6, 0.0])
@pytest.mark.parametrize("kind", SIDES)
def test_energies_balance_with_what_drag_takes(kind: str, driver: float) -> None:
    loading = {"pull_rate": 0.2} if driver == np.inf else {"far_stress": 8.3e6, "pull_rate": 0.1}
    law = ss.friction.Coulomb(0.8, 0.3)
    run = ss.simulate(ss.Problem(with_drag(kind, driver_impedance=driver), law, initial_load=8.0e6, **loading), 20.0)
    assert len(run.events)
    t = np.random.default_rng(3).uniform(0.0, 20.0, 12)
    energy = run.energy(t)
    largest = max(float(np.abs(energy[name]).max()) for name in ("work", "stored", "heat"))
    assert energy.damped.max() > 0.05 * largest
    assert (np.diff(energy.damped.sortby("time")) > 0.0).all()
    np.testing.assert_allclose(energy.balance, 0.0, rtol=0.0, atol=1e-9 * largest)
    events = run.catalogue(energy=True)
    np.testing.assert_allclose(events.balance, 0.0, rtol=0.0, atol=1e-9 * largest)
    assert (events.damped > 0.0).all()


@pytest.mark.sampled(every=3)
@pytest.mark.parametrize("kind", SIDES)
def test_stress_at_rest_stays_and_layers_that_are_pulled_begin_steadily(kind: str) -> None:
    held = ss.simulate(ss.Problem(with_drag(kind), RATE_LAW, 0.0, initial_load=7e6), 1e4)
    np.testing.assert_array_equal(held.traction(np.linspace(0.0, 1e4, 99)), 7e6)
    body = with_drag(kind)
    pulled = ss.simulate(ss.Problem(body, RATE_LAW, 1e-3, initial_load=7e6), 50.0)
    t = np.linspace(0.0, 50.0, 99)
    np.testing.assert_allclose(pulled.traction(t) - 7e6, body.stiffness * 1e-3 * t, rtol=1e-9, atol=1e-6)
    assert float(np.abs(pulled.energy(t).trapped).max()) < 1e-9 * float(pulled.energy(t).work.max())


def test_steady_sliding_goes_on_with_drag() -> None:
    """The far stress is by default that behind the last layer, which holds against friction and drag."""
    body, law = with_drag("one", driver_impedance=4e6, contact_mass=1e4), ss.friction.Coulomb(0.6, 0.6)
    run = ss.simulate(ss.Problem(body, law, 0.1, initial_rate=0.1, initial_load=6e6 + 0.1 * body.impedance), 20.0)
    np.testing.assert_allclose(run.slip_rate(np.linspace(0.0, 20.0, 50)), 0.1, rtol=1e-9)


@pytest.mark.sampled(every=3)
@pytest.mark.parametrize("kind", SIDES)
def test_rest_is_leapt_over_once_waves_have_died_against_drag(kind: str) -> None:
    body = with_drag(kind)
    run = ss.simulate(ss.Problem(body, ss.friction.Coulomb(0.8, 0.75), 1e-6, initial_excess=0.0), "10 days")
    starts, ends, slips = (run.events[name].to_numpy() for name in ("start", "end", "slip"))
    assert len(run.history) < 0.02 * run.duration / body.round_trip_time
    late = np.flatnonzero(starts[1:] - ends[:-1] > 1e4)
    assert len(late) > 2
    # the stress that slip has taken is back after the time in which the driver has been pulled as far
    np.testing.assert_allclose(np.cumsum(slips)[late] / 1e-6, starts[1:][late], rtol=0.0, atol=body.round_trip_time)


def test_no_drag_leaves_every_bit() -> None:
    runs = [
        ss.simulate(ss.Problem(ss.LayeredSlab(**SOFT, normal_stress=1e8, drag=drag), RATE_LAW, 1e-12, initial_excess=0.0), 30.0)
        for drag in (None, [0.0, 0.0])
    ]
    assert runs[0].history.store.load.tobytes() == runs[1].history.store.load.tobytes()


def test_slow_slip_is_damped_by_drag() -> None:
    """Of one layer: the velocity falls linearly from the contact to the driver, so that a third of the drag acts on the slip."""
    assert slab(DRAG, 0.001).equivalent_block().damping == pytest.approx(DRAG * THICKNESS / 3.0, rel=1e-5)


def test_layers_with_drag_resist_disturbances_as_waves_that_drag_slows() -> None:
    """Behind them is a rigid driver: W = Z q coth(s q h / c) with q = sqrt(1 + drag / (rho s))."""
    s = (np.array([0.3, 2.0 + 1.0j, 0.5 + 4.0j, 9.0j]) * SPEED / THICKNESS).astype(complex)
    above, below = response_of(slab(DRAG, 0.005), s)
    q = np.sqrt(1.0 + DRAG / (DENSITY * s))
    np.testing.assert_allclose(above / below, Z * q / np.tanh(s * q * THICKNESS / SPEED), rtol=1e-3)


@pytest.mark.slow
def test_drag_keeps_steady_sliding_stable_under_friction_that_falls_gently() -> None:
    body = with_drag("one")
    damping = body.equivalent_block().damping
    for share, stable in ((0.3, True), (3.0, False)):
        law = ss.friction.HyperbolicRate(0.7, 0.6, share * damping / (0.1 * NORMAL))
        found = ss.studies.steady(ss.Problem(body, law, pull_rate=1e-6, initial_rate="steady"))
        assert found.slidings[0].stable == stable


def test_wrong_drags_are_refused_in_one_line() -> None:
    with refused("LayeredSlab: thickness, density, wave_speed and drag need one number for each layer, got 2 of thickness, 2 of"):
        ss.LayeredSlab(**SOFT, normal_stress=1e8, drag=[1.0])
    with refused("LayeredSlab: drag[1] must be at least 0 Pa s/m^2, got -1"):
        ss.LayeredSlab(**SOFT, normal_stress=1e8, drag=[1.0, -1.0])
    with refused("LayeredSlab: drag_step needs drag: nothing is lumped without it"):
        ss.LayeredSlab([THICKNESS], [DENSITY], [SPEED], NORMAL, drag_step=0.01)
    with refused("LayeredSlab: drag_step must be at most 0.5, got 0.6"):
        slab(DRAG, 0.6)
    with refused("LayeredSlab: drag needs more than 2048 cells of two halves, each of at most 3.33e-05 s: allow more (drag_step)"):
        slab(DRAG, 1e-4 / 2)
