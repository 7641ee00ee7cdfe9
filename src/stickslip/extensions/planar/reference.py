"""Closed forms for the slab whose friction varies along the contact, under a rigid driver; slip is that of the slab alone.

alpha_w = -S mu'(u) / G (1/m) is the weakening of friction with slip, c the wave speed, h the thickness, G the shear modulus.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]

CRITICAL_PATCH = 1.1577738836977
"""alpha_w times half the length of a weakening patch on a half-space above which slip grows, in 2D.

It is the smallest eigenvalue of |k| on functions that vanish outside the interval from -1 to 1. Source: Dascalu, Ionescu & Campillo
2000, Earth Planet. Sci. Lett. 177, 163 (1.157774); Kwasnicki 2012, J. Funct. Anal. 262, 2379 (the digits).
"""


def growth_rate_on_half_space(weakening: float, wavenumber: float, wave_speed: float) -> float:
    """Return the growth rate (1/s) of slip with a wave number k (1/m): lambda = c sqrt(alpha_w^2 - k^2), 0 if that is imaginary."""
    return wave_speed * math.sqrt(max(weakening**2 - wavenumber**2, 0.0))


def growth_rate_on_slab(weakening: float, wavenumber: float, thickness: float, wave_speed: float) -> float:
    """Return the growth rate (1/s) of slip with a wave number k (1/m) on a slab; 0 if it does not grow.

    Notes
    -----
    u = exp(lambda t) cos(k y) sinh(q (h - x)) solves the wave equation if lambda = c sqrt(q^2 - k^2), and friction at x = 0 if
    q coth(q h) = alpha_w. For k = 0 this is `stickslip.run.reference.slab`.
    """
    from scipy.optimize import brentq  # here, because it takes a quarter of a second to import

    target = weakening * thickness
    if target <= 1.0:
        return 0.0
    qh = brentq(lambda x: x / math.tanh(x) - target, 1e-9, target, xtol=1e-15)
    return wave_speed * math.sqrt(max((qh / thickness) ** 2 - wavenumber**2, 0.0))


@dataclass(frozen=True)
class SteadyFront:
    """A front that runs along a slab at a steady speed below c, with a constant dynamic strength behind it and no process zone.

    Parameters
    ----------
    stress_drop
        Initial load minus dynamic strength (Pa).
    thickness, shear_modulus, wave_speed
        h (m), G (Pa), c (m/s).

    Notes
    -----
    In the coordinate xi = (y - V t) / a, a = sqrt(1 - V^2 / c^2), displacement is harmonic. It vanishes at the contact ahead of the
    front and at the driver; behind the front the stress has dropped. The solution is

        u = (2 drop h / (pi G)) Re arccos(exp(pi (xi + i x) / (2 h))) - drop x / G.

    Behind the front, slip grows towards drop h / G without end: a steady front below c is followed by no healing. Near the front
    the slab holds the energy E = (2 ln 2 / pi) h G0 / a in excess of the states far ahead and far behind. If the front
    accelerates slowly, the energy that feeds this excess is missing at the front: with fracture energy Gc,

        Gc = G0 [1 - (2 ln 2 / pi) (h / c^2) (dV/dt) / a^3].

    So V / a grows linearly in time, as the momentum of a relativistic particle under a constant force. This has the form of the
    equation that Weng & Ampuero 2019 (J. Geophys. Res. 124, 8584) found for a fault of finite width in a full space, with the
    constant of a slab, and the same for fronts that slow down; Goldman, Livne & Fineberg 2010 (Phys. Rev. Lett. 104, 114301) found
    such an inertia for tension in a strip. A process zone that is not short beside h lowers the inertia.
    """

    stress_drop: float
    thickness: float
    shear_modulus: float
    wave_speed: float

    INERTIA = 2.0 * math.log(2.0) / math.pi
    """Inertia of the front: the factor of h / c^2 in the equation of motion."""

    @property
    def final_slip(self) -> float:
        """Slip far behind the front (m)."""
        return self.stress_drop * self.thickness / self.shear_modulus

    @property
    def released_energy(self) -> float:
        """G0 (J/m^2): the energy that the slab releases per area which the front passes, whatever its speed."""
        return 0.5 * self.stress_drop * self.final_slip

    def contraction(self, speed: float) -> float:
        """Return sqrt(1 - V^2 / c^2) for a speed V (m/s)."""
        return math.sqrt(1.0 - (speed / self.wave_speed) ** 2)

    def slip(self, behind: ArrayLike, speed: float) -> Array:
        """Return the slip (m) at distances behind the front (m), 0 ahead of it, where distances are negative."""
        share = np.exp(-np.maximum(behind, 0.0) * math.pi / (2.0 * self.thickness * self.contraction(speed)))
        return np.asarray(2.0 / math.pi * self.final_slip * np.arccos(share))

    def speed(self, time: ArrayLike, fracture_energy: float, first_speed: float) -> Array:
        """Return the speed V (m/s) at times (s) after it was `first_speed`, if fracture energy (J/m^2) is constant.

        A front with G0 < Gc slows down to 0, where it stops.
        """
        force = (1.0 - fracture_energy / self.released_energy) * self.wave_speed**2 / (self.INERTIA * self.thickness)
        momentum = np.maximum(first_speed / self.contraction(first_speed) + force * np.asarray(time), 0.0)
        return np.asarray(momentum / np.hypot(1.0, momentum / self.wave_speed))


def linear_fracture_energy(strength_drop: float, distance: float) -> float:
    """Return Gc (J/m^2) of strength that falls by `strength_drop` (Pa) linearly over a `distance` of slip (m)."""
    return 0.5 * strength_drop * distance
