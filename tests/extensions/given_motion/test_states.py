"""Friction along a given motion agrees with closed forms, and with scipy's integrators on the formulas themselves."""

from __future__ import annotations

import math
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import stickslip as ss

RTOL = 1e-10
RATE_AND_STATE = {"reference": 0.6, "a": 0.01, "b": 0.015, "distance": 1e-5}
STEP = ss.loading.Steps([0.0, 20.0], [1e-6, 1e-5])
LUGRE = {"static": 0.15, "dynamic": 0.1, "rate": 1e-3, "stiffness": 1e4, "damping": 3.0, "viscosity": 0.04}


def test_after_a_step_of_the_slip_rate_the_ageing_law_settles_as_its_closed_form_says() -> None:
    run = ss.simulate(ss.MovedContact(ss.friction.RateAndState(**RATE_AND_STATE), STEP, "5 MPa"), 60.0)
    t = np.linspace(20.0, 60.0, 401)
    theta = 1.0 + (10.0 - 1.0) * np.exp(-(t - 20.0))  # v / distance is 1 / s
    np.testing.assert_allclose(run.state(t), theta, rtol=1e-10, atol=0.0)
    traction = 5e6 * 0.01 * np.arcsinh(5.0 * np.exp((0.6 + 0.015 * np.log(0.1 * theta)) / 0.01))
    np.testing.assert_allclose(run.traction(t), traction, rtol=1e-11, atol=0.0)
    assert np.all(abs(run.traction(t) - traction) <= run.error(t))


def test_after_a_step_of_the_slip_rate_the_slip_law_settles_as_its_closed_form_says() -> None:
    law = ss.friction.RateAndState(**RATE_AND_STATE, evolution="slip")
    run = ss.simulate(ss.MovedContact(law, STEP, "5 MPa"), 60.0)
    t = np.linspace(20.0, 60.0, 401)
    theta = np.exp(math.log(10.0) * np.exp(-(t - 20.0)))
    np.testing.assert_allclose(run.state(t), theta, rtol=1e-10, atol=0.0)


def test_in_a_hold_the_ageing_law_heals_by_one_second_each_second() -> None:
    hold = ss.loading.HoldAndSlide("1 um/s", "100 s", ["1000 s", "1e6 s"])
    run = ss.simulate(ss.MovedContact(ss.friction.RateAndState(**RATE_AND_STATE), hold, "5 MPa"), "1.0013e6 s")
    since = np.array([0.0, 1e-3, 1.0, 500.0, 1000.0 - 1e-9])
    np.testing.assert_allclose(run.state(100.0 + since), 10.0 + since, rtol=1e-10, atol=0.0)
    again = 10.0 + 1000.0 * math.exp(-10.0)  # theta after 100 s of slip at 1 um/s
    np.testing.assert_allclose(run.state(1200.0 + 5e5), again + 5e5, rtol=1e-10, atol=0.0)
    assert float(run.traction(500.0)) == 0.0  # this law never sticks: friction at v = 0 is 0


def test_lugre_at_a_constant_slip_rate_relaxes_exponentially() -> None:
    law = ss.friction.LuGre(**LUGRE)
    run = ss.simulate(ss.MovedContact(law, 2e-3, "100 N", initial_state=0.0), 0.1)
    t = np.linspace(0.0, 0.1, 301)
    steady = 0.1 + 0.05 * math.exp(-4.0)
    bending = steady / 1e4 * -np.expm1(-1e4 * 2e-3 / steady * t)
    np.testing.assert_allclose(run.state(t), bending, rtol=0.0, atol=1e-10 * steady / 1e4)
    friction = 1e4 * bending + 3.0 * 2e-3 * (1.0 - 1e4 * bending / steady) + 0.04 * 2e-3
    np.testing.assert_allclose(run.traction(t), 100.0 * friction, rtol=0.0, atol=1e-9)


@pytest.mark.slow
def test_bristles_follow_many_reversals_as_scipy_does() -> None:
    law = ss.friction.LuGre(**LUGRE)
    run = ss.simulate(ss.MovedContact(law, ss.loading.Sinusoidal(2e-4, 1e-3, 0.5, 0.3), 100.0, initial_state=0.0), 2.0)

    def speed(t: Any) -> Any:
        return 2e-4 + 1e-3 * np.sin(4.0 * np.pi * t + 0.3)

    def bend(t: float, z: Any) -> Any:
        v = speed(t)
        return v - 1e4 * abs(v) * z / (0.1 + 0.05 * np.exp(-((v / 1e-3) ** 2)))

    t = np.linspace(0.0, 2.0, 501)
    z = solve_ivp(bend, (0.0, 2.0), [0.0], "Radau", t, rtol=1e-10, atol=1e-16, max_step=2e-3).y[0]
    np.testing.assert_allclose(run.state(t), z, rtol=0.0, atol=2e-9 * 1.5e-5)
    force = 100.0 * (1e4 * z + 3.0 * bend(t, z) + 0.04 * speed(t))
    np.testing.assert_allclose(run.traction(t), force, rtol=0.0, atol=1e-6)


