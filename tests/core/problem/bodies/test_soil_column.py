"""A column of soil with a damped free top: its modes, its answer to shaken ground, its limits, and its energy.

The references know nothing of waves with kinks: a chain of masses and springs with a dashpot and a mass on top, a rigid block, and
a method of steps with straight lines between small steps.
"""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import stickslip as ss
from stickslip.foundation.arrays import Floats
from stickslip.problem.loading import PiecewiseLinear, Sinusoidal
from stickslip.solution.observables.proof_of_load import load_compared
from tests.messages import refused

G = 9.80665
SOIL: dict[str, Any] = {"density": 1900.0, "wave_speed": 160.0, "thickness": 20.0, "normal_stress": 359955.0}
SLOPE = 96449.6  # Pa: rho g h sin(15 deg)
MU = 0.3715
SAID = {
    0.02: (0.0141, 0.0105, 0.0084),
    0.05: (0.0346, 0.0257, 0.0203),
    0.1: (0.0684, 0.0506, 0.0400),
    0.2: (0.1493, 0.1176, 0.0966),
}
"""What modes 3 to 5 have of a damping ratio, on the page."""
RATIOS = tuple(SAID)


def record() -> PiecewiseLinear:
    """A burst of shaking of 0.4 g at 1.5 Hz that leaves the ground at rest."""
    time = np.arange(81) * 0.05
    swing = np.round(0.4 * np.sin(np.pi * time / 4.0) ** 2 * np.sin(3.0 * np.pi * (time - 2.0)), 3)
    return PiecewiseLinear(time.tolist(), (G * swing).tolist())


def column(damping_ratio: float, **other: Any) -> ss.SoilColumn:
    return ss.SoilColumn(**{**SOIL, **other}, damping_ratio=damping_ratio)


def shaken(body: Any, strength: float = MU, **other: Any) -> ss.Problem:
    """The body on a slope under the record, with Coulomb friction and slip downhill alone."""
    given = {"initial_load": SLOPE, "pull_rate": 0.0, "one_way": True, "ground_acceleration": record(), **other}
    return ss.Problem(body, ss.friction.Coulomb(strength, strength), **given)


STRONG = 10.0  # a friction coefficient under which nothing slips


# ---- modes ------------------------------------------------------------------------------------------------------------------


def chain(body: ss.SoilColumn, count: int) -> Floats:
    """The matrix of motion of a chain of masses stuck at its base, with dashpot and mass on top: displacements, then velocities."""
    step, rho = body.distance / count, body.impedance / body.wave_speed
    spring, mass = body.modulus / step, np.full(count, rho * step)
    mass[-1] *= 0.5
    stiff = np.diag(np.full(count, 2.0 * spring)) - np.diag(np.full(count - 1, spring), 1) - np.diag(np.full(count - 1, spring), -1)
    stiff[-1, -1] = spring
    matrix = np.zeros((2 * count + 1, 2 * count + 1))  # the last one is the velocity of the mass behind the dashpot
    matrix[:count, count:-1] = np.eye(count)
    matrix[count:-1, :count] = -stiff / mass[:, None]
    dashpot = body.dashpot_of_damper
    matrix[2 * count - 1, 2 * count - 1] -= dashpot / mass[-1]
    matrix[2 * count - 1, -1] += dashpot / mass[-1]
    matrix[-1, 2 * count - 1], matrix[-1, -1] = dashpot / body.mass_of_damper, -dashpot / body.mass_of_damper
    return matrix


def modes(body: ss.SoilColumn, count: int) -> Floats:
    """The roots (1/s) of the first modes of a chain of many masses, of the smallest frequency first."""
    roots = np.linalg.eigvals(chain(body, count))
    roots = roots[roots.imag > 0.0]
    return roots[np.argsort(roots.imag)][:5]


@pytest.mark.sampled(every=4)
@pytest.mark.parametrize("ratio", RATIOS)
def test_the_first_two_modes_of_a_chain_have_the_damping_ratio_and_the_first_its_period(ratio: float) -> None:
    """A chain of n masses is wrong by the order n^-2: two of them extrapolate to 1e-5."""
    coarse, fine = modes(column(ratio), 150), modes(column(ratio), 300)
    root = (4.0 * fine - coarse) / 3.0
    damped = -root.real / np.abs(root)
    assert np.allclose(damped[:2], ratio, rtol=1e-5, atol=0.0)
    assert math.isclose(2.0 * math.pi / abs(root[0]), 4.0 * 20.0 / 160.0, rel_tol=1e-5)
    assert (np.diff(damped[1:]) < 0.0).all()


@pytest.mark.sampled(every=4)
@pytest.mark.parametrize(("ratio", "higher"), SAID.items())
def test_higher_modes_have_what_the_page_says(ratio: float, higher: tuple[float, ...]) -> None:
    root = (4.0 * modes(column(ratio), 300) - modes(column(ratio), 150)) / 3.0
    found = -root.real / np.abs(root)
    assert np.allclose(found[2:], higher, rtol=0.0, atol=6e-5)
    table = (Path(ss.__file__).parents[2] / "docs" / "loading.md").read_text(encoding="utf-8")
    assert " | ".join(f"{one:.4f}" for one in (ratio, *higher)) in table


