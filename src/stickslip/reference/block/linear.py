"""The spring-block under linear slip weakening: exponential growth up to the weakening distance, then a harmonic oscillation.

Source: Campillo et al. 1996, eqs (4)-(6), with the linear law of Ida (1972). Let E be the excess of the initial load over the
static strength. From rest, m u'' = E + K V t - k u with k = K - S (muS - muD) / Dc < 0 while u < Dc. After that,
m u'' = E + S (muS - muD) + K (V t - u) until the slip rate returns to zero.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stickslip.foundation.errors import InputError
from stickslip.reference.bisection import bisect


@dataclass(frozen=True)
class LinearBlock:
    """One slip event of a spring-block under linear slip weakening.

    Parameters
    ----------
    mass : float
        Mass m (kg).
    stiffness : float
        Stiffness K (N/m).
    normal_force : float
        Normal force S (N).
    static, dynamic : float
        Friction coefficients before and after weakening.
    distance : float
        Weakening distance Dc (m).
    pull_rate : float
        Pull rate V (m/s).
    excess : float
        Excess E of the initial load over the static strength (N).

    Raises
    ------
    InputError
        If the spring is at least as stiff as the law weakens (there is no growth then), or if nothing sets the block in motion.
    """

    mass: float
    stiffness: float
    normal_force: float
    static: float
    dynamic: float
    distance: float
    pull_rate: float = 0.0
    excess: float = 0.0

    def __post_init__(self) -> None:
        if self.weakening <= self.stiffness:
            raise InputError("LinearBlock: S (static - dynamic) / distance must exceed the stiffness")
        if min(self.pull_rate, self.excess) < 0.0 or max(self.pull_rate, self.excess) == 0.0:
            raise InputError("LinearBlock: give a pull_rate > 0 or an excess > 0")

    @property
    def weakening(self) -> float:
        """Return the weakening rate S (muS - muD) / Dc (N/m)."""
        return self.normal_force * (self.static - self.dynamic) / self.distance

    @property
    def growth(self) -> float:
        """Return the rate of the exponential growth (1/s)."""
        return math.sqrt((self.weakening - self.stiffness) / self.mass)

    @property
    def frequency(self) -> float:
        """Return the angular frequency sqrt(K / m) (rad/s)."""
        return math.sqrt(self.stiffness / self.mass)

    @cached_property
    def knot_time(self) -> float:
        """Return the time from onset at which the slip reaches the weakening distance (s)."""
        late = 1.0 / self.growth
        while self._growing(late)[0] < self.distance:
            late *= 2.0
        return bisect(lambda t: float(self._growing(t)[0]) - self.distance, 0.0, late)

    @cached_property
    def duration(self) -> float:
        """Return the time from onset to arrest (s); inf if the block never stops."""
        turn = 2.0 * math.pi / self.frequency
        # v = V + R sin(phase) is positive at the knot, and negative at the bottom of the sine unless V >= R
        _, sine, cosine = self._swing
        bottom = (1.5 * math.pi - math.atan2(cosine, sine)) % (2.0 * math.pi) / self.frequency
        top = bottom - 0.5 * turn
        if math.hypot(sine, cosine) <= self.pull_rate:
            return math.inf
        return self.knot_time + bisect(lambda t: float(self._swinging(t)[1]), max(top, 0.0), bottom)

    @property
    def total_slip(self) -> float:
        """Return the slip of the event (m)."""
        return float(self.slip(self.duration))

    def slip(self, t: ArrayLike) -> NDArray[np.float64]:
        """Return the slip since onset (m) at times t (s) after onset, of the shape of t."""
        t = np.clip(t, 0.0, self.duration)
        early, late = self._growing(np.minimum(t, self.knot_time)), self._swinging(np.maximum(t - self.knot_time, 0.0))
        return np.where(t < self.knot_time, early[0], late[0])

    def slip_rate(self, t: ArrayLike) -> NDArray[np.float64]:
        """Return the slip rate v(t) (m/s) at times t (s) after onset, of the shape of t; 0 before onset and from arrest on."""
        t = np.asarray(t, float)
        early, late = self._growing(np.clip(t, 0.0, self.knot_time)), self._swinging(np.maximum(t - self.knot_time, 0.0))
        return np.where((t < 0.0) | (t >= self.duration), 0.0, np.where(t < self.knot_time, early[1], late[1]))

    def _growing(self, t: ArrayLike) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Return slip (m) and slip rate (m/s) at time t (s) after onset, while friction falls."""
        fall, ramp = self.weakening - self.stiffness, self.stiffness * self.pull_rate
        x = self.growth * np.asarray(t, float)
        swell = 2.0 * np.sinh(0.5 * x) ** 2
        slip = (self.excess * swell + ramp / self.growth * (np.sinh(x) - x)) / fall
        return slip, (self.excess * self.growth * np.sinh(x) + ramp * swell) / fall

    @cached_property
    def _swing(self) -> tuple[float, float, float]:
        """Return the slip (m) about which the block oscillates after the knot, and the sine and cosine part of its rate (m/s)."""
        slip, rate = self._growing(self.knot_time)
        steady = (self.excess + self.weakening * self.distance) / self.stiffness + self.pull_rate * self.knot_time
        return steady, (steady - float(slip)) * self.frequency, float(rate) - self.pull_rate

    def _swinging(self, t: ArrayLike) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Return slip (m) and slip rate (m/s) at time t (s) after the knot, with v = V + sine sin(w t) + cosine cos(w t)."""
        steady, sine, cosine = self._swing
        t = np.asarray(t, float)
        phase = self.frequency * t
        slip = steady + self.pull_rate * t + (cosine * np.sin(phase) - sine * np.cos(phase)) / self.frequency
        return slip, self.pull_rate + sine * np.sin(phase) + cosine * np.cos(phase)
