"""A body without a spring, and a force that is given in time, against closed forms and a small integrator of their own."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

import stickslip as ss
from stickslip.loading import PiecewiseLinear, Sinusoidal, Steps

DRY = ss.friction.Coulomb(0.6, 0.4)
FREE = ss.SpringBlock(mass=2.0, stiffness=0.0, normal_force=20.0)
DISC = ss.RotatingBlock(inertia=2.0, stiffness=0.0, normal_torque=20.0)
SPRUNG = replace(FREE, stiffness=30.0)
SLOWED = 0.4 * 20.0 / 2.0
"""Deceleration (m/s^2) of a body that nothing pushes."""
SWING = Sinusoidal(mean=1.0, amplitude=16.0, period=1.7, phase=0.4)
POINTS = PiecewiseLinear([0.0, 1.0, 1.5, 3.0, 8.0], [4.0, 18.0, -16.0, 17.0, 0.0])
JUMPS = Steps([0.0, 1.0, 2.5, 4.0], [14.0, -16.0, 18.0, 0.0])
TABLE = PiecewiseLinear([0.0, 1.0, 2.0, 4.0, 9.0], [0.0, 0.5, -3.0, 1.0, 0.0])


@pytest.mark.parametrize("body", [FREE, DISC])
@pytest.mark.parametrize("rate", [1e-9, 3.0, -3.0, 1e4])
def test_a_body_thrown_on_a_floor_stops_after_v_squared_over_2_mu_g_to_rounding(body: ss.SpringBlock, rate: float) -> None:
    stop = abs(rate) / SLOWED
    run = ss.simulate(ss.Problem(body, DRY, initial_rate=rate), 10.0 * stop)
    (event,) = run.events.itertuples()
    assert float(run.slip(10.0 * stop)) == pytest.approx(rate * abs(rate) / (2.0 * SLOWED), rel=4e-15, abs=0.0)
    assert event.end == pytest.approx(stop, rel=4e-15, abs=0.0)
    assert float(run.slip_rate(10.0 * stop)) == 0.0


def test_a_constant_force_above_friction_accelerates_and_one_below_it_holds() -> None:
    pushed = ss.simulate(ss.Problem(FREE, DRY, force=13.0), 10.0)
    assert float(pushed.slip(10.0)) == pytest.approx(0.5 * (13.0 - 8.0) / 2.0 * 100.0, rel=1e-13)
    held = ss.simulate(ss.Problem(FREE, DRY, force="11 N"), 1e9)
    assert held.events.empty
    assert float(held.slip(1e9)) == 0.0
    assert float(held.load(5.0)) == 11.0


def test_a_force_does_what_an_initial_load_of_its_size_does_without_a_spring() -> None:
    by_force = ss.simulate(ss.Problem(FREE, DRY, force=13.0, initial_rate=0.5), 4.0)
    by_load = ss.simulate(ss.Problem(FREE, DRY, initial_load=13.0, initial_rate=0.5), 4.0)
    times = np.linspace(0.1, 4.0, 30)
    assert by_force.slip(times) == pytest.approx(by_load.slip(times), rel=1e-13)
    assert by_force.energy(times).work.to_numpy() == pytest.approx(by_load.energy(times).work.to_numpy(), rel=1e-12)


def test_a_ramp_of_force_breaks_away_when_it_reaches_the_strength() -> None:
    ramp, end = 3.0, 9.0
    run = ss.simulate(ss.Problem(FREE, DRY, force=PiecewiseLinear([0.0, end], [0.0, ramp * end])), end)
    (event,) = run.events.itertuples()
    since = end - 4.0
    assert event.start == pytest.approx(12.0 / ramp, rel=1e-15)
    slip = ((12.0 - 8.0) * since**2 / 2.0 + ramp * since**3 / 6.0) / 2.0
    assert float(run.slip(end)) == pytest.approx(slip, rel=1e-13)


def test_a_box_dropped_on_a_belt_moves_with_it_after_v_over_mu_g() -> None:
    run = ss.simulate(ss.Problem(FREE.on_belt(), DRY, pull_rate=2.0, initial_rate=2.0), 3.0)
    (event,) = run.events.itertuples()
    assert event.end == pytest.approx(2.0 / SLOWED, rel=4e-15)
    assert float(run.slip(3.0)) == pytest.approx(2.0**2 / (2.0 * SLOWED), rel=4e-15)


def test_a_block_on_an_oscillating_table_slides_to_and_fro_as_westermo_and_udwadia_say() -> None:
    """A strong shake never lets it rest: it turns at phases with cos p = pi mu g / (2 a), where its velocity is that of the table.

    The velocity of the block is a zigzag of slope mu g, that of the table (a/w) sin. Source: Westermo & Udwadia 1983, Earthq.
    Eng. Struct. Dyn. 11, 135.
    """
    size, period = 12.0, 0.5
    w, slides = 2.0 * math.pi / period, ss.friction.Coulomb(0.4, 0.4)
    shake = Sinusoidal(mean=0.0, amplitude=size, period=period, phase=0.5 * math.pi)
    run = ss.simulate(ss.Problem(FREE, slides, ground_acceleration=shake), 60.0 * period)
    times = np.linspace(58.0 * period, 60.0 * period, 20001)
    rates = run.slip_rate(times)
    turns = times[:-1][(rates[:-1] < 0.0) & (rates[1:] >= 0.0)]
    assert np.diff(turns) == pytest.approx(period, abs=2e-4 * period)
    lag = w * brentq(lambda t: float(run.slip_rate(t)), turns[-1] - 1e-3, turns[-1] + 1e-3)
    # slip rate = zigzag - (size/w) sin(w t): the zigzag is at its least, -mu g period / 4, where it turns up
    assert size / w * abs(math.sin(lag)) == pytest.approx(SLOWED * period / 4.0, rel=1e-6)


def den_hartog(ratio: float, friction: float) -> float:
    """Return the amplitude (F0/k) of a dry oscillator that does not stop, under F0 cos w t at w/w0, with friction over F0.

    Source: Den Hartog 1931, Trans. ASME 53, 107.
    """
    response = 1.0 / (1.0 - ratio**2)
    turned = math.pi / ratio
    damping = math.sin(turned) / (ratio * (1.0 + math.cos(turned)))
    return math.sqrt(response**2 - (friction * damping) ** 2)


@pytest.mark.parametrize(("ratio", "digits"), [(0.7, 1.885700), (1.3, 1.315348)])
def test_a_dry_oscillator_has_the_amplitude_of_den_hartog(ratio: float, digits: float) -> None:
    stiffness, force = 30.0, 5.0
    body = ss.SpringBlock(mass=2.0, stiffness=stiffness, normal_force=0.3 * force)
    period = 2.0 * math.pi / (ratio * math.sqrt(stiffness / 2.0))
    push = Sinusoidal(mean=0.0, amplitude=force, period=period, phase=0.5 * math.pi)
    run = ss.simulate(ss.Problem(body, ss.friction.Coulomb(1.0, 1.0), initial_load=0.0, force=push), 400.0 * period)
    times = np.linspace(399.0 * period, 400.0 * period, 200001)
    slip = run.slip(times)
    amplitude = 0.5 * (slip.max() - slip.min()) * stiffness / force
    assert den_hartog(ratio, 0.3) == pytest.approx(digits, abs=5e-7)
    assert amplitude == pytest.approx(den_hartog(ratio, 0.3), rel=1e-9)


def integrated(
    problem: ss.Problem, push: Callable[[float], float], end: float, breaks: list[float]
) -> Iterator[tuple[float, float]]:
    """Yield times and slips at the ends of rests and of slips, by Runge & Kutta's steps to each zero of the slip rate."""
    mass, spring, normal = problem.body.inertia, problem.body.stiffness, problem.normal
    law = problem.friction
    assert isinstance(law, ss.friction.Coulomb)
    strength, slides = normal * law.static, normal * law.dynamic
    stops = [*sorted(one for one in breaks if 0.0 < one < end), end]
    t, u, v = 0.0, 0.0, 0.0
    while t < end:
        until = next(one for one in stops if one > t)
        if v == 0.0:
            grid = np.linspace(t, until, 4001)
            beyond = [abs(push(one) - spring * u) > strength for one in (*(grid + 1e-12), until)]
            if not any(beyond[:-1]):
                t = until
                continue
            n = beyond.index(True)
            if n > 0:
                t = brentq(lambda s, at=u: abs(push(s) - spring * at) - strength, grid[n - 1], grid[n], xtol=1e-15)
                yield t, u
            way = math.copysign(1.0, push(t + 1e-12) - spring * u)
        else:
            way = math.copysign(1.0, v)

        def motion(s: float, y: list[float], way: float = way) -> list[float]:
            return [y[1], (push(s) - spring * y[0] - way * slides) / mass]

        def stopped(s: float, y: list[float], way: float = way) -> float:
            return way * y[1]

        stopped.terminal, stopped.direction = True, -1.0  # type: ignore[attr-defined] # as scipy wants it
        found = solve_ivp(motion, (t, until - 1e-13), (u, v), method="DOP853", rtol=1e-13, atol=1e-14, events=stopped)
        t, u, v = found.t[-1], found.y[0, -1], found.y[1, -1]
        if found.status == 1:
            v = 0.0
            yield t, u
        else:
            t = until


