"""An own integrator of a slab whose driver is a machine, by the method of steps with DOP853. It knows forward slip only.

Nothing of the package is used. Over each round trip the wave that left the contact is known; it moves the machine h/c later, and
the load of the next round trip follows. What is smooth between two breaking points is kept as Chebyshev series on short parts.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.polynomial import Chebyshev
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

DEGREE, SHORTEST = 22, 1e-6
TIGHT = {"method": "DOP853", "rtol": 1e-12, "atol": 1e-14}

Function = Callable[..., Any]


@dataclass
class Parts:
    """A function of time, smooth between its edges (s)."""

    edges: list[float]
    series: list[Chebyshev] = field(default_factory=list)

    def add(self, end: float, f: Callable[[np.ndarray], np.ndarray]) -> None:
        """Append f from the last edge to `end`, in parts so short that it is resolved."""
        begin = self.edges[-1]
        if not end > begin:
            return
        one = Chebyshev.interpolate(f, DEGREE, [begin, end])
        size = np.abs(one.coef).max()
        if np.abs(one.coef[-4:]).max() > 1e-12 * size and end - begin > SHORTEST:
            self.add(0.5 * (begin + end), f)
            self.add(end, f)
            return
        self.series.append(one)
        self.edges.append(end)

    def __call__(self, t: np.ndarray | float) -> np.ndarray:
        time = np.atleast_1d(np.asarray(t, float))
        which = np.clip(np.searchsorted(self.edges, time, side="right") - 1, 0, len(self.series) - 1)
        out = np.empty(len(time))
        for n in np.unique(which):
            out[which == n] = self.series[n](time[which == n])
        return out

    def within(self, begin: float, end: float) -> list[float]:
        """Return the edges between two times."""
        return [edge for edge in self.edges if begin < edge < end]


_Kept = tuple[Parts, Parts, list[float]]


@dataclass
class Slab:
    """Impedance Z, time T = h/c, contact mass m, static strength, sliding friction of the slip rate, and the machine."""

    Z: float
    T: float
    mass: float
    static: float
    sliding: Callable[[float], float]
    inertia: float
    kp: float
    ki: float
    pull: Callable[[float], float]
    pull_breaks: tuple[float, ...]
    stress: float  # at the start, everywhere in the slab
    beyond: float = 0.0  # the far stress, minus that

    def run(self, trips: int) -> tuple[Parts, Parts, Parts, list[float]]:
        """Return the slip rate, the load and the machine's rate as functions of time, and the times of onset and arrest."""
        Z, T, R, pull = self.Z, self.T, 2.0 * self.T, self.pull(0.0)
        wave = Parts([-R])  # 2 Z v - beta
        wave.add(-T, lambda t: 0.0 * t - self.stress)  # never used
        wave.add(0.0, lambda t: -Z * pull * t / T - self.stress)
        rate, load, machine = Parts([0.0]), Parts([0.0]), Parts([0.0])
        lag, v, rests, events = np.array([pull, 0.0]), 0.0, True, []
        for trip in range(trips):
            begin, end = trip * R, (trip + 1) * R
            first = begin if trip else T
            breaks = [e + T for e in wave.within(first - R, end - R)] + [b for b in self.pull_breaks if first - T < b < end - T]
            lag = self._move(machine, lag, wave, sorted({*breaks, end - T}))
            edges = sorted({begin, end, *(e + R for e in wave.within(begin - R, end - R)), *(b + T for b in breaks)})
            edges = [e for e in edges if begin <= e <= end]

            def beta(t: np.ndarray, at: float = begin) -> np.ndarray:
                time = np.atleast_1d(np.asarray(t, float))
                known = -wave(time - R) + 2.0 * Z * machine(time - T) if machine.series else 0.0 * time
                return np.where((at == 0.0) & (time < T), self.stress + Z * pull * time / T, known)

            if trip == 0:
                edges = sorted({*edges, T})
            for low, high in pairwise(edges):
                if high - low < 1e-13 * R:
                    continue
                inside = self._inside(beta, low, high)
                load.add(high, inside)
                v, rests = self._contact(inside, (low, high), (v, rests), (rate, wave, events))
        return rate, load, machine, events

    @staticmethod
    def _inside(beta: Function, low: float, high: float) -> Function:
        """Return the load on a part, from inside at both its edges."""
        tiny = 1e-13 * (high - low)
        fit = Chebyshev.interpolate(lambda t: beta(np.clip(t, low + tiny, high - tiny)), 3 * DEGREE, [low, high])
        return lambda t: fit(np.asarray(t, float))

    def _move(self, machine: Parts, lag: np.ndarray, wave: Parts, edges: list[float]) -> np.ndarray:
        for end in edges:
            begin = machine.edges[-1]
            if end - begin < 1e-13 * self.T:
                continue
            fit = self._inside(wave, begin - self.T, end - self.T)
            middle = 0.5 * (begin + end)
            slope = (self.pull(middle + 1e-3 * (end - begin)) - self.pull(middle)) / (1e-3 * (end - begin))

            def pulled(t: float, at: float = middle, slope: float = slope) -> float:
                return self.pull(at) + slope * (t - at)

            def change(t: float, y: np.ndarray, fit: Function = fit, pulled: Function = pulled) -> list[float]:
                push = self.kp * pulled(t) + self.stress + self.beyond + self.ki * y[1] + float(fit(t - self.T))
                quick = push / (self.kp + self.Z) if self.inertia == 0.0 else y[0]
                faster = 0.0 if self.inertia == 0.0 else (push - (self.kp + self.Z) * y[0]) / self.inertia
                return [faster, pulled(t) - quick]

            done = solve_ivp(change, (begin, end), lag, dense_output=True, **TIGHT)

            def moved(
                t: np.ndarray,
                sol: Function = done.sol,
                fit: Function = fit,
                pulled: Callable[..., float] = pulled,
            ) -> np.ndarray:
                y = sol(t)
                if self.inertia > 0.0:
                    return y[0]
                return (self.kp * pulled(t) + self.stress + self.beyond + self.ki * y[1] + fit(np.asarray(t) - self.T)) / (
                    self.kp + self.Z
                )

            machine.add(end, moved)
            lag = done.y[:, -1]
        return lag

    def _contact(self, load: Function, span: tuple[float, float], state: tuple[float, bool], kept: _Kept) -> tuple[float, bool]:
        (now, high), (v, rests), (rate, wave, events) = span, state, kept
        while now < high:
            if rests:
                crossing = _first(lambda t: load(t) - self.static, now, high)
                until = high if crossing is None else crossing
                self._keep(until, lambda t: 0.0 * t, load, rate, wave)
                if crossing is not None:
                    events.append(crossing)
                    rests, v = False, 0.0
                now = until
                continue
            if self.mass == 0.0:
                crossing = _first(lambda t: self.sliding(0.0) - load(t), now, high)
                until = high if crossing is None else crossing
                self._keep(until, lambda t: (load(t) - self.sliding(0.0)) / self.Z, load, rate, wave)
                stops = crossing is not None
            else:

                def halt(t: float, y: np.ndarray, begin: float = now) -> float:
                    return y[0] if t > begin else 1.0

                halt.terminal, halt.direction = True, -1.0  # type: ignore[attr-defined]
                done = solve_ivp(
                    lambda t, y: [(float(load(t)) - self.Z * y[0] - self.sliding(y[0])) / self.mass],
                    (now, high),
                    [v],
                    events=halt,
                    dense_output=True,
                    **TIGHT,
                )
                until, stops = done.t[-1], done.status == 1
                self._keep(until, lambda t, sol=done.sol: sol(t)[0], load, rate, wave)
                v = 0.0 if stops else float(done.y[0, -1])
            if stops:
                events.append(until)
                rests = True
            now = until
        return v, rests

    def _keep(self, until: float, v: Function, load: Function, rate: Parts, wave: Parts) -> None:
        rate.add(until, v)
        wave.add(until, lambda t: 2.0 * self.Z * v(t) - load(t))


def _first(f: Function, low: float, high: float) -> float | None:
    """Return the first place where f becomes positive, or None; `low` itself if f is positive there."""
    places = np.linspace(low, high, 200)
    values = f(places)
    if values[0] > 0.0:
        return low
    rises = np.flatnonzero((values[:-1] <= 0.0) & (values[1:] > 0.0))
    return (
        None
        if not len(rises)
        else float(brentq(lambda t: float(f(t)), places[rises[0]], places[rises[0] + 1], xtol=1e-15, rtol=1e-14))
    )
