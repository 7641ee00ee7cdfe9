"""Ground that moves: parabolas by hand, an own integrator, echoes summed by hand, energy, one-way slip, files and refusals."""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

import stickslip as ss
from stickslip.problem.loading import LoadingHistory, PiecewiseLinear, Sinusoidal, Steps
from tests.core.problem.loading.sliding_by_hand import by_hand

MASS, FORCE, LOOSE = 1.0, 10.0, 1e-12
"""kg, N; a spring (N/m) so loose that its force does not change by a digit."""
BLOCK = ss.SpringBlock(MASS, LOOSE, FORCE)
DENSITY, SPEED, THICKNESS = 2000.0, 500.0, 25.0
IMPEDANCE, TRIP = DENSITY * SPEED, 2.0 * THICKNESS / SPEED
LAW = ss.friction.Coulomb(static=0.6, dynamic=0.5)


def slab(driver: float = 0.0, mass: float = 0.0, normal: float = 1e6) -> ss.ElasticSlab:
    """Return a slab that is free at its top unless it has a driver."""
    return ss.ElasticSlab(DENSITY, SPEED, THICKNESS, normal, driver_impedance=driver, contact_mass=mass)


def record(seed: int, step: float = 0.02, points: int = 60, size: float = 12.0) -> PiecewiseLinear:
    """Return a record of acceleration at random (m/s^2) that begins and ends with 0."""
    values = size * np.random.default_rng(seed).normal(size=points)
    values[0] = values[-1] = 0.0
    return PiecewiseLinear(step * np.arange(points), values)  # type: ignore[arg-type]


@pytest.mark.parametrize("one_way", [False, True])
@pytest.mark.parametrize("seed", range(4))
def test_a_rigid_block_under_a_record_slips_as_cubics_by_hand_say(seed: int, one_way: bool) -> None:
    problem = ss.Problem(BLOCK, LAW, initial_load=2.0, ground_acceleration=record(seed), one_way=one_way)
    run = ss.simulate(problem, 9.0)
    hand = by_hand(record(seed), 2.0, 9.0, one_way=one_way, mass=MASS, limits=(0.6 * FORCE, 0.5 * FORCE))
    assert float(run.slip(9.0)) == pytest.approx(hand, rel=1e-9, abs=1e-12)
    rates = run.slip_rate(np.linspace(0.0, 2.0, 997))
    assert bool(rates.min() >= 0.0) is one_way


def test_a_rectangular_pulse_is_the_closed_form_of_newmark() -> None:
    """Ground A g for a time t0, then at rest: slip V^2 / (2 N g) (1 - N/A), with N g the yield acceleration and V = A g t0."""
    yields, pulse, lasting = 3.0, 5.0, 0.4
    law = ss.friction.Coulomb(static=yields * MASS / FORCE, dynamic=yields * MASS / FORCE)
    pushed = Steps([0.0, lasting], [-pulse, 0.0])
    event = ss.simulate(ss.Problem(BLOCK, law, initial_load=0.0, ground_acceleration=pushed), 3.0).events.iloc[0]
    slip = (pulse * lasting) ** 2 / (2.0 * yields) * (1.0 - yields / pulse)
    assert [event.start, event.end, event.slip] == pytest.approx([0.0, pulse * lasting / yields, slip], rel=1e-12)


def test_velocity_and_acceleration_of_one_motion_give_one_run() -> None:
    velocity = PiecewiseLinear([0.0, 0.3, 0.7, 1.1], [0.0, -3.0, 2.0, 0.0])
    accelerates = Steps([0.0, 0.3, 0.7, 1.1], [-10.0, 12.5, -5.0, 0.0])
    slips = [
        ss.simulate(ss.Problem(BLOCK, LAW, initial_load=0.0, **ground), 4.0).slip(np.linspace(0.0, 4.0, 9))
        for ground in ({"ground_velocity": velocity}, {"ground_acceleration": accelerates})
    ]
    assert slips[0] == pytest.approx(slips[1], rel=1e-12)
    assert slips[0][-1] < -0.1


