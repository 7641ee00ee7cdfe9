"""What moving ground adds to the load of a contact, as segments for the engine.

A block's load gains -m a(t), with a the acceleration of the ground: its growth is in `drivers.spring`, its jumps are here. At
the contact of a slab m d(v + v_g)/dt + Z (v + v_g) + tau = beta, with m its mass, if it has one, v the slip rate and v_g the
velocity of the ground. The load of the engine is beta - Z v_g - m v_g', so that its inflow gains that and, from the wave 2 Z (v +
v_g) - beta that comes back, r (Z v_g - m v_g')(t - R): parabolas and a sinusoid. Under layers, whose echoes are many, the engine
takes the velocity of the ground itself (`engine.waves.shaken_ladder`).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from stickslip.foundation.arrays import Floats
from stickslip.problem import Ground, Inflow, Problem, Tone, inflow_of, tone_of

STILL_GROUND = 1e-15
"""Ground whose velocity is below this share of its largest one (1) is at rest: the rest is rounding of sums."""


@dataclass(frozen=True, eq=False)
class StepsOfForce:
    """The jumps (N) of a block's load where the acceleration of the ground jumps."""

    start: Floats
    step: Floats
    brings_inflow: bool = False

    @classmethod
    def of(cls, problem: Problem) -> StepsOfForce:
        """Return the jumps under a problem's block."""
        ground = moving(problem)
        acceleration = ground.acceleration.copy()
        acceleration[1:] -= acceleration[:-1] + ground.jerk[:-1] * np.diff(ground.start)
        size = np.abs(ground.acceleration).max()
        acceleration[1:][np.abs(acceleration[1:]) <= 1e-14 * size] = 0.0
        amplitude, frequency, phase = ground.tone
        acceleration[0] += amplitude * frequency * math.cos(phase)
        return cls(ground.start, -problem.body.inertia * acceleration)

    def put(self, segments: Any, start: Floats) -> None:
        """Write the jumps into segments that begin at times (s)."""
        step = np.zeros(len(start))
        step[np.searchsorted(start, self.start)] = self.step
        segments.step = step
        segments.jump[1:] = segments.step[1:] != 0.0


@dataclass(frozen=True, eq=False)
class Shaking:
    """The inflow of a slab on moving ground, by segments: parabolas and the phasor of a sinusoid, in Pa."""

    start: Floats
    value: Floats
    slope: Floats
    curve: Floats  # Pa/s^2: half the second derivative
    phasor: Floats  # complex: amplitude times exp(i phase) of the sinusoid
    jump: Floats  # 1 where the inflow jumps, else 0
    shakes: Floats  # 1 while the ground moves or its motion is on its way back
    brings_inflow: bool = True

    @classmethod
    def of(cls, problem: Problem) -> Shaking:
        """Return the inflow of a slab on moving ground: that of its driver from h/c on, and that of the ground."""
        return _shaking_of(problem, moving(problem), inflow_of(problem))

    def put(self, segments: Any, start: Floats) -> None:
        """Write the inflow into segments (`LoadingSegment.of` a table) that begin at times (s), those of the inflow among them."""
        of = np.searchsorted(self.start, start, side="right") - 1
        since = start - self.start[of]
        segments.value = self.value[of] + since * (self.slope[of] + since * self.curve[of])
        segments.slope, segments.curve = self.slope[of] + 2.0 * since * self.curve[of], self.curve[of]
        segments.tone, segments.tone_phase = np.abs(self.phasor)[of], np.angle(self.phasor)[of]
        segments.jump, segments.shakes = np.where(since == 0.0, self.jump[of], 0.0), self.shakes[of]


@dataclass(frozen=True, eq=False)
class GroundUnderLayers:
    """The velocity of the ground under layers, whose echoes are many."""

    ground: Ground
    brings_inflow: bool = False

    @classmethod
    def of(cls, problem: Problem) -> GroundUnderLayers:
        """Return the ground of a problem."""
        return cls(moving(problem))

    @property
    def start(self) -> Floats:
        """Times (s) at which pieces of its motion begin."""
        return self.ground.start

    def put(self, segments: Any, start: Floats) -> None:
        """Write the velocity of the ground into segments that begin at times (s)."""
        middle = start + 0.5 * np.diff(np.append(start, start[-1] + 1.0))
        (value, slope, curve), _, phasor, segments.shakes = _moved(self.ground, start, middle)
        segments.ground, segments.ground_slope, segments.ground_curve = value, slope, curve
        segments.ground_tone, segments.ground_phase = np.abs(phasor), np.angle(phasor)
        segments.jump = np.maximum(segments.jump, _jumps(start, np.array([value, slope, curve]), phasor, self.ground.tone))


