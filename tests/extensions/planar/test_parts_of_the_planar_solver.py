"""The arithmetic of the planar solver, each piece by itself: against sums written out, and the loads of the exact engine."""

from __future__ import annotations

import math

import jax.numpy as jnp
import numpy as np
import pytest
from scipy.integrate import quad
from scipy.special import j1

import stickslip as ss
from stickslip.extensions.planar import echo as echoes
from stickslip.extensions.planar.driving import locked_load
from stickslip.extensions.planar.memory import advanced, recurrence
from stickslip.extensions.planar.nodes import node_values
from stickslip.extensions.planar.solver import PlanarSolver, our_settings
from stickslip.problem import inflow_of
from tests.extensions.planar.patches import SLAB, patch

RANDOM = np.random.default_rng(3)


def test_the_memory_of_a_plane_is_that_of_its_wavenumbers_one_by_one() -> None:
    frequencies = RANDOM.uniform(0.1, 40.0, (3, 4))
    plane, line = (recurrence(one, 2.0, 0.05, 10.0) for one in (frequencies, frequencies.ravel()))
    for name in ("decay", "gain", "now"):
        assert np.array_equal(getattr(plane, name).reshape(getattr(line, name).shape), getattr(line, name))


def test_the_memory_of_slip_that_grows_evenly_is_its_integral() -> None:
    """F = -Z w^2 int J1(w s)/(w s) U(t - s) ds for U = t, by quadrature, to 1e-8 of Z."""
    frequency, impedance, step, steps = 3.0, 2.0, 0.07, 40
    found = recurrence(np.array([frequency]), impedance, step, steps * step)
    memory, inherited = np.zeros_like(found.decay), 0.0
    for n in range(1, steps + 1):
        slip, time = n * step, n * step
        force = inherited + float(found.now[0]) * slip
        wanted = quad(lambda s, end=time: j1(frequency * s) / (frequency * s) * (end - s), 0.0, time, epsabs=1e-12)[0]
        assert force == pytest.approx(-impedance * frequency**2 * wanted, rel=0, abs=1e-8 * impedance)
        memory, summed = advanced(memory, found.decay, found.gain, slip)
        inherited = float(summed[0])


def test_heat_is_the_sum_of_traction_times_slip_rate_over_the_steps() -> None:
    run = PlanarSolver(patch(nodes=32, length=2e4), 3.0)
    before, heat = run.now(), np.zeros(32)
    for _ in range(30):
        assert run.advance(1)
        now = run.now()
        heat += 0.5 * run.dt * (before.traction * before.rate + now.traction * now.rate)
        before = now
    assert heat.max() > 0.0
    assert np.allclose(before.heat, heat, rtol=1e-12)


@pytest.mark.parametrize("fastest", [1.5, 3.9, 4.2])
def test_uniqueness_is_looked_at_up_to_four_times_the_rate(fastest: float) -> None:
    """A law of slip and rate that falls steeply at one rate only: seen below four times the rate asked for, and not beyond."""
    law = ss.friction.FromExpression(
        "0.6 - w*tanh((v - v0)/s) - r*u", {"w": 0.1, "v0": f"{fastest} m/s", "s": "0.05 m/s", "r": "1e-9 1/m"}
    )
    problem = ss.Problem(SLAB, law, pull_rate=1e-6, initial_load=0.5 * SLAB.normal_stress)
    values = node_values(problem, {}, (1,))
    assert values.is_unique(0.02 * problem.normal, 0.0, 1.0) == (fastest > 4.0)
    assert values.is_unique(1e9 * problem.normal, 0.0, 1.0)
    assert values.is_unique(0.02 * problem.normal, 0.0, 0.0)


def test_a_contact_reaches_twice_as_far_as_the_largest_load_would_take_it() -> None:
    slab = patch(nodes=32, length=2e4)
    assert slab.reach == pytest.approx(2.0 * np.abs(slab.values.load).max() * 1e4 / SLAB.shear_modulus, rel=1e-12)
    assert SLAB.thickness == 1e4


