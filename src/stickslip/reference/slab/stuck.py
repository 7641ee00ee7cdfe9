"""The load on a contact that stays stuck, under a driver of any impedance.

With v = 0 the recursion of the slab, which is paper eq. (13) extended to a driver of finite impedance Zd, is

    beta(t) = -r beta(t - R) + 2 Z [Zd V + s(t - h/c)] / (Z + Zd),    r = (Z - Zd) / (Z + Zd),    s(t) = far_stress + rate t

and sums to a geometric series. The load is linear in time for a rigid driver (r = -1); otherwise it tends to far_stress + Zd V,
and follows the drift of the far stress.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray


@dataclass(frozen=True)
class StuckSlab:
    """A slab whose contact stays stuck.

    Parameters
    ----------
    density : float
        Density (kg/m^3).
    wave_speed : float
        Wave speed c (m/s).
    thickness : float
        Thickness h (m).
    driver_impedance : float
        Impedance Zd of the driver (Pa s/m), inf for a rigid one.
    initial_load : float
        Initial load tau0 (Pa).
    pull_rate : float
        Pull rate V (m/s).
    far_stress, far_stress_rate : float
        Far stress (Pa) and its rate (Pa/s); they have no effect under a rigid driver.
    """

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
        """Return the impedance Z = rho c (Pa s/m)."""
        return self.density * self.wave_speed

    @property
    def two_way_time(self) -> float:
        """Return the two-way travel time R = 2 h / c (s)."""
        return 2.0 * self.thickness / self.wave_speed

    @property
    def loading_rate(self) -> float:
        """Return the loading rate G V / h (Pa/s)."""
        return self.density * self.wave_speed**2 * self.pull_rate / self.thickness

    def load(self, t: ArrayLike) -> NDArray[np.float64]:
        """Return the load beta(t) (Pa) at times t >= 0 (s), of the shape of t; right limits at jumps."""
        t = np.asarray(t, float)
        if math.isinf(self.driver_impedance):
            return self.initial_load + self.loading_rate * t
        trips = np.floor(t / self.two_way_time)
        factor = -self._reflection
        power = factor**trips
        # `ones` and `indices` are the sums over k < trips of factor^k and of k factor^k; factor < 1
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
        """Return beta for 0 <= t < R: the uniform ramp until h/c, then the reflection of the start w(-y) = G V y / h - tau0."""
        early = self.initial_load + self.loading_rate * t
        late = self._reflection * (self.loading_rate * (self.two_way_time - t) - self.initial_load) + self._forcing(t)
        return np.where(t < 0.5 * self.two_way_time, early, late)
