"""A driver that is set free, stops, or takes up another share of waves: by hand, by an own recursion, energy, files, refusals."""

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
from stickslip.problem.loading import LoadingHistory, PiecewiseLinear, Sinusoidal, Steps
from tests.core.problem.loading.changed_driver import by_recursion

STRESS, STATIC, DYNAMIC = 1e8, 6e7, 5e7
SLAB = ss.ElasticSlab(2800.0, 3500.0, 1000.0, STRESS)
Z, R = SLAB.impedance, SLAB.two_way_time
LAW = ss.friction.Coulomb(STATIC / STRESS, DYNAMIC / STRESS)
GLUE = ss.friction.Coulomb(1.0, 1.0)
"""A contact that never slips here."""


def steps(*of: tuple[float, float]) -> Steps:
    """Return the reflection of a driver that is rigid at first, from times (round trips) on."""
    times, shares = zip((0.0, -1.0), *of, strict=True)
    return Steps(R * np.array(times), shares)  # type: ignore[arg-type]


def behind(share: float, **others: Any) -> ss.ElasticSlab:
    """Return the slab behind a driver that sends back a share of the waves (1)."""
    return replace(SLAB, driver_impedance=math.inf if share == -1.0 else Z * (1.0 - share) / (1.0 + share), **others)


def balance(run: ss.Solution, times: Floats) -> float:
    """Return how far work, stored energy and heat are from their balance, as a share of the largest of them (1)."""
    energy = run.energy(np.append(0.0, times))
    stored = energy.stored.to_numpy() - float(energy.stored[0])
    size = max(float(abs(one).max()) for one in (energy.work, energy.stored, energy.heat))
    return float(abs(energy.work.to_numpy() - stored - energy.heat.to_numpy()).max()) / size


def test_a_slab_at_rest_that_is_set_free_rings_between_its_load_and_the_opposite() -> None:
    """The load falls from tau0 to 2 s - tau0 one h/c after the release, and back after each further round trip."""
    problem = ss.Problem(SLAB, LAW, initial_load=5e7, far_stress=1e7, driver_reflection=steps((1.3, 1.0)))
    run = ss.simulate(problem, 6.0 * R)
    arrives = 1.8 * R
    trips = np.arange(4)
    for side, first in (("left", 5e7), ("right", -3e7)):
        load = run.load(arrives + trips * R, side=side)
        expected = np.where(trips % 2 == 0, first, 2e7 - first)
        np.testing.assert_allclose(load, expected, rtol=1e-14)
        inside = run.field(0.0, arrives + trips * R, side=side)
        np.testing.assert_allclose(inside.stress, expected, rtol=1e-14)
        assert abs(inside.velocity).max() < 1e-14
    free = run.field(SLAB.thickness, np.array([1.31, 1.9, 2.29, 2.31]) * R)
    np.testing.assert_allclose(free.stress, 1e7, rtol=1e-13)
    swing = 4e7 / Z  # the far end moves towards its rest, for one round trip, and back in the next
    np.testing.assert_allclose(free.velocity, [-swing, -swing, -swing, swing], rtol=1e-13)
    np.testing.assert_allclose(
        run.field(SLAB.thickness, 2.3 * R).displacement - run.field(SLAB.thickness, 1.3 * R).displacement, -swing * R
    )


def test_a_matched_driver_after_a_rigid_one_swallows_everything() -> None:
    problem = ss.Problem(SLAB, LAW, initial_load=6.2e7, far_stress=3e7, driver_reflection=steps((2.2, 0.0)))
    run = ss.simulate(problem, 1e6 * R)
    assert "locked for ever" in str(run.status)
    np.testing.assert_array_equal(run.load(np.array([2.71, 3.3, 17.0, 1e6]) * R), 3e7)
    waves = run.energy(np.array([3.3, 5.0]) * R).trapped
    assert abs(waves).max() < 1e-12 * STATIC**2 / SLAB.stiffness


