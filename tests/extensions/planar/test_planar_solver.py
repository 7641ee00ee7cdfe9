"""The planar solver against the exact engine in 1D, closed forms of growth, and itself on several devices."""

from __future__ import annotations

import json
import math
import os
import socket
import subprocess
import sys
from typing import Any

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.special import j1

import stickslip as ss
from stickslip.extensions.planar.echo import echo_weights
from stickslip.extensions.planar.friction import ContactOfNodes, Nodes
from stickslip.extensions.planar.memory import exponentials
from stickslip.extensions.planar.solver import PlanarSolver, our_settings
from tests.extensions.planar.patches import LAW, SLAB, patch

DENSITY, SPEED, THICKNESS, STRESS = 2800.0, 3500.0, 1e4, 1e8
MODULUS = DENSITY * SPEED**2
WEAKENING = 1.5 / THICKNESS  # alpha_w = -S mu'/G, so that alpha_w h = 1.5
DISTANCE = 1e3


def weakening_law() -> ss.friction.LinearSlipWeakening:
    drop = WEAKENING * MODULUS * DISTANCE / STRESS
    return ss.friction.LinearSlipWeakening(static=drop + 0.1, dynamic=0.1, distance=DISTANCE)


def slips(problem: ss.Problem, duration: float, steps: int) -> tuple[np.ndarray, np.ndarray]:
    run = PlanarSolver(ss.PlanarSlab(problem, nodes=8, length=4e4), duration, steps_per_round_trip=steps)
    times, found = [], []
    while run.advance(steps // 20):
        times.append(run.time)
        found.append(run.now().slip)
    assert all(np.ptp(one) < 1e-12 for one in found)
    return np.array(times), np.array(found)[:, 0]


@pytest.mark.parametrize("longest", [1.0, 100.0, 1e4])
def test_exponentials_sum_to_the_bessel_kernel(longest: float) -> None:
    poles, weights = exponentials(longest)
    x = np.concatenate([np.linspace(1e-3, min(longest, 60.0), 2000), np.linspace(1e-3, longest, 2001)])
    found = np.sum(weights[:, None] * np.exp(poles[:, None] * x), axis=0).real
    assert np.abs(found - j1(x) / x).max() < 2e-9
    assert poles.real.max() <= 0.0


@pytest.mark.parametrize("phase", [0.05, 0.39, 0.41, 1.89, 1.91, 6.0])
def test_weights_of_echoes_are_integrals_of_the_kernel(phase: float) -> None:
    """W linear in time in each step against w R J1(w s)/s, to 2e-11; `phase` is w dt."""
    steps, trip = 40, 2.0
    found = echo_weights(np.array([phase * steps / trip]), steps, trip, 80)
    w, dt = phase * steps / trip, trip / steps
    for i in (0, 1, 7, 79):
        ends = [math.sqrt((trip + (i + j) * dt) ** 2 - trip**2) for j in (0, 1)]
        for weights, begins in ((found.early, 0.0), (found.late, 1.0)):

            def integrand(s: float, i: int = i, begins: float = begins) -> float:
                passed = (math.hypot(trip, s) - trip) / dt - i
                return float(w * trip * j1(w * s) / math.hypot(trip, s) * abs(begins - passed))

            exact, _ = quad(integrand, *ends, epsabs=1e-13, epsrel=1e-13, limit=400)
            assert weights[i, 0] == pytest.approx(exact, abs=2e-11, rel=0.0)


@pytest.mark.slow
def test_slip_rates_that_are_found_stay_while_others_are_sought(monkeypatch: pytest.MonkeyPatch) -> None:
    """Five steps of Newton's method from 1 % beside the root, or from the root itself, meet the load to 1e-12."""
    monkeypatch.setattr("stickslip.extensions.planar.friction.ITERATIONS", 5)
    law, impedance = ss.friction.RateAndState(reference=0.6, a=0.01, b=0.015, distance=0.1), SLAB.impedance
    problem = ss.Problem(SLAB, law, initial_load=60e6, initial_state=1.0)
    slab = ss.PlanarSlab(problem, nodes=64, length=2e4)
    nodes, contact = Nodes.of(slab.values, slab.locked, impedance), ContactOfNodes.of(law)
    rates, slip, states = np.geomspace(1e-9, 10.0, 64), np.zeros(64), slab.values.states
    with our_settings():
        load = impedance * rates + 1e8 * contact.coefficient(nodes, slip, rates, states)
        found = contact.rate(nodes, load, slip, states, rates * np.where(np.arange(64) % 2, 1.01, 1.0))
        missed = impedance * found + 1e8 * contact.coefficient(nodes, slip, found, states) - load
    assert np.abs(missed / load).max() < 1e-12


def test_a_uniform_contact_is_the_slab_in_1d_at_order_two() -> None:
    problem = ss.scenarios["fig5-slab-reconstructed"].problem
    exact = ss.simulate(problem, 7.0)
    errors = []
    for steps in (1000, 2000):
        times, slip = slips(problem, 7.0, steps)
        errors.append(np.abs(slip - exact.slip(times)).max())
    assert errors[1] < 1e-3  # of 0.376 m, while three pulses pass
    assert 3.3 < errors[0] / errors[1] < 4.7
    assert slip[-1] - problem.initial_slip == pytest.approx(0.376105283, abs=5e-6, rel=0.0)
    assert slip[-1] == slip[times > SLAB.two_way_time + 0.01][0]  # it has arrested with the echo


def test_a_run_may_end_with_a_round_trip() -> None:
    """The loading of the round trip after it does not exist."""
    run = ss.simulate(patch(nodes=32, length=2e4), 2.0 * SLAB.two_way_time, frames=10)
    assert run.times[-1] == pytest.approx(2.0 * SLAB.two_way_time, rel=1e-12, abs=0.0)


LAWS = {
    "state": ss.Problem(
        ss.ElasticSlab(DENSITY, SPEED, 1e3, STRESS),
        ss.friction.RateAndState(reference=0.6, a=0.01, b=0.015, distance=1e-3),
        pull_rate=1e-3,
        initial_load=63e6,
        initial_state=1.2,
    ),
    "rate": ss.Problem(SLAB, ss.friction.HyperbolicRate(0.8, 0.3, 0.15), initial_excess=2e6, pull_rate=0.5),
    "slip and rate": ss.Problem(SLAB, lambda u, v: 0.6 - 0.1 * np.tanh(u / 0.5) - 0.02 * v / (v + 1.0), initial_excess=1e6),
    "pieces": ss.Problem(SLAB, ss.friction.LinearSlipWeakening(0.7, 0.5, 0.4), initial_excess=1e6),
    "backward": ss.Problem(SLAB, ss.friction.LinearSlipWeakening(0.7, 0.5, 0.4), initial_load=-71e6),
    "half-space above": ss.Problem(
        ss.ElasticSlab(DENSITY, SPEED, THICKNESS, STRESS, driver_impedance=2e7),
        ss.friction.SinusoidalSlip(mean=0.6, amplitude=0.1, wavenumber=1.0),
        3.0,
        initial_excess=1e6,
    ),
    "dead load": ss.Problem(
        ss.ElasticSlab(DENSITY, SPEED, THICKNESS, STRESS, driver_impedance=0.0),
        ss.friction.LinearSlipWeakening(0.7, 0.65, 0.4),
        initial_excess=1e6,
    ),
}


QUICK = ("half-space above",)


@pytest.mark.slow
@pytest.mark.parametrize("name", [name if name in QUICK else pytest.param(name, marks=pytest.mark.slow) for name in LAWS])
def test_any_law_on_a_uniform_contact_is_the_slab_in_1d(name: str) -> None:
    problem = LAWS[name]
    duration = 2.6 * problem.round_trip_time
    exact = ss.simulate(problem, duration)
    errors = []
    for steps in (400, 800):
        times, slip = slips(problem, duration, steps)
        errors.append(np.abs(slip - exact.slip(times)).max() / np.ptp(exact.slip(times)))
    assert errors[1] < 2e-4
    assert errors[1] < 0.6 * errors[0]


@pytest.mark.sampled(every=3)
@pytest.mark.parametrize(("kh", "rate"), [(0.0, 1.287839), (0.5, 1.186815), (1.0, 0.811499)])
def test_a_disturbance_of_a_wavenumber_grows_as_the_closed_form_says(kh: float, rate: float) -> None:
    """q coth(q h) = alpha_w, lambda = c sqrt(q^2 - k^2), to 1e-4 of the rate, which the time steps leave: half as long, 2e-5.

    Echoes of the start fade first. Slip begins small, so that by then friction still weakens.
    """
    length = 2.0 * math.pi * THICKNESS / (kh or 1.0)
    problem = ss.Problem(SLAB, weakening_law(), initial_excess=1e-3)
    mode = int(kh > 0.0)
    contact = ss.PlanarSlab(
        problem, nodes=8, length=length, along={"excess": lambda y: 1e-3 + 5e-4 * mode * np.cos(2.0 * np.pi * y / length)}
    )
    run = PlanarSolver(contact, 60.0, steps_per_round_trip=200)
    times, size = [], []
    while run.advance(20):
        times.append(run.time)
        size.append(abs(np.fft.rfft(run.now().slip)[mode]))
    late = np.array(times) > 45.0
    grows = np.polyfit(np.array(times)[late], np.log(np.array(size)[late]), 1)[0]
    assert grows * THICKNESS / SPEED == pytest.approx(rate, rel=1e-4, abs=0.0)


@pytest.mark.slow
def test_a_disturbance_on_a_half_space_grows_as_the_closed_form_says() -> None:
    """lambda = c sqrt(alpha_w^2 - k^2), before an echo returns."""
    wavenumber = 0.5 / THICKNESS
    problem = ss.Problem(ss.ElasticSlab(DENSITY, SPEED, 2e5, STRESS), weakening_law(), initial_excess=1.0)
    length = 2.0 * math.pi / wavenumber
    contact = ss.PlanarSlab(problem, nodes=32, length=length, along={"excess": lambda y: 1.0 + 0.5 * np.cos(wavenumber * y)})
    run = PlanarSolver(contact, 40.0, steps_per_round_trip=4000)
    times, size = [], []
    while run.advance(20):
        times.append(run.time)
        size.append(abs(np.fft.rfft(run.now().slip)[1]))
    late = np.array(times) > 15.0
    grows = np.polyfit(np.array(times)[late], np.log(np.array(size)[late]), 1)[0]
    assert grows == pytest.approx(SPEED * math.sqrt(WEAKENING**2 - wavenumber**2), rel=1e-4, abs=0.0)


@pytest.mark.sampled(every=2)
@pytest.mark.parametrize(("phase", "stable"), [(2.5, True), (3.2, False)])
def test_steps_are_stable_up_to_a_phase_of_the_shortest_wave(phase: float, stable: bool) -> None:
    """The largest w dt is 2.5: there a disturbance from node to node fades, and at 3.2 it grows. Friction is constant."""
    problem = ss.Problem(SLAB, ss.friction.FromFunction(lambda u, v: 0.6 + 0.0 * u), initial_load=61e6)
    wavy = {"initial.load": 61e6 + 1e3 * (-1.0) ** np.arange(16)}
    steps = math.ceil(math.pi / 500.0 * SPEED * SLAB.two_way_time / phase)
    run = PlanarSolver(ss.PlanarSlab(problem, nodes=16, length=8e3, along=wavy), SLAB.two_way_time, steps_per_round_trip=steps)
    run.advance(steps - 1)
    size = np.abs(np.fft.rfft(run.now().rate)[-1]) / 16.0
    begun = 1e3 / SLAB.impedance
    assert size < 1e-3 * begun if stable else size > begun


@pytest.mark.slow
def test_a_plane_on_which_nothing_varies_with_z_is_a_line() -> None:
    problem = ss.Problem(SLAB, LAW, initial_load=60e6)
    nucleus = {"load": lambda y, *_: np.where(np.abs(y) < 4e3, 71e6, 60e6)}
    line = ss.simulate(ss.PlanarSlab(problem, nodes=64, length=2e4, along=nucleus), 8.0, frames=10)
    plane = ss.PlanarSlab(problem, nodes=64, length=2e4, width=1e4, width_nodes=32, along=nucleus)
    found = ss.simulate(plane, 8.0, frames=10)
    assert np.abs(found.slip - line.slip[..., None]).max() < 1e-10 * line.slip.max()


@pytest.mark.slow
def test_a_contact_without_replicas_is_a_periodic_one_until_waves_of_replicas_arrive() -> None:
    grid = {"nodes": 64, "length": 2e4}
    alone, periodic = (ss.simulate(patch(**grid, replicas=kind), 8.0, frames=50) for kind in (False, True))
    gap = 2e4 - 2 * 9e3
    before = alone.times < gap / SPEED  # from the edge of one contact to that of the next
    assert alone.slip.shape == periodic.slip.shape
    # waves between nodes are sums of a finite number of wavelengths, which run ahead of the front a little
    assert np.abs(alone.slip - periodic.slip)[before].max() < 1e-4 * alone.slip[before].max()
    assert np.abs(alone.slip - periodic.slip)[-1].max() > 1e-2 * alone.slip.max()  # later they are not alike


def test_slip_of_one_contact_is_symmetric_and_locked_nodes_rest() -> None:
    found = ss.simulate(patch(nodes=32, length=2e4), 7.0, frames=10)
    assert np.abs(found.slip[:, 1:] - found.slip[:, :0:-1]).max() < 1e-9 * found.slip.max()
    assert not found.slip[:, np.abs(found.slab.y) > 9e3].any()
    assert (found.slip_rate * found.traction >= 0.0).all()


SEVERAL = """
import json, re, sys
import jax, numpy as np
if len(sys.argv) > 1:
    jax.distributed.initialize(sys.argv[1], num_processes=2, process_id=int(sys.argv[2]))
from stickslip.extensions.planar.solver import PlanarSolver, our_settings
from tests.extensions.planar.patches import patch
found = []
for grid in ({"nodes": 32, "length": 2e4}, {"nodes": 32, "length": 2e4, "width": 2e4, "width_nodes": 16}):
    run = PlanarSolver(patch(**grid), 8.0)
    while run.advance(1000):
        pass
    found.append(run.now().slip.ravel().tolist())
with our_settings():
    step = run.functions.march.lower(run.motion, run.waves, run.constants, run.loading[0], np.array([0, 1])).compile().as_text()
print(json.dumps([len(jax.devices()), found, sorted(set(re.findall("all-[a-z-]+[a-z]", step)))]))
"""


def started(devices: int, *arguments: str) -> subprocess.Popen[str]:
    flags = {"XLA_FLAGS": f"--xla_force_host_platform_device_count={devices}", "JAX_PLATFORMS": "cpu"}
    flags["JAX_DISABLE_MOST_OPTIMIZATIONS"] = "0"  # as users have it
    command = [sys.executable, "-c", SEVERAL, *arguments]
    return subprocess.Popen(command, env=os.environ | flags, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


def answered(process: subprocess.Popen[str]) -> Any:
    output, errors = process.communicate(timeout=300)
    assert process.returncode == 0, errors
    return json.loads(output.splitlines()[-1])


def agree(one: Any, other: Any) -> bool:
    return all(np.abs(np.subtract(a, b)).max() < 1e-12 * np.abs(a).max() for a, b in zip(one, other, strict=True))


@pytest.mark.slow
def test_two_devices_give_the_numbers_of_one_and_transpose_planes() -> None:
    """The compiled step of a plane exchanges parts (all-to-all), and never gathers a plane."""
    (one, slip, _), (two, others, exchanges) = (answered(started(count)) for count in (1, 2))
    assert (one, two) == (1, 2)
    assert agree(slip, others)
    assert exchanges == ["all-to-all"]


@pytest.mark.slow
def test_two_processes_give_the_numbers_of_one() -> None:
    """They find each other at a port of this machine, as processes of a cluster do."""
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        address = f"127.0.0.1:{free.getsockname()[1]}"
    processes = [started(1, address, str(rank)) for rank in (0, 1)]
    _, slip, _ = answered(started(1))
    for devices, others, exchanges in map(answered, processes):
        assert devices == 2
        assert agree(slip, others)
        assert exchanges == ["all-to-all"]