GROUNDS: dict[str, dict[str, LoadingHistory]] = {
    "sinusoid of velocity": {"ground_velocity": Sinusoidal(0.01, 0.3, 0.37, 0.3)},
    "sinusoid of acceleration": {"ground_acceleration": Sinusoidal(0.0, 9.0, 0.37, 0.3)},
    "record of acceleration": {"ground_acceleration": record(2, size=9.0)},
    "steps of velocity": {"ground_velocity": Steps([0.0, 0.13, 0.31], [0.1, -0.2, 0.0])},
}


@pytest.mark.sampled(every=13)
@pytest.mark.parametrize("driver", [0.0, math.inf, 0.4 * IMPEDANCE])
@pytest.mark.parametrize("ground", GROUNDS.values(), ids=GROUNDS)
def test_a_slab_is_the_sum_of_its_echoes(ground: dict[str, LoadingHistory], driver: float) -> None:
    """Z (v + v_g) + S mu(v) = beta, and beta is what left a round trip before: r (2 Z (v + v_g) - beta) + a constant."""
    law, start, body = ss.friction.FromExpression("0.4 + 0.05*log(1 + v/v1)", {"v1": "0.1 m/s"}), 1e5, slab(driver)
    problem = ss.Problem(body, law, initial_load=start, **ground)
    run = ss.simulate(problem, 1.0)
    assert problem.ground is not None
    moves, reflection = problem.ground.velocity_at, body.reflection

    def rate(load: float) -> float:
        if abs(load) <= 4e5:
            return 0.0
        slips = brentq(lambda v: IMPEDANCE * v + 1e6 * (0.4 + 0.05 * math.log1p(v / 0.1)) - abs(load), 0.0, 10.0, xtol=1e-16)
        return math.copysign(slips, load)

    def arriving(t: float) -> float:
        if t < TRIP:
            return start
        before, velocity = arriving(t - TRIP), float(moves(t - TRIP))
        return (
            reflection * (2.0 * IMPEDANCE * (rate(before - IMPEDANCE * velocity) + velocity) - before) + (1.0 + reflection) * start
        )

    times = np.linspace(0.0031, 0.9963, 83)
    loads = [arriving(t) - IMPEDANCE * float(moves(t)) for t in times]
    assert run.load(times) == pytest.approx(loads, rel=1e-9, abs=1e-4)
    assert run.slip_rate(times) == pytest.approx([rate(load) for load in loads], rel=1e-8, abs=1e-10)
    energy = run.energy(times)
    assert np.abs(energy.balance).max() < 1e-11 * np.abs(energy.stored).max()


@pytest.mark.sampled(every=2)
@pytest.mark.parametrize("mass", [0.0, 3000.0])
def test_the_field_in_a_slab_is_that_of_the_absolute_motion(mass: float) -> None:
    """At the contact it moves with slip and ground; inside, velocity is the derivative of displacement, and stress that in x."""
    ground = record(5, size=9.0)
    law = ss.friction.LinearSlipWeakening(0.6, 0.5, 0.1)
    problem = ss.Problem(slab(mass=mass), law, initial_load=1e5, ground_acceleration=ground)
    run, moves = ss.simulate(problem, 1.5), problem.ground
    assert moves is not None
    assert run.slip(1.5) > 0.01
    times = np.linspace(0.01, 1.49, 31)
    at_contact = run.field(0.0, times)
    assert at_contact.displacement == pytest.approx(run.slip(times) + moves.displacement_at(times), abs=1e-12)
    assert at_contact.velocity == pytest.approx(run.slip_rate(times) + moves.velocity_at(times), abs=1e-12)
    grows = run.slip_rate(times + 1e-6) - run.slip_rate(times - 1e-6)
    inertia = mass * (grows / 2e-6 + moves.acceleration_at(times))
    assert at_contact.stress == pytest.approx(run.traction(times) + inertia, abs=30.0)
    x = np.array([[3.3], [11.1], [21.7]])
    later, before, here = (run.field(x, times + by) for by in (1e-6, -1e-6, 0.0))
    assert (later.displacement - before.displacement) / 2e-6 == pytest.approx(here.velocity, abs=2e-3)
    above, below = (run.field(x + by, times) for by in (1e-3, -1e-3))
    assert DENSITY * SPEED**2 * (above.displacement - below.displacement) / 2e-3 == pytest.approx(here.stress, abs=2e3)
    energy = run.energy(times)
    assert np.abs(energy.balance).max() < 1e-10 * np.abs(energy.stored).max()