def test_the_mass_of_the_damper_is_taken_from_the_column() -> None:
    for ratio in (0.0, *RATIOS):
        body = column(ratio)
        carried = body.impedance / body.wave_speed * body.distance
        assert math.isclose(carried + body.mass_of_damper, 1900.0 * 20.0, rel_tol=1e-13)


def test_a_larger_damping_ratio_than_one_damper_gives_is_refused() -> None:
    with refused("SoilColumn: damping_ratio must be at most 0.2 (a pure number), got 0.21"):
        column(0.21)


# ---- stuck at its base ------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("ratio", RATIOS)
def test_free_swings_decay_as_the_first_mode(ratio: float) -> None:
    run = ss.simulate(shaken(column(ratio), STRONG), 5.2 + 0.5 / ratio)
    turn = 0.5 / math.sqrt(1.0 - ratio * ratio)  # s: period of the damped swing
    later = 4.0 + 0.5 / ratio + np.linspace(0.0, 0.5, 40)
    swing = run.load(later) - SLOPE
    scale = np.abs(swing).max()
    expected = swing * math.exp(-2.0 * math.pi * ratio / math.sqrt(1.0 - ratio * ratio))
    higher = math.exp(-2.0 * np.pi / 0.5 * ratio * 3.0 * (later[0] - 4.0))  # of the second mode, which decays thrice as fast
    assert np.allclose(run.load(later + turn) - SLOPE, expected, rtol=0.0, atol=(higher + 1e-7) * scale)


def test_shaking_of_one_frequency_reaches_the_stress_of_the_transfer_function() -> None:
    body = column(0.1)
    frequency = 2.0 * math.pi * 3.1
    ground = Sinusoidal(0.0, 0.2, 2.0 * math.pi / frequency, 0.5 * math.pi)  # cosine, so that the velocity begins with 0
    run = ss.simulate(shaken(body, STRONG, ground_acceleration=ground), 20.0)
    s, z = 1j * frequency, body.impedance
    dashpot = body.dashpot_of_damper
    top = dashpot * s / (s + dashpot / body.mass_of_damper)
    echo = (z - top) / (z + top) * np.exp(-s * body.round_trip_time)
    later = np.linspace(19.0, 19.9, 60)  # waves of the start have died to 1e-10
    velocity = 0.2 / frequency * np.exp(1j * frequency * later)  # its imaginary part is that of the ground
    expected = (-z * (1.0 - echo) / (1.0 + echo) * velocity).imag
    assert np.allclose(run.load(later) - SLOPE, expected, rtol=0.0, atol=1e-7 * np.abs(expected).max())


# ---- sliding ----------------------------------------------------------------------------------------------------------------


def by_small_steps(problem: ss.Problem, duration: float, parts: int) -> tuple[Floats, Floats, Floats]:
    """Times (s), slip (m), and heat of the dashpot h/c before (J/m^2), by a method of steps: waves are straight lines between them.

    One way alone is open.
    """
    body: Any = problem.body
    z, r, far, ground = body.impedance, body.reflection, problem.initial_load, problem.ground
    step = body.round_trip_time / parts
    pace = z * body.dashpot_of_damper / body.mass_of_damper / (z + body.dashpot_of_damper)
    fades, time = math.exp(-pace * step), np.arange(int(duration / step)) * step
    moved = ground.velocity_at(time)  # type: ignore[union-attr] # it moves
    (left, rate, force), passed, before = np.empty((3, len(time))), 0.0, 0.0
    for n in range(len(time)):
        met = left[n - parts] + far if n >= parts else 0.0  # type: ignore[operator] # a number
        passed = fades * passed + before * (1.0 - fades) + (met - before) * (1.0 - (1.0 - fades) / (pace * step))
        before, force[n] = met, 0.5 * (1.0 - r) * (met - passed)
        load = far + r * met + (1.0 - r) * passed  # type: ignore[operator]
        rate[n] = max(0.0, (load - z * moved[n] - problem.strength) / z)
        left[n] = 2.0 * z * (rate[n] + moved[n]) - load
    power = force**2 / body.dashpot_of_damper
    return time, *(np.append(0.0, np.cumsum(0.5 * step * (one[1:] + one[:-1]))) for one in (rate, power))  # type: ignore[return-value]