@pytest.mark.sampled(every=3)
@pytest.mark.parametrize("body", [FREE, SPRUNG])
@pytest.mark.parametrize("force", [SWING, POINTS, JUMPS], ids=["swing", "points", "jumps"])
def test_a_force_moves_a_body_as_an_integrator_says_with_stops(body: ss.SpringBlock, force: ss.loading.LoadingHistory) -> None:
    problem = ss.Problem(body, DRY, force=force, initial_load=0.0)
    run = ss.simulate(problem, 8.0)
    truth = list(integrated(problem, lambda t: float(force.at(t)), 8.0, force.parts[0].tolist()))
    assert len(truth) >= 3
    times, slips = np.array(truth).T
    assert run.slip(times) == pytest.approx(slips, rel=1e-9, abs=1e-9)
    assert np.abs(run.slip_rate(times)).max() < 1e-8


@pytest.mark.slow
def test_a_slow_force_on_a_dry_oscillator_lets_it_stop_twice_in_each_period() -> None:
    push = Sinusoidal(mean=0.0, amplitude=24.0, period=12.0, phase=0.5 * math.pi)
    problem = ss.Problem(SPRUNG, DRY, force=push, initial_load=0.0)
    run = ss.simulate(problem, 36.0)
    truth = np.array(list(integrated(problem, lambda t: float(push.at(t)), 36.0, [])))
    assert run.slip(truth[:, 0]) == pytest.approx(truth[:, 1], abs=1e-9)
    assert run.events.start.iloc[1:].to_numpy() == pytest.approx(truth[1::2, 0][: len(run.events) - 1], abs=1e-7)