def test_a_contact_that_has_no_reach_has_no_process_zone() -> None:
    assert math.isnan(patch(nodes=32, length=2e4).nodes_per_process_zone(0.0))
    assert patch(nodes=32, length=2e4).nodes_per_process_zone(1e-3) > 0.0


def test_weights_do_not_depend_on_how_many_are_made_at_a_time(monkeypatch: pytest.MonkeyPatch) -> None:
    frequencies = np.array([0.0, 1.0, 20.0])
    whole = echoes.echo_weights(frequencies, 10, 2.0, 30)
    monkeypatch.setattr(echoes, "EVALUATIONS_TOGETHER", 50)
    assert all(np.array_equal(one, other) for one, other in zip(whole, echoes.echo_weights(frequencies, 10, 2.0, 30), strict=True))


def test_the_echo_of_three_round_trips_is_the_sum_written_out() -> None:
    """Convolution by Fourier transforms against the sum over all earlier steps, each linear in time, to 1e-12."""
    steps, trips, frequencies, reflection = 6, 3, np.array([0.0, 1.3, 9.0]), -1.0
    weights = echoes.echo_weights(frequencies, steps, 2.0, trips * steps)
    sent = RANDOM.normal(size=(trips, steps + 1, 2, 3))
    sent[1:, 0] = sent[:-1, -1]  # a round trip begins where the one before it ended
    sent[0, 0] = 0.0
    path = np.concatenate([sent[0], *sent[1:, 1:]])
    with our_settings():
        spectra = jnp.asarray(echoes.kernel_spectra(weights, steps, np.arange(3)))
        echo = echoes.silent(trips, steps, (2, 3))
        for trip in range(trips):
            found, echo = echoes.echo_of(jnp.asarray(sent[trip]), echo, spectra, reflection)
            for moment in range(steps + 1):
                now = trip * steps + moment
                ago = np.arange(now)
                integral = sum(weights.late[n] * path[now - n] + weights.early[n] * path[now - n - 1] for n in ago)
                assert np.allclose(found[moment], reflection * (path[now] - integral), rtol=0, atol=1e-12)


@pytest.mark.parametrize("case", ["rigid", "impedance", "far stress", "growing", "history"])
def test_the_load_of_a_locked_contact_is_that_of_the_exact_engine(case: str) -> None:
    """beta(t) = -r beta(t - R) + F(t) at rest, with the inflow of the exact engine: to 1e-12 of the load."""
    law = ss.friction.LinearSlipWeakening(static=0.9, dynamic=0.1, distance=1.0)
    body = ss.ElasticSlab(2800.0, 3500.0, 1e4, 1e8, driver_impedance=math.inf if case == "rigid" else 2e6)
    given = {
        "rigid": {"pull_rate": 1e-3},
        "impedance": {"pull_rate": 1e-3},
        "far stress": {"pull_rate": 0.0, "far_stress": 3e7},
        "growing": {"pull_rate": 0.0, "far_stress": 3e7, "far_stress_rate": 1e4},
        "history": {"pull_rate": 0.0, "far_stress": ss.loading.PiecewiseLinear([0.0, 20.0, 30.0], [3e7, 4e7, 2e7])},
    }[case]
    problem = ss.Problem(body, law, initial_load=3e7, **given)  # type: ignore[arg-type]
    steps, trips = 8, 5
    found = problem.load + locked_load(problem, steps, trips)
    inflow, strength = inflow_of(problem), problem.strength
    trip = body.two_way_time
    excess = found - strength
    for n in range(1, trips):
        times = (n + np.arange(steps + 1) / steps) * trip
        assert np.allclose(excess[n], -body.reflection * excess[n - 1] + inflow.at(times), rtol=0, atol=1e-12 * strength)
