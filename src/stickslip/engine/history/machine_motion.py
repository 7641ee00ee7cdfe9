"""The motion of a driver that is a machine over a whole run, from the waves that left the contact: its rate, forces and energies.

The equations are those of `engine.waves.driver`. Every piece of the history is the wave that moves the machine h/c later, so its
motion is known for h/c beyond the end of the run. It is found again here, because a run keeps the loads at the contact alone.
Times are seconds since the start of the run.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from stickslip.engine.history.series import horner
from stickslip.engine.state.layout import TERMS, Store
from stickslip.foundation.arrays import Floats, Floats1, Floats2, Floats3
from stickslip.foundation.errors import InputError
from stickslip.foundation.kernels.kernels import entry
from stickslip.problem import EDGE, Inflow, Problem, driver_of, inflow_of, pace_of, pull_of, settled_rate, wave_before

FINEST = 0.5
"""Parts of a piece are so short that a machine changes by at most about this share of its size (1) in each."""
EARLY = 1e-9
"""Times up to this share of themselves before the start of a motion are at the start, by rounding."""
MOTION_NODES, MOTION_WEIGHTS = (values / 2.0 for values in np.polynomial.legendre.leggauss(TERMS + 1))
"""Places and weights of the Gauss-Legendre rule, exact for products of two polynomials of a part; places count from its middle."""


class MachineNumbers(NamedTuple):
    """Hold the numbers of a machine."""

    weight: float  # kg/m^2
    resists: float  # Pa s/m: proportional gain and impedance of the slab
    gain: float  # Pa/m


@entry
def walk(series: Floats3, pace: Floats2, machine: MachineNumbers, start: Floats1) -> None:
    """Write the series of rate and push of a machine along parts of its time; each begins where the last one ended.

    `series` holds force, pull rate, rate and push (4, parts, TERMS): the first two are given, the others found. A row of `pace`
    holds dt/dxi at the start of a part, half its change, and what the push gains before the part. `start` holds rate and push at
    the start of the first.
    """
    force, pull, rate, push = series[0], series[1], series[2], series[3]
    now, pushed = start[0], start[1]
    for n in range(len(force)):
        speed, bend = pace[n, 0], 2.0 * pace[n, 1]
        rate[n, 0], push[n, 0] = now, pushed + pace[n, 2]
        faster = growth = 0.0
        for k in range(TERMS):
            if machine.weight == 0.0:
                rate[n, k] = (force[n, k] + push[n, k]) / machine.resists
            before, growth = growth, machine.gain * (pull[n, k] - rate[n, k])
            slower = faster
            if machine.weight > 0.0:
                faster = (force[n, k] + push[n, k] - machine.resists * rate[n, k]) / machine.weight
            if k + 1 < TERMS:
                push[n, k + 1] = (speed * growth + bend * before) / (k + 1)
                if machine.weight > 0.0:
                    rate[n, k + 1] = (speed * faster + bend * slower) / (k + 1)
        now, pushed = rate[n].sum(), push[n].sum()


@dataclass(frozen=True, eq=False)
class MotionInParts(ABC):
    """The motion of a driver in parts of time; in each, its rate is a polynomial in xi on [0, 1]."""

    start: Floats  # s: when a part begins at the driver
    speed: Floats  # s: time since then is speed xi + bend xi^2
    bend: Floats
    rate: Floats  # m/s, (parts, TERMS)
    mass: float  # kg/m^2
    problem: Problem

    def at(self, time: Floats) -> Floats:
        """Return the rate of the driver (m/s) at times (s)."""
        n, xi = self._placed(time)
        return horner(self.rate[n], xi)

    def way(self, low: Floats, high: Floats) -> Floats:
        """Return how far (m) the driver moves between times (s)."""
        return self._until(self.rate, self._ways, high) - self._until(self.rate, self._ways, low)

    def kinetic(self, time: float) -> float:
        """Return the kinetic energy of the mass (J/m^2) at a time (s)."""
        return 0.5 * self.mass * float(self.at(np.array([time]))[0]) ** 2

    def work(self, begin: float, end: float) -> float:
        """Return the work (J/m^2) on the driver that moves its mass, between two times (s)."""
        return self.kinetic(end) - self.kinetic(begin)

    @abstractmethod
    def dissipated(self, begin: float, end: float) -> float:
        """Return the energy (J/m^2) that the driver takes up between two times (s)."""

    @cached_property
    def _ways(self) -> Floats:
        return np.append(0.0, np.cumsum(_primitive(self.rate, self.speed, self.bend, np.ones(len(self.rate)))))

    def _until(self, series: Floats, whole: Floats, time: Floats) -> Floats:
        n, xi = self._placed(np.asarray(time))
        return np.asarray(whole[n] + _primitive(series[n], self.speed[n], self.bend[n], xi))

    def _placed(self, time: Floats) -> tuple[NDArray[np.intp], Floats]:
        """Return the part that holds each time (s), and the place xi in it."""
        first, trip = self.start[0], self.problem.round_trip_time
        if first > trip and np.size(time) and np.min(time) < first - EARLY * first:  # else nothing was forgotten
            raise InputError("the motion of the driver is not known so early: the run has forgotten what came before")
        n = np.clip(np.searchsorted(self.start, time, side="right") - 1, 0, len(self.start) - 1)
        since, speed, bend = np.maximum(time - self.start[n], 0.0), self.speed[n], self.bend[n]
        pace = speed + np.sqrt(np.maximum(speed * speed + 4.0 * bend * since, 0.0))
        return n, np.minimum(2.0 * since / np.where(pace > 0.0, pace, 1.0), 1.0)

    def integrated(self, density: Callable[[NDArray[np.intp], Floats], Floats], begin: float, end: float) -> float:
        """Return the integral of a function of parts and of places in them between two times (s)."""
        (first, last), (low, high) = self._placed(np.array([begin, end]))
        n = np.arange(first, last + 1)
        from_xi, to_xi = np.where(n == first, low, 0.0), np.where(n == last, high, 1.0)
        xi = (0.5 * (from_xi + to_xi))[:, None] + (to_xi - from_xi)[:, None] * MOTION_NODES
        each = np.repeat(n, len(MOTION_NODES))
        pace = self.speed[n, None] + 2.0 * self.bend[n, None] * xi
        values = density(each, xi.ravel()).reshape(xi.shape) * pace * MOTION_WEIGHTS
        return float((values.sum(axis=1) * (to_xi - from_xi)).sum())


@dataclass(frozen=True, eq=False)
class MachineMotion(MotionInParts):
    """The motion of a machine, and the forces on it, which are polynomials, too."""

    motor: Floats  # Pa: stress of gains and far stress on the slab and the mass
    pull: Floats  # m/s

    def work(self, begin: float, end: float) -> float:
        """Return the work (J/m^2) of gains and far stress on the machine between two times (s)."""
        return self.integrated(lambda n, xi: horner(self.motor[n], xi) * horner(self.rate[n], xi), begin, end)

    def dissipated(self, begin: float, end: float) -> float:
        """Return the energy (J/m^2) that the proportional gain takes up between two times (s)."""
        gain = self.problem.body.driver_impedance
        return gain * self.integrated(lambda n, xi: (horner(self.rate[n], xi) - horner(self.pull[n], xi)) ** 2, begin, end)


def machine_motion(problem: Problem, store: Store, duration: float) -> MachineMotion:
    """Return the motion of the machine of a problem, to h/c after the end of a run.

    If the run has forgotten its first pieces, or begins with a wave, it is known from the first piece on whose source is kept, too.
    """
    body, trip_time = problem.body, problem.round_trip_time
    machine = MachineNumbers(body.driver_inertia, body.driver_impedance + body.impedance, body.driver_integral_gain)
    parts = parts_of(problem, store, pace_of(body))
    gap = np.diff(parts.left, append=duration) - (parts.speed + parts.bend)
    rests = np.flatnonzero(gap > 1e-9 * trip_time)
    parts = parts.with_rests(rests, gap[rests])
    start, since = np.array(driver_of(problem).at_first(problem)), -math.inf
    if store.trip[0] != 0 or store.phase_from[0] != 0.0 or math.isnan(store.amplified[0]):  # the last begins with a wave
        start, since = _start_in(problem, store, machine)
        parts = parts.from_time(since)
    arrives, driven = parts.left + trip_time, inflow_of(problem)
    force, pull = (_series(flow, arrives, parts) for flow in (driven, pull_of(problem)))
    force += parts.wave
    settled = settled_rate(problem, arrives)
    rest = parts.rest
    gained = np.where(rest, machine.gain * (pull[:, 0] - settled) * parts.speed, 0.0)
    pace = np.column_stack([np.where(rest, 0.0, parts.speed), np.where(rest, 0.0, parts.bend), np.append(0.0, gained[:-1])])
    force[rest] = 0.0
    series = np.stack([force, pull, np.zeros_like(force), np.zeros_like(force)])
    walk(series, pace, machine, start)
    _, _, rate, push = series
    rate[rest], push[rest, 1] = 0.0, gained[rest]
    rate[rest, 0] = settled[rest]
    drive = _series(driven, arrives, parts) + push - body.driver_impedance * rate
    drive[:, 0] += problem.strength
    return MachineMotion(parts.left + 0.5 * trip_time, parts.speed, parts.bend, rate, body.driver_inertia, problem, drive, pull)


def _start_in(problem: Problem, store: Store, machine: MachineNumbers) -> tuple[Floats, float]:
    """Return rate and push of the machine (m/s, Pa) where the motion begins, and when the wave that it meets left the contact (s).

    The load of a piece and the wave whose echo it is give the rate and how fast it changes, and the equation of motion the push.
    """
    body, trip_time = problem.body, problem.round_trip_time
    known = np.flatnonzero((store.echo_of >= 0) & (store.speed > 0.0))
    known = known[store.speed[store.echo_of[known]] > 0.0] if len(known) else known
    if not len(known):
        raise InputError("the motion of a driver with a mass or an integral gain is not known in so short a part of a run")
    n = int(known[0])
    source, time = int(store.echo_of[n]), float(store.trip[n] * trip_time + store.phase_from[n])
    speed, bend = float(store.speed[source]), float(store.bend[source])
    since = max(float(store.phase_from[n] - store.phase_from[source]), 0.0)
    xi = np.array([2.0 * since / (speed + math.sqrt(speed**2 + 4.0 * bend * since))])
    arrives, leaped = np.array([time]), float(store.trip[n] - store.trip[source] - 1)
    wave = 2.0 * body.impedance * store.rate[source] - store.load[source]
    powers = np.arange(1, TERMS)
    left = float(horner(wave[None], xi)[0]) - leaped * 2.0 * body.impedance * float(settled_rate(problem, arrives - trip_time)[0])
    turns = float(horner((wave[1:] * powers)[None], xi)[0]) / (speed + 2.0 * bend * xi[0])
    rate = (store.load[n, 0] + left) / (2.0 * body.impedance)
    faster = (store.load[n, 1] / store.speed[n] + turns) / (2.0 * body.impedance)
    push = machine.weight * faster + machine.resists * rate - float(inflow_of(problem).at(arrives)[0]) - left
    return np.array([rate, push]), time - trip_time


class WavesLeft(NamedTuple):
    """Parts of waves that left the contact: when (s), dt/dxi at first, half its change, the wave (Pa) in powers of xi; rests."""

    left: Floats
    speed: Floats
    bend: Floats
    wave: Floats
    rest: NDArray[np.bool_]

    def with_rests(self, after: NDArray[np.intp], lasting: Floats) -> WavesLeft:
        """Return the same with a part for each rest (s) that was leaped over after one of the parts."""
        ends = self.left[after] + self.speed[after] + self.bend[after]
        added = WavesLeft(ends, lasting, np.zeros(len(after)), np.zeros((len(after), TERMS)), np.ones(len(after), bool))
        return WavesLeft(*(np.insert(one, after + 1, other, axis=0) for one, other in zip(self, added, strict=True)))

    def from_time(self, since: float) -> WavesLeft:
        """Return the parts of waves that left from a time (s) on; the first one may be cut."""
        n = max(int(np.searchsorted(self.left, since + EDGE * max(abs(since), self.speed.max()), side="right")) - 1, 0)
        kept = WavesLeft(self.left[n:].copy(), self.speed[n:].copy(), self.bend[n:].copy(), self.wave[n:].copy(), self.rest[n:])
        late = max(since - kept.left[0], 0.0)
        speed, bend = kept.speed[0], kept.bend[0]
        pace = speed + math.sqrt(speed * speed + 4.0 * bend * late)
        xi = min(2.0 * late / pace, 1.0)
        kept.left[0], kept.speed[0], kept.bend[0] = since, (speed + 2.0 * bend * xi) * (1.0 - xi), bend * (1.0 - xi) ** 2
        kept.wave[:1] = _restricted(kept.wave[:1], np.array([xi]), np.array([1.0 - xi]))
        return kept


def parts_of(problem: Problem, store: Store, pace: float) -> WavesLeft:
    """Return the waves that left the contact, from h/c before the start on, cut where the loading breaks, and into short parts.

    The driver changes by its own size at a pace (1/s).
    """
    body, trip_time = problem.body, problem.round_trip_time
    half = 0.5 * trip_time
    first = np.zeros((1, TERMS))
    slope = body.impedance * problem.initial_shear  # over half a round trip
    first[0, :2] = slope - wave_before(problem), -slope
    left = np.append(-half, store.trip * trip_time + store.phase_from)
    speed, bend = np.append(half, store.speed), np.append(0.0, store.bend)
    wave = np.concatenate([first, 2.0 * body.impedance * store.rate - store.load])
    tone = inflow_of(problem).tone
    fastest = max(pace, tone.frequency if tone.amplitude != 0.0 else 0.0)
    cuts = np.ceil(fastest * (np.abs(speed) + 2.0 * np.abs(bend)) / FINEST).astype(int).clip(1)
    which = np.repeat(np.arange(len(left)), cuts)
    begin = np.concatenate([np.arange(count) / count for count in cuts])
    for time in inflow_of(problem).start[1:] - trip_time:
        n = int(np.searchsorted(left, time, side="right")) - 1
        since = time - left[n]
        along = speed[n] + math.sqrt(max(speed[n] ** 2 + 4.0 * bend[n] * since, 0.0))
        xi = 2.0 * since / along if along > 0.0 else 0.0
        if EDGE < xi < 1.0 - EDGE:
            place = int(np.searchsorted(which + begin, n + xi))
            which, begin = np.insert(which, place, n), np.insert(begin, place, xi)
    end = np.append(begin[1:], 1.0)
    end[np.append(np.diff(which) > 0, True)] = 1.0
    width = end - begin
    return WavesLeft(
        left[which] + begin * (speed[which] + begin * bend[which]),
        (speed[which] + 2.0 * bend[which] * begin) * width,
        bend[which] * width**2,
        _restricted(wave[which], begin, width),
        np.zeros(len(which), bool),
    )


def _series(flow: Inflow, arrives: Floats, parts: WavesLeft) -> Floats:
    """Return an inflow as polynomials in xi along parts that arrive at the contact at given times (s)."""
    n = flow.segment(arrives + 0.5 * (parts.speed + parts.bend))
    begins = flow.value[n] + flow.slope[n] * (arrives - flow.start[n])
    return series_along((begins, flow.slope[n], np.zeros(len(n))), flow.tone, arrives, parts)


def series_along(straight: Sequence[Floats], tone: tuple[Any, float, Any], arrives: Floats, parts: WavesLeft) -> Floats:
    """Return a parabola in time (value, slope, curve) and a tone as polynomials in xi along parts that arrive at times (s)."""
    (value, slope, curve), (amplitude, frequency, phase) = straight, tone
    series = np.zeros((len(arrives), TERMS))
    series[:, 0], series[:, 1], series[:, 2] = value, slope * parts.speed, slope * parts.bend + curve * parts.speed**2
    series[:, 3], series[:, 4] = 2.0 * curve * parts.speed * parts.bend, curve * parts.bend**2
    if np.any(amplitude):
        sine, cosine, angle = np.zeros_like(series), np.zeros_like(series), frequency * arrives + phase
        sine[:, 0], cosine[:, 0] = amplitude * np.sin(angle), amplitude * np.cos(angle)
        turn, bent = frequency * parts.speed, 2.0 * frequency * parts.bend
        for k in range(TERMS - 1):
            before = (sine[:, k - 1], cosine[:, k - 1]) if k else (0.0, 0.0)
            sine[:, k + 1] = (turn * cosine[:, k] + bent * before[1]) / (k + 1)
            cosine[:, k + 1] = -(turn * sine[:, k] + bent * before[0]) / (k + 1)
        series += sine
    return series


def _restricted(series: Floats, begin: Floats, width: Floats) -> Floats:
    """Return polynomials on the part of [0, 1] that begins at `begin`, as polynomials of a place from 0 to 1 in that part."""
    found = series.copy()
    for first in range(TERMS - 1):
        for k in range(TERMS - 2, first - 1, -1):
            found[:, k] += begin * found[:, k + 1]
    return np.asarray(found * width[:, None] ** np.arange(TERMS))


def _primitive(series: Floats, speed: Floats, bend: Floats, xi: Floats) -> Floats:
    """Return the integral of polynomials in time up to places xi."""
    powers = np.arange(1, TERMS + 1)
    straight = xi * horner(speed[:, None] * series / powers, xi)
    return np.asarray(straight + xi**2 * horner(2.0 * bend[:, None] * series / (powers + 1), xi))
