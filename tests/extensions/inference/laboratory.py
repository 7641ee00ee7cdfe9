"""Synthetic records of a laboratory, made without the engine: scipy's integrator, and closed forms of Coulomb friction."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp
from scipy.signal import lfilter

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class RateAndStateBlock:
    """A block on a spring under rate-and-state friction, integrated by Radau's method."""

    mass: float = 20.0
    stiffness: float = 6e7
    normal: float = 5e4
    reference: float = 0.62
    a: float = 0.008
    b: float = 0.0125
    distance: float = 15e-6
    rate: float = 1e-6

    def friction(self, time: Floats, times: Sequence[float], rates: Sequence[float]) -> Floats:
        """Friction at sample times from steady sliding at the first of several load-point rates, each from a time on."""
        steady = self.reference + (self.a - self.b) * math.log(rates[0] / self.rate)
        spring, log_rate, log_state = self.normal * steady, math.log(rates[0]), math.log(self.distance / rates[0])
        state, found = np.array([spring, log_rate, log_state]), []
        ends = [*times[1:], float(time[-1])]
        for i, (begin, end, pull) in enumerate(zip(times, ends, rates, strict=True)):
            inside = time[(time >= begin) & ((time < end) | (i == len(rates) - 1))]
            # the spring force (N), ln v and ln theta: m dv/dt = F - S mu, dF/dt = K (V - v)
            at = np.union1d(inside, end)
            run = solve_ivp(self._change, (begin, end), state, "Radau", args=(pull,), t_eval=at, rtol=1e-9, atol=1e-10)
            state = run.y[:, -1]
            found.append(self._mu(run.y[1], run.y[2])[: len(inside)])
        return np.concatenate(found)

    def _mu(self, log_rate: Any, log_state: Any) -> Any:
        exponent = (self.reference + self.b * (math.log(self.rate / self.distance) + log_state)) / self.a
        return self.a * np.arcsinh(np.exp(log_rate + exponent) / (2.0 * self.rate))

    def _change(self, time: float, y: Floats, pull: float) -> list[float]:
        spring, log_rate, log_state = y
        rate = math.exp(log_rate)
        force = spring - self.normal * self._mu(log_rate, log_state)
        return [self.stiffness * (pull - rate), force / (self.mass * rate), math.exp(-log_state) - rate / self.distance]


def load_point(time: Floats, times: Sequence[float], rates: Sequence[float]) -> Floats:
    """Displacement of a load point whose rate changes at given times."""
    moved = np.zeros(len(time))
    for before, after, at in zip([0.0, *rates[:-1]], rates, times, strict=True):
        moved += (after - before) * np.maximum(time - at, 0.0)
    return moved


def correlated(count: int, per_sample: float, seed: int) -> Floats:
    """Noise of standard deviation 1 whose correlation falls by a factor e in so many samples; 0 for white noise."""
    white = np.random.default_rng(seed).standard_normal(count)
    if per_sample == 0.0:
        return white
    rho = math.exp(-1.0 / per_sample)
    drive = white * math.sqrt(1.0 - rho**2)
    drive[0] = white[0]
    return np.asarray(lfilter([1.0], [1.0, -rho], drive))


@dataclass(frozen=True)
class CoulombBlock:
    """Stick-slip of a block with static and dynamic Coulomb friction, by the closed form of each slip."""

    mass: float = 2.0
    stiffness: float = 4e6
    normal: float = 1e3
    static: float = 0.65
    dynamic: float = 0.5
    pull: float = 1e-3

    def sampled(self, time: Floats, spring: float, scatter: float = 0.0, seed: int = 0) -> tuple[Floats, Floats]:
        """Spring force (N) and slip (m) at sample times, from rest at a spring force; static friction may scatter."""
        random, strength = np.random.default_rng(seed), self.static * self.normal
        frequency = math.sqrt(self.stiffness / self.mass)
        force, slip = np.zeros(len(time)), np.zeros(len(time))
        at, moved, sticks, load = 0.0, 0.0, True, spring
        while at < time[-1]:
            if sticks:
                strength = (self.static + scatter * random.standard_normal()) * self.normal
                lasts = (strength - load) / (self.stiffness * self.pull)
                inside = (time >= at) & (time <= at + lasts)
                force[inside], slip[inside] = load + self.stiffness * self.pull * (time[inside] - at), moved
                load = strength
            else:
                # F - Fd = A cos(w t) + B sin(w t), v = V - F'/K, at rest again where v = 0
                above, sine = load - self.dynamic * self.normal, self.stiffness * self.pull / frequency
                lasts = 2.0 / frequency * (math.pi - math.atan2(above, sine))
                inside = (time > at) & (time <= at + lasts)
                phase = frequency * (time[inside] - at)
                force[inside] = self.dynamic * self.normal + above * np.cos(phase) + sine * np.sin(phase)
                slip[inside] = moved + self.pull * (time[inside] - at) - (force[inside] - load) / self.stiffness
                end = self.dynamic * self.normal + above * math.cos(frequency * lasts) + sine * math.sin(frequency * lasts)
                moved += self.pull * lasts - (end - load) / self.stiffness
                load = end
            at, sticks = at + lasts, not sticks
        return force, slip