def test_slip_of_a_slab_that_is_set_free_is_that_by_hand() -> None:
    """In MPa: 62 slips and sends -38 back; set free under 45 the echo of w is w + 90, first of the start, -62, from 0.7 R on."""
    problem = ss.Problem(SLAB, LAW, initial_load=6.2e7, far_stress=4.5e7, driver_reflection=steps((0.2, 1.0)))
    run = ss.simulate(problem, 8.0 * R)
    loads = [(62, 28), (52, 62), (38, 52), (52, 38), (38, 52), (52, 38)]
    for trip, pair in enumerate(loads):
        np.testing.assert_allclose(run.load((trip + np.array([0.35, 0.85])) * R), 1e6 * np.array(pair), rtol=1e-14)
    events = run.events
    np.testing.assert_allclose(events[["start", "end"]], [[0.0, 0.7 * R], [1.7 * R, 2.0 * R]], rtol=1e-13)
    np.testing.assert_allclose(events.slip, 12e6 / Z * R * np.array([0.7, 0.3]), rtol=1e-12)
    assert list(run.shocks.cause) == ["start", "loading", "echo", "echo"]


def drawn(
    rng: np.random.Generator,
) -> tuple[ss.Problem, Callable[[float], float], Callable[[float], float], Callable[[float], float]]:
    """Return a problem at random, with its driver, pull rate (m/s) and far stress (Pa) as functions of time."""
    times = np.sort(rng.uniform(0.02, 12.0, rng.integers(1, 5))) * R
    shares = rng.choice([-1.0, 1.0, 0.0, 0.5, -0.5, -0.9], len(times) + 1)
    pull, far, load = rng.uniform(-1.0, 3.0), rng.uniform(-1e8, 1e8), rng.uniform(-STATIC, STATIC)
    kinds: list[tuple[float | LoadingHistory, float | LoadingHistory]] = [
        (pull, far),
        (PiecewiseLinear([0.0, 3.0 * R, 7.0 * R], [pull, 2.0 * pull, -pull]), far),
        (Sinusoidal(pull, 1.0, 2.7 * R), far),
        (pull, Sinusoidal(far, 5e7, 3.1 * R)),
    ]
    pulled, stressed = kinds[rng.integers(len(kinds))]
    given = Steps([0.0, *times], shares)  # type: ignore[arg-type]
    problem = ss.Problem(behind(shares[0]), LAW, pull_rate=pulled, initial_load=load, far_stress=stressed, driver_reflection=given)

    def of(value: float | LoadingHistory) -> Callable[[float], float]:
        return (lambda t: float(value.at(t))) if isinstance(value, LoadingHistory) else lambda _: value

    return problem, lambda t: float(shares[np.searchsorted(times, t, side="right")]), of(pulled), of(stressed)


def same(one: tuple[Floats, Floats], other: tuple[Floats, Floats]) -> Floats:
    """Return where load and slip rate agree."""
    return (abs(one[0] - other[0]) < 1e-7 * STRESS) & (abs(one[1] - other[1]) < 1e-7 * STRESS / Z)


@pytest.mark.sampled(every=16)
@pytest.mark.parametrize("seed", range(16))
def test_runs_at_random_are_those_of_an_own_recursion_and_keep_energy(seed: int) -> None:
    rng = np.random.default_rng([46, seed])
    problem, driver, pull, far = drawn(rng)
    run = ss.simulate(problem, 12.0 * R)

    def own(count: int) -> tuple[Floats, tuple[Floats, Floats]]:
        time = (np.arange(12 * count) + 0.5) * R / count
        start = problem.load, SLAB.stiffness * pull(0.0)
        return time, by_recursion(time, count, Z, start=start, driver=driver, pull=pull, far=far, strengths=(STATIC, DYNAMIC))

    (time, coarse), (_, fine) = own(300), own(900)
    sure = same(coarse, (fine[0][1::3], fine[1][1::3]))  # elsewhere it steps over rests that are shorter than its steps
    assert sure.mean() > 0.8
    assert same((run.load(time), run.slip_rate(time)), coarse)[sure].mean() > 0.997
    times = np.sort(rng.uniform(0.0, 12.0 * R, 20))
    assert balance(run, times) < 1e-12
    contact = run.field(0.0, times)
    np.testing.assert_allclose(contact.velocity, run.slip_rate(times), atol=1e-9)
    far_end = [run.field(SLAB.thickness, times * 0.9 + step) for step in (0.0, 1e-4 * R)]
    between = run.field(SLAB.thickness, times * 0.9 + 0.5e-4 * R).velocity
    moved = (far_end[1].displacement - far_end[0].displacement) / (1e-4 * R)
    assert np.quantile(abs(moved - between), 0.8) < 1e-6


