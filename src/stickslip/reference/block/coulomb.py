"""Coulomb friction on the spring-block: a sine that ends where the slip rate returns to zero.

Source: Campillo et al. 1996, eqs (4)-(6). From the static strength m u'' + K u = (static - dynamic) S + K V t, u(0) = u'(0) = 0.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray


@dataclass(frozen=True)
class CoulombBlock:
    """Mass (kg), stiffness (N/m), normal force (N), two coefficients, pull rate (m/s; 0 means its limit 0+)."""

    mass: float
    stiffness: float
    normal_force: float
    static: float
    dynamic: float
    pull_rate: float = 0.0

    @property
    def frequency(self) -> float:
        """sqrt(K / m), in rad/s."""
        return math.sqrt(self.stiffness / self.mass)

    @property
    def swing(self) -> float:
        """(static - dynamic) S / sqrt(K m), in m/s: the peak rate for pull_rate 0."""
        return (self.static - self.dynamic) * self.normal_force / math.sqrt(self.stiffness * self.mass)

    @property
    def duration(self) -> float:
        """Time from onset to arrest (s): pi sqrt(m / K) for pull_rate 0."""
        return 2.0 * (math.pi - math.atan2(self.swing, self.pull_rate)) / self.frequency

    @property
    def peak_time(self) -> float:
        """Time of the largest slip rate (s)."""
        return (math.pi - math.atan2(self.swing, self.pull_rate)) / self.frequency

    @property
    def peak_rate(self) -> float:
        """Largest slip rate (m/s)."""
        return self.pull_rate + math.hypot(self.swing, self.pull_rate)

    @property
    def total_slip(self) -> float:
        """Slip of the event (m): 2 (static - dynamic) S / K for pull_rate 0."""
        return float(self.slip(self.duration))

    def slip(self, t: ArrayLike) -> NDArray[np.float64]:
        """Slip since onset (m), t in s after onset."""
        phase = self.frequency * np.clip(t, 0.0, self.duration)
        return (2.0 * self.swing * np.sin(0.5 * phase) ** 2 + self.pull_rate * (phase - np.sin(phase))) / self.frequency

    def slip_rate(self, t: ArrayLike) -> NDArray[np.float64]:
        """v(t) in m/s."""
        phase = self.frequency * np.clip(t, 0.0, self.duration)
        moving = (np.asarray(t) >= 0.0) & (np.asarray(t) < self.duration)
        return np.where(moving, self.swing * np.sin(phase) + 2.0 * self.pull_rate * np.sin(0.5 * phase) ** 2, 0.0)
