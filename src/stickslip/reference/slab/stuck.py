"""The load on a contact that stays stuck, under a driver of any impedance.

With v = 0 the recursion of the slab, which is paper eq. (13) extended to a driver of finite impedance Zd, is

    beta(t) = -r beta(t - R) + 2 Z [Zd V + s(t - h/c)] / (Z + Zd),    r = (Z - Zd) / (Z + Zd),    s(t) = far_stress + rate t

and sums to a geometric series. The load is linear in time for a rigid driver (r = -1); otherwise it tends to far_stress + Zd V,
and follows the drift of the far stress.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stickslip.bodies import ElasticSlab


@dataclass(frozen=True)
class StuckSlab:
    """A slab whose contact stays stuck, from an initial load tau0 (Pa), under a pull rate V (m/s) or a far stress (Pa, and Pa/s).

    Nothing checks that the load stays within the static strength, beyond which the contact would slip. The far stress has no effect
    under a rigid driver.

    Source: Campillo et al. 1996, eq. (13), extended to a driver of finite impedance.
    """

    body: ElasticSlab
    initial_load: float
    pull_rate: float
    far_stress: float = 0.0
    far_stress_rate: float = 0.0

    @property
    def loading_rate(self) -> float:
        """The loading rate G V / h (Pa/s)."""
        return self.body.stiffness * self.pull_rate

    def load(self, t: ArrayLike) -> NDArray[np.float64]:
        """Return the load beta(t) (Pa) at times t >= 0 (s), of the shape of t; right limits at jumps."""
        t = np.asarray(t, float)
        if self.body.is_driven_rigidly:
            return self.initial_load + self.loading_rate * t
        trips = np.floor(t / self.body.two_way_time)
        factor = -self.body.reflection
        power = factor**trips
        # `ones` and `indices` are the sums over k < trips of factor^k and of k factor^k; factor < 1
        ones = (1.0 - power) / (1.0 - factor)
        indices = (factor - trips * power + (trips - 1.0) * power * factor) / (1.0 - factor) ** 2
        forcing = self._forcing(t) * ones - self._forcing_rate * self.body.two_way_time * indices
        return power * self._first_trip(t - trips * self.body.two_way_time) + forcing

    @property
    def _passed(self) -> float:
        """The share 2 Z / (Z + Zd) of a stress beyond the driver that reaches the contact as load."""
        return 2.0 * self.body.impedance / (self.body.impedance + self.body.driver_impedance)

    @property
    def _forcing_rate(self) -> float:
        return self._passed * self.far_stress_rate

    def _forcing(self, t: NDArray[np.float64]) -> NDArray[np.float64]:
        far = self.body.driver_impedance * self.pull_rate + self.far_stress
        return self._passed * far + self._forcing_rate * (t - 0.5 * self.body.two_way_time)

    def _first_trip(self, t: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return beta for 0 <= t < R: the uniform ramp until h/c, then the reflection of the start w(-y) = G V y / h - tau0."""
        trip = self.body.two_way_time
        early = self.initial_load + self.loading_rate * t
        late = self.body.reflection * (self.loading_rate * (trip - t) - self.initial_load) + self._forcing(t)
        return np.where(t < 0.5 * trip, early, late)