@pytest.mark.sampled(every=8)
@pytest.mark.parametrize("seed", range(8))
def test_rest_of_thousands_of_round_trips_is_leapt_over_between_changes(seed: int) -> None:
    """The load of a contact at rest is the recursion in whole round trips, at any phase."""
    rng = np.random.default_rng([47, seed])
    trips = 4000
    times = np.sort(rng.uniform(0.0, trips, 4))
    shares = np.append(-1.0, rng.choice([-1.0, 0.0, 0.5, -0.5, -0.2], 4))
    jumps, pulls = np.sort(rng.uniform(0.0, trips, 2)), rng.uniform(0.0, 1e-4, 3)
    pull: float | LoadingHistory = float(pulls[0]) if seed % 2 else Steps([0.0, *jumps * R], pulls)  # type: ignore[arg-type]
    problem = ss.Problem(
        SLAB, GLUE, pull_rate=pull, initial_load=1e7, far_stress=3e6, driver_reflection=steps(*zip(times, shares[1:], strict=True))
    )
    run = ss.simulate(problem, trips * R)
    phase, load = rng.uniform(0.0, 1.0, 9), np.zeros((trips, 9))
    for n in range(trips):
        sent = n + phase - 0.5
        share = shares[np.searchsorted(times, sent, side="right")]
        moved = problem.pull_rate_at(np.maximum(sent, 0.0) * R)
        before = load[n - 1] if n else 1e7 - SLAB.stiffness * pulls[0] * R * (1.0 - phase)
        load[n] = -share * before + Z * (1.0 - share) * moved + (1.0 + share) * 3e6
        if n == 0:
            load[0] = np.where(phase < 0.5, 1e7 + SLAB.stiffness * pulls[0] * R * phase, load[0])
    chosen = np.unique(
        np.concatenate([rng.integers(0, trips, 200), np.clip(np.add.outer(times, [-1, 0, 1, 2]), 0, trips - 1).astype(int).ravel()])
    )
    np.testing.assert_allclose(run.load((chosen[:, None] + phase) * R), load[chosen], rtol=1e-9, atol=1e-9 * abs(load).max())
    assert len(run.history) < 1500
    assert balance(run, np.sort(rng.uniform(0.0, trips * R, 12))) < 1e-9


@pytest.mark.sampled(every=4)
@pytest.mark.parametrize(
    "others",
    [
        {"ground_velocity": Sinusoidal(0.0, 0.5, 1.7 * R)},
        {"ground_acceleration": PiecewiseLinear([0.0, R, 3.0 * R, 4.0 * R], [0.0, 2.0, -1.0, 0.0])},
        {"normal_load": Steps([0.0, 2.6 * R, 4.1 * R], [STRESS, 0.8 * STRESS, 1.2 * STRESS])},
        {"body": replace(SLAB, contact_mass=0.3 * Z * R), "friction": ss.friction.ExponentialStribeck(0.6, 0.4, 0.2)},
    ],
)
def test_energy_balances_beside_whatever_else_varies(others: dict[str, Any]) -> None:
    changes = steps((1.15, 0.6), (2.35, -1.0), (4.2, 0.0), (5.0, 1.0))
    base = ss.Problem(SLAB, LAW, pull_rate=0.4, initial_load=5.5e7, far_stress=2e7, driver_reflection=changes)
    run = ss.simulate(replace(base, **others), 9.0 * R)
    assert len(run.events) > 0
    assert balance(run, np.linspace(0.03, 8.97, 40) * R) < 1e-9