@pytest.mark.sampled(every=4)
@pytest.mark.parametrize(
    "body",
    [slab(), slab(mass=3000.0), slab(0.4 * IMPEDANCE), ss.SpringBlock(5e4, 2e6, 1e6)],
    ids=["free top", "contact mass", "driver", "block"],
)
def test_the_energies_of_every_event_balance_and_its_window_is_the_run(body: ss.ElasticSlab | ss.SpringBlock) -> None:
    problem = ss.Problem(
        body, ss.friction.LinearSlipWeakening(0.6, 0.5, 0.1), initial_load=1e5, ground_acceleration=record(5, size=9.0)
    )
    run = ss.simulate(problem, 1.5)
    table = run.energetics()
    assert len(table) > 1
    assert np.abs(table.balance).max() < 1e-10 * table.heat.max()
    if body.has_waves:
        event = run.events.iloc[1]
        window = run.window(1)
        places, local = np.array([0.0, 5.0, 24.0]), 0.01
        inside, whole = window.field(places, local), run.field(places, event.start + local)
        assert problem.ground is not None
        stood = float(run.slip(event.start) + problem.ground.displacement_at(event.start))
        assert inside.displacement == pytest.approx(whole.displacement - stood, abs=1e-11)
        assert inside.velocity == pytest.approx(whole.velocity, abs=1e-9)


@pytest.mark.sampled(every=2)
@pytest.mark.parametrize("ground", [Sinusoidal(0.0, 0.5, 0.4), Steps([0.0, 0.3, 0.7], [-0.4, 0.4, 0.0])], ids=["sinusoid", "steps"])
def test_rate_and_state_on_shaken_ground_follows_an_own_integrator(ground: LoadingHistory) -> None:
    """To 1e-7 of the slip; steps of acceleration are met by implicit steps, too."""
    reference, a, b, distance, slow, pull = 0.6, 0.01, 0.008, 1e-3, 1e-3, 1e-2
    law = ss.friction.RateAndState(reference, a, b, distance, slow)
    run = ss.simulate(ss.Problem(ss.SpringBlock(1e3, 2e5, 1e4), law, pull_rate=pull, ground_acceleration=ground), 1.0)

    def change(t: float, y: list[float]) -> list[float]:
        u, v, w = y
        friction = 1e4 * a * math.asinh(v / (2.0 * slow) * math.exp((reference + b * w) / a))
        load = start + 2e5 * (pull * t - u) - 1e3 * float(ground.at(t))
        return [v, (load - friction) / 1e3, slow / distance * math.exp(-w) - v / distance]

    w = math.log(slow / pull)
    start = 1e4 * a * math.asinh(pull / (2.0 * slow) * math.exp((reference + b * w) / a))
    y, edges = [0.0, pull, w], [0.0, 0.3, 0.7, 1.0]
    for begin, end in pairwise(edges):
        y = solve_ivp(change, (begin, np.nextafter(end, 0.0)), y, "Radau", rtol=1e-10, atol=1e-12).y[:, -1].tolist()
    assert [float(run.slip(1.0)), float(run.slip_rate(1.0))] == pytest.approx(y[:2], rel=1e-7)


