"""Laws and normal loads drawn at random, against an integrator that shares no code with the engine: DOP853 between all breaks.

The contact equation is Z v + M dv/dt + S(t) mu(u, |v|, z) = load. The load of a block is that of its spring, and that of a slab is
the echo of one round trip before: load(t) = load(t - R) + 2 Z (V - v(t - R)).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

import stickslip as ss
from stickslip.problem.loading import LoadingHistory, PiecewiseLinear, Sinusoidal, Steps

NORMAL, PULL, STIFFNESS = 10.0, 0.5, 60.0
DURATION = 2.7
BODIES = {
    "block": ss.SpringBlock(mass=1.0, stiffness=STIFFNESS, normal_force=NORMAL, damping=0.2),
    "slab": ss.ElasticSlab(density=1.0, wave_speed=1.0, thickness=0.5, normal_stress=NORMAL),
    "slab with mass": ss.ElasticSlab(density=1.0, wave_speed=1.0, thickness=0.5, normal_stress=NORMAL, contact_mass=0.3),
}
ROUND_TRIP = 1.0
MASS = {"block": 1.0, "slab": 0.0, "slab with mass": 0.3}
DAMPING = {"block": 0.2, "slab": 1.0, "slab with mass": 1.0}
SLACK = 1e-11
"""A contact without mass rests if its load is below its strength by more than this (Pa): an onset is known to rounding only."""
Friction = Callable[[float, float, float], float]


@dataclass(frozen=True)
class Drawn:
    """A law: what the engine is given, and mu(u, |v|, z) and dz/dt(|v|, z, S'/S) as plain functions."""

    law: ss.friction.FrictionLaw
    mu: Friction
    change: Callable[[float, float, float], float] = lambda rate, z, grows: 0.0
    start: dict[str, float] = field(default_factory=dict)
    z: float = 0.0
    jump: float = 0.0
    """Change of z per growth of ln S at a step."""


def typed(expression: str, parameters: dict[str, float], mu: Friction, units: dict[str, str], **more: Any) -> Drawn:
    """Return a law in a user's words, beside the same as a function."""
    texts = {name: f"{value!r} {units[name]}" if name in units else value for name, value in parameters.items()}
    state = {key: more.pop(key) for key in ("change", "start", "z") if key in more}
    return Drawn(ss.friction.FromExpression(expression, texts, **more), mu, **state)


def of_slip(rng: np.random.Generator, body: str) -> Drawn:
    """Friction that falls with slip."""
    m, d, length = rng.uniform(0.3, 0.5), rng.uniform(0.1, 0.3), rng.uniform(0.1, 0.4)
    return typed("m + d*exp(-u/l)", {"m": m, "d": d, "l": length}, lambda u, v, z: m + d * math.exp(-u / length), {"l": "m"})


def of_rate(rng: np.random.Generator, body: str) -> Drawn:
    """Friction that falls with the slip rate where there is a mass, and grows with it where there is none."""
    m, d, rate = rng.uniform(0.4, 0.5), rng.uniform(0.05, 0.2), rng.uniform(0.1, 0.5)
    sign = 1.0 if body == "slab" else -1.0
    expression = f"m {'+' if sign > 0 else '-'} d*v/(v + r)"
    return typed(expression, {"m": m, "d": d, "r": rate}, lambda u, v, z: m + sign * d * v / (v + rate), {"r": "m/s"})


def of_both(rng: np.random.Generator, body: str) -> Drawn:
    """Friction of slip and slip rate."""
    m, d, length = rng.uniform(0.3, 0.5), rng.uniform(0.1, 0.2), rng.uniform(0.1, 0.4)
    a, rate = rng.uniform(0.01, 0.05), rng.uniform(0.1, 0.5)

    def mu(u: float, v: float, z: float) -> float:
        return m + d * math.exp(-u / length) + a * math.log1p(v / rate)

    numbers = {"m": m, "d": d, "l": length, "a": a, "r": rate}
    return typed("m + d*exp(-u/l) + a*log(1 + v/r)", numbers, mu, {"l": "m", "r": "m/s"})


def of_state(rng: np.random.Generator, body: str) -> Drawn:
    """Friction of a contact that ages towards z = q within a time, also at rest, and that slip renews."""
    m, q, time, length = rng.uniform(0.3, 0.4), rng.uniform(0.1, 0.2), rng.uniform(0.2, 1.0), rng.uniform(0.05, 0.2)
    a, rate = rng.uniform(0.01, 0.05), rng.uniform(0.1, 0.5)
    numbers, z = {"m": m, "q": q, "a": a, "r": rate, "T": time, "l": length}, rng.uniform(0.0, 0.15)
    return typed(
        "m + a*log(1 + v/r) + z",
        numbers,
        lambda u, v, z: m + a * math.log1p(v / rate) + z,
        {"r": "m/s", "T": "s", "l": "m"},
        evolution="dz/dt = (q - z)/T - z*v/l",
        change=lambda v, z, grows: (q - z) / time - z * v / length,
        start={"initial_state": z},
        z=z,
    )


def of_rate_and_state(rng: np.random.Generator, body: str) -> Drawn:
    """Rate-and-state friction that follows the normal load, by one of its three evolution laws; z is ln(rate theta / distance)."""
    reference, a, b, rate = 0.6, rng.uniform(0.01, 0.02), rng.uniform(0.01, 0.02), 0.1
    distance, coupling = rng.uniform(0.02, 0.1), rng.uniform(0.0, 0.4)
    evolution = ("ageing", "slip", "prz")[int(rng.integers(3))]
    law = ss.friction.RateAndState(reference, a, b, distance, rate, evolution, coupling)
    z = float(rng.uniform(-1.0, 1.0))

    def change(v: float, z: float, grows: float) -> float:
        y = v / rate * math.exp(z)
        aged = {"ageing": 1.0 - y, "slip": -y * math.log(y) if y > 0.0 else 0.0, "prz": 1.0 - 0.25 * y * y}[evolution]
        return aged * math.exp(-z) * rate / distance - coupling / b * grows

    def mu(u: float, v: float, z: float) -> float:
        return a * math.asinh(0.5 * v / rate * math.exp((reference + b * z) / a))

    return Drawn(law, mu, change, {"initial_state": distance / rate * math.exp(z)}, z, -coupling / b)


LAWS = {"slip": of_slip, "rate": of_rate, "both": of_both, "state": of_state, "rate-and-state": of_rate_and_state}


def history(rng: np.random.Generator, kind: str, most: float) -> LoadingHistory:
    """Return steps, ramps or a sinusoid within a share `most` of the normal load of the bodies."""
    if kind == "sinusoid":
        return Sinusoidal(NORMAL, float(rng.uniform(0.25 * most, most)) * NORMAL, float(rng.uniform(0.3, 3.0)))
    times = [0.0, *np.sort(rng.uniform(0.1, DURATION, 4)).tolist()]
    values = [NORMAL, *(NORMAL * rng.uniform(1.0 - most, 1.0 + most, 4)).tolist()]
    return Steps(times, values) if kind == "steps" else PiecewiseLinear(times, values)


Motion = Callable[[float], tuple[float, float]]


@dataclass
class Side:
    """Where a piece of motion lies: the direction of slip (0 at rest), the straight part of the history, and a time inside it.

    That time tells on which side of its breaks an echo is looked up.
    """

    way: int
    part: int
    within: float


@dataclass
class Integrator:
    """An own integration: pieces of motion between breaks, each with its begin (s), and slip and slip rate as functions of t."""

    body: str
    drawn: Drawn
    history: LoadingHistory
    load_at_start: float
    rate_at_start: float
    pieces: list[tuple[float, Motion]] = field(default_factory=list)
    onsets: list[float] = field(default_factory=list)
    t: float = 0.0
    breaks: set[float] = field(default_factory=set)

    def normal(self, t: float, side: Side) -> tuple[float, float]:
        """Return S and its slope at a time."""
        one, tone = self.history.segments[side.part], self.history.tone
        angle = tone.frequency * t + tone.phase
        value = one.value + one.slope * (t - one.start) + tone.amplitude * math.sin(angle)
        return value, one.slope + tone.amplitude * tone.frequency * math.cos(angle)

    def load(self, t: float, u: float, within: float) -> float:
        """Return the load at a time and, on a block, a slip."""
        if self.body == "block":
            return self.load_at_start + STIFFNESS * (PULL * t - u)
        if within < ROUND_TRIP:
            return self.load_at_start + (PULL - self.rate_at_start) / (0.5 * ROUND_TRIP) * t
        before, back = t - ROUND_TRIP, within - ROUND_TRIP
        slip, rate = self.motion(before, back)
        return self.load(before, slip, back) + 2.0 * (PULL - rate)

    def motion(self, t: float, within: float) -> tuple[float, float]:
        """Return slip and slip rate at a time in the past."""
        return next(motion for begin, motion in reversed(self.pieces) if within >= begin)(t)

    def slip(self, t: float) -> float:
        """Return the slip at a time."""
        return self.motion(t, t)[0]

    def beyond(self, t: float, u: float, z: float, side: Side) -> float:
        """Return by how much the load exceeds the strength at rest, in the direction of slip."""
        return side.way * self.load(t, u, side.within) - self.normal(t, side)[0] * self.drawn.mu(u, 0.0, z)

    def rate_without_mass(self, t: float, u: float, z: float, side: Side) -> float:
        """Return the slip rate that solves the contact equation of a slab without contact mass."""
        load, normal, mu = side.way * self.load(t, u, side.within), self.normal(t, side)[0], self.drawn.mu
        if not self.drawn.law.sticks:  # slip in the direction of the load, however slow
            fast = brentq(lambda x: math.exp(x) + normal * mu(u, math.exp(x), z) - abs(load), -200.0, 5.0, xtol=1e-14)
            return math.copysign(math.exp(fast), load)
        if load <= normal * mu(u, 0.0, z):
            return 0.0
        return side.way * float(brentq(lambda s: s + normal * mu(u, s, z) - load, 0.0, load, xtol=1e-15))

    def change(self, t: float, rate: float, z: float, side: Side) -> float:
        """Return dz/dt."""
        normal, slope = self.normal(t, side)
        return self.drawn.change(abs(rate), z, slope / normal)

    def rest(self, end: float, now: list[float], side: Side) -> tuple[list[float], int]:
        """Stay at rest until the load exceeds the strength; return slip, rate and z there, and the direction of slip."""
        u, _, z = now
        sides = [Side(way, side.part, side.within) for way in (1, -1)]
        events = [lambda t, y, one=one: self.beyond(t, u, y[0], one) for one in sides]
        found = self.solve(lambda t, y: [self.change(t, 0.0, y[0], side)], end, [z], events, 1.0)
        self.pieces.append((self.t, lambda t: (u, 0.0)))
        self.t = float(found.t[-1])
        began = found.status == 1
        return [u, 0.0, float(found.y[0, -1])], (1 if len(found.t_events[0]) else -1) if began else 0

    def slide(self, end: float, now: list[float], side: Side) -> tuple[list[float], int]:
        """Slip until the rate comes back to zero; return slip, rate and z there, and the direction of slip from then on."""
        sticks, mass = self.drawn.law.sticks, MASS[self.body]
        u, v, z = now

        def with_mass(t: float, y: Any) -> list[float]:
            way = side.way if sticks else math.copysign(1.0, y[1])
            friction = way * self.normal(t, side)[0] * self.drawn.mu(y[0], abs(y[1]), y[2])
            force = self.load(t, y[0], side.within) - DAMPING[self.body] * y[1] - friction
            return [y[1], force / mass, self.change(t, y[1], y[2], side)]

        def without_mass(t: float, y: Any) -> list[float]:
            rate = self.rate_without_mass(t, y[0], y[1], side)
            return [rate, self.change(t, rate, y[1], side)]

        stops = (lambda t, y: side.way * y[1]) if mass else (lambda t, y: self.beyond(t, y[0], y[1], side) + SLACK)
        found = self.solve(with_mass if mass else without_mass, end, [u, v, z] if mass else [u, z], [stops] * sticks, -1.0)
        dense, last = found.sol, found.y[:, -1].tolist()

        def motion(t: float) -> tuple[float, float]:
            y = dense(t).tolist()
            return (y[0], y[1]) if mass else (y[0], self.rate_without_mass(t, y[0], y[1], side))

        self.pieces.append((self.t, motion))
        self.t = float(found.t[-1])
        ended = found.status == 1
        return [last[0], 0.0 if ended or not mass else last[1], last[-1]], 0 if ended else side.way

    def solve(self, change: Any, end: float, begins: list[float], events: list[Any], direction: float) -> Any:
        """Return an integration from now to a time or to the first event, and note the breaks that an event makes."""
        for one in events:
            one.terminal, one.direction = True, direction
        longest = 0.02 if direction > 0.0 else math.inf  # at rest a step would leap over the end of the rest
        settings: dict[str, Any] = {"method": "DOP853", "rtol": 1e-10, "atol": 1e-12, "max_step": longest, "dense_output": True}
        found = solve_ivp(change, (self.t, end), begins, events=events, **settings)
        if found.status == 1:
            self.breaks |= {float(found.t[-1]) + k * ROUND_TRIP for k in range(1, 5)}
        return found

    def run(self) -> None:
        """Integrate to the end."""
        starts, sticks = [one.start for one in self.history.segments], self.drawn.law.sticks
        way, part, now = 0, 0, [0.0, self.rate_at_start, self.drawn.z]
        self.breaks = {DURATION, *(s + k * ROUND_TRIP for s in (0.0, *starts) for k in range(5))}
        while self.t < DURATION - 1e-12:
            end = min(one for one in self.breaks if one > self.t + 1e-12)
            before = self.normal(self.t, Side(0, part, self.t))[0]
            part = int(np.searchsorted(starts, self.t, side="right")) - 1
            side = Side(way, part, 0.5 * (self.t + end))
            now[2] += self.drawn.jump * math.log(self.normal(self.t, side)[0] / before)
            if sticks and way != 0 and not MASS[self.body] and self.beyond(self.t, now[0], now[2], side) < -SLACK:
                side.way = 0
            if side.way == 0:
                side.way = next((w for w in (1, -1) if self.beyond(self.t, now[0], now[2], Side(w, part, side.within)) > SLACK), 0)
                side.way = side.way if sticks else 1
                self.onsets += [self.t] * (side.way != 0)
            now, way = self.slide(end, now, side) if side.way else self.rest(end, now, side)
            self.onsets += [self.t] * (way != 0 and side.way == 0)


@pytest.mark.sampled(every=90)
@pytest.mark.parametrize("seed", range(2))
@pytest.mark.parametrize("kind", ["steps", "ramps", "sinusoid"])
@pytest.mark.parametrize("body", BODIES)
@pytest.mark.parametrize("law", LAWS)
def test_slip_and_onsets_are_those_of_an_own_integrator(law: str, body: str, kind: str, seed: int) -> None:
    """Slip to 1e-7 of the way pulled, starts of events to 1e-7 s."""
    rng = np.random.default_rng([seed, *map(ord, law + body + kind)])
    drawn, load = LAWS[law](rng, body), NORMAL * float(rng.uniform(0.3, 0.6))
    # friction without rest turns into a wall where slip nearly stops, which takes this integrator for ever: press it gently
    pressed = history(rng, kind, 0.4 if drawn.law.sticks else 0.08)
    more: dict[str, Any] = {"initial_load": load, **drawn.start}
    if not drawn.law.sticks:
        load = NORMAL * drawn.mu(0.0, PULL, drawn.z) + DAMPING[body] * PULL
        more |= {"initial_load": load} | ({} if body == "slab" else {"initial_rate": PULL})
    own = Integrator(body, drawn, pressed, load, 0.0 if drawn.law.sticks or body == "slab" else PULL)
    own.run()
    problem = ss.Problem(BODIES[body], drawn.law, pull_rate=PULL, normal_load=pressed, **more)
    run = ss.simulate(problem, DURATION, rtol=1e-10)
    times = np.linspace(0.05, DURATION - 0.01, 40)
    assert run.slip(times) == pytest.approx([own.slip(t) for t in times], abs=1e-7 * PULL * DURATION, rel=0.0)
    if drawn.law.sticks:
        starts = run.events.start.to_numpy()
        assert starts == pytest.approx(own.onsets[: len(starts)], abs=1e-7)