CASES = {
    "thrown": ss.Problem(FREE, DRY, initial_rate=3.0),
    "load and throw": ss.Problem(FREE, DRY, initial_load=-14.0, initial_rate=2.0),
    "swing": ss.Problem(FREE, DRY, force=SWING),
    "points": ss.Problem(FREE, DRY, force=POINTS),
    "jumps": ss.Problem(DISC, DRY, force=JUMPS),
    "swing and table": ss.Problem(FREE, DRY, force=SWING, ground_velocity=TABLE),
    "points on a swinging table": ss.Problem(FREE, DRY, force=POINTS, ground_acceleration=Sinusoidal(0.0, 9.0, 2.0)),
    "dashpot alone": ss.Problem(replace(FREE, driver_damping=3.0, damping=0.5), DRY, pull_rate=3.0, force=SWING),
    "spring": ss.Problem(SPRUNG, DRY, pull_rate=0.5, force=JUMPS, initial_load=0.0),
    "spring and dashpot": ss.Problem(
        replace(SPRUNG, driver_damping=2.0), DRY, pull_rate=Steps([0.0, 1.0, 3.0], [1.0, 5.0, -2.0]), force=JUMPS, initial_load=0.0
    ),
    "belt": ss.Problem(
        FREE.on_belt(), DRY, pull_rate=PiecewiseLinear([0.0, 1.0, 2.0, 3.0], [2.0, 5.0, -1.0, 1.0]), initial_rate=2.0, force=SWING
    ),
    "normal load": ss.Problem(FREE, DRY, force=POINTS, normal_load=Sinusoidal(20.0, 6.0, 0.7)),
    "rate": ss.Problem(FREE, ss.friction.FromExpression("0.4 + 0.2/(1 + 5*v)"), force=POINTS),
    "bristles": ss.Problem(FREE, ss.friction.LuGre(0.6, 0.4, 0.1, "1e3 1/m", "3 s/m", 0.0), force=SWING),
    "one way": ss.Problem(FREE, DRY, force=SWING, one_way=True),
}
CASE = pytest.mark.parametrize("problem", CASES.values(), ids=CASES.keys())


