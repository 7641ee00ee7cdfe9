"""Records as a double-direct-shear rig makes them, integrated by scipy: trend, servo, wobble of the normal force, and noise."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np
from scipy.integrate import solve_ivp

import stickslip as ss
from tests.extensions.inference.laboratory import Floats


@dataclass(frozen=True)
class Rig:
    """A rig without inertia under rate-and-state friction (ageing), whose load point steps from rate to rate through a servo.

    `trend` is friction per metre of slip, `creep` friction per second. `wobble` is that of the normal force (share), of a period
    of `period` (s).
    """

    times: tuple[float, ...] = (0.0, 15.0, 25.0, 40.0, 50.0)
    rates: tuple[float, ...] = (1e-5, 1e-4, 1e-5, 3e-5, 1e-5)
    lasts: float = 60.0
    rate: float = 50.0
    """Samples per second."""
    trend: float = 0.0
    creep: float = 0.0
    servo: float = 0.08
    wobble: float = 3e-4
    period: float = 3.7
    noise: float = 2e-4
    stiffness: float = 6e7
    normal: float = 5e4
    law: dict[str, float] = field(
        default_factory=lambda: {"reference": 0.62, "a": 0.008, "b": 0.0125, "distance": 15e-6, "rate": 1e-5}
    )

    @property
    def truth(self) -> dict[str, float]:
        """The numbers to find, by their full names."""
        numbers = {f"friction.{name}": self.law[name] for name in ("a", "b", "distance", "reference")}
        return {**numbers, "body.stiffness": self.stiffness}

    @cached_property
    def clock(self) -> Floats:
        return np.arange(round(self.lasts * self.rate)) / self.rate

    def pressed(self, time: Any) -> Any:
        """The normal force (N)."""
        return self.normal * (1.0 + self.wobble * np.sin(2.0 * math.pi * np.asarray(time) / self.period))

    @cached_property
    def run(self) -> tuple[Floats, Floats]:
        """Friction, and displacement of the load point (m), at the samples."""
        law, start = self.law, self.rates[0]
        steady = law["reference"] + (law["a"] - law["b"]) * math.log(start / law["rate"])
        state = np.array([self.normal * steady, math.log(law["distance"] / start), 0.0, 0.0, start])
        mu, moved = [], []
        for begin, end, wanted in zip(self.times, [*self.times[1:], self.lasts], self.rates, strict=True):
            inside = self.clock[(self.clock >= begin) & (self.clock < end)]
            options = {"rtol": 1e-9, "atol": [1e-3, 1e-9, 1e-12, 1e-12, 1e-14]}
            found = solve_ivp(self._change, (begin, end), state, "LSODA", args=(wanted,), t_eval=np.union1d(inside, end), **options)
            state = found.y[:, -1]
            mu.append((found.y[0] / self.pressed(found.t))[: len(inside)])
            moved.append(found.y[3][: len(inside)])
        return np.concatenate(mu), np.concatenate(moved)

    def _change(self, time: float, y: Floats, wanted: float) -> list[float]:
        spring, log_state, slip, _, pull = y
        law = self.law
        mu = spring / float(self.pressed(time)) - self.trend * slip - self.creep * time
        exponent = law["reference"] + law["b"] * (math.log(law["rate"] / law["distance"]) + log_state)
        rate = 2.0 * law["rate"] * math.sinh(mu / law["a"]) * math.exp(-exponent / law["a"])
        driven = (wanted - pull) / self.servo if self.servo else 0.0
        return [self.stiffness * (pull - rate), math.exp(-log_state) - rate / law["distance"], rate, pull, driven]

    def record(self, seed: int = 1) -> dict[str, Floats]:
        """Return columns of a record: friction and the load point, both with white noise; the load point in digits of 10 nm."""
        mu, moved = self.run
        random = np.random.default_rng(seed)
        moved = moved + 2e-8 * random.standard_normal(len(mu))
        return {
            "time (s)": self.clock,
            "load point (um)": np.round(1e8 * moved) / 100.0,
            "mu": mu + self.noise * random.standard_normal(len(mu)),
        }


LONG = Rig(tuple(30.0 * i for i in range(11)), (1e-5, 3e-5, 1e-5, 1e-4, 1e-5, 3e-5, 1e-4, 3e-5, 1e-5, 1e-4, 1e-5), 330.0, 100.0)
"""A record of 33 000 samples and 13 mm of slip."""
GUESS = ss.Problem(ss.SpringBlock(20.0, 9e7, 5e4), ss.friction.RateAndState(0.6, 0.01, 0.013, 1e-5, 1e-5), pull_rate=1e-5)
FREE = ("a", "b", "distance", "stiffness", "reference")
