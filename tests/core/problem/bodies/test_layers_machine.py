"""A driver that is a machine behind layers: one slab, closed forms, an own program, its neighbours, energies, taken up again."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import stickslip as ss
from stickslip.foundation.arrays import Floats
from stickslip.problem.loading import Sinusoidal, Steps
from tests.core.problem.bodies import layer_chains
from tests.core.problem.bodies.layer_chains import Chain, march
from tests.messages import refused

STRESS, THICKNESS, DENSITY, SPEED = 1e6, 100.0, 2800.0, 3500.0
RIGID = ss.ElasticSlab(DENSITY, SPEED, THICKNESS, STRESS)
Z, T = RIGID.impedance, 0.5 * RIGID.two_way_time
COULOMB = ss.friction.Coulomb(0.6, 0.4)
STRIBECK = ss.friction.ExponentialStribeck(static=0.6, dynamic=0.4, rate=0.02)
WEAKENS = ss.friction.HyperbolicRate(0.6, 0.4, 1.5 * Z / (0.2 * STRESS))


def slab(inertia: float = 0.0, impedance: float = 1.0, gain: float = 0.0, mass: float = 0.0) -> ss.ElasticSlab:
    """Return the slab with a machine, in units of Z T, Z and Z / T."""
    machine = {"driver_inertia": inertia * Z * T, "driver_impedance": impedance * Z, "driver_integral_gain": gain * Z / T}
    return replace(RIGID, contact_mass=mass * Z * T, **machine)  # type: ignore[arg-type]


def cut(body: ss.ElasticSlab, *shares: float) -> ss.LayeredSlab:
    """Return a slab cut into layers that have these shares of its thickness."""
    lists = [THICKNESS * share for share in shares], [DENSITY] * len(shares), [SPEED] * len(shares)
    numbers = {name: getattr(body, name) for name in ("driver_impedance", "contact_mass", "driver_inertia", "driver_integral_gain")}
    return ss.LayeredSlab(*lists, STRESS, **numbers)


CASES: dict[str, tuple[ss.ElasticSlab, Any]] = {
    "mass": (slab(2.6, 0.12), COULOMB),
    "mass and mass of the contact": (slab(0.5, 4.2, mass=0.1), STRIBECK),
    "gain": (slab(0.0, 0.43, 0.94), COULOMB),
    "all": (slab(1.3, 0.55, 0.3), COULOMB),
    "all, and folds": (slab(1.3, 0.55, 0.3), WEAKENS),
    "gain, and folds": (slab(0.0, 0.2, 0.5), WEAKENS),
}
PULLS: dict[str, Any] = {
    "steady": 0.03,
    "steps": Steps([0.0, 3.3 * T], [0.03, 0.075]),
    "sinusoid": Sinusoidal(mean=0.03, amplitude=0.01, period=5.0 * T),
}


@pytest.mark.sampled(every=65)
@pytest.mark.parametrize("shares", [(1.0,), (0.2, 0.8), (0.3, 0.4, 0.3)])
@pytest.mark.parametrize("pull", PULLS)
@pytest.mark.parametrize("name", CASES)
def test_layers_of_equal_impedance_are_one_slab(name: str, pull: str, shares: tuple[float, ...]) -> None:
    check_one_slab(*CASES[name], shares, pull_rate=PULLS[pull])


@pytest.mark.sampled(every=2)
@pytest.mark.parametrize("name", ["gain", "all"])
def test_layers_of_equal_impedance_are_one_slab_under_a_far_stress_of_its_own(name: str) -> None:
    check_one_slab(*CASES[name], (0.2, 0.8), pull_rate=0.03, far_stress=6.3e5)


def check_one_slab(body: ss.ElasticSlab, law: Any, shares: tuple[float, ...], **loading: Any) -> None:
    """Compare a run of a slab with that of the layers into which it is cut."""
    lasting = 12.0 * T
    known, run = (ss.simulate(ss.Problem(one, law, initial_excess=-2e4, **loading), lasting) for one in (body, cut(body, *shares)))
    t = np.linspace(1e-3, 0.999, 17) * lasting
    assert known.slip(lasting) > 1e-3
    np.testing.assert_allclose(run.slip(t), known.slip(t), rtol=1e-9, atol=1e-10 * float(known.slip(lasting)))
    x = np.linspace(0.0, THICKNESS, 5)[:, None]
    for one, other in zip(run.field(x, t), known.field(x, t), strict=True):
        assert np.quantile(np.abs(one - other), 0.97) < 1e-9 * np.abs(other).max()
    energy, of_slab = run.energy(t), known.energy(t)
    size = float(np.abs(of_slab.stored).max())
    for part in ("work", "stored", "kinetic", "radiated", "trapped", "heat", "balance"):
        np.testing.assert_allclose(energy[part], of_slab[part], rtol=1e-9, atol=1e-10 * size, err_msg=part)
    events, of_events = run.catalogue(0.0, energy=True), known.catalogue(0.0, energy=True)
    np.testing.assert_allclose(events.released, of_events.released, rtol=1e-7, atol=1e-9 * size)


@pytest.mark.slow
def test_rests_are_leapt_over_once_the_waves_have_died() -> None:
    """Two events in 6 000 000 s, as of the slab; and a pull that stops and goes on while the contact rests."""
    body = slab(0.0, 0.3, 0.2)
    for pull in (1e-9, Steps([0.0, 1e6, 2e6], [1e-9, 0.0, 3e-9])):
        problem = ss.Problem(body, COULOMB, pull_rate=pull, initial_excess=-1.0)
        known, run = (ss.simulate(replace(problem, body=one), 6e6) for one in (body, cut(body, 0.4, 0.6)))
        assert len(run.history) < 20_000
        assert len(run.events) >= 2
        np.testing.assert_allclose(run.events.start, known.events.start, rtol=1e-7)
        np.testing.assert_allclose(run.events.slip, known.events.slip, rtol=1e-9)
        times = np.array([0.5e6, 1.7e6, 2.1e6, 4.3e6, 5.9e6])
        np.testing.assert_allclose(run.load(times), known.load(times), rtol=1e-9, atol=1e-7 * STRESS)
        energy, of_slab = run.energy(times), known.energy(times)
        np.testing.assert_allclose(energy.work, of_slab.work, rtol=1e-7)
        assert np.abs(energy.balance).max() < 1e-10 * np.abs(energy.work).max()
        driven = run.field(THICKNESS, times).velocity
        np.testing.assert_allclose(driven, known.field(THICKNESS, times).velocity, rtol=1e-5, atol=1e-15)


def test_a_mass_without_bound_is_a_rigid_driver() -> None:
    lists = [40.0, 60.0], [2000.0, 2800.0], [2000.0, 3000.0]
    rigid = ss.LayeredSlab(*lists, STRESS)
    problem = ss.Problem(rigid, COULOMB, pull_rate=0.01, initial_excess=-1e4)
    known, time = ss.simulate(problem, 20.0 * T), np.linspace(0.0, 20.0 * T, 300)
    infinite = replace(rigid, driver_impedance=Z, driver_inertia=math.inf)
    assert np.array_equal(ss.simulate(replace(problem, body=infinite), 20.0 * T).history.store.pieces, known.history.store.pieces)
    apart = []
    for mass in (1e4, 1e5, 1e6):
        heavy = replace(rigid, driver_impedance=Z, driver_inertia=mass * Z * T)
        apart.append(np.abs(ss.simulate(replace(problem, body=heavy), 20.0 * T).slip(time) - known.slip(time)).max())
    assert apart[0] / apart[1] == pytest.approx(10.0, rel=2e-2)
    assert apart[1] / apart[2] == pytest.approx(10.0, rel=2e-3)


def test_a_mass_and_gain_that_vanish_leave_the_impedance() -> None:
    lists = [40.0, 60.0], [2000.0, 2800.0], [2000.0, 3000.0]
    plain = ss.LayeredSlab(*lists, STRESS, driver_impedance=0.5 * Z, travel_time_error=1e-2)
    problem = ss.Problem(plain, COULOMB, pull_rate=0.01, far_stress=6.2e5, initial_excess=-1e4)
    known, time = ss.simulate(problem, 20.0 * T), np.linspace(0.0, 20.0 * T, 300)
    apart = []
    for gain in (1e-3, 1e-4, 1e-5):
        weak = replace(plain, driver_integral_gain=gain * Z / T)
        apart.append(np.abs(ss.simulate(replace(problem, body=weak), 20.0 * T).slip(time) - known.slip(time)).max())
    assert apart[0] / apart[1] == pytest.approx(10.0, rel=5e-2)
    assert apart[1] / apart[2] == pytest.approx(10.0, rel=5e-3)


def test_a_step_of_the_far_stress_moves_a_mass_as_an_exponential_and_comes_through_the_layers() -> None:
    """Before echoes come back to the machine, its wave reaches the contact by the share that the boundary lets through."""
    count, time = (3, 4), 0.01
    zs = np.array([2000.0 * 1500.0, DENSITY * SPEED])
    body = ss.LayeredSlab(
        [time * n * c for n, c in zip(count, (1500.0, SPEED), strict=True)], [2000.0, DENSITY], [1500.0, SPEED], STRESS,
        driver_impedance=1.5 * zs[1], driver_inertia=0.7 * zs[1] * time,
    )  # fmt: skip
    step, when = 1e4, 0.25 * time
    far = Steps([0.0, when], [1e5, 1e5 + step])
    run = ss.simulate(ss.Problem(body, COULOMB, initial_load=1e5, far_stress=far), 12.0 * time)
    since = np.linspace(0.0, 5.9 * time, 50)  # the echo of the contact comes to it after six crossings of its cells
    rate = step / (2.5 * zs[1]) * -np.expm1(-2.5 * zs[1] * since / body.driver_inertia)
    through = 2.0 * zs[0] / (zs[0] + zs[1])
    load = run.load(when + 7.0 * time + since[:40])
    np.testing.assert_allclose(load, 1e5 + through * 2.0 * zs[1] * rate[:40], rtol=1e-12)
    driven = run.field(float(np.sum(body.thickness)), when + since[: int(0.6 * 50)]).velocity
    np.testing.assert_allclose(driven, rate[: int(0.6 * 50)], rtol=1e-9, atol=1e-14)


def of_trapezium(
    inertia: float, gains: tuple[float, float], before: float, step: float, first: Floats
) -> Callable[[Floats], Floats]:
    """Return the machine as a function of the waves that meet it at evenly spaced times (s), by the trapezoidal rule.

    `gains` are the proportional and the integral one, `before` the impedance of the last layer; `first` holds pull rate, far stress
    and the wave that meets the machine at the start.
    """
    pull, far, wave = first
    state, known = np.array([pull, 0.0]), wave
    kp, ki = gains
    if ki > 0.0:
        state[1] = before * pull - wave - far  # its integral force balances the stress at first
    matrix = np.array([[-(kp + before) / inertia, 1.0 / inertia], [-ki, 0.0]])
    left, right = np.eye(2) - 0.5 * step * matrix, np.eye(2) + 0.5 * step * matrix

    def moves(waves: Floats) -> Floats:
        nonlocal state, known
        found = np.empty(len(waves))
        for n, one in enumerate(waves):
            push = np.array([(kp * pull + far + 0.5 * (one + known)) / inertia, ki * pull])
            state, known = np.linalg.solve(left, right @ state + step * push), one
            found[n] = state[0]
        return found

    return moves


@pytest.mark.sampled(every=7)
@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("gain", [0.0, 0.4])
def test_layers_with_contrast_move_as_an_own_program_says(seed: int, gain: float, monkeypatch: pytest.MonkeyPatch) -> None:
    draw = np.random.default_rng([91, seed])
    cells, time, normal, stress, pull = draw.integers(1, 4, 2), 0.01, 1e7, 5.9e6, 0.4
    density, speed = draw.uniform(1500.0, 3500.0, 2), draw.uniform(800.0, 4000.0, 2)
    last = float(density[1] * speed[1])
    kp, mass, ki = 0.6 * last, 3.0 * last * time, gain * last / time
    body = ss.LayeredSlab(
        cells * time * speed, density, speed, normal, driver_impedance=kp, driver_inertia=mass, driver_integral_gain=ki
    )
    side = body.stacks[0]
    zs, fine = np.array(side.cell_impedances), side.time
    run = ss.simulate(ss.Problem(body, COULOMB, pull_rate=pull, initial_load=stress), 0.6)
    steps, errors = round(0.6 / fine), []
    for many in (100, 1600):
        monkeypatch.setattr(layer_chains, "PHASES", many)
        chain = Chain(zs, kp, pull, 1.0)
        step = fine / many
        chain.moves = of_trapezium(mass, (kp, ki), last, step, np.array([pull, stress, last * pull - stress]))
        known = march([chain], False, COULOMB, normal, fine, steps, {"rates": [(0.0, pull)], "stress": stress})
        times = (np.arange(steps)[:, None] + (np.arange(many) + 0.5) / many) * fine
        errors.append(float(np.mean(np.abs(run.slip_rate(times) - known))) / float(np.abs(known).max()))
    assert np.abs(known).max() > 0.05
    assert errors[1] < 2e-4
    assert errors[1] < 0.4 * errors[0]


@pytest.mark.slow
@pytest.mark.sampled(every=3)
@pytest.mark.parametrize("stop", [1.7, 9.3, 13.7])
def test_a_run_that_is_taken_up_again_has_every_bit(stop: float, tmp_path: Path) -> None:
    body = ss.LayeredSlab(
        [40.0, 60.0], [2000.0, 2800.0], [2000.0, 3000.0], STRESS,
        driver_impedance=0.6 * Z, driver_inertia=0.5 * Z * T, driver_integral_gain=0.2 * Z / T,
    )  # fmt: skip
    for law, more in ((COULOMB, {}), (ss.friction.RateAndState(0.6, 0.01, 0.015, 1e-3), {"initial_state": 1.0})):
        start = {"initial_excess": -2e4} if law is COULOMB else {"initial_load": 5.9e5}
        problem = ss.Problem(body, law, pull_rate=0.03, **start, **more)
        whole = ss.simulate(problem, 20.0 * T)
        longer = ss.resume(ss.simulate(problem, stop * T).to_netcdf(tmp_path / "part.nc"), 20.0 * T)
        assert longer.history.store.pieces.tobytes() == whole.history.store.pieces.tobytes()
        assert longer.history.store.state.tobytes() == whole.history.store.state.tobytes()
        energy = ss.open_solution(whole.to_netcdf(tmp_path / "whole.nc")).energy(np.linspace(0.5, 19.5, 9) * T)
        assert np.abs(energy.balance).max() < 1e-9 * np.abs(energy.work).max()


def test_sections_under_a_soft_drive_are_the_string_with_its_numbers() -> None:
    string = ss.load_scenario("drill-string").problem
    soft = replace(string.body, driver_impedance="1 kN m s", driver_inertia="2900 kg m^2", driver_integral_gain="500 N m/rad")
    length = soft.length
    sections = ss.SectionedString(
        [0.25 * length, 0.75 * length], [soft.outer_diameter] * 2, [soft.inner_diameter] * 2, [soft.density] * 2,
        [soft.shear_modulus] * 2, soft.weight_on_bit, soft.bit_radius, soft.normal_torque,
        **{name: getattr(soft, name) for name in ("driver_impedance", "inertia", "driver_inertia", "driver_integral_gain")},
    )  # fmt: skip
    runs = [ss.simulate(replace(string, body=one), 12.0) for one in (soft, sections)]
    times = np.linspace(0.0, 12.0, 200)
    np.testing.assert_allclose(runs[1].slip(times), runs[0].slip(times), rtol=1e-8, atol=1e-8)


def test_what_is_not_followed_is_refused_in_one_line() -> None:
    body = cut(slab(0.5, 0.6, 0.2), 0.4, 0.6)
    with refused(begins="LayeredSlab: driver_inertia needs a finite driver_impedance"):
        ss.LayeredSlab([1.0], [1.0], [1.0], 1.0, driver_inertia=1.0)
    with refused(begins="Problem: driver_reflection: a driver with a mass or an integral gain is not followed where it changes"):
        ss.Problem(body, COULOMB, initial_load=1e5, driver_reflection=Steps([0.0, 1.0], [0.0, 1.0]))
    with refused(begins="Problem: a driver with a mass or an integral gain is not followed on ground that moves"):
        ss.Problem(body, COULOMB, initial_load=1e5, ground_velocity=Sinusoidal(0.0, 0.1, 1.0))
    with refused(begins="simulate: creep_rtol"):
        ss.simulate(ss.Problem(body, COULOMB, pull_rate=0.1, initial_load=1e5), 1.0, creep_rtol=1e-6)
    sliding = ss.studies.steady(ss.Problem(body, STRIBECK, pull_rate=0.01, initial_load=1e5))
    assert "not sought for layers behind a driver with a mass" in str(sliding)
    with pytest.raises(TypeError):
        ss.TwoSlabs([1.0], [1.0], [1.0], [1.0], [1.0], [1.0], 1.0, driver_inertia=1.0)  # type: ignore[call-arg]