@pytest.mark.sampled(every=5)
@CASE
def test_energies_balance_and_the_run_is_proven(problem: ss.Problem) -> None:
    run = ss.simulate(problem, 6.0)
    spent = run.energy(np.linspace(0.0, 6.0, 200))
    assert np.abs(spent.balance).max() < 1e-11 * float(np.abs(spent.work).max() + spent.heat.max())
    assert run.proven.load < 1e-11 * 20.0
    assert run.proven.compared > 0


@pytest.mark.sampled(every=15)
@CASE
def test_a_run_in_two_parts_is_that_in_one_bit_for_bit(problem: ss.Problem, tmp_path: Path) -> None:
    whole, half = ss.simulate(problem, 6.0), ss.simulate(problem, 1.93)
    resumed = ss.resume(half.to_netcdf(tmp_path / "half.nc"), 6.0)
    times = np.linspace(0.0, 6.0, 300)
    assert np.array_equal(resumed.slip(times), whole.slip(times))
    assert np.array_equal(resumed.load(times), whole.load(times))


@pytest.mark.parametrize("force", [SWING, POINTS, JUMPS], ids=["swing", "points", "jumps"])
def test_a_force_turned_round_turns_the_motion_round(force: ss.loading.LoadingHistory) -> None:
    one, other = (ss.simulate(ss.Problem(SPRUNG, DRY, force=force.scaled(way), initial_load=0.0), 6.0) for way in (1.0, -1.0))
    times = np.linspace(0.0, 6.0, 100)
    assert other.slip(times) == pytest.approx(-one.slip(times), abs=1e-11)


def test_mass_force_and_normal_load_times_a_power_of_2_leave_the_motion_as_it_is() -> None:
    heavy = ss.Problem(ss.SpringBlock(8.0, 0.0, 80.0), DRY, force=POINTS.scaled(4.0))
    one, other = ss.simulate(ss.Problem(FREE, DRY, force=POINTS), 6.0), ss.simulate(heavy, 6.0)
    times = np.linspace(0.0, 6.0, 100)
    assert np.array_equal(one.slip(times), other.slip(times))


def test_a_force_that_swings_too_often_in_a_run_is_refused() -> None:
    body, law = ss.RotatingBlock(1.0, 0.0, 10.0), ss.friction.Coulomb(0.1, 0.05)
    moves = ss.Problem(body, law, force=ss.loading.Sinusoidal(0.0, 2.0, 1e-9))
    with pytest.raises(ss.InputError, match="the force's period of 1e-09 s is too short for a run of 1 s: at least about 1e-08 s"):
        ss.simulate(moves, 1.0)
    assert ss.simulate(moves, 1e-7).duration == 1e-7
