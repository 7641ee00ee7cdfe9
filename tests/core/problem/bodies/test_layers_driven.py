"""Layers on ground that moves and behind a driver that changes: one slab, an own program, energies, the inside, taken up again."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import stickslip as ss
from stickslip.foundation.arrays import Floats
from stickslip.problem.loading import LoadingHistory, PiecewiseLinear, Sinusoidal, Steps
from tests.core.problem.bodies.layer_chains import PHASES, Chain, march
from tests.core.problem.bodies.layers import DENSITY, NORMAL, ONE, SPEED, THICKNESS, layered
from tests.messages import refused

ROUND = 2.0 * THICKNESS / SPEED
LAW = ss.friction.Coulomb(0.6, 0.5)
FREED = Steps([0.0, 1.0, 8.0, 13.3], [-1.0, 1.0, -1.0, 0.3])
"""A rigid driver that lets go, holds again, and then takes waves up."""
MOVES: dict[str, dict[str, Any]] = {
    "driver": {"far_stress": 1e7, "driver_reflection": FREED},
    "driver under a tone": {"far_stress": 1e7, "driver_reflection": FREED, "pull_rate": Sinusoidal(0.2, 0.3, 7.0)},
    "ground in lines": {"ground_velocity": PiecewiseLinear([0.0, 2.0, 5.0, 9.0], [0.0, 1.0, -1.0, 0.0])},
    "ground in steps": {"ground_velocity": Steps([0.0, 2.0, 5.0, 9.0], [0.0, 1.0, -1.0, 0.0])},
    "ground in parabolas": {"ground_acceleration": PiecewiseLinear([0.0, 2.0, 5.0, 9.0], [0.0, 1.0, -1.0, 0.0])},
    "ground of a tone": {"ground_acceleration": Sinusoidal(0.0, 1.0, 3.0)},
    "both": {
        "far_stress": Sinusoidal(1e7, 5e6, 4.0),
        "driver_reflection": FREED,
        "ground_velocity": PiecewiseLinear([0.0, 2.0, 5.0, 9.0], [0.0, 1.0, -1.0, 0.0]),
    },
}
MASS = 1e5


def same_inside(run: ss.Solution, known: ss.Solution, x: Floats, lasting: float) -> None:
    """Assert that slip, field and energies are those of one slab."""
    t = np.linspace(0.003, 0.997, 15) * lasting
    assert np.abs(known.slip(t)).max() > 0.1
    np.testing.assert_allclose(run.slip(t), known.slip(t), rtol=1e-10, atol=1e-10)
    for one, other in zip(run.field(x, t), known.field(x, t), strict=True):
        np.testing.assert_allclose(one, other, rtol=1e-9, atol=1e-10 * np.abs(other).max())
    energy, of_slab = run.energy(t), known.energy(t)
    size = float(np.abs(of_slab.stored).max())
    for name in ("work", "stored", "kinetic", "radiated", "trapped", "heat", "balance"):
        np.testing.assert_allclose(energy[name], of_slab[name], rtol=1e-9, atol=1e-10 * size, err_msg=name)


@pytest.mark.sampled(every=52)
@pytest.mark.parametrize("shares", [(0.2, 0.8), (0.3, 0.4, 0.3), (1.0,)])
@pytest.mark.parametrize("mass", [0.0, MASS])
@pytest.mark.parametrize("name", MOVES)
def test_layers_of_equal_impedance_are_one_slab(name: str, mass: float, shares: tuple[float, ...]) -> None:
    if mass and name == "ground in steps":
        pytest.skip("steps of the velocity are an infinite force on a mass")
    loading = {"initial_load": 59e6, "pull_rate": 0.2} | MOVES[name]
    if name == "both":
        loading["pull_rate"] = 0.0
    bodies = ss.ElasticSlab(DENSITY, SPEED, THICKNESS, NORMAL, contact_mass=mass), layered(*shares, contact_mass=mass)
    lasting = (3.5 if mass else 7.5) * ROUND
    known, run = (ss.simulate(ss.Problem(body, LAW, **loading), lasting) for body in bodies)
    same_inside(run, known, np.linspace(0.0, THICKNESS, 5)[:, None], lasting)
    events, of_slab = run.energetics(), known.energetics()
    size = 1e-9 * float(np.abs(of_slab.work).max() + np.abs(of_slab.heat).max())
    for name in ("work", "elastic", "radiated", "heat", "balance"):
        np.testing.assert_allclose(events[name], of_slab[name], rtol=1e-7, atol=size, err_msg=name)


@pytest.mark.sampled(every=6)
@pytest.mark.parametrize("name", [name for name in MOVES if name.startswith("ground")])
def test_two_equal_slabs_that_are_joined_are_one_of_twice_the_impedance_on_the_same_ground(name: str) -> None:
    loading = {"initial_load": 59e6, "pull_rate": 0.2} | MOVES[name]
    two, one = ss.TwoSlabs(*ONE, *ONE, NORMAL, sides="joined"), ss.ElasticSlab(2.0 * DENSITY, SPEED, THICKNESS, NORMAL)
    run, known = (ss.simulate(ss.Problem(body, LAW, **loading), 5.0 * ROUND) for body in (two, one))
    t = np.linspace(0.003, 0.997, 41) * 5.0 * ROUND
    np.testing.assert_allclose(run.slip(t), known.slip(t), rtol=1e-10, atol=1e-10)
    energy, of_slab = run.energy(t), known.energy(t)
    size = float(np.abs(of_slab.stored).max())
    for part in ("work", "stored", "kinetic", "balance"):
        np.testing.assert_allclose(energy[part], of_slab[part], rtol=1e-9, atol=1e-10 * size, err_msg=part)
    inside = np.linspace(0.0, THICKNESS, 5)[:, None]
    np.testing.assert_allclose(run.field(inside, t).velocity, known.field(inside, t).velocity, rtol=1e-9, atol=1e-9)
    np.testing.assert_allclose(run.field(-inside, t).velocity, known.field(inside, t).velocity, rtol=1e-9, atol=1e-9)


def drawn(seed: int) -> tuple[ss.Problem, list[Chain], float, dict[str, Any]]:
    """Return a problem on layers drawn at random, the same as chains of cells with their time (s), and how these start."""
    draw = np.random.default_rng([73, seed])
    kind, time, normal, stress = ("one", "joined", "apart")[seed % 3], 0.01, 1e7, 4e6
    far, pull = float(draw.uniform(0.0, 5e6)), float(draw.uniform(0.05, 0.5))
    fields, chains = {}, []
    for prefix in ("",) if kind == "one" else ("", "other_"):
        count = int(draw.integers(2, 4))
        cells = draw.integers(1, 6, count)
        density, speed = draw.uniform(1500.0, 3500.0, count), draw.uniform(500.0, 4000.0, count)
        fields |= {f"{prefix}density": density, f"{prefix}wave_speed": speed, f"{prefix}thickness": cells * time * speed}
        fields[f"{prefix}driver_impedance"] = math.inf
        chains.append(Chain(np.repeat(density * speed, cells), math.inf, pull, 1.0))
    body = (
        ss.LayeredSlab(**fields, normal_stress=normal) if kind == "one" else ss.TwoSlabs(**fields, normal_stress=normal, sides=kind)
    )
    fine = body.stacks[0].time
    for chain, side in zip(chains, body.stacks, strict=True):
        chain.impedances = np.array(side.cell_impedances)
    stiffness = [1.0 / (fine * np.sum(1.0 / chain.impedances)) for chain in chains]
    slow = 0.0
    if kind == "joined":
        for chain, one in zip(chains, stiffness, strict=True):
            chain.share = one / sum(stiffness)
    elif kind == "apart":
        chains[1].rate, slow = 0.0, pull * stiffness[0] / sum(stiffness)
    rates = [(slow, pull), (-slow, 0.0) if kind == "apart" else (0.0, pull)][: len(chains)]
    start: dict[str, Any] = {"rates": rates, "stress": stress}
    loading: dict[str, Any] = {"pull_rate": pull, "initial_load": stress}
    if seed % 2 or kind == "apart":
        times, shares = np.sort(draw.uniform(0.1, 3.0, 3)), draw.permutation([-1.0, 1.0, 0.0, 0.4, -0.6])[:3]
        last, share = chains[0].impedances[-1], chains[0].share
        loading |= {"far_stress": far, "driver_reflection": Steps([0.0, *times], [-1.0, *shares])}  # type: ignore[list-item]

        def follows(now: Floats) -> tuple[Floats, Floats, Floats]:
            r = np.array([-1.0, *shares])[np.searchsorted(times, now, side="right")]
            driver = np.where(r > -1.0, last * (1.0 - r) / np.where(r > -1.0, 1.0 + r, 1.0), np.inf)
            return driver, np.full(PHASES, pull), np.full(PHASES, share * far)

        chains[0].follows = follows
    if kind != "apart" and seed % 4 < 3:
        ground: LoadingHistory = PiecewiseLinear(np.linspace(0.0, 3.0, 9), draw.normal(size=9) * 0.3)  # type: ignore[arg-type]
        ground = Sinusoidal(0.05, 0.4, float(draw.uniform(0.1, 1.0))) if seed % 4 == 2 else ground
        loading["ground_velocity"], start["ground"] = ground, ground.at
    return ss.Problem(body, LAW, **loading), chains, fine, start


@pytest.mark.sampled(every=18)  # every third one is joined
@pytest.mark.parametrize("seed", range(18))
def test_layers_drawn_at_random_move_as_their_waves_do_and_keep_energy(seed: int) -> None:
    problem, chains, time, start = drawn(seed)
    steps, joined = round(4.0 / time), seed % 3 == 1
    known = march(chains, joined, LAW, problem.normal, time, steps, start)
    run = ss.simulate(problem, steps * time, max_pieces=200_000)
    times = (np.arange(steps)[:, None] + (np.arange(PHASES) + 0.5) / PHASES) * time
    reached = times <= run.duration
    times, known = times[reached], known[reached]
    assert run.duration > 0.3 * steps * time
    assert np.abs(known).max() > 1e-3
    off = np.abs(run.slip_rate(times) - known) > 1e-9 * np.abs(known).max() + 1e-7 * np.abs(known)
    assert off.mean() < 0.02, (off.mean(), times[off][:5])  # as there; with ten times as many phases, 0
    moments = np.linspace(0.01, 0.99, 23) * run.duration
    energy = run.energy(moments)
    assert np.abs(energy.balance).max() < 1e-9 * max(float(np.abs(energy[name]).max()) for name in ("work", "stored", "heat"))
    depth = np.cumsum(problem.body.stacks[0].thickness)  # type: ignore[attr-defined]
    places, step = depth[-1] * np.linspace(0.05, 0.95, 7)[:, None], 1e-7
    later, before, here = (run.field(places, moments + by) for by in (step, -step, 0.0))
    moved = (later.displacement - before.displacement) / (2.0 * step)
    assert np.quantile(np.abs(moved - here.velocity), 0.8) < 1e-6 * np.abs(here.velocity).max()


@pytest.mark.parametrize("counts", [(2, 3), (2, 4)])
def test_rest_is_leapt_over_between_changes_once_drag_has_taken_the_waves(counts: tuple[int, int]) -> None:
    layers = ([350.0 * n for n in counts], [2800.0] * 2, [3500.0] * 2)
    body = ss.LayeredSlab(*layers, NORMAL, drag=[2e4, 2e4], drag_step=0.4)
    trip = body.two_way_time
    changes = Steps([0.0, 3.0 * trip, 1e5 * trip, 3e5 * trip], [-1.0, 1.0, -1.0, 0.5])
    problem = ss.Problem(body, LAW, initial_load=5e7, far_stress=1e7, driver_reflection=changes)
    run = ss.simulate(problem, 4e5 * trip)
    assert len(run.history) < 30_000
    np.testing.assert_allclose(run.load(np.array([2.5, 9e4, 2e5, 3.9e5]) * trip), [5e7, 1e7, 1e7, 1e7], rtol=1e-9)
    energy = run.energy(np.array([9e4, 2e5, 3.9e5]) * trip)
    assert np.abs(energy.balance).max() < 1e-9 * np.abs(energy.stored).max()
    assert float(energy.damped[-1]) > 0.5 * abs(float(energy.stored[-1]))


@pytest.mark.sampled(every=15)
@pytest.mark.parametrize("name", ["driver", "driver under a tone", "ground in parabolas", "ground of a tone"])
@pytest.mark.parametrize("stop", [0.3, 1.7, 3.2])
def test_a_run_that_is_taken_up_again_has_every_bit(name: str, stop: float, tmp_path: Path) -> None:
    body = ss.LayeredSlab([1e3, 8e3], [DENSITY] * 2, [SPEED / 2, SPEED], NORMAL, contact_mass=MASS)
    problem = ss.Problem(body, LAW, **({"initial_load": 59e6, "pull_rate": 0.2} | MOVES[name]))
    whole = ss.simulate(problem, 5.0 * ROUND)
    part = ss.simulate(problem, stop * ROUND).to_netcdf(tmp_path / "part.nc")
    longer = ss.resume(part, 5.0 * ROUND)
    assert longer.problem == problem
    assert longer.history.store.pieces.tobytes() == whole.history.store.pieces.tobytes()


def test_steps_to_the_same_driver_change_no_bit_of_a_slip() -> None:
    body = layered(0.3, 0.7, driver_impedance=DENSITY * SPEED / 3.0)
    plain = ss.Problem(body, LAW, initial_load=5.9e7, far_stress=6.3e7, driver_reflection=Steps([0.0, 2.0], [0.5, 0.1]))
    assert body.reflection == pytest.approx(0.5)
    twice = replace(plain, driver_reflection=Steps([0.0, 1.0, 2.0, 5.0], [0.5, 0.5, 0.1, 0.1]))
    one, other = (ss.simulate(problem, 40.0).history.store.pieces.tobytes() for problem in (plain, twice))
    assert one == other


def test_sections_of_a_string_may_be_let_go_and_their_ground_may_turn() -> None:
    string = ss.load_scenario("pipe-and-collar").problem
    sections = string.body
    freed = Steps([0.0, 2.0], [sections.reflection, 1.0])
    loose = replace(string, far_stress="0 N m", driver_reflection=freed)
    shaken = replace(string, ground_velocity=Sinusoidal("0 rpm", "3 rpm", 1.7))
    for problem in (loose, shaken):
        run = ss.simulate(problem, 8.0)
        energy = run.energy(np.linspace(0.1, 7.9, 15))
        assert np.abs(energy.balance).max() < 1e-9 * np.abs(energy.work).max()
        assert abs(run.slip(8.0) - ss.simulate(string, 8.0).slip(8.0)) > 1e-3


def test_what_is_not_followed_is_refused_in_one_line() -> None:
    apart = ss.TwoSlabs(*ONE, *ONE, NORMAL)
    with refused(begins="Problem: ground that moves is not followed under sides that are apart"):
        ss.Problem(apart, LAW, initial_load=5e7, ground_velocity=Sinusoidal(0.0, 0.1, 1.0))
    with refused(begins="Problem: driver_reflection needs a far_stress, because the driver is rigid at first: 0 Pa if nothing"):
        ss.Problem(apart, LAW, initial_load=5e7, driver_reflection=FREED)
    soft = replace(apart, other_driver_impedance=4e6)
    with refused(begins="Problem: driver_reflection needs a far_stress, because the driver is rigid at first: 0 Pa if nothing"):
        ss.Problem(soft, LAW, initial_load=5e7, driver_reflection=FREED)
    pulled = {"pull_rate": Sinusoidal(0.2, 0.3, 7.0), "far_stress": 0.0, "driver_reflection": FREED}
    with refused(begins="Problem: pull_rate that varies needs rigid drivers on both sides of a TwoSlabs"):
        ss.Problem(apart, LAW, initial_load=5e7, **pulled)