def test_a_slab_whose_top_lets_waves_out_moves_by_its_transfer_function() -> None:
    omega, size, driver = 2.0 * math.pi / 0.37, 0.1, 0.3 * IMPEDANCE
    body = slab(driver)
    run = ss.simulate(ss.Problem(body, LAW, initial_load=1e5, ground_velocity=Sinusoidal(0.0, size, 0.37)), 6.4)
    times, r, late = np.linspace(6.0, 6.4, 33), body.reflection, np.exp(-1j * omega * TRIP)
    top = size * (1.0 + r) * np.exp(-0.5j * omega * TRIP) / (1.0 + r * late)
    stress = -IMPEDANCE * size * (1.0 - r * late) / (1.0 + r * late)
    turns = np.exp(1j * omega * times)
    assert run.field(THICKNESS, times).velocity == pytest.approx((top * turns).imag, abs=1e-11)
    assert run.traction(times) == pytest.approx(1e5 + (stress * turns).imag, abs=1e-4)


@pytest.mark.slow
def test_a_stiff_slab_slips_as_the_rigid_block() -> None:
    """The difference falls with h/c: the masses are the same, and the free top follows the sooner."""
    ground, mass, law = record(1, size=6.0), DENSITY * THICKNESS, ss.friction.Coulomb(static=0.5, dynamic=0.5)
    rigid = ss.simulate(
        ss.Problem(ss.SpringBlock(mass, LOOSE, 2.5e5), law, initial_load=0.0, ground_acceleration=ground, one_way=True), 1.3
    )
    missed = []
    for trips in (4, 8, 16):  # in each step of the record
        body = ss.ElasticSlab(DENSITY, 2.0 * THICKNESS * trips / 0.02, THICKNESS, 2.5e5, driver_impedance=0.0)
        slips = ss.simulate(ss.Problem(body, law, initial_load=0.0, ground_acceleration=ground, one_way=True), 1.3)
        missed.append(abs(float(slips.slip(1.3)) / float(rigid.slip(1.3)) - 1.0))
    assert missed[0] < 0.04
    assert missed[1] < 0.4 * missed[0]
    assert missed[2] < 0.4 * missed[1]


def test_one_way_rest_under_a_falling_load_costs_nothing_and_never_ends() -> None:
    for body, load in ((ss.SpringBlock(1.0, 100.0, 10.0), 0.0), (ss.ElasticSlab(2700.0, 3000.0, 3000.0, 1e7), 0.0)):
        problem = ss.Problem(body, LAW, pull_rate=-1e-9, initial_load=load, one_way=True)
        run = ss.simulate(problem, "1e6 years")
        assert (len(run.events), len(run.history) < 20) == (0, True)
        assert len(ss.simulate(replace(problem, one_way=False), "1e6 years", max_events=2).events) == 2


def test_a_scenario_reads_a_record_in_g_and_a_saved_run_is_the_same(tmp_path: Path) -> None:
    (tmp_path / "shaking.csv").write_text("time (s),ground_acceleration (g)\n0,0\n0.1,-1.2\n0.2,0.9\n0.3,0\n")
    scenario = tmp_path / "shaken.toml"
    scenario.write_text(
        '[body]\nkind = "spring-block"\nmass = 1.0\nstiffness = 1e-6\nnormal_force = 9.8\n'
        '[friction]\nkind = "coulomb"\nstatic = 0.5\ndynamic = 0.4\n[loading]\none_way = true\n'
        '[loading.ground_acceleration]\nkind = "piecewise-linear"\nfile = "shaking.csv"\n'
        "[initial]\nload = 1.0\n[run]\nduration = 2.0\n"
    )
    read = ss.load_scenario(scenario)
    assert read.problem.ground_acceleration is not None
    assert read.problem.ground_acceleration.at(0.1) == pytest.approx(-1.2 * 9.80665, rel=1e-15)
    run = ss.simulate(read)
    saved = ss.open_solution(run.to_netcdf(tmp_path / "run.nc"))
    times = np.linspace(0.0, 2.0, 41)
    assert saved.slip(times).tobytes() == run.slip(times).tobytes()
    assert saved.problem == read.problem
    assert float(run.slip(2.0)) > 0.0
    half = ss.simulate(read.problem, 0.15).to_netcdf(tmp_path / "half.nc")
    assert ss.resume(half, 2.0).slip(times).tobytes() == run.slip(times).tobytes()
    scaled = read.with_values({"loading.ground_acceleration.values[1]": "-1500 gal"}).problem
    assert scaled.ground_acceleration.at(0.1) == pytest.approx(-15.0)  # type: ignore[union-attr]


