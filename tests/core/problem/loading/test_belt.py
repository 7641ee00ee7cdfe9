"""A block on a belt: closed forms, scipy in the frame of the wall, the critical speed of a belt, energy, and how it is said."""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import quad, solve_ivp

import stickslip as ss
from stickslip.problem.loading import HoldAndSlide, LoadingHistory, PiecewiseLinear, Sinusoidal, Steps
from stickslip.run.check.examine import examine
from tests.core.problem.loading.belt_by_scipy import MASS, STIFFNESS, by_scipy
from tests.core.problem.loading.belts import BLOCK, FORCE, LAW, SCENARIO

SWINGS = Sinusoidal(0.3, 0.12, 0.5, 0.4)
FREQUENCY = math.sqrt(STIFFNESS / MASS)


def moved(belt: Sinusoidal, times: np.ndarray) -> np.ndarray:
    """Return how far (m) a belt has moved since the start, in closed form."""
    amplitude, frequency, phase = belt.tone
    return belt.mean * times + amplitude / frequency * (np.cos(phase) - np.cos(frequency * times + phase))


def accelerates(belt: Sinusoidal, times: np.ndarray) -> np.ndarray:
    """Return the acceleration (m/s^2) of a belt."""
    amplitude, frequency, phase = belt.tone
    return np.asarray(amplitude * frequency * np.cos(frequency * times + phase))


@pytest.mark.parametrize("period", [0.5, 2.0 * math.pi / FREQUENCY, 0.07], ids=["slow", "its own", "fast"])
def test_a_block_that_slides_all_the_time_does_not_feel_how_the_belt_swings(period: float) -> None:
    """Coulomb friction is the same at all slip rates: x is the swing about S mu / K that it is on a steady belt, to 1e-11."""
    belt, begins, at_first = Sinusoidal(3.0, 0.9, period, 0.4), 4.0, 3.0
    problem = ss.Problem(BLOCK, LAW, pull_rate=belt, initial_load=begins, initial_rate=at_first)
    times = np.linspace(0.0, 3.0, 61)
    run = ss.simulate(problem, 3.0)
    rest, velocity = FORCE * 0.4 / STIFFNESS, belt.first - at_first
    turned = FREQUENCY * times
    place = rest + (begins / STIFFNESS - rest) * np.cos(turned) + velocity / FREQUENCY * np.sin(turned)
    runs = -FREQUENCY * (begins / STIFFNESS - rest) * np.sin(turned) + velocity * np.cos(turned)
    assert run.slip_rate(times).min() > 0.5
    assert run.slip_rate(times) == pytest.approx(belt.at(times) - runs, abs=1e-11)
    assert run.slip(times) == pytest.approx(moved(belt, times) - place + begins / STIFFNESS, abs=1e-11)
    load = STIFFNESS * place + MASS * accelerates(belt, times)
    assert run.load(times[1:]) == pytest.approx(load[1:], rel=1e-11)
    without_inertia = STIFFNESS * place
    assert np.abs(run.load(times[1:]) / without_inertia[1:] - 1.0).max() > 0.1  # the test sees the force of inertia


@pytest.mark.parametrize("period", [0.5, 2.0 * math.pi / FREQUENCY], ids=["slow", "its own"])
def test_a_block_that_sticks_bears_the_spring_and_its_own_inertia(period: float) -> None:
    """At its own period the two swing against each other, and the load grows as on a steady belt."""
    belt = Sinusoidal(0.02, 0.05, period, 0.3)
    run = ss.simulate(ss.Problem(BLOCK, LAW, pull_rate=belt, initial_load=1.0), 0.9)
    times = np.linspace(0.01, 0.9, 41)
    assert len(run.events) == 0
    assert run.load(times) == pytest.approx(1.0 + STIFFNESS * moved(belt, times) + MASS * accelerates(belt, times), rel=1e-12)