def test_moving_ground_comes_back_from_the_driver_of_the_moment() -> None:
    """A contact at rest on ground of velocity g sends w = 2 Z g - beta; what it feels is beta - Z g."""
    changes, ground = steps((1.15, 0.6), (2.35, -0.3), (4.2, 0.0)), Sinusoidal(0.0, 0.5, 1.7 * R)
    run = ss.simulate(
        ss.Problem(SLAB, GLUE, initial_load=1e7, far_stress=2e7, ground_velocity=ground, driver_reflection=changes), 8.0 * R
    )
    phase = np.linspace(0.01, 0.99, 25)
    beta = np.full(25, 1e7)
    for n in range(1, 8):
        share = changes.at((n + phase - 0.5) * R)
        moved = ground.at((n - 1 + phase) * R)
        if n == 1:  # in the first round trip the driver is rigid, so that the load of the start stays
            assert (changes.at(phase * R - 0.5 * R) == -1.0).all()
        beta = share * (2.0 * Z * moved - beta) + (1.0 + share) * 2e7
        np.testing.assert_allclose(run.load((n + phase) * R), beta - Z * ground.at((n + phase) * R), atol=1e-6 * STRESS * 1e-4)


def test_a_step_to_the_same_driver_changes_no_bit() -> None:
    plain = ss.Problem(SLAB, LAW, pull_rate=0.01, initial_load=5.9e7)
    doubled = replace(plain, driver_reflection=steps((1.3, -1.0), (7.0, -1.0)))
    changed = replace(plain, far_stress=0.0, driver_reflection=steps((2.3, 0.5), (9.0, -1.0)))
    twice = replace(changed, driver_reflection=steps((1.1, -1.0), (2.3, 0.5), (5.0, 0.5), (9.0, -1.0)))
    for one, other in ((plain, doubled), (changed, twice)):
        runs = [ss.simulate(problem, 60.0 * R).history.store for problem in (one, other)]
        assert runs[0].pieces.tobytes() == runs[1].pieces.tobytes()
    typed = replace(changed, body=behind(1.0 / 3.0), driver_reflection=Steps([0.0, R, 2.0 * R], [0.3333333, -1.0, 0.3333333]))
    assert typed.driver_steps == ((0.0, typed.body.reflection), (R, -1.0), (2.0 * R, typed.body.reflection))


LAYERS = [300.0, 700.0], [2000.0, 2800.0], [1500.0, 3500.0]


@pytest.mark.parametrize("body", [SLAB, ss.LayeredSlab(*LAYERS, STRESS), ss.TwoSlabs(*LAYERS, *LAYERS, STRESS, sides="joined")])
@pytest.mark.parametrize(
    "far", [{"far_stress": 3e7, "far_stress_rate": 1e3}, {"far_stress": Steps([0.0, R], [3e7, 4e7])}], ids=["number", "history"]
)
def test_a_driver_that_only_ever_is_rigid_does_not_feel_the_far_stress(body: Any, far: dict[str, Any]) -> None:
    """So a sweep over where the driver is set free, or to what, may include never, and the rigid driver."""
    plain = ss.Problem(body, LAW, pull_rate=0.01, initial_load=5.9e7)
    never = replace(plain, driver_reflection=steps((1.3, -1.0), (7.0, -1.0)), **far)
    runs = [ss.simulate(problem, 30.0 * R) for problem in (plain, never)]
    assert len(runs[0].events) > 0
    assert runs[0].history.store.pieces.tobytes() == runs[1].history.store.pieces.tobytes()
    assert balance(runs[1], np.linspace(R, 29.0 * R, 7)) < 1e-9
    found = [ss.studies.steady(problem, from_rest=False).lines() for problem in (plain, never)]
    assert found[0] == found[1]


