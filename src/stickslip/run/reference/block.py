"""Slip events of the spring-block in closed form, from rest, under Coulomb friction and under linear slip weakening.

Source: Campillo et al. 1996, eqs (4)-(6). Under Coulomb friction a block that is released at its static strength obeys
m u'' + K u = (muS - muD) S + K V t: its slip rate is sinusoidal until it returns to zero.

Under linear slip weakening (Ida 1972) the slip first grows exponentially. Let E be the excess of the initial load over the static
strength. From rest, m u'' = E + K V t - k u with k = K - S (muS - muD) / Dc < 0 while u < Dc. After that, the slip is a harmonic
oscillation, m u'' = E + S (muS - muD) + K (V t - u), until the slip rate returns to zero.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike
from scipy.optimize import brentq

from stickslip.foundation.arrays import Floats
from stickslip.foundation.errors import InputError
from stickslip.problem.bodies import SpringBlock


@dataclass(frozen=True)
class CoulombBlock:
    """One slip event of a spring-block without damping, under Coulomb friction; a pull rate V (m/s) of 0 means the limit 0+.

    The block is released at its static strength. Its initial load, its slip and the path that it has slipped count from there.

    Source: Campillo et al. 1996, eqs (4)-(6), with the limit alpha -> infinity of the rate law (15).
    """

    body: SpringBlock
    static: float
    dynamic: float
    pull_rate: float = 0.0

    @property
    def frequency(self) -> float:
        """The angular frequency sqrt(K / m) (rad/s)."""
        return math.sqrt(self.body.stiffness / self.body.mass)

    @property
    def swing(self) -> float:
        """(static - dynamic) S / sqrt(K m) (m/s), the peak slip rate for pull_rate 0."""
        return (self.static - self.dynamic) * self.body.normal_force / math.sqrt(self.body.stiffness * self.body.mass)

    @property
    def duration(self) -> float:
        """The time from onset to arrest (s); it is pi sqrt(m / K) for pull_rate 0."""
        return 2.0 * self.peak_time

    @property
    def peak_time(self) -> float:
        """The time from onset to the largest slip rate (s)."""
        return (math.pi - math.atan2(self.swing, self.pull_rate)) / self.frequency

    @property
    def peak_rate(self) -> float:
        """The largest slip rate (m/s)."""
        return self.pull_rate + math.hypot(self.swing, self.pull_rate)

    @property
    def total_slip(self) -> float:
        """The slip of the event (m); it is 2 (static - dynamic) S / K for pull_rate 0."""
        return float(self.slip(self.duration))

    def slip(self, t: ArrayLike) -> Floats:
        """Return the slip since onset (m) at times t (s) after onset, of the shape of t."""
        phase = self.frequency * np.clip(t, 0.0, self.duration)
        return (2.0 * self.swing * np.sin(0.5 * phase) ** 2 + self.pull_rate * (phase - np.sin(phase))) / self.frequency

    def slip_rate(self, t: ArrayLike) -> Floats:
        """Return the slip rate v(t) (m/s) at times t (s) after onset, of the shape of t; 0 before onset and from arrest on."""
        phase = self.frequency * np.clip(t, 0.0, self.duration)
        moving = (np.asarray(t) >= 0.0) & (np.asarray(t) < self.duration)
        return np.where(moving, self.swing * np.sin(phase) + 2.0 * self.pull_rate * np.sin(0.5 * phase) ** 2, 0.0)


@dataclass(frozen=True)
class LinearBlock:
    """One slip event of a spring-block without damping, under linear slip weakening over the distance Dc (m).

    The pull rate is V (m/s), and `excess` is that of the initial load over the static strength (N). The slip grows exponentially
    until it reaches the weakening distance, and oscillates harmonically after that. Raises InputError if the spring is at least as
    stiff as the law weakens (there is no growth then), or if nothing sets the block in motion.

    Source: Campillo et al. 1996, eqs (4)-(6); the law is from Ida 1972, J. Geophys. Res. 77, 3796.
    """

    body: SpringBlock
    static: float
    dynamic: float
    distance: float
    pull_rate: float = 0.0
    excess: float = 0.0

    def __post_init__(self) -> None:
        if self.weakening <= self.body.stiffness:
            raise InputError("LinearBlock: S (static - dynamic) / distance must exceed the stiffness")
        if min(self.pull_rate, self.excess) < 0.0 or max(self.pull_rate, self.excess) == 0.0:
            raise InputError("LinearBlock: give a pull_rate > 0 or an excess > 0")

    @property
    def weakening(self) -> float:
        """The weakening rate S (muS - muD) / Dc (N/m)."""
        return self.body.normal_force * (self.static - self.dynamic) / self.distance

    @property
    def growth(self) -> float:
        """The rate of the exponential growth (1/s)."""
        return math.sqrt((self.weakening - self.body.stiffness) / self.body.mass)

    @property
    def frequency(self) -> float:
        """The angular frequency sqrt(K / m) (rad/s)."""
        return math.sqrt(self.body.stiffness / self.body.mass)

    @cached_property
    def knot_time(self) -> float:
        """The time from onset at which the slip reaches the weakening distance (s)."""
        late = 1.0 / self.growth
        while self._growing(late)[0] < self.distance:
            late *= 2.0
        found: float = brentq(lambda t: float(self._growing(t)[0]) - self.distance, 0.0, late, xtol=1e-300)
        return found

    @cached_property
    def duration(self) -> float:
        """The time from onset to arrest (s); inf if the block never stops."""
        # v = V + R sin(phase) is positive at the knot, and negative at the bottom of the sine unless V >= R
        _, sine, cosine = self._swing
        bottom = (1.5 * math.pi - math.atan2(cosine, sine)) % (2.0 * math.pi) / self.frequency
        top = bottom - math.pi / self.frequency
        if math.hypot(sine, cosine) <= self.pull_rate:
            return math.inf
        stop = brentq(lambda t: float(self._swinging(t)[1]), max(top, 0.0), bottom, xtol=1e-300)
        return self.knot_time + float(stop)

    @property
    def total_slip(self) -> float:
        """The slip of the event (m)."""
        return float(self.slip(self.duration))

    def slip(self, t: ArrayLike) -> Floats:
        """Return the slip since onset (m) at times t (s) after onset, of the shape of t."""
        t = np.clip(t, 0.0, self.duration)
        early, late = self._growing(np.minimum(t, self.knot_time)), self._swinging(np.maximum(t - self.knot_time, 0.0))
        return np.where(t < self.knot_time, early[0], late[0])

    def slip_rate(self, t: ArrayLike) -> Floats:
        """Return the slip rate v(t) (m/s) at times t (s) after onset, of the shape of t; 0 before onset and from arrest on."""
        t = np.asarray(t, float)
        early, late = self._growing(np.clip(t, 0.0, self.knot_time)), self._swinging(np.maximum(t - self.knot_time, 0.0))
        return np.where((t < 0.0) | (t >= self.duration), 0.0, np.where(t < self.knot_time, early[1], late[1]))

    def _growing(self, t: ArrayLike) -> tuple[Floats, Floats]:
        """Return slip (m) and slip rate (m/s) at time t (s) after onset, while friction falls."""
        fall, ramp = self.weakening - self.body.stiffness, self.body.stiffness * self.pull_rate
        x = self.growth * np.asarray(t, float)
        swell = 2.0 * np.sinh(0.5 * x) ** 2
        slip = (self.excess * swell + ramp / self.growth * (np.sinh(x) - x)) / fall
        return slip, (self.excess * self.growth * np.sinh(x) + ramp * swell) / fall

    @cached_property
    def _swing(self) -> tuple[float, float, float]:
        """The slip (m) about which the block oscillates after the knot, and the sine and cosine part of its rate (m/s)."""
        slip, rate = self._growing(self.knot_time)
        steady = (self.excess + self.weakening * self.distance) / self.body.stiffness + self.pull_rate * self.knot_time
        return steady, (steady - float(slip)) * self.frequency, float(rate) - self.pull_rate

    def _swinging(self, t: ArrayLike) -> tuple[Floats, Floats]:
        """Return slip (m) and slip rate (m/s) at time t (s) after the knot, with v = V + sine sin(w t) + cosine cos(w t)."""
        steady, sine, cosine = self._swing
        t = np.asarray(t, float)
        phase = self.frequency * t
        slip = steady + self.pull_rate * t + (cosine * np.sin(phase) - sine * np.cos(phase)) / self.frequency
        return slip, self.pull_rate + sine * np.sin(phase) + cosine * np.cos(phase)