PULSE = PiecewiseLinear([0.0, 0.1, 0.2], ["0 g", "0.5 g", "0 g"])
SHAKEN = ss.Problem(slab(), LAW, initial_load=1e5, ground_acceleration=PULSE)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (
            lambda: replace(SHAKEN, ground_velocity=PiecewiseLinear([0.0, 1.0], [0.0, 1.0])),
            "Problem: only one of ground_velocity and ground_acceleration may be given: one follows from the other",
        ),
        (
            lambda: replace(SHAKEN, ground_acceleration=None, ground_velocity=PULSE),
            "Problem: ground_velocity must be in m/s, got a history of values in m/s^2",
        ),
        (
            lambda: ss.Problem(BLOCK, LAW, initial_load=0.0, ground_velocity=Steps([0.0, 1.0], [0.0, 1.0])),
            "Problem: ground_velocity jumps, which is an infinite force on a mass: join the points (piecewise-linear), beginning"
            " with 0 m/s, or give ground_acceleration",
        ),
        (
            lambda: replace(SHAKEN, body=slab(1e5), far_stress=Sinusoidal(1e5, 1e3, 1.0), ground_acceleration=Sinusoidal(0, 1, 1)),
            "Problem: only one of the ground and the pull may have a sinusoid: give the other as straight lines",
        ),
        (
            lambda: ss.Problem(BLOCK, LAW, initial_load=0.0, ground_acceleration=3.0),  # type: ignore[arg-type]
            "Problem: ground_acceleration must be a loading history, got 3.0; what varies in time is one of stickslip.loading,"
            " such as Steps([0.0, 10.0], [1e-6, 1e-5])",
        ),
        (
            lambda: replace(SHAKEN, body=ss.RotatingBlock(1.0, 100.0, 1e6)),
            "Problem: ground_acceleration must be in rad/s^2, got a history of values in m/s^2",
        ),
        (
            lambda: PiecewiseLinear(np.arange(1e6 + 1.0), np.zeros(10**6 + 1)),  # type: ignore[arg-type]
            "PiecewiseLinear: times must have 2 to 1000000 numbers, got 1000001",
        ),
        (
            lambda: replace(SHAKEN, friction=ss.friction.RateAndState(0.6, 0.01, 0.008, 1e-4), initial_state=1.0, one_way=True),
            "Problem: one_way needs a law with a static strength, and RateAndState never sticks",
        ),
        (
            lambda: replace(SHAKEN, one_way="yes"),  # type: ignore[arg-type]
            "Problem: one_way must be True or False, got 'yes'",
        ),
        (
            lambda: replace(SHAKEN, initial_rate=-1.0, body=slab(mass=1.0), one_way=True),
            "Problem: initial_rate is backwards, where a contact that slips one way only does not go",
        ),
        (
            lambda: ss.simulate(SHAKEN, 1.0, creep_rtol=1e-3),
            "simulate: creep_rtol must be 0 here: leaps over creep need a rigid driver (no driver_impedance)",
        ),
    ],
)
def test_what_cannot_be_is_refused_in_one_line(make: object, message: str) -> None:
    with pytest.raises(ss.InputError) as refused:
        make()  # type: ignore[operator]
    assert str(refused.value) == message