def changes_of(run: ss.Solution) -> np.ndarray:
    """Return the times (s) at which rest begins or ends, the start among them if the block slips at once."""
    history = run.history
    rests = history.store.mode[: len(history)] == 0
    begin = history.store.trip[: len(history)] * history.round_trip_time + history.store.phase_from[: len(history)]
    return begin[np.append(not rests[0], rests[1:] != rests[:-1])]


@pytest.mark.sampled(every=3)
@pytest.mark.parametrize("damping", [0.0, 0.8])
@pytest.mark.parametrize(
    ("belt", "number"),
    [(SWINGS, (7, 3)), (Sinusoidal(0.0, 0.9, 0.9, 0.2), (5, 17)), (Sinusoidal(0.05, 0.3, 0.31, -1.0), (25, 25))],
    ids=["forwards", "to and fro", "fast"],
)
def test_stick_and_slip_on_a_belt_that_swings_come_when_scipy_says(
    belt: Sinusoidal, damping: float, number: tuple[int, int]
) -> None:
    """To 1e-11 s, where scipy has tolerances of 1e-13."""
    run = ss.simulate(ss.Problem(replace(BLOCK, damping=damping), LAW, pull_rate=belt, initial_load=0.0), 4.0)
    ours, theirs = changes_of(run), by_scipy(belt, 4.0, damping, 0.6 * FORCE, 0.4 * FORCE)
    assert len(ours) == number[damping > 0.0]
    assert ours == pytest.approx(theirs, abs=1e-11)


def test_stick_and_slip_on_a_belt_that_starts_and_stops_come_when_scipy_says() -> None:
    """To 1e-11 s: the force of inertia jumps where the acceleration of the belt does, and one jump makes the block slip."""
    belt = PiecewiseLinear([0.0, 0.5, 1.5, 2.0], [0.0, 0.6, 0.6, -0.2])
    ours = changes_of(ss.simulate(ss.Problem(BLOCK, LAW, pull_rate=belt, initial_load=0.0), 3.5))
    theirs = by_scipy(belt, 3.5, 0.0, 0.6 * FORCE, 0.4 * FORCE)
    assert ours == pytest.approx(theirs, abs=1e-11)
    assert 2.0 in theirs


def test_a_belt_is_a_pull_on_ground_that_moves_the_other_way() -> None:
    """The two histories that say the same on a block on a spring; a sinusoid of both is refused there."""
    belt = PiecewiseLinear([0.0, 0.5, 1.5, 2.0], [0.1, 0.6, 0.6, -0.2])
    ground = PiecewiseLinear(belt.times, [0.1 - one for one in belt.values])
    on_ground = ss.Problem(ss.SpringBlock(MASS, STIFFNESS, FORCE), LAW, pull_rate=belt, ground_velocity=ground, initial_load=0.0)
    runs = [ss.simulate(one, 3.0) for one in (on_ground, ss.Problem(BLOCK, LAW, pull_rate=belt, initial_load=0.0))]
    times = np.linspace(0.0, 3.0, 31)
    assert runs[0].slip(times) == pytest.approx(runs[1].slip(times), rel=1e-12, abs=1e-14)
    assert abs(float(ss.simulate(replace(on_ground, ground_velocity=None), 3.0).slip(3.0)) / float(runs[1].slip(3.0)) - 1.0) > 1e-3


STEADY = {"number": 0.2, "silent": Sinusoidal(0.2, 0.0, 1.0), "equal": Steps([0.0, 1.0], [0.2, 0.2])}


@pytest.mark.parametrize("speed", STEADY.values(), ids=STEADY)
def test_a_steady_belt_is_a_pulled_spring_to_the_last_bit(speed: float | LoadingHistory) -> None:
    pulled = ss.simulate(ss.Problem(ss.SpringBlock(MASS, STIFFNESS, FORCE), LAW, pull_rate=speed, initial_load=0.0), 5.0)
    belt = ss.simulate(ss.Problem(BLOCK, LAW, pull_rate=speed, initial_load=0.0), 5.0)
    times = np.linspace(0.0, 5.0, 101)
    assert belt.slip(times).tobytes() == pulled.slip(times).tobytes()
    assert belt.problem.ground is None


