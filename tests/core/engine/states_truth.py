"""Laws with states of their own, written once more by hand with signed slip rates, and their motion by scipy alone.

A block is integrated as it is; a slab, without mass, one round trip after the other (the method of steps), with slip rates that
brentq finds from the contact equation. Nothing here is shared with the package.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

import stickslip as ss

F = ss.friction
Floats = NDArray[np.float64]
AXIS = ss.SpringBlock(mass=10.0, stiffness=2e5, normal_force=100.0)
LIGHT = ss.SpringBlock(mass=1.0, stiffness=2e3, normal_force=10.0)
FAULT = ss.SpringBlock(mass=1e3, stiffness=1e7, normal_force=1e7)
SLAB = ss.ElasticSlab(density=2800.0, wave_speed=3500.0, thickness=100.0, normal_stress=1e7)


class Truth(NamedTuple):
    """A law and, by hand: mu and the rates of change of its states, from signed slip rate (m/s) and states as formulas use them."""

    law: Any
    mu: Callable[..., float]
    change: Callable[..., tuple[float, ...]]


# ---- laws ----------------------------------------------------------------------------------------------------------------------


def _bristles(v: float, z: float) -> float:
    """dz/dt (m/s) under LUGRE."""
    return v - 1e4 * abs(v) * z / (0.1 + 0.05 * math.exp(-((v / 1e-3) ** 2)))


def _flash(v: float, psi: float) -> tuple[float]:
    """dpsi/dt (1/s) under FLASH."""
    y = max(abs(v), 1e-300) / 1e-6
    x = (0.2 + (0.4 - 0.004 * math.log(y)) / (1.0 + (abs(v) / 0.1) ** 8) ** 0.125) / 0.01
    return (-abs(v) / 0.4 * (psi - 0.01 * (x + math.log1p(-math.exp(-2.0 * x)) - math.log(y))),)


LUGRE = Truth(
    F.LuGre(static=0.15, dynamic=0.1, rate=1e-3, stiffness=1e4, damping=3.0, viscosity=0.04),
    lambda v, z: 1e4 * z + 3.0 * _bristles(v, z) + 0.04 * v,
    lambda v, z: (_bristles(v, z),),
)
TYPED_LUGRE = LUGRE._replace(
    law=F.FromExpression(
        "s*z + d*(v - s*v*z/(low + fall*exp(-(v/r)**2))) + c*v",
        {"s": "1e4 1/m", "d": "3 s/m", "c": "0.04 s/m", "low": 0.1, "fall": 0.05, "r": "1 mm/s"},
        evolution="dz/dt = v - s*v*z/(low + fall*exp(-(v/r)**2))",
        state_unit="m",
        at_reversal="changes-sign",
    )
)
DAHL = Truth(F.Dahl(sliding=0.1, stiffness=1e4), lambda v, z: 1e4 * z, lambda v, z: (v - abs(v) * 1e5 * z,))
FLASH = Truth(
    F.FlashHeating(reference=0.6, a=0.01, b=0.014, distance=0.4, weakened=0.2, weakening_rate=0.1),
    lambda v, psi: 0.01 * math.asinh(v / 2e-6 * math.exp(psi / 0.01)),
    _flash,
)
HEALING = Truth(
    F.FromExpression("0.3 + 0.05*v + z", evolution="dz/dt = (0.2 - z)/0.5 - v*z/2e-3"),
    lambda v, z: math.copysign(0.3 + 0.05 * abs(v) + z, v),
    lambda v, z: ((0.2 - z) / 0.5 - abs(v) * z / 2e-3,),
)
WARM = Truth(
    F.FromExpression(
        "s*(z + v*d*(1 - s*z/(0.1*(1 + w))))/(1 + T)",
        {"s": "1e4 1/m", "d": "1 ms", "w": 0.5, "heat": "30 1/m", "tau": "50 ms"},
        evolution="dz/dt = v - s*v*z/(0.1*(1 + w)); dT/dt = heat*v - T/tau",
        state_unit="m; 1",
        at_reversal="first-changes-sign",
    ),
    lambda v, z, warmth: 1e4 * (z + 1e-3 * (v - abs(v) * 1e4 * z / 0.15)) / (1.0 + warmth),
    lambda v, z, warmth: (v - 1e4 * abs(v) * z / 0.15, 30.0 * abs(v) - warmth / 0.05),
)
"""Bristles that soften as the contact warms up: one state changes its sign at a reversal, the other keeps it."""
RATE = 1e-6
"""Reference slip rate (m/s) of the laws below."""


def _logarithm(evolution: str, v: float, w: float, distance: float) -> float:
    """Rate of change (1/s) of w = ln(RATE theta/distance)."""
    v = abs(v)
    if evolution == "ageing":
        return RATE * math.exp(-w) / distance - v / distance
    if evolution == "prz":
        return RATE * math.exp(-w) / distance - v * v * math.exp(w) / (4.0 * RATE * distance)
    return -v / distance * (w + math.log(max(v, 1e-300) / RATE))


def one_state(law: ss.friction.RateAndState) -> Truth:
    """Rate-and-state friction with a reference slip rate of RATE; its state is the logarithm."""
    return Truth(
        law,
        lambda v, w: law.a * math.asinh(v / (2.0 * RATE) * math.exp((law.reference + law.b * w) / law.a)),
        lambda v, w: (_logarithm(law.evolution, v, w, law.distance),),
    )


def two_states(evolution: str, second_b: float = 0.006) -> Truth:
    """Rate-and-state friction with the logarithms of two states."""
    a, b, near, far = 0.01, 0.01, 1e-3, 2e-2
    return Truth(
        F.TwoStateRateAndState(0.6, a, b, near, second_b, far, RATE, evolution),
        lambda v, w, w2: a * math.asinh(v / (2.0 * RATE) * math.exp((0.6 + b * w + second_b * w2) / a)),
        lambda v, w, w2: (_logarithm(evolution, v, w, near), _logarithm(evolution, v, w2, far)),
    )


# ---- motion --------------------------------------------------------------------------------------------------------------------


def block_truth(
    one: Truth, body: Any, force: Callable[[float], float], start: tuple[float, ...], t: Floats, method: str = "Radau"
) -> Floats:
    """Slip, slip rate and states at times t, from those at t = 0; `force` is that of the spring (N) without slip."""

    def right(now: float, y: Floats) -> list[float]:
        u, v, *states = y.tolist()
        resists = body.normal_force * one.mu(v, *states) + body.damping * v
        return [v, (force(now) - body.stiffness * u - resists) / body.mass, *one.change(v, *states)]

    exact: dict[str, Any] = {"rtol": 1e-11, "atol": 1e-15, "max_step": t[-1] / 500}
    return np.asarray(solve_ivp(right, (0.0, t[-1]), start, method, t, **exact).y)


def slab_truth(one: Truth, problem: Any, t: Floats) -> tuple[Floats, Floats]:
    """Slip and states, shape (states, times), of a slab with a rigid driver and a constant pull, without mass."""
    body, pull, trip = problem.body, problem.pull_rate, problem.body.two_way_time
    ramp = body.stiffness * pull
    past: list[Any] = []

    def load(s: float) -> float:
        if s <= trip or not past:
            return float(problem.load + ramp * s)
        return load(s - trip) - 2.0 * body.impedance * (rate(s - trip) - pull)

    def rate(s: float) -> float:
        return solved(load(s), past[min(int(s / trip), len(past) - 1)](s)[1:])

    def solved(force: float, states: Floats) -> float:
        values = states.tolist()

        def missing(v: float) -> float:
            return body.impedance * v + body.normal_stress * one.mu(v, *values) - force

        far = 1.0
        while missing(far) < 0.0 or missing(-far) > 0.0:
            far *= 10.0
        return float(brentq(missing, -far, far, xtol=1e-18, rtol=1e-14))

    def changes(s: float, y: Floats) -> list[float]:
        v = solved(load(s), y[1:])
        return [v, *one.change(v, *y[1:].tolist())]

    exact: dict[str, Any] = {"rtol": 1e-11, "atol": 1e-15, "first_step": 1e-9, "max_step": 4e-4, "dense_output": True}
    y, n = np.array([0.0, *problem.states]), 0
    while n * trip < t[-1]:
        found = solve_ivp(changes, (n * trip, (n + 1) * trip), y, "DOP853", **exact)
        past.append(found.sol)
        y, n = found.y[:, -1], n + 1
    values = np.array([past[min(int(s / trip), n - 1)](s) for s in t])
    return values[:, 0], values[:, 1:].T


def largest_difference(run: Any, t: Floats, slip: Floats, states: Any) -> float:
    """The largest of the largest relative differences of slip and of each state, as the package shows them."""
    readings = run.state, run.second_state
    pairs = [(run.slip(t), slip), *((read(t), truth) for read, truth in zip(readings, states, strict=False))]
    return max(float(np.abs(ours - truth).max() / np.abs(truth).max()) for ours, truth in pairs)
