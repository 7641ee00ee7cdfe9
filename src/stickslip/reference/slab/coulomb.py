"""The elastic slab under Coulomb friction and a rigid driver: one pulse that lasts one round trip.

Source: Campillo et al. 1996, eqs (12)-(13) with the limit alpha -> infinity of (15). Slip starts at the static strength. Until
the first echo Z v = (static - dynamic) S + G V t / h; the echo of the start then arrests the contact.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stickslip.bodies import ElasticSlab


@dataclass(frozen=True)
class CoulombSlab:
    """One slip event of an elastic slab under Coulomb friction, a rigid driver and no contact mass.

    The pull rate V is in m/s; 0 means the limit 0+. The echo arrests the contact as long as the pull rate is at most half the slip
    rate at the start and the load stays within the static strength. Nothing checks these two conditions: outside them the slab
    slips on after the echo, and these formulas do not hold.

    Source: Campillo et al. 1996, eqs (12)-(13), with the limit alpha -> infinity of the rate law (15).
    """

    body: ElasticSlab
    static: float
    dynamic: float
    pull_rate: float = 0.0

    @property
    def duration(self) -> float:
        """The time from onset to arrest (s), which is the two-way travel time R = 2 h / c."""
        return self.body.two_way_time

    @property
    def drop(self) -> float:
        """The static minus the dynamic strength (Pa)."""
        return (self.static - self.dynamic) * self.body.normal_stress

    @property
    def loading_rate(self) -> float:
        """The loading rate G V / h (Pa/s)."""
        return self.body.stiffness * self.pull_rate

    def slip_rate(self, t: ArrayLike) -> NDArray[np.float64]:
        """Return the slip rate v(t) (m/s) at times t (s) after onset, of the shape of t; right limits at jumps."""
        t = np.asarray(t, float)
        moving = (t >= 0.0) & (t < self.duration)
        return np.where(moving, (self.drop + self.loading_rate * t) / self.body.impedance, 0.0)

    def slip(self, t: ArrayLike) -> NDArray[np.float64]:
        """Return the slip since onset (m) at times t (s) after onset, of the shape of t."""
        t = np.clip(t, 0.0, self.duration)
        return (self.drop * t + 0.5 * self.loading_rate * t**2) / self.body.impedance

    @property
    def total_slip(self) -> float:
        """The slip of the event (m); it is 2 (static - dynamic) S h / G for pull_rate 0."""
        return float(self.slip(self.duration))

    @property
    def end_load(self) -> float:
        """The load right after arrest (Pa), S (2 dynamic - static) + 2 Z V."""
        return (2.0 * self.dynamic - self.static) * self.body.normal_stress + 2.0 * self.body.impedance * self.pull_rate
