"""A block driven by a spring and a dashpot side by side: closed forms of its sliding, and an own integrator of stick and slip."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
from scipy.integrate import solve_ivp

import stickslip as ss
from stickslip.problem.loading import LoadingHistory, Sinusoidal

MASS, STIFFNESS, FORCE, GROUND, DASHPOT = 2.0, 50.0, 10.0, 0.3, 4.0
"""kg, N/m, N, N s/m, N s/m."""
STATIC, DYNAMIC = 0.6, 0.5
BLOCK = ss.SpringBlock(MASS, STIFFNESS, FORCE, damping=GROUND, driver_damping=DASHPOT)
LAW = ss.friction.Coulomb(static=STATIC, dynamic=DYNAMIC)


def free(u: float, v: float, since: float) -> tuple[float, float]:
    """Return slip and rate of m u'' + (damping + driver_damping) u' + K u = 0 after a time (s) from their values."""
    half = 0.5 * (GROUND + DASHPOT) / MASS
    swing = math.sqrt(STIFFNESS / MASS - half * half)
    fades, cos, sin = math.exp(-half * since), math.cos(swing * since), math.sin(swing * since)
    other = (v + half * u) / swing
    return fades * (u * cos + other * sin), fades * (v * cos - (half * other + swing * u) * sin)


def driven(pull: LoadingHistory, pushed: float) -> list[tuple[float, Callable[[float], tuple[float, float]]]]:
    """Return from when on (s) which slip and rate solve the equation without the free swings, under a constant force (N).

    On a straight part V = a + b t they are a parabola; under a sine they are of a phasor. `pushed` is the initial load less dynamic
    friction and less c V(0).
    """
    total = GROUND + DASHPOT
    if isinstance(pull, Sinusoidal):
        frequency = 2.0 * math.pi / pull.period
        sine = pull.amplitude * np.exp(1j * pull.phase)  # V = mean + Im(sine exp(i w t))
        moved = sine / (1j * frequency)
        answer = (STIFFNESS * moved + DASHPOT * sine) / (STIFFNESS - MASS * frequency**2 + 1j * frequency * total)
        begun = (moved).imag  # the integral of the sine begins at 0

        def sinusoidal(t: float) -> tuple[float, float]:
            phasor = answer * np.exp(1j * frequency * t)
            steady = (pushed + DASHPOT * pull.mean - STIFFNESS * begun - total * pull.mean) / STIFFNESS + pull.mean * t
            return steady + phasor.imag, pull.mean + (1j * frequency * phasor).imag

        return [(0.0, sinusoidal)]
    found: list[tuple[float, Callable[[float], tuple[float, float]]]] = []
    way = 0.0
    for n, (start, a, b) in enumerate(pull.segments):

        def straight(t: float, start: float = start, a: float = a, b: float = b, way: float = way) -> tuple[float, float]:
            curve, since = 0.5 * b, t - start
            line = a - GROUND * b / STIFFNESS
            level = (pushed + STIFFNESS * way + DASHPOT * a - MASS * b - total * line) / STIFFNESS
            return level + since * (line + curve * since), line + 2.0 * curve * since

        found.append((start, straight))
        lasting = pull.segments[n + 1].start - start if n + 1 < len(pull.segments) else 0.0
        way += lasting * (a + 0.5 * b * lasting)
    return found


def in_slip(pull: LoadingHistory, load: float, times: np.ndarray) -> np.ndarray:
    """Return slip and rate (rows) at times (s) of a block that slides from 0 s on, by closed forms joined at the breaks."""
    parts = driven(pull, load - DYNAMIC * FORCE - DASHPOT * pull.first)
    u, v, found = 0.0, 0.0, np.full((2, len(times)), math.nan)
    for n, (start, forced) in enumerate(parts):
        end = parts[n + 1][0] if n + 1 < len(parts) else math.inf
        away = np.subtract((u, v), forced(start))
        for k in np.flatnonzero((times >= start) & (times < end)):
            found[:, k] = np.add(free(*away, times[k] - start), forced(times[k]))
        if end < math.inf:
            u, v = np.add(free(*away, end - start), forced(end)).tolist()
    return found


def integrated(
    problem: ss.Problem, end: float, pushing: Callable[[float], float] = lambda t: 0.0
) -> tuple[np.ndarray, list[float]]:
    """Return slip, rate, pulled way, work, damped energy and heat at the end, and the starts of events, by DOP853 (rtol 1e-12).

    Slip is forwards only. `pushing` is the acceleration of the ground (m/s^2).
    """
    body: Any = problem.body
    k, c, d, m = body.stiffness, body.driver_damping, body.damping, body.inertia
    strength, dynamic = STATIC * problem.normal, DYNAMIC * problem.normal
    held = problem.load - c * problem.first_pull_rate
    pull = problem.pull_rate
    breaks = [one.start for one in pull.segments if 0.0 < one.start < end] if isinstance(pull, LoadingHistory) else []
    time, y, slips, starts = 0.0, np.zeros(6), False, list[float]()
    for stop in [*breaks, end]:
        inside = 0.5 * (time + stop)

        def pulled(t: float, inside: float = inside) -> float:
            if not isinstance(pull, LoadingHistory):
                return pull
            n = int(np.searchsorted([one.start for one in pull.segments], inside, side="right")) - 1
            amplitude, frequency, phase = pull.tone
            return pull.segments[n].at(t) + amplitude * math.sin(frequency * t + phase)

        def right(t: float, y: np.ndarray, slips: bool) -> list[float]:
            u, v, way, *_ = y
            rate = pulled(t)
            stretched = held + k * (way - u)
            force = stretched + c * (rate - v)
            grows = (force - d * v - dynamic) / m - pushing(t) if slips else 0.0
            work = force * rate - m * pushing(t) * v
            return [v, grows, rate, work, d * v * v + c * (rate - v) ** 2, dynamic * v]

        def exceeds(t: float, y: np.ndarray, slips: bool) -> float:
            return held + k * (y[2] - y[0]) + c * pulled(t) - m * pushing(t) - strength

        def arrests(t: float, y: np.ndarray, slips: bool) -> float:
            return y[1] if t > starts[-1] + 1e-9 else 1.0

        exceeds.terminal, exceeds.direction = True, 1.0  # type: ignore[attr-defined]
        arrests.terminal, arrests.direction = True, -1.0  # type: ignore[attr-defined]
        while time < stop:
            if not slips and exceeds(time, y, slips) > 0.0:
                slips = True
                starts.append(time)
            event = arrests if slips else exceeds
            found = solve_ivp(
                right, (time, stop), y, method="DOP853", rtol=1e-12, atol=1e-14, events=event, args=(slips,), max_step=0.05
            )
            time, y = found.t[-1], found.y[:, -1]
            if found.status == 1:
                slips = not slips
                y[1] = 0.0
                if slips:
                    starts.append(time)
    return y, starts
