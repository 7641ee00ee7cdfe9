"""Cycles without the package: hunting by matrix exponentials or DOP853, and a block on a spring with a play under bristles.

The state of an axis is the lag e behind its reference, the slip rate v and the force q of the integral, in SI. Events are located
by `brentq` or by the events of `solve_ivp`, cycles by `brentq`, and multipliers are differences of returns.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.integrate import solve_ivp
from scipy.linalg import expm
from scipy.optimize import brentq

WIDE = np.array([-2.0, -1.0, 1.0, 2.0])
WEIGHTS = np.array([1.0, -8.0, 8.0, -1.0]) / 12.0
"""A central difference of fourth order."""
MOST_STEPS = 100_000
"""Steps, slips or events after which a motion counts as lost (1)."""


@dataclass(frozen=True)
class Axis:
    """A mass under PID control of its position, with friction that drops from static to dynamic, and a stop ahead."""

    mass: float
    kp: float
    ki: float
    kd: float
    static: float
    """Static friction (N)."""
    dynamic: float
    """Dynamic friction (N)."""
    pull: float = 0.0
    """Rate of the reference (m/s)."""
    stop: float = -math.inf
    """Lag at which a stop bars the way forwards (m)."""
    restitution: float = 0.0

    def slipped(self, state: Any, way: int) -> tuple[Any, float, bool]:
        """Return the state where slip in a direction ends, how long it lasts, and whether the stop ends it."""
        m, pull = self.mass, self.pull
        pushed = (self.kd * pull - way * self.dynamic) / m
        matrix = np.array(
            [[0.0, -1.0, 0.0, pull], [self.kp / m, -self.kd / m, 1.0 / m, pushed], [self.ki, 0.0, 0.0, 0.0], np.zeros(4)]
        )
        length = 0.02 * math.sqrt(m / self.kp)
        step, time, now = expm(length * matrix), 0.0, np.append(state, 1.0)
        for _ in range(MOST_STEPS):
            new = step @ now
            hit, back = new[0] < self.stop, way * new[1] < 0.0 and (time > 0.0 or now[1] != 0.0)
            if hit or back:

                def off(lasts: float, n: int, now: Any = now) -> float:
                    return float((expm(lasts * matrix) @ now)[n]) - (self.stop if n == 0 else 0.0)

                ends = [brentq(off, 0.0, length, (n,), xtol=1e-16, rtol=1e-15) for n, true in ((0, hit), (1, back)) if true]
                lasts = min(ends)
                return (expm(lasts * matrix) @ now)[:3], time + lasts, bool(hit and lasts == ends[0])
            now, time = new, time + length
        raise AssertionError("the slip does not end")

    def next_onset(self, lag: float) -> tuple[float, float]:
        """Return the lag at the next onset of forward slip after one at a lag, and the time between them."""
        state, way, time = np.array([lag, 0.0, self.static - self.kp * lag - self.kd * self.pull]), 1, 0.0
        for _ in range(MOST_STEPS):
            state, lasts, hit = self.slipped(state, way)
            time += lasts
            if hit and self.restitution * abs(state[1]) > 1e-9:
                state, way = np.array([self.stop, -self.restitution * state[1], state[2]]), -way
                continue
            load = self.kp * state[0] + self.kd * self.pull + state[2]
            assert hit or abs(load) < self.static
            lasts, way = self.rested(self.stop if hit else state[0], load)
            e = (self.stop if hit else state[0]) + self.pull * lasts
            state, time = np.array([e, 0.0, way * self.static - self.kp * e - self.kd * self.pull]), time + lasts
            if way > 0:
                return float(e), time
        raise AssertionError("forward slip does not begin")

    def rested(self, lag: float, load: float) -> tuple[float, int]:
        """Return how long a rest lasts from a lag and a load on, until slip begins, and in what direction it does."""
        grows = self.kp * self.pull + self.ki * lag
        found = []
        for way in (1, -1):
            roots = np.roots([0.5 * self.ki * self.pull, grows, load - way * self.static])
            found += [(float(one.real), way) for one in roots if one.imag == 0.0 and one.real > 0.0]
        return min(found)

    def returned(self, lag: float, onsets: int) -> tuple[float, float]:
        """Return the lag after some onsets of forward slip, and the time to it."""
        time = 0.0
        for _ in range(onsets):
            lag, lasts = self.next_onset(lag)
            time += lasts
        return lag, time

    def cycle(self, low: float, high: float, onsets: int = 1) -> tuple[float, float, float]:
        """Return lag at onset, period and multiplier of the cycle between two lags."""
        lag = brentq(lambda one: self.returned(one, onsets)[0] - one, low, high, xtol=1e-15, rtol=1e-13)
        step = 1e-4 * lag
        ends = [self.returned(lag + n * step, onsets)[0] for n in WIDE]
        return lag, self.returned(lag, onsets)[1], float(WEIGHTS @ ends) / step


@dataclass(frozen=True)
class CurvedAxis(Axis):
    """The same under friction that falls from static to dynamic as exp(-(v / rate)^power), by DOP853."""

    rate: float = 1.0
    power: int = 1

    def slipped(self, state: Any, way: int) -> tuple[Any, float, bool]:
        """Return the state where slip in a direction ends, how long it lasts, and whether the stop ends it."""

        def pace(_: float, y: Any) -> list[float]:
            friction = self.dynamic + (self.static - self.dynamic) * math.exp(-((way * y[1] / self.rate) ** self.power))
            force = self.kp * y[0] + self.kd * (self.pull - y[1]) + y[2] - way * friction
            return [self.pull - y[1], force / self.mass, self.ki * y[0]]

        begun = 1e-4 * math.sqrt(self.mass / self.kp)  # there is no event where it begins
        first = solve_ivp(pace, (0.0, begun), state, "DOP853", rtol=1e-13, atol=1e-16)
        turn, hit = _event(lambda _, y: way * y[1], -1.0), _event(lambda _, y: y[0] - self.stop, -1.0)
        events = [turn, hit] if math.isfinite(self.stop) and way > 0 else [turn]
        run = solve_ivp(pace, (begun, 1e3), first.y[:, -1], "DOP853", events=events, rtol=1e-13, atol=1e-16)
        return run.y[:, -1], float(run.t[-1]), len(events) > 1 and len(run.t_events[1]) > 0


def _event(function: Callable[[float, Any], float], direction: float) -> Any:
    def event(time: float, y: Any) -> float:
        return function(time, y)

    event.terminal, event.direction = True, direction  # type: ignore[attr-defined]
    return event


@dataclass(frozen=True)
class BlockWithPlay:
    """A block under LuGre's bristles that is pulled by a spring beside a play; the state is lag, slip rate and bristles."""

    mass: float
    stiffness: float
    normal: float
    pull: float
    half: float
    """Half the play (m)."""
    static: float
    dynamic: float
    rate: float
    bristles: float
    bristle_damping: float
    viscosity: float

    def pace(self, _: float, y: Any) -> list[float]:
        """Return the derivatives in time."""
        e, v, z = y
        bends = v - self.bristles * abs(v) * z / (self.dynamic + (self.static - self.dynamic) * math.exp(-((v / self.rate) ** 2)))
        friction = self.normal * (self.bristles * z + self.bristle_damping * bends + self.viscosity * v)
        spring = self.stiffness * (e - math.copysign(min(abs(e), self.half), e))
        return [self.pull - v, (spring - friction) / self.mass, bends]

    def returned(self, load: float, bend: float, guess: float) -> tuple[float, float, float]:
        """Return load and bristles where the slip rate next passes the pull rate upwards after 0.7 of a guess, and the time."""
        state, time = np.array([load / self.stiffness + self.half, self.pull, bend]), 0.0
        kinks = [_event(lambda _, y: y[1], 0.0), *(_event(lambda _, y, b=b: y[0] - b, 0.0) for b in (self.half, -self.half))]  # type: ignore[misc]
        for one in kinks:
            one.terminal = True
        passed = _event(lambda time, y: y[1] - self.pull if time > 0.7 * guess else -1.0, 1.0)
        for _ in range(MOST_STEPS):
            run = solve_ivp(self.pace, (time, 2.0 * guess), state, "DOP853", events=[passed, *kinks], rtol=1e-11, atol=1e-13)
            state, time = run.y[:, -1], float(run.t[-1])
            if len(run.t_events[0]):
                return self.stiffness * (state[0] - self.half), float(state[2]), time
            past = solve_ivp(self.pace, (time, time + 1e-9), state, "DOP853", rtol=1e-11, atol=1e-15)
            state, time = past.y[:, -1], time + 1e-9  # so that the event is not met again
        raise AssertionError("the slip rate does not pass the pull rate again")
