"""An axis in a position loop follows independent integrators, keeps its energy, and is a block on a spring without an integral."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.linalg import expm
from scipy.optimize import brentq

import stickslip as ss
from stickslip.foundation.arrays import Floats

GAINS: dict[str, float] = {
    "mass": 1.0,
    "proportional_gain": 100.0,
    "normal_force": 10.0,
    "integral_gain": 50.0,
    "derivative_gain": 10.0,
    "damping": 0.5,
}
STEP = 0.1
TIGHT, RTOL = 1e-12, 1e-10


@dataclass
class Axis:
    """Own integrator of an axis under Coulomb friction, with its reference at a steady rate: exponentials between events.

    The motion is (lag, slip rate, integral, 1).
    """

    gains: dict[str, float]
    static: float
    kinetic: float
    rate: float
    grid: float = 1e-3

    def sliding(self, way: float) -> Floats:
        m, kp, ki, kd, c = (
            self.gains[name] for name in ("mass", "proportional_gain", "integral_gain", "derivative_gain", "damping")
        )
        push = (kd * self.rate - way * self.kinetic) / m
        return np.array([[0, -1, 0, self.rate], [kp / m, -(kd + c) / m, 1 / m, push], [ki, 0, 0, 0], [0, 0, 0, 0]])

    def resting(self, since: float, motion: Floats) -> Floats:
        lag = motion[0] + self.rate * since
        gained = self.gains["integral_gain"] * (motion[0] + 0.5 * self.rate * since) * since
        return np.array([lag, 0.0, motion[2] + gained, 1.0])

    def force(self, motion: Floats) -> float:
        kp, kd = self.gains["proportional_gain"], self.gains["derivative_gain"]
        return float(kp * motion[0] + motion[2] + kd * self.rate)

    def events(self, motion: Floats, duration: float) -> list[tuple[float, Floats]]:
        """Return the times (s) when slip begins or ends, and the motion then."""
        time, way, found = 0.0, 0.0, []
        if abs(self.force(motion)) > self.static:
            way = float(np.sign(self.force(motion)))
        while time < duration:
            if way == 0.0:
                since = 0.0
                while abs(self.force(self.resting(since + self.grid, motion))) <= self.static and time + since < duration:
                    since += self.grid
                if time + since >= duration:
                    break
                way = float(np.sign(self.force(self.resting(since + self.grid, motion))))
                since = brentq(self.beyond, since, since + self.grid, (motion, way), xtol=1e-15, rtol=1e-15)
                motion, time = self.resting(since, motion), time + since
                found.append((time, motion))
            flow, first = self.sliding(way), 1e-4 * self.grid
            motion, time, step = expm(flow * first) @ motion, time + first, expm(flow * self.grid)
            while way * (step @ motion)[1] > 0.0 and time < duration:
                motion, time = step @ motion, time + self.grid
            if time >= duration:
                break
            since = brentq(rate_after, 0.0, self.grid, (flow, motion), xtol=1e-15, rtol=1e-15)
            motion, time = expm(flow * since) @ motion, time + since
            motion[1] = 0.0
            found.append((time, motion))
            way = float(np.sign(self.force(motion))) if abs(self.force(motion)) > self.static else 0.0
        return found

    def beyond(self, since: float, motion: Floats, way: float) -> float:
        return way * self.force(self.resting(since, motion)) - self.static


def rate_after(since: float, flow: Floats, motion: Floats) -> float:
    return float((expm(flow * since) @ motion)[1])


def problem(static: float = 0.4, kinetic: float = 0.3, **changed: Any) -> ss.Problem:
    given = {"pull_rate": 0.0, "initial_load": 0.0} | {name: changed.pop(name) for name in list(changed) if name in PROBLEM}
    body = ss.PositionLoop(**{**GAINS, "reference_step": STEP, **changed})
    return ss.Problem(body, ss.friction.Coulomb(static, kinetic), **given)


PROBLEM = ("pull_rate", "initial_load", "initial_rate", "normal_load")


@pytest.mark.parametrize("rate", [0.0, 2e-3])
def test_hunting_meets_exponentials_between_roots_of_rest(rate: float) -> None:
    solution = ss.simulate(problem(pull_rate=rate), 200.0, rtol=TIGHT)
    first = np.array([STEP, 0.0, -GAINS["derivative_gain"] * rate, 1.0])  # the load of the start is all that is felt
    expected = Axis(GAINS, 4.0, 3.0, rate).events(first, 200.0)
    times = np.array([time for time, _ in expected])
    begun = solution.events.start.to_numpy()
    ended = begun + solution.events.duration.to_numpy()
    found = np.sort(np.concatenate([begun, ended]))[1:][: len(times)]
    assert len(times) > 12
    assert found[: len(times)] == pytest.approx(times[: len(found)], rel=1e-10)
    lags = np.array([motion[0] for _, motion in expected])
    slips = STEP + rate * times - solution.slip(times)
    assert slips == pytest.approx(lags, abs=1e-11)


def test_hunting_goes_on_where_static_friction_exceeds_kinetic_friction_and_fades_where_it_does_not() -> None:
    hunts = ss.simulate(problem(), 3000.0).events.slip.abs().to_numpy()
    assert hunts[-20:] == pytest.approx(np.full(20, hunts[-1]), rel=0.05)
    fades = ss.simulate(problem(0.3, 0.3), 3000.0).events
    assert len(fades) < 15
    assert abs(fades.slip.to_numpy()[-1]) < 0.05 * hunts[-1]


def test_a_loop_without_friction_is_three_exponentials() -> None:
    body = {name: value for name, value in GAINS.items() if name != "damping"}
    given = ss.Problem(ss.PositionLoop(**body, reference_step=STEP), ss.friction.Coulomb(0.0, 0.0), 0.01, initial_load=0.0)
    solution = ss.simulate(given, 4.0, rtol=1e-13)
    t = np.linspace(0.1, 4.0, 9)
    flow = Axis(body | {"damping": 0.0}, 0.0, 0.0, 0.01).sliding(1.0)
    exact = np.array([expm(flow * time) @ np.array([STEP, 0.0, -GAINS["derivative_gain"] * 0.01, 1.0]) for time in t])
    assert STEP + 0.01 * t - solution.slip(t) == pytest.approx(exact[:, 0], abs=1e-13)
    assert solution.slip_rate(t) == pytest.approx(exact[:, 1], abs=1e-12)


@pytest.mark.parametrize("pull", [ss.loading.Sinusoidal(0.001, 0.05, 2.0, 0.4), ss.loading.Waypoints([0.0, 1.0, 2.5, 4.0], [0.0, 0.03, 0.03, -0.02])])
def test_bristles_under_a_moving_reference_meet_an_integrator_of_other_people(pull: Any) -> None:
    law = ss.friction.LuGre(0.3, 0.4, 1e-3, 1e5, 30.0) if False else lugre()
    body = ss.PositionLoop(**{**GAINS, "integral_gain": 150.0})
    given = ss.Problem(body, law, pull, initial_load=0.0, initial_rate=0.0, initial_state=0.0)
    solution = ss.simulate(given, 5.0, rtol=1e-9)
    t = np.linspace(0.5, 5.0, 10)
    reference = [float(np.trapezoid(pull.at(s := np.linspace(0.0, time, 400_001)), s)) for time in t]
    expected = integrated(body, law, pull, t)
    assert solution.slip(t) == pytest.approx(expected, abs=2e-8)
    assert np.ptp(reference) > 1e-2  # the reference moves