def moving(problem: Problem) -> Ground:
    """Return the motion of the ground, which moves."""
    assert problem.ground is not None
    return problem.ground


def _shaking_of(problem: Problem, ground: Ground, driver: Inflow) -> Shaking:
    body = problem.body
    delay, trip = 0.5 * body.round_trip_time, body.round_trip_time
    lates = (0.0, trip) if driver.reflection.any() else (0.0,)
    starts = [driver.start[driver.start > delay], np.array([0.0, delay]), *(ground.start + late for late in lates)]
    start = _without_doubles(np.concatenate(starts), trip)
    middle = start + 0.5 * np.diff(np.append(start, start[-1] + trip))  # which segment holds, whatever the rounding of its start
    known = _driven(driver, start, middle)  # as if it had come since the start, to tell where the inflow jumps
    all_straight, phasor = known.copy(), np.zeros(len(start), complex)
    all_straight[:, middle < delay] = 0.0
    if driver.tone.amplitude != 0.0:
        gain = driver.gain[driver.segment(middle)]
        phasor += np.where(middle < delay, 0.0, gain * driver.tone.amplitude * np.exp(1j * driver.tone.phase))
    shakes = np.zeros(len(start))
    for late in lates:
        share = driver.reflection_at(middle) if late > 0.0 else -np.ones(len(start))
        impedance, mass = share * body.impedance, (-share if late > 0.0 else share) * body.inertia
        velocity, acceleration, swing, moving = _moved(ground, start - late, middle - late)
        known += impedance * velocity + mass * acceleration
        all_straight += impedance * velocity + mass * acceleration
        phasor += (impedance + 1j * ground.tone.frequency * mass) * swing * np.exp(-1j * ground.tone.frequency * late)
        shakes = np.maximum(shakes, moving)
    value, slope, curve = all_straight
    return Shaking(start, value, slope, curve, phasor, _jumps(start, known, phasor, tone_of(problem)), shakes)


def _without_doubles(start: Floats, trip: float) -> Floats:
    """Return times (s) in order, those that differ by rounding as one."""
    start = np.unique(start)
    return start[np.append(True, np.diff(start) > max(1e-13 * trip, 8.0 * float(np.spacing(start[-1]))))]


def _driven(driver: Inflow, start: Floats, middle: Floats) -> Floats:
    """Return value, slope and curve (rows) of the driver's inflow at times (s), each in the segment that holds at `middle`."""
    n = driver.segment(middle)
    return np.array([driver.value[n] + driver.slope[n] * (start - driver.start[n]), driver.slope[n], np.zeros(len(n))])


def _moved(ground: Ground, start: Floats, middle: Floats) -> tuple[Floats, Floats, Floats, Floats]:
    """Return value, slope and curve (rows) of the ground's velocity and acceleration at times (s), and the velocity's phasor.

    The last result is 1 where the ground moves and 0 where it rests.
    """
    n = np.maximum(np.searchsorted(ground.start, middle, side="right") - 1, 0)
    since, begun = start - ground.start[n], middle >= 0.0
    v = ground.velocity[n] + since * (ground.acceleration[n] + 0.5 * since * ground.jerk[n])
    v[np.abs(v) <= STILL_GROUND * np.abs(ground.velocity).max()] = 0.0
    a = ground.acceleration[n] + since * ground.jerk[n]
    velocity = np.array([v, a, 0.5 * ground.jerk[n]]) * begun
    acceleration = np.array([a, ground.jerk[n], np.zeros(len(n))]) * begun
    phasor = ground.tone.amplitude * np.exp(1j * ground.tone.phase) * begun
    return velocity, acceleration, phasor, ((velocity != 0.0).any(axis=0) | (phasor != 0.0)).astype(float)


def _jumps(start: Floats, straight: Floats, phasor: Floats, tone: Tone) -> Floats:
    """Return 1 where the inflow jumps as a segment begins, and 0 elsewhere."""
    lasting = np.diff(start)
    value, slope, curve = straight
    begins = value + (phasor * np.exp(1j * tone.frequency * start)).imag
    ends = value[:-1] + lasting * (slope[:-1] + lasting * curve[:-1]) + (phasor[:-1] * np.exp(1j * tone.frequency * start[1:])).imag
    size = np.abs(begins).max()
    return np.append(0.0, np.abs(begins[1:] - ends) > 1e-12 * size)