def test_a_disc_that_turns_under_a_body_is_a_belt_in_angles() -> None:
    turned = ss.RotatingBlock(MASS, STIFFNESS, FORCE).on_belt()
    runs = [ss.simulate(ss.Problem(body, LAW, pull_rate=SWINGS, initial_load=0.0), 4.0) for body in (BLOCK, turned)]
    times = np.linspace(0.0, 4.0, 41)
    assert runs[0].slip(times).tobytes() == runs[1].slip(times).tobytes()


def test_the_critical_speed_of_a_belt_is_where_damping_makes_up_for_falling_friction() -> None:
    """c + S mu'(v) = 0 at v = v1 ln(S drop / (c v1)), to 1e-9; runs on both sides of it, from near steady sliding, agree."""
    drop, scale, damping = 0.2, 0.05, 4.0
    law = ss.friction.FromExpression("0.3 + 0.2*exp(-v/v1)", {"v1": "50 mm/s"})
    critical = scale * math.log(FORCE * drop / (damping * scale))
    block = replace(BLOCK, damping=damping)
    found = ss.studies.steady(ss.Problem(block, law, pull_rate=0.05, initial_load=0.0), from_rest=False)
    assert found.changes[0].pull_rate == pytest.approx(critical, rel=1e-9)
    for factor, slides in ((1.1, True), (0.9, False)):
        speed = factor * critical
        friction = FORCE * (0.3 + drop * math.exp(-speed / scale)) + damping * speed
        start = ss.Problem(block, law, pull_rate=speed, initial_rate=speed, initial_load=1.001 * friction)
        run = ss.simulate(start, 60.0)
        swing = np.abs(run.slip_rate(np.linspace(50.0, 60.0, 997)) - speed).max()
        assert bool(swing < 1e-4 * speed) is slides


@pytest.mark.parametrize("belt", [SWINGS, PiecewiseLinear([0.0, 0.5, 1.5, 2.0], [0.1, 0.6, 0.6, -0.2])], ids=["swings", "stops"])
def test_energies_balance_as_seen_from_the_belt_and_from_the_wall(belt: LoadingHistory) -> None:
    """From the belt to 1e-13; from the wall, friction's work on the block is what it gains of energy, to 1e-9."""
    problem = ss.Problem(replace(BLOCK, damping=0.8), LAW, pull_rate=belt, initial_load=1.0)
    run = ss.simulate(problem, 3.0)
    energy = run.energy(np.linspace(0.1, 3.0, 30))
    assert np.abs(energy.balance).max() < 1e-13 * float(energy.work.max())
    assert np.abs(run.energetics().balance).max() < 1e-12 * run.energetics().heat.max()

    def works(t: float) -> float:  # where it sticks, the load is what holds the block
        rate = float(run.slip_rate(t))
        drags = float(run.traction(t)) + 0.8 * rate
        return drags * (float(belt.at(t)) - rate)

    points = sorted({*(one for one in [*run.events.start, *run.events.end, 0.5, 1.5, 2.0] if 0.0 < one < 3.0)})
    edges = [0.0, *points, 3.0]
    work = sum(quad(works, low, high, epsabs=1e-12, epsrel=1e-12, limit=200)[0] for low, high in pairwise(edges))
    velocity = [float(belt.at(t) - run.slip_rate(t)) for t in (0.0, 3.0)]
    stretch = [1.0 / STIFFNESS, 1.0 / STIFFNESS + quad(belt.at, 0.0, 3.0, points=[0.5, 1.5, 2.0])[0] - float(run.slip(3.0))]
    gained = [0.5 * MASS * v**2 + 0.5 * STIFFNESS * x**2 for v, x in zip(velocity, stretch, strict=True)]
    assert work == pytest.approx(gained[1] - gained[0], rel=1e-9)


