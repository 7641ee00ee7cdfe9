"""The spring-block under Coulomb friction: a sinusoidal slip rate, until it returns to zero.

Source: Campillo et al. 1996, eqs (4)-(6). A block released at its static strength obeys
m u'' + K u = (static - dynamic) S + K V t with u(0) = u'(0) = 0.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray


@dataclass(frozen=True)
class CoulombBlock:
    """One slip event of a spring-block under Coulomb friction.

    Parameters
    ----------
    mass : float
        Mass m (kg).
    stiffness : float
        Stiffness K (N/m).
    normal_force : float
        Normal force S (N).
    static, dynamic : float
        Friction coefficients at rest and while slipping.
    pull_rate : float
        Pull rate V (m/s); 0 means the limit 0+.
    """

    mass: float
    stiffness: float
    normal_force: float
    static: float
    dynamic: float
    pull_rate: float = 0.0

    @property
    def frequency(self) -> float:
        """Return the angular frequency sqrt(K / m) (rad/s)."""
        return math.sqrt(self.stiffness / self.mass)

    @property
    def swing(self) -> float:
        """Return (static - dynamic) S / sqrt(K m) (m/s), the peak slip rate for pull_rate 0."""
        return (self.static - self.dynamic) * self.normal_force / math.sqrt(self.stiffness * self.mass)

    @property
    def duration(self) -> float:
        """Return the time from onset to arrest (s); it is pi sqrt(m / K) for pull_rate 0."""
        return 2.0 * (math.pi - math.atan2(self.swing, self.pull_rate)) / self.frequency

    @property
    def peak_time(self) -> float:
        """Return the time from onset to the largest slip rate (s)."""
        return (math.pi - math.atan2(self.swing, self.pull_rate)) / self.frequency

    @property
    def peak_rate(self) -> float:
        """Return the largest slip rate (m/s)."""
        return self.pull_rate + math.hypot(self.swing, self.pull_rate)

    @property
    def total_slip(self) -> float:
        """Return the slip of the event (m); it is 2 (static - dynamic) S / K for pull_rate 0."""
        return float(self.slip(self.duration))

    def slip(self, t: ArrayLike) -> NDArray[np.float64]:
        """Return the slip since onset (m) at times t (s) after onset, of the shape of t."""
        phase = self.frequency * np.clip(t, 0.0, self.duration)
        return (2.0 * self.swing * np.sin(0.5 * phase) ** 2 + self.pull_rate * (phase - np.sin(phase))) / self.frequency

    def slip_rate(self, t: ArrayLike) -> NDArray[np.float64]:
        """Return the slip rate v(t) (m/s) at times t (s) after onset, of the shape of t; 0 before onset and from arrest on."""
        phase = self.frequency * np.clip(t, 0.0, self.duration)
        moving = (np.asarray(t) >= 0.0) & (np.asarray(t) < self.duration)
        return np.where(moving, self.swing * np.sin(phase) + 2.0 * self.pull_rate * np.sin(0.5 * phase) ** 2, 0.0)
