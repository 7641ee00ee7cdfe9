"""Creep of a block under a law of slip: how it swings about its moving equilibrium, for ever if nothing damps it.

In the direction of slip a block obeys  m u'' + c u' + K u + F(u) = load_0 + K V t,  F(u) = S mu(u) beyond its first value. Where
k = K + F'(u) > 0 the slip is u = U + x, a slow motion U(t) and a swing x about it:

    K U + F(U) + c U' + m U'' + F'' a^2 / 4 = load_0 + K V t,      U' = K V / k,    U'' = -F'' U'^2 / k,
    x = -a sin(theta),   theta' = w,   w^2 = k/m - (c/2m)^2.

All of it varies slowly. The *action* J = m w a^2 / 2 of the swing is then an adiabatic invariant (it fades as e^(-c t/m) where the
block is damped), and time as a function of U is explicit. Where the block is damped so much that it does not swing, w is
sqrt(k/m), and theta means nothing: only what is left of the deviation counts.

The contact rests as soon as its rate falls to zero. A swing can therefore never be larger than w a = U'. Where k grows along the
slip, U' falls and a w would grow: each cycle touches rest, and begins again from rest in equilibrium (theta = 0) with w a = U'.
By its expansion in d = F'' U' / (k w) such a cycle lasts 2 pi / w, with w in the middle of its slip, plus (5 pi d)^(3/2) / (3 w):
less than the order of d would have it, because what it loses by arresting early it gains by resting. So

    J = the smallest m U'^2 / (2 w) so far, or J_0 if that is smaller,

covers both, with theta' = w, less that lag where the swing touches rest. Whatever theta is, slip is within the swing of U: that
bounds the error from above, and what is left out of theta is estimated from the terms of second order.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from stickslip.engine.creep.averaged import Strength

SAFETY_OF_TERMS = 4.0
"""Bound of the error as a multiple of the terms that are left out."""
SWINGS = 0.75
"""Square of the damping, as a share of the critical one's, below which a block swings."""
SWING_NODES, SWING_WEIGHTS = (np.asarray(one) for one in np.polynomial.legendre.leggauss(8))
"""Places and weights of Gauss' rule on [-1, 1]."""


class CreepPlace(NamedTuple):
    """The slow motion at one slip U. Slip counts from the start of the leap, in the direction of slip."""

    slip: float  # U, m
    stiffness: float  # k, N/m
    frequency: float  # w, rad/s; NaN where k is not positive
    fades: float  # rate at which a swing fades, 1/s
    swings: bool  # False if the block is damped so much that it does not swing
    rate: float  # U', m/s
    bend: float  # F'', N/m^2
    drift: float  # w' / w^2: the relative change of w in a radian of the swing, or of what stands for w

    @property
    def most(self) -> float:
        """The largest amplitude of a swing (m): one that just touches rest."""
        return self.rate / self.frequency


class Swing(NamedTuple):
    """A swing about the slow motion at one moment."""

    place: CreepPlace
    amplitude: float  # a, m
    angle: float  # theta, rad

    @property
    def slip(self) -> float:
        """The slip, m."""
        return self.place.slip - self.amplitude * math.sin(self.angle)

    @property
    def rate(self) -> float:
        """The slip rate, m/s; 0 where the swing touches rest."""
        place, shrinks = self.place, 0.5 * self.place.drift * self.place.frequency
        swings = self.amplitude * (place.frequency * math.cos(self.angle) - shrinks * math.sin(self.angle))
        return max(place.rate - swings, 0.0)


@dataclass(frozen=True)
class SwingingBlock:
    """A block that creeps under a law of slip, from a moment on; all is seen in the direction of slip."""

    strength: Strength
    mass: float  # kg
    spring: float  # K, N/m
    damping: float  # c, N s/m
    speed: float  # of the driver, m/s
    load: float  # N at that moment, minus the reference strength

    def at(self, slip: float) -> CreepPlace:
        """Return the slow motion at a slip (m)."""
        slope, bend = self.strength.slope_and_curvature(slip)
        k = self.spring + slope
        if not k > 0.0:
            return CreepPlace(slip, k, math.nan, 0.0, False, math.inf, bend, math.nan)
        half, free, rate = 0.5 * self.damping / self.mass, k / self.mass, self.spring * self.speed / k
        rate += self.damping * bend * rate * rate / (k * k)  # less c U'' / k
        swings = half * half < SWINGS * free
        w = math.sqrt(free - half * half if swings else free)
        fades = half if half * half <= free else free / (half + math.sqrt(half * half - free))
        return CreepPlace(slip, k, w, fades, swings, rate, bend, bend * rate / (2.0 * self.mass * w**3))

    def quickness(self, place: CreepPlace) -> float:
        """Return how much the slow motion changes while a swing turns by a radian, or fades: 0 where it is slow."""
        return abs(place.drift) * math.sqrt(1.0 + self.damping * place.frequency / place.stiffness) ** 3

    def action(self, place: CreepPlace, amplitude: float) -> float:
        """Return the action J (J s) of a swing."""
        return 0.5 * self.mass * place.frequency * amplitude**2

    def amplitude(self, place: CreepPlace, action: float) -> float:
        """Return the amplitude (m) of a swing with an action (J s)."""
        return math.sqrt(2.0 * action / (self.mass * place.frequency))

    def time(self, place: CreepPlace, amplitude: float) -> float:
        """Return the time (s) at which the slow motion reaches a place."""
        inertia = -self.mass * place.bend * place.rate**2 / place.stiffness
        small = self.damping * place.rate + inertia + 0.25 * place.bend * amplitude**2
        excess = self.strength(place.slip) + self.spring * place.slip - self.load
        return float((excess + small) / (self.spring * self.speed))

    def start(self, rate: float) -> Swing:
        """Return the swing at the moment when the leap begins, with this slip rate (m/s) and no slip yet."""
        place, amplitude = self.at(0.0), 0.0
        for _ in range(ROUNDS_TO_START):
            if not place.frequency > 0.0:
                break
            off = self.time(place, amplitude) * place.rate
            place = self.at(place.slip - off)
            across = (place.rate - rate) + 0.5 * place.slip * place.drift * place.frequency
            amplitude = math.hypot(place.slip, across / place.frequency)
        if not place.frequency > 0.0:
            return Swing(place, math.nan, math.nan)
        return Swing(place, amplitude, math.atan2(place.slip, across / place.frequency))

    def turns(self, begin: float, end: float) -> float:
        """Return the growth of theta (rad) from one slip of the slow motion to another (m)."""
        half = 0.5 * (end - begin)
        k = self.spring + self.strength.slopes(begin + half * (1.0 + SWING_NODES))
        damped = (0.5 * self.damping / self.mass) ** 2
        w = np.sqrt(np.maximum(k / self.mass - damped, 0.0))
        return half * float(SWING_WEIGHTS @ (w * k)) / (self.spring * self.speed)

    @cached_property
    def scale(self) -> float:
        """The slip (m) of the driver in a radian of the free oscillation."""
        return self.speed * math.sqrt(self.mass / self.spring)


ROUNDS_TO_START = 6
"""Number of rounds that match the slow motion to the load at the start: each gains as many digits as a cycle is short."""
