"""Coulomb friction on the elastic slab under a rigid driver: one pulse that lasts a round trip.

Source: Campillo et al. 1996, eqs (12)-(13) with the limit alpha -> infinity of (15). Slip starts at the static strength; until
the first echo Z v = (static - dynamic) S + G V t / h, and the echo of that start puts the contact to rest.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray


@dataclass(frozen=True)
class CoulombSlab:
    """Density (kg/m^3), wave speed (m/s), thickness (m), normal stress (Pa), two coefficients, pull rate (m/s; 0: its limit 0+).

    The echo arrests the contact as long as pull_rate <= slip_rate_at_start / 2 and the load stays within the static strength.
    """

    density: float
    wave_speed: float
    thickness: float
    normal_stress: float
    static: float
    dynamic: float
    pull_rate: float = 0.0

    @property
    def impedance(self) -> float:
        """Z = rho c (Pa s/m)."""
        return self.density * self.wave_speed

    @property
    def duration(self) -> float:
        """Time from onset to arrest: one round trip R = 2 h / c (s)."""
        return 2.0 * self.thickness / self.wave_speed

    @property
    def drop(self) -> float:
        """Static minus dynamic strength (Pa)."""
        return (self.static - self.dynamic) * self.normal_stress

    @property
    def loading_rate(self) -> float:
        """G V / h (Pa/s)."""
        return self.density * self.wave_speed**2 * self.pull_rate / self.thickness

    def slip_rate(self, t: ArrayLike) -> NDArray[np.float64]:
        """v(t) in m/s, t in s after onset; right limits."""
        t = np.asarray(t, float)
        moving = (t >= 0.0) & (t < self.duration)
        return np.where(moving, (self.drop + self.loading_rate * t) / self.impedance, 0.0)

    def slip(self, t: ArrayLike) -> NDArray[np.float64]:
        """Slip since onset, in m."""
        t = np.clip(t, 0.0, self.duration)
        return (self.drop * t + 0.5 * self.loading_rate * t**2) / self.impedance

    @property
    def total_slip(self) -> float:
        """Slip of the event (m); 2 (static - dynamic) S h / G for pull_rate 0."""
        return float(self.slip(self.duration))

    @property
    def end_load(self) -> float:
        """Load right after arrest (Pa): S (2 dynamic - static) + 2 Z V."""
        return (2.0 * self.dynamic - self.static) * self.normal_stress + 2.0 * self.impedance * self.pull_rate
