"""A rigid body meets hard stops as exponentials between events do, rests at them, and its energy balances."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.linalg import expm
from scipy.optimize import brentq

import stickslip as ss
from stickslip.foundation.arrays import Floats

MASS, STIFFNESS, DAMPING, STATIC, KINETIC, RATE = 1.0, 100.0, 0.4, 3.0, 2.0, 0.05


def block(restitution: float = 0.5, ahead: float = 0.021, behind: float = math.inf, **given: Any) -> ss.Problem:
    body = ss.SpringBlock(MASS, STIFFNESS, 10.0, DAMPING, stop_ahead=ahead, stop_behind=behind, restitution=restitution)
    return ss.Problem(body, ss.friction.Coulomb(STATIC / 10.0, KINETIC / 10.0), **{"pull_rate": RATE, "initial_load": 0.0, **given})


def flow(way: float, rate: float) -> Floats:
    """Return the matrix that moves (force of the spring, slip rate, slip, 1)."""
    return np.array(
        [
            [0.0, -STIFFNESS, 0.0, STIFFNESS * rate],
            [1.0 / MASS, -DAMPING / MASS, 0.0, -way * KINETIC / MASS],
            [0.0, 1.0, 0.0, 0.0],
            [0.0, 0.0, 0.0, 0.0],
        ]
    )


def impacts(given: ss.Problem, motion: Floats, duration: float, least: float = 1e-7) -> list[tuple[float, float, float]]:
    """Return the impacts of own steps: times (s), and slip rates (m/s) before and after. Bounces below `least` are left out."""
    body: Any = given.body
    rate, time, found, grid = float(given.pull_rate), 0.0, [], 2e-4
    way = 0.0 if motion[1] == 0.0 else float(np.sign(motion[1]))
    while time < duration:
        at_stop = 1.0 if motion[2] >= body.stop_ahead else -1.0 if motion[2] <= -body.stop_behind else 0.0
        if way == 0.0:
            force = motion[0] + STIFFNESS * rate * np.array([0.0, grid])
            leaves = [one for one in (1.0, -1.0) if one * force[1] > STATIC and one != at_stop]
            if not leaves:
                motion, time = motion + np.array([STIFFNESS * rate * grid, 0.0, 0.0, 0.0]), time + grid
                continue
            way = leaves[0]
            since = max((way * STATIC - motion[0]) / (STIFFNESS * rate), 0.0) if rate else 0.0
            motion, time = motion + np.array([STIFFNESS * rate * since, 0.0, 0.0, 0.0]), time + since
            motion, time = expm(flow(way, rate) * 1e-9) @ motion, time + 1e-9
            continue
        moves = flow(way, rate)
        stop = body.stop_ahead if way > 0.0 else -body.stop_behind
        later = expm(moves * grid) @ motion
        if way * later[1] > 0.0 and way * (later[2] - stop) < 0.0:
            motion, time = later, time + grid
            continue
        levels = [(1, 0.0), *([(2, stop)] if math.isfinite(stop) else [])]
        due = [(moves, motion, *one) for one in levels if (motion[one[0]] - one[1]) * (later[one[0]] - one[1]) < 0.0]
        since, place = min((brentq(reached, 0.0, grid, one, xtol=1e-16, rtol=1e-15), one[2]) for one in due)
        motion, time = expm(moves * since) @ motion, time + since
        if place == 1:
            motion[1], way = 0.0, 0.0
            if abs(motion[0]) > STATIC:
                way = float(np.sign(motion[0]))
                motion, time = expm(flow(way, rate) * 1e-9) @ motion, time + 1e-9
            continue
        after = -body.restitution * motion[1]
        pulled_off = -way * motion[0] > STATIC
        if abs(after) <= least and not pulled_off:
            after = 0.0
        found.append((time, float(motion[1]), float(after)))
        motion[1], motion[2], way = after, stop, -way if after or pulled_off else 0.0
    return found


def reached(since: float, moves: Floats, motion: Floats, place: int, level: float) -> float:
    return float((expm(moves * since) @ motion)[place] - level)


@pytest.mark.sampled(every=2)
@pytest.mark.parametrize("restitution", [0.0, 0.5, 0.8, 1.0])
def test_impacts_are_where_exponentials_meet_the_stop(restitution: float) -> None:
    given = block(restitution)
    solution = ss.simulate(given, 4.0, rtol=1e-12)
    expected = impacts(given, np.array([0.0, 0.0, 0.0, 1.0]), 4.0)
    shocks = solution.shocks[solution.shocks.cause == "stop"]
    strong = [one for one in expected if abs(one[1]) > 1e-4]
    assert len(strong) >= 1
    assert shocks.time.to_numpy()[: len(strong)] == pytest.approx([one[0] for one in strong], abs=2e-9)
    assert shocks.rate_before.to_numpy()[: len(strong)] == pytest.approx([one[1] for one in strong], abs=1e-7)
    assert shocks.rate_after.to_numpy()[: len(strong)] == pytest.approx([one[2] for one in strong], abs=1e-7)
    assert float(solution.slip(np.linspace(0.0, 4.0, 4001)).max()) <= 0.021 * (1.0 + 1e-15)


def test_a_body_rests_at_the_stop_until_the_load_pulls_it_off() -> None:
    turning = ss.loading.PiecewiseLinear([0.0, 1.5, 1.501, 9.0], [RATE, RATE, -RATE, -RATE])
    solution = ss.simulate(block(0.0, pull_rate=turning), 4.0, rtol=1e-12)
    # the end of the spring is where it was pulled to, and the block leaves when K (D - u) is minus the static strength
    expected = 1.501 + (RATE * 1.5 - (0.021 - STATIC / STIFFNESS)) / RATE
    begins = solution.events.start.to_numpy()
    assert begins[begins > 1.0][0] == pytest.approx(expected, abs=1e-9)
    resting = np.linspace(0.9, expected - 1e-6, 50)
    assert solution.slip(resting) == pytest.approx(np.full(50, 0.021), abs=0.0)
    assert float(solution.load(1.5)) > STATIC


def test_a_body_that_is_pressed_to_the_stop_for_ever_is_locked() -> None:
    solution = ss.simulate(block(0.3), 1e9)
    assert float(solution.slip(1e9)) == 0.021
    assert len(solution.history) < 300


def test_bounces_without_friction_come_to_rest_as_a_geometric_series() -> None:
    """A spring at its end presses a block to the stop: half periods between impacts, each shorter for a smaller rate."""
    body = ss.SpringBlock(1.0, 1e-6, 10.0, stop_ahead=0.5, restitution=0.6)
    solution = ss.simulate(ss.Problem(body, ss.friction.Coulomb(0.0, 0.0), 0.0, initial_load=2.0), 10.0, rtol=1e-11)
    shocks = solution.shocks[solution.shocks.cause == "stop"]
    first = math.sqrt(2.0 * 0.5 * 2.0)  # rate after 0.5 m under 2 N
    times = np.sqrt(2.0 * 0.5 / 2.0) + np.append(0.0, np.cumsum(2.0 * first * 0.6 ** np.arange(1, 12) / 2.0))
    assert shocks.time.to_numpy()[:12] == pytest.approx(times, abs=1e-6)  # the force of the spring changes by 5e-7 of itself
    assert float(solution.slip(9.0)) == 0.5
    assert float(solution.slip_rate(9.0)) == 0.0


@pytest.mark.parametrize("restitution", [0.9, 0.99])
@pytest.mark.parametrize("side", [1.0, -1.0])
def test_a_force_presses_a_free_block_to_rest_where_slip_no_longer_resolves_its_hops(restitution: float, side: float) -> None:
    """The number of impacts is that of a geometric series with friction: out under F + f, back under F - f (N), to 1e-7 m/s."""
    force, friction = 9.0, 0.6
    body = ss.SpringBlock(1.0, 0.0, 3.0, stop_ahead=0.04, stop_behind=0.04, restitution=restitution)
    solution = ss.simulate(ss.Problem(body, ss.friction.Coulomb(0.3, 0.2), force=side * force), 30.0)
    shocks = solution.shocks[solution.shocks.cause == "stop"]
    loss = restitution * math.sqrt((force - friction) / (force + friction))
    strong = np.abs(shocks.rate_before.to_numpy()) > 1e-4
    expected = math.sqrt(2.0 * 0.04 * (force - friction)) * loss ** np.arange(strong.sum())
    assert np.abs(shocks.rate_before.to_numpy())[strong] == pytest.approx(expected, rel=1e-4)
    assert expected[-1] * loss < 1e-4
    assert len(shocks) < math.log(1e-8) / math.log(loss)
    assert float(solution.slip(30.0)) == side * 0.04
    assert abs(solution.shocks.rate_after.iloc[-2]) < 1e-6


@pytest.mark.parametrize("restitution", [0.9, 0.99])
def test_a_pulled_spring_and_a_loop_press_a_bouncing_body_to_rest(restitution: float) -> None:
    pulled = ss.SpringBlock(1.0, 100.0, 3.0, stop_ahead=0.04, restitution=restitution)
    gains = {"integral_gain": 50.0, "derivative_gain": 5.0, "reference_step": 0.05}
    held = ss.PositionLoop(1.0, 100.0, 3.0, stop_ahead=0.03, restitution=restitution, **gains)
    law = ss.friction.Coulomb(0.3, 0.2)
    for body, rate, place in ((pulled, 0.28, 0.04), (held, 0.0, 0.03)):
        solution = ss.simulate(ss.Problem(body, law, pull_rate=rate, initial_load=0.0), 10.0)
        assert float(solution.slip(10.0)) == place
        assert float(solution.slip_rate(10.0)) == 0.0
        assert len(solution.shocks) < 3000


@pytest.mark.parametrize("restitution", [0.0, 0.7])
def test_energies_balance_with_what_stops_take(restitution: float) -> None:
    swings = block(restitution, 0.01, 0.02, pull_rate=ss.loading.Sinusoidal(0.0, 0.4, 1.3), initial_load=1.0)
    solution = ss.simulate(swings, 8.0)
    shocks = solution.shocks[solution.shocks.cause == "stop"]
    lost = 0.5 * MASS * float((shocks.rate_before**2 - shocks.rate_after**2).sum())
    energy = solution.energy(np.linspace(0.0, 8.0, 33))
    assert len(shocks) > (5 if restitution else 0)
    assert float(energy.damped[-1]) > lost > 0.0
    assert abs(energy.balance).max() < 1e-9 * float(energy.heat[-1])
    assert abs(solution.catalogue(energy=True).balance).max() < 1e-9 * float(energy.heat[-1])
    proven = solution.proven
    assert proven.residual < 1e-7
    assert proven.load < 1e-9
    assert proven.rest < 1e-9
    assert proven.rate < 1e-9


@pytest.mark.slow
def test_a_run_with_stops_goes_on_bit_for_bit_from_a_file(tmp_path: Path) -> None:
    swings = block(0.7, 0.01, 0.02, pull_rate=ss.loading.Sinusoidal(0.0, 0.4, 1.3), initial_load=1.0)
    whole = ss.simulate(swings, 8.0)
    ss.simulate(swings, 3.1).to_netcdf(tmp_path / "part.nc")
    t = np.linspace(0.0, 8.0, 401)
    assert np.array_equal(ss.resume(tmp_path / "part.nc", 8.0).slip(t), whole.slip(t))


def test_a_loop_and_a_body_that_turns_have_stops_too() -> None:
    turns = ss.RotatingBlock(1.0, 100.0, 10.0, 0.4, stop_ahead=0.021, restitution=0.5)
    t = np.linspace(0.0, 3.0, 101)
    given = block()
    assert np.array_equal(ss.simulate(replace(given, body=turns), 3.0).slip(t), ss.simulate(given, 3.0).slip(t))
    loop = ss.PositionLoop(1.0, 100.0, 10.0, integral_gain=50.0, derivative_gain=5.0, reference_step=0.05, stop_ahead=0.03)
    solution = ss.simulate(ss.Problem(loop, given.friction, 0.0, initial_load=0.0), 20.0)
    assert float(solution.slip(20.0)) == 0.03
    expected = 100.0 * 0.02 + 50.0 * (0.02 * 20.0 + lag_of_approach(solution))
    assert float(solution.load(20.0)) == pytest.approx(expected, rel=1e-6)
    assert abs(solution.energy([20.0]).balance[0]) < 1e-10


def lag_of_approach(solution: ss.Solution) -> float:
    """Return the integral of the lag beyond 0.02 m (m s), by the trapezoidal rule with a correction of its own step."""
    end = float(solution.shocks.time.to_numpy()[-1])
    x, w = np.polynomial.legendre.leggauss(80)
    t = 0.5 * end * (1.0 + x)
    return 0.5 * end * float(w @ (0.03 - solution.slip(t)))


@pytest.mark.parametrize(
    ("make", "text"),
    [
        (lambda: ss.SpringBlock(1.0, 1.0, 1.0, restitution=0.5), "SpringBlock: restitution needs a stop to bounce off"),
        (lambda: ss.SpringBlock(1.0, 1.0, 1.0, stop_ahead=-0.1), "SpringBlock: stop_ahead must be at least 0 m"),
        (lambda: ss.SpringBlock(1.0, 1.0, 1.0, stop_ahead=0.1, restitution=1.5), "restitution must be at most 1"),
        (
            lambda: ss.SpringBlock(1.0, 1.0, 1.0, stop_ahead=0.1).on_belt(),
            "BlockOnBelt: stop_ahead: stops are not followed over a belt",
        ),
        (
            lambda: ss.Problem(ss.SpringBlock(1.0, 1.0, 1.0, stop_behind=0.1), ss.friction.LuGre(0.2, 0.1, 1e-3, 1e4)),
            "Problem: friction: hard stops need a law that knows rest, which LuGre does not",
        ),
        (
            lambda: block(ahead=0.0, initial_rate=1.0),
            "Problem: initial_rate: stop_ahead is 0, so that the body cannot move forwards",
        ),
        (lambda: block(behind=0.0, initial_rate=-1.0), "initial_rate: stop_behind is 0, so that the body cannot move backwards"),
    ],
)
def test_what_stops_do_not_follow_is_refused(make: Any, text: str) -> None:
    with pytest.raises(ss.InputError, match=text):
        make()
