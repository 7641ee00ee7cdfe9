"""Stability of steady sliding under rate-and-state friction: critical stiffness and growth rates of the linearised system.

With s the growth rate, V the slip rate and T = Dc/V, friction responds to a unit disturbance of the slip by
S s/V (a - b / (1 + s T)), for the ageing law and the slip law alike, and the body responds by

    block   m s^2 + damping s + K              (Rice & Ruina 1983, J. Appl. Mech. 50, 343)
    slab    Z s coth(s h/c)                    (rigid driver; G/h for slow disturbances)

The PRZ law, whose steady state is theta = 2 Dc/V, relaxes in the same way.
"""

from __future__ import annotations

import cmath
from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class SteadySliding:
    """Sliding at a constant rate V (m/s) under a rate-and-state law with a characteristic slip distance Dc (m).

    The normal load, masses, dampings and stiffnesses below belong to a block (N, kg, N s/m, N/m), or are all per unit area.

    Source: Rice & Ruina 1983, J. Appl. Mech. 50, 343, for the block; for the slab the same linearised friction meets the waves of
    Campillo et al. 1996, eqs (7)-(13).
    """

    normal: float
    a: float
    b: float
    distance: float
    rate: float

    @property
    def time(self) -> float:
        """The time T = Dc / V in which the state follows the slip rate (s)."""
        return self.distance / self.rate

    def critical_stiffness(self, mass: float = 0.0, damping: float = 0.0) -> float:
        """Return the stiffness (N/m) below which steady sliding of a block is unstable; negative if it is stable at any stiffness.

        `mass` is in kg and `damping` in N s/m.
        The result is (S (b - a) / V - damping) (1 / T + m / (A T^2)) with A = damping + S a / V: Routh's condition on the cubic of
        `block_growth`. Without damping it is S (b - a) / Dc (1 + m V^2 / (S a Dc)), without mass
        S (b - a) / Dc - damping V / Dc, and without both S (b - a) / Dc.
        """
        viscous = damping + self.normal * self.a / self.rate
        fall = self.normal * (self.b - self.a) / self.rate
        return (fall - damping) * (1.0 / self.time + mass / (viscous * self.time * self.time))

    def inertia_of(self, mass: float, damping: float = 0.0) -> float:
        """Return the share (1) that a mass (kg) adds to the critical stiffness of a block: m V^2 / (S a Dc) if undamped."""
        return mass / ((damping + self.normal * self.a / self.rate) * self.time)

    def block_growth(self, stiffness: float, mass: float, damping: float = 0.0) -> complex:
        """Return the complex growth rate (1/s) of the fastest growing disturbance of a block.

        `stiffness` is in N/m, `mass` in kg and `damping` in N s/m. The imaginary part is not negative.
        """
        time, viscous = self.time, damping + self.normal * self.a / self.rate
        fall = self.normal * self.b / self.rate
        cubic = [mass * time, mass + viscous * time, viscous - fall + stiffness * time, stiffness]
        root = max(np.roots(cubic), key=lambda root: root.real)
        return complex(root.real, abs(root.imag))

    def slab_growth(self, impedance: float, half_time: float) -> complex:
        """Return the complex growth rate (1/s) of a disturbance of a slab under a rigid driver.

        It is the root of S/V (a - b / (1 + s T)) + Z coth(s h/c) = 0 reached from that of the block of stiffness G/h = Z c/h and
        of a third of the slab's mass. `impedance` is Z (Pa s/m), and `half_time` is h/c (s).
        """
        from scipy.optimize import newton  # here, because it takes a quarter of a second to import

        def miss(s: complex) -> complex:
            friction = self.normal / self.rate * (self.a - self.b / (1.0 + s * self.time))
            return friction + impedance / cmath.tanh(s * half_time)

        start = self.block_growth(impedance / half_time, impedance * half_time / 3.0)
        found = newton(miss, start, x1=start * (1.0 + 1e-6), tol=1e-300, rtol=1e-13, maxiter=100, disp=False)
        return complex(found)
