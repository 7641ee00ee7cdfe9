"""The load on a contact that stays stuck, under a driver of any impedance.

With v = 0 the recursion of the slab, paper eq. (13) and its extension to a driver of finite impedance Zd, is

    beta(t) = -r beta(t - R) + 2 Z [Zd V + s(t - h/c)] / (Z + Zd),    r = (Z - Zd) / (Z + Zd),    s(t) = far_stress + rate t

and sums to a geometric series: linear in time for a rigid driver (r = -1), otherwise towards far_stress + Zd V and its drift.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray


@dataclass(frozen=True)
class StuckSlab:
    """Density (kg/m^3), wave speed (m/s), thickness (m), driver impedance (Pa s/m, inf allowed), initial load (Pa),
    pull rate (m/s), far stress (Pa) and its rate (Pa/s); the far side only counts for a finite driver impedance."""

    density: float
    wave_speed: float
    thickness: float
    driver_impedance: float
    initial_load: float
    pull_rate: float
    far_stress: float = 0.0
    far_stress_rate: float = 0.0

    @property
    def impedance(self) -> float:
        """Z = rho c (Pa s/m)."""
        return self.density * self.wave_speed

    @property
    def two_way_time(self) -> float:
        """R = 2 h / c (s)."""
        return 2.0 * self.thickness / self.wave_speed

    @property
    def loading_rate(self) -> float:
        """G V / h (Pa/s)."""
        return self.density * self.wave_speed**2 * self.pull_rate / self.thickness

    def load(self, t: ArrayLike) -> NDArray[np.float64]:
        """beta(t) in Pa, t >= 0 in s; right limits."""
        t = np.asarray(t, float)
        if math.isinf(self.driver_impedance):
            return self.initial_load + self.loading_rate * t
        trips = np.floor(t / self.two_way_time)
        factor = -self._reflection
        power = factor**trips
        # the sum over k < trips of factor^k (a - b k R), factor < 1
        ones = (1.0 - power) / (1.0 - factor)
        indices = (factor - trips * power + (trips - 1.0) * power * factor) / (1.0 - factor) ** 2
        forcing = self._forcing(t) * ones - self._forcing_rate * self.two_way_time * indices
        return power * self._first_trip(t - trips * self.two_way_time) + forcing

    @property
    def _reflection(self) -> float:
        return (self.impedance - self.driver_impedance) / (self.impedance + self.driver_impedance)

    @property
    def _forcing_rate(self) -> float:
        return 2.0 * self.impedance / (self.impedance + self.driver_impedance) * self.far_stress_rate

    def _forcing(self, t: NDArray[np.float64]) -> NDArray[np.float64]:
        far = self.driver_impedance * self.pull_rate + self.far_stress
        constant = 2.0 * self.impedance / (self.impedance + self.driver_impedance) * far
        return constant + self._forcing_rate * (t - 0.5 * self.two_way_time)

    def _first_trip(self, t: NDArray[np.float64]) -> NDArray[np.float64]:
        """beta for 0 <= t < R: the uniform ramp until h/c, then what the start w(-y) = G V y / h - tau0 brings back."""
        early = self.initial_load + self.loading_rate * t
        late = self._reflection * (self.loading_rate * (self.two_way_time - t) - self.initial_load) + self._forcing(t)
        return np.where(t < 0.5 * self.two_way_time, early, late)