@pytest.mark.slow
@pytest.mark.sampled(every=5)
@pytest.mark.parametrize("stop", [0.4, 1.7, 2.6, 5.5, 300.0])
def test_a_run_that_is_taken_up_again_has_every_bit_of_one_that_never_stopped(stop: float, tmp_path: Path) -> None:
    changes = steps((1.3, 1.0), (4.1, -0.5), (400.2, -1.0))
    problem = ss.Problem(SLAB, LAW, pull_rate=0.4, initial_load=6.1e7, far_stress=2e7, driver_reflection=changes)
    whole = ss.simulate(problem, 500.0 * R)
    ss.simulate(problem, stop * R, checkpoint=tmp_path / "run.nc")
    taken_up = ss.resume(tmp_path / "run.nc", 500.0 * R)
    assert isinstance(taken_up, ss.Solution)
    assert taken_up.problem == problem
    assert taken_up.history.store.pieces.tobytes() == whole.history.store.pieces.tobytes()


FREED = {"far_stress": 0.0, "driver_reflection": steps((1.0, 1.0))}
STRING = ss.load_scenario("drill-string").problem.body


@pytest.mark.parametrize(
    ("others", "message"),
    [
        (
            {"driver_reflection": 0.5},
            "driver_reflection must be a loading history, got 0.5: a constant one follows from driver_imp",
        ),
        ({"driver_reflection": Steps([0, 1], ["0 m/s", "1 m/s"])}, "driver_reflection must be in numbers without unit, got a hist"),
        (
            {"driver_reflection": Sinusoidal(-0.5, 0.5, 1.0)},
            "driver_reflection must change by steps, got sinusoidal: give kind ste",
        ),
        ({"driver_reflection": steps((1.0, 1.5))}, "driver_reflection must lie between -1 (rigid) and 1 (set free), got 1.5"),
        (
            {"driver_reflection": Steps([0, 1], [0, 1])},
            "driver_reflection begins with 0, but that of the body's driver_impedance is -1: make them equal",
        ),
        (
            {"far_stress": None},
            "driver_reflection needs a far_stress, because the driver is rigid at first: 0 Pa if nothing holds",
        ),
        (
            {"driver_reflection": None},
            "far_stress and far_stress_rate need a slab with a finite driver_impedance",
        ),
        (
            {"body": replace(SLAB, driver_impedance=Z, driver_inertia=Z * R)},
            "driver_reflection: a driver with a mass or an integral gain is not followed where it changes",
        ),
        (
            {"body": ss.SpringBlock(1.0, 1.0, 1.0)},
            "driver_reflection is not followed behind a SpringBlock, which sends no waves to its driver: give a slab",
        ),
    ],
)
def test_what_cannot_be_followed_is_refused_in_one_line(others: dict[str, Any], message: str) -> None:
    with pytest.raises(ss.InputError) as caught:
        ss.Problem(**{"body": SLAB, "friction": LAW, "initial_load": 5e7} | FREED | others)
    assert str(caught.value).startswith(f"Problem: {message}")


def test_a_string_may_be_let_go() -> None:
    problem = ss.Problem(
        STRING, LAW, initial_load=0.0, far_stress="0 N m", driver_reflection=Steps([0.0, 2.0], [STRING.reflection, 1.0])
    )
    assert problem.driver_changes
    assert ss.simulate(problem, 4.0).status.ok


def test_leaps_over_creep_need_a_driver_that_stays() -> None:
    weakens = ss.friction.LinearSlipWeakening(0.6, 0.5, 0.1)
    problem = ss.Problem(SLAB, weakens, pull_rate=1e-6, initial_load=5e7, **FREED)
    with pytest.raises(ss.InputError, match=r"leaps over creep need a driver that does not change$"):
        ss.simulate(problem, R, creep_rtol=1e-6)