def test_a_scenario_says_it_and_a_run_that_is_taken_up_again_is_the_same(tmp_path: Path) -> None:
    file = tmp_path / "belt.toml"
    file.write_text(SCENARIO)
    scenario = ss.load_scenario(file)
    assert scenario.problem == ss.Problem(BLOCK, LAW, pull_rate=SWINGS, initial_load=0.0)
    run, times = ss.simulate(scenario), np.linspace(0.0, 4.0, 41)
    half = ss.simulate(scenario.problem, 1.7).to_netcdf(tmp_path / "half.nc")
    assert ss.resume(half, 4.0).slip(times).tobytes() == run.slip(times).tobytes()
    found = examine(scenario)
    assert found.chosen[0] == "the pull rate is the velocity of the belt: forwards it drags the block away from the wall"
    assert not any("ground" in one for one in found.chosen)
    inertia = next(one.value for one in found.derived if one.name == "m w'")
    assert inertia == pytest.approx(MASS * 0.12 * 2.0 * math.pi / 0.5, rel=1e-14)
    assert ss.uniqueness(scenario.problem).regime == "regular"


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        (
            {"pull_rate": Steps([0.0, 1.0], [0.1, 0.3])},
            "Problem: pull_rate jumps: a belt whose velocity jumps makes the slip rate jump, which that of a mass does not here:"
            " join the steps by short ramps (piecewise-linear)",
        ),
        (
            {"pull_rate": HoldAndSlide(0.1, 1.0, [1.0])},
            "Problem: pull_rate jumps: a belt whose velocity jumps makes the slip rate jump, which that of a mass does not here:"
            " join the steps by short ramps (piecewise-linear)",
        ),
        (
            {"ground_velocity": PiecewiseLinear([0.0, 1.0], [0.0, 1.0])},
            "Problem: ground_velocity: the ground of a BlockOnBelt is the belt, whose velocity is pull_rate: leave"
            " ground_velocity out",
        ),
    ],
    ids=["steps", "holds", "ground"],
)
def test_what_no_belt_does_is_refused_in_one_line(changes: dict[str, LoadingHistory], message: str) -> None:
    with pytest.raises(ss.InputError) as refused:
        replace(ss.Problem(BLOCK, LAW, pull_rate=0.1, initial_load=0.0), **changes)
    assert str(refused.value) == message


@pytest.mark.parametrize("body", [BLOCK, ss.RotatingBlock(1.0, 2.0, 3.0).on_belt()], ids=["belt", "disc"])
def test_what_is_shown_of_a_body_on_a_belt_makes_it(body: ss.SpringBlock | ss.RotatingBlock) -> None:
    assert eval(f"ss.{body!r}") == body
    assert body.on_belt() == body


def test_a_dashpot_beside_the_spring_hangs_on_the_wall() -> None:
    """To 1e-12 of scipy (tolerances 1e-13) in the frame of the wall, where it resists x' alone; its sinusoid is out of phase."""
    dashpot, belt, begins = 1.5, Sinusoidal(3.0, 0.9, 0.5, 0.4), 4.0
    body = ss.SpringBlock(MASS, STIFFNESS, FORCE, driver_damping=dashpot).on_belt()
    start = begins + dashpot * belt.first  # the load counts what the dashpot would bear of a block that moves with the belt
    run = ss.simulate(ss.Problem(body, LAW, pull_rate=belt, initial_load=start, initial_rate=belt.first), 2.0)
    times = np.linspace(0.0, 2.0, 21)

    def change(t: float, y: list[float]) -> list[float]:
        return [y[1], (0.4 * FORCE - STIFFNESS * y[0] - dashpot * y[1]) / MASS]

    place, velocity = solve_ivp(change, (0.0, 2.0), [begins / STIFFNESS, 0.0], "DOP853", rtol=1e-13, atol=1e-15, t_eval=times).y
    assert run.slip_rate(times) == pytest.approx(belt.at(times) - velocity, abs=1e-12)
    assert run.slip(times) == pytest.approx(moved(belt, times) - place + begins / STIFFNESS, abs=1e-12)
    energy = run.energy(times)
    assert np.abs(energy.balance).max() < 1e-13 * float(energy.work.max())