LAWS = {
    "ageing": ss.friction.RateAndState(**RATE_AND_STATE),
    "slip": ss.friction.RateAndState(**RATE_AND_STATE, evolution="slip"),
    "prz": ss.friction.RateAndState(**RATE_AND_STATE, evolution="prz"),
    "coupled": ss.friction.RateAndState(**RATE_AND_STATE, normal_stress_coupling=0.2),
    "two states": ss.friction.TwoStateRateAndState(
        reference=0.6, a=0.01, b=0.01, distance=1e-5, second_b=0.006, second_distance=2e-4
    ),
    "flash": ss.friction.FlashHeating(reference=0.6, a=0.01, b=0.014, distance=1e-4, weakened=0.2, weakening_rate=1e-4),
    "typed": ss.friction.FromExpression(
        "mu_0 + a*log(1 + v/v_0) + z*exp(-u/c)",
        {"mu_0": 0.6, "a": 0.01, "v_0": 1e-6, "b": 0.02, "tau": 5.0, "d": 1e-5, "c": 1e-3},
        evolution="dz/dt = (b - z)/tau - v*z/d",
        counts="path",
    ),
}


@pytest.mark.sampled(every=3)
@pytest.mark.parametrize("name", LAWS)
def test_states_along_random_motion_agree_with_scipy_at_a_tolerance_of_1e_12(name: str) -> None:
    """Slip rate and normal load of straight lines with jumps and turns between random points; the formulas are the law's own."""
    law = LAWS[name]
    draw = np.random.default_rng(71 + len(name))
    times = np.append(0.0, np.sort(draw.uniform(0.5, 9.5, 5)))
    rates = draw.choice([-1.0, 1.0], 6) * 10.0 ** draw.uniform(-6.5, -4.5, 6)
    loads = draw.uniform(0.5, 2.0, 6)
    start = {"initial_state": 0.6 if name == "flash" else 0.01 if name == "typed" else 3.0}
    if len(law.states) > 1:
        start["initial_second_state"] = 8.0
    contact = ss.MovedContact(law, ss.loading.PiecewiseLinear(times, rates), ss.loading.PiecewiseLinear(times, loads), **start)
    run = ss.simulate(contact, 10.0)
    traction, path = _by_scipy(law, times, rates, loads, contact.given_states)
    t = traction[0]
    np.testing.assert_allclose(run.slip(t), path, rtol=1e-12, atol=1e-18)
    np.testing.assert_allclose(run.traction(t), traction[1], rtol=0.0, atol=2e-9)
    assert float(run.error(t).max()) < 1e-7


def _by_scipy(law: Any, times: Any, rates: Any, loads: Any, start: Any) -> Any:
    """Integrate slip, path and states between the points with scipy; return times with tractions, and slip."""
    rows: list[Any] = []
    state = np.array([0.0, 0.0, *law.inner_states(start)])
    evolve = law.state_rate if isinstance(law.state_rate, tuple) else (law.state_rate,)
    numbers = type("Numbers", (), law.numbers())
    edges = np.append(times, 10.0)
    for begin, end in pairwise(edges):
        zero = [] if begin == times[-1] else _zero(times, rates, begin, end)
        for low, high in pairwise([begin, *zero, end]):
            middle = 0.5 * (low + high)
            way = np.sign(np.interp(middle, times, rates))
            growth = (np.interp(high, times, loads) - np.interp(low, times, loads)) / (high - low)

            def change(t: float, y: Any, way: float = way, growth: float = growth) -> Any:
                v = max(0.0, way * np.interp(t, times, rates))
                u = y[1] if law.counts == "path" else y[0]
                own = [one(numbers, u, v, *y[2:]) for one in evolve]
                own[0] -= law.normal_coupling * growth / np.interp(t, times, loads)
                return np.array([way * v, v, *own], float)

            t = np.linspace(low, high, 12)[1:-1]
            found = solve_ivp(change, (low, high), state, "DOP853", np.append(t, high), rtol=1e-12, atol=1e-16)
            state = found.y[:, -1]
            for time, y in zip(t, found.y.T, strict=False):
                u, w = (y[1] if law.counts == "path" else y[0]), (y[2:] if len(y) > 3 else y[2])
                mu = law.coefficient(float(u), abs(float(np.interp(time, times, rates))), w)
                rows.append((time, way * np.interp(time, times, loads) * float(mu), y[0]))
    t, traction, slip = np.array(rows).T
    return (t, traction), slip


def _zero(times: Any, rates: Any, begin: float, end: float) -> list[float]:
    first, last = np.interp([begin, end], times, rates)
    return [begin + (end - begin) * first / (first - last)] if first * last < 0.0 else []


def test_each_tolerance_is_kept_and_a_looser_one_takes_fewer_steps() -> None:
    law = ss.friction.RateAndState(**RATE_AND_STATE)
    steps, t = [], np.linspace(20.0, 60.0, 201)
    for rtol in (1e-5, 1e-8, 1e-12):
        run = ss.simulate(ss.MovedContact(law, STEP, 1.0), 60.0, rtol=rtol)
        off = abs(np.log(run.state(t) / (1.0 + 9.0 * np.exp(20.0 - t)))).max()
        assert off < 10.0 * rtol
        steps.append(len(run.steps.length))
    assert steps == sorted(steps)
    assert steps[0] < steps[-1]