@dataclass(frozen=True)
class WeakeningSlab:
    """An elastic slab under linear slip weakening: Heun's method on a grid that divides the two-way travel time."""

    density: float = 1180.0
    wave_speed: float = 1300.0
    thickness: float = 0.1
    normal: float = 5e6
    static: float = 0.6
    dynamic: float = 0.5
    distance: float = 2e-5
    pull: float = 1e-3
    steps: int = 1000

    def run(self, stress: float, duration: float) -> tuple[Floats, Floats, Floats]:
        """Times (s), shear stress at the contact (Pa) and slip (m), from rest at a uniform shear stress."""
        impedance, trip = self.density * self.wave_speed, 2.0 * self.thickness / self.wave_speed
        step, count = trip / self.steps, int(duration / trip * self.steps) + 2
        rise = self.density * self.wave_speed**2 * self.pull / self.thickness
        load, rate, slip, shear = np.zeros(count), np.zeros(count), np.zeros(count), np.zeros(count)
        load[: self.steps] = stress + rise * step * np.arange(min(self.steps, count))
        for i in range(count):
            if i >= self.steps:
                load[i] = load[i - self.steps] + 2.0 * impedance * (self.pull - rate[i - self.steps])
            if i:
                ahead = max(load[i] - self._strength(slip[i - 1] + step * rate[i - 1]), 0.0) / impedance
                slip[i] = slip[i - 1] + 0.5 * step * (rate[i - 1] + ahead)
            strength = self._strength(slip[i])
            rate[i] = max(load[i] - strength, 0.0) / impedance
            shear[i] = min(load[i], strength)
        return step * np.arange(count), shear, slip

    def _strength(self, slip: float) -> float:
        fallen = min(slip / self.distance, 1.0)
        return self.normal * (self.static + (self.dynamic - self.static) * fallen)


@dataclass(frozen=True)
class CoulombSlab:
    """An elastic slab under static and dynamic Coulomb friction: the closed form of its first slip event."""

    density: float = 1180.0
    wave_speed: float = 1300.0
    thickness: float = 0.1
    normal: float = 5e6
    static: float = 0.6
    dynamic: float = 0.5
    pull: float = 1e-3

    @property
    def trip(self) -> float:
        """Two-way travel time of waves (s), for which the slab slips."""
        return 2.0 * self.thickness / self.wave_speed

    def onset(self, stress: float) -> float:
        """Time (s) at which slip begins, from rest at a uniform shear stress."""
        return (self.static * self.normal - stress) / self._rise

    @property
    def _rise(self) -> float:
        return self.density * self.wave_speed**2 * self.pull / self.thickness

    def sampled(self, time: Floats, stress: float) -> tuple[Floats, Floats]:
        """Shear stress at the contact (Pa) and slip (m) at sample times before the end of the second round trip after the onset."""
        impedance, begin, end = self.density * self.wave_speed, self.onset(stress), self.onset(stress) + self.trip
        back = time - self.trip
        rate = np.where((back > begin) & (back <= end), (stress + self._rise * back - self.dynamic * self.normal) / impedance, 0.0)
        after = stress + self._rise * back - 2.0 * impedance * rate + 2.0 * impedance * self.pull
        before = np.where(time <= begin, stress + self._rise * time, self.dynamic * self.normal)
        lasts = np.clip(time - begin, 0.0, self.trip)
        slip = ((self.static - self.dynamic) * self.normal * lasts + 0.5 * self._rise * lasts**2) / impedance
        return np.where(time <= end, before, after), slip

    def stick_slip(self, stress: float, duration: float, scatter: float = 0.0, seed: int = 0) -> tuple[Floats, Floats, Floats]:
        """Times (s), shear stress at the contact (Pa) and slip (m) over many events, along characteristics, 80 steps a round trip.

        Static friction may scatter from event to event.
        """
        random, steps, impedance = np.random.default_rng(seed), 80, self.density * self.wave_speed
        step, drag = self.trip / steps, self.dynamic * self.normal
        load = stress + self._rise * step * np.arange(steps)
        strength, sliding, slip = self.normal * (self.static + scatter * random.standard_normal()), False, 0.0
        shears, slips = list[Floats](), list[Floats]()
        for _ in range(int(duration / self.trip) + 1):
            rate, shear = np.zeros(steps), load.copy()
            if sliding or load.max() >= strength:
                for i, beta in enumerate(load.tolist()):
                    sliding = sliding or beta >= strength
                    rate[i] = max(beta - drag, 0.0) / impedance if sliding else 0.0
                    shear[i] = drag if rate[i] > 0.0 else beta
                    if sliding and rate[i] == 0.0:
                        sliding, strength = False, self.normal * (self.static + scatter * random.standard_normal())
            shears.append(shear)
            slips.append(slip + step * np.cumsum(rate))
            slip = float(slips[-1][-1])
            load = load + 2.0 * impedance * (self.pull - rate)
        return step * np.arange(steps * len(shears)), np.concatenate(shears), np.concatenate(slips)