@pytest.mark.sampled(every=4)
@pytest.mark.parametrize("ratio", RATIOS)
def test_sliding_agrees_with_a_method_of_small_steps(ratio: float) -> None:
    problem = shaken(column(ratio))
    run = ss.simulate(problem, 6.0)
    time, slip, heat = by_small_steps(problem, 6.0, 4000)
    assert slip[-1] > 0.1
    assert np.allclose(run.slip(time[::50]), slip[::50], rtol=0.0, atol=2e-6 * slip[-1])
    at_top = time[4000::4000] - 0.5 * problem.round_trip_time
    assert np.allclose(run.energy(at_top)["radiated"], heat[4000::4000], rtol=0.0, atol=2e-6 * heat[-1])


@pytest.mark.parametrize("ratio", [0.05, 0.2])
def test_a_stiff_column_is_the_rigid_block_of_all_its_mass(ratio: float) -> None:
    mass = 1900.0 * 20.0
    block = ss.SpringBlock(mass, 1e-6 * mass, 359955.0)
    rigid = ss.simulate(shaken(block), 5.0)
    slip = rigid.slip(5.0)
    apart = [abs(ss.simulate(shaken(column(ratio, wave_speed=speed)), 5.0).slip(5.0) / slip - 1.0) for speed in (2e3, 4e3, 8e3)]
    assert apart[-1] < 0.01
    assert apart[2] < 0.6 * apart[1] < 0.36 * apart[0]


def test_without_damping_the_column_is_a_slab_with_a_free_top_bit_for_bit() -> None:
    slab = ss.simulate(shaken(ss.ElasticSlab(**SOIL, driver_impedance=0.0)), 5.0).history.store
    own = ss.simulate(shaken(column(0.0)), 5.0).history.store
    for name in ("load", "rate", "slip", "phase_from", "trip"):
        assert np.array_equal(getattr(own, name), getattr(slab, name)), name


@pytest.mark.sampled(every=4)
@pytest.mark.parametrize("ratio", RATIOS)
def test_energy_is_balanced_with_what_the_damper_takes(ratio: float) -> None:
    run = ss.simulate(shaken(column(ratio)), 6.0)
    time = np.linspace(0.1, 5.9, 30)
    energy = run.energy(time)
    missing = energy["work"] - energy["heat"] - (energy["stored"] - run.energy(np.array([0.0]))["stored"][0])
    assert np.abs(missing).max() < 1e-8 * np.abs(energy["work"]).max()
    taken = np.asarray(energy["radiated"])
    assert taken[-1] > 0.0
    assert (np.diff(taken) >= -1e-12 * taken[-1]).all()


@pytest.mark.slow
def test_a_resumed_run_is_the_run_bit_for_bit(tmp_path: Path) -> None:
    problem = shaken(column(0.05))
    whole = ss.simulate(problem, 5.0)
    ss.simulate(problem, 2.3).to_netcdf(tmp_path / "run.nc")
    resumed = ss.resume(tmp_path / "run.nc", 5.0)
    for name in ("load", "rate", "slip"):
        assert np.array_equal(getattr(resumed.history.store, name), getattr(whole.history.store, name)), name


def test_the_loads_of_a_run_follow_from_its_slip() -> None:
    run = ss.simulate(shaken(column(0.05)), 5.0)
    found = load_compared(run.history)
    assert found.compared > 500
    assert found.missed < 1e-10 * run.problem.strength
    assert run.proven.unproven == 0


@pytest.mark.slow
def test_a_long_record_ends_because_echoes_of_its_kinks_are_merged() -> None:
    """Unmerged, the 3000 kinks would come back some 170 times each, as 500 000 pieces."""
    drawn = np.random.default_rng(7).normal(size=3000)
    swing = np.convolve(drawn, np.hanning(12), mode="same")
    swing = 0.35 * G * (swing - swing.mean()) / np.abs(swing).max()
    ground = PiecewiseLinear((0.01 * np.arange(3000)).tolist(), swing.tolist())
    problem = shaken(column(0.05, wave_speed=457.0), ground_acceleration=ground)
    run = ss.simulate(problem, 30.0)
    assert run.status.name == "finished"
    assert len(run.history) < 100_000
    assert "pieces of waves were merged" in str(run)
    time, slip, _ = by_small_steps(problem, 30.0, 800)
    assert np.allclose(run.slip(time[::200]), slip[::200], rtol=0.0, atol=2e-6 * slip[-1])


def test_a_scenario_has_the_column(tmp_path: Path) -> None:
    path = tmp_path / "column.toml"
    soil = "\n".join(f"{name} = {value}" for name, value in SOIL.items())
    law = '[friction]\nkind = "coulomb"\nstatic = 0.3715\ndynamic = 0.3'
    text = f'[body]\nkind = "soil-column"\n{soil}\ndamping_ratio = 0.05\n{law}\n[initial]\nload = 133000\n[run]\nduration = 2\n'
    path.write_text(text + "[loading]\npull_rate = 0\n", encoding="utf-8")
    assert ss.load_scenario(path).problem.body == column(0.05)


def test_replacing_the_damping_ratio_makes_another_damper() -> None:
    body = column(0.05)
    assert replace(body, damping_ratio=0.1).reflection < body.reflection < 1.0
