"""Stability of steady sliding under rate-and-state friction: critical stiffness and growth rates of the linearised system.

With s the growth rate, V the slip rate and T = Dc/V, friction responds to a unit disturbance of the slip by
S s/V (a - b / (1 + s T)), for the ageing law and the slip law alike, and the body responds by

    block   m s^2 + damping s + K              (Rice & Ruina 1983, J. Appl. Mech. 50, 343)
    slab    Z s coth(s h/c)                    (rigid driver; G/h for slow disturbances)

The PRZ law, whose steady state is theta = 2 Dc/V, relaxes in the same way.
"""

from __future__ import annotations

import cmath
from collections.abc import Callable

import numpy as np


def critical_stiffness(
    normal: float, a: float, b: float, distance: float, rate: float, mass: float = 0.0, damping: float = 0.0
) -> float:
    """Return the stiffness K below which steady sliding of a block is unstable.

    Parameters
    ----------
    normal : float
        Normal force S (N).
    a, b : float
        Coefficients of the rate-and-state law.
    distance : float
        Characteristic slip distance Dc (m).
    rate : float
        Slip rate V (m/s).
    mass : float
        Mass m (kg).
    damping : float
        Viscous damping (N s/m).

    Returns
    -------
    float
        Critical stiffness (N/m); negative if sliding is stable at any stiffness.

    Notes
    -----
    Forces, mass, damping and stiffness may also all be per unit area. The result is
    (S (b - a) / V - damping) (1 / T + m / (A T^2)) with A = damping + S a / V and T = Dc / V: Routh's condition on the cubic of
    `block_growth`. Without damping it is S (b - a) / Dc (1 + m V^2 / (S a Dc)), without mass S (b - a) / Dc - damping V / Dc,
    and without both S (b - a) / Dc.
    """
    time = distance / rate
    viscous = damping + normal * a / rate
    return (normal * (b - a) / rate - damping) * (1.0 / time + mass / (viscous * time * time))


def block_growth(
    normal: float, a: float, b: float, distance: float, rate: float, stiffness: float, mass: float, damping: float = 0.0
) -> complex:
    """Return the complex growth rate (1/s) of the fastest growing disturbance of a block's steady sliding.

    Its imaginary part is not negative. The arguments are those of `critical_stiffness`, with the stiffness in N/m.
    """
    time = distance / rate
    viscous = damping + normal * a / rate
    cubic = [mass * time, mass + viscous * time, viscous - normal * b / rate + stiffness * time, stiffness]
    root = max(np.roots(cubic), key=lambda root: root.real)
    return complex(root.real, abs(root.imag))


def slab_growth(normal: float, a: float, b: float, distance: float, rate: float, impedance: float, half_time: float) -> complex:
    """Return the complex growth rate (1/s) of a disturbance of the steady sliding of a slab under a rigid driver.

    It is the root of S/V (a - b / (1 + s T)) + Z coth(s h/c) = 0 reached from that of the block of stiffness G/h = Z c/h and of a
    third of the slab's mass. `normal` is the normal stress (Pa), `impedance` is Z (Pa s/m), and `half_time` is h/c (s); the other
    arguments are those of `critical_stiffness`.
    """
    time = distance / rate

    def miss(s: complex) -> complex:
        return normal / rate * (a - b / (1.0 + s * time)) + impedance / cmath.tanh(s * half_time)

    start = block_growth(normal, a, b, distance, rate, impedance / half_time, impedance * half_time / 3.0)
    return _root(miss, start)


def _root(miss: Callable[[complex], complex], start: complex) -> complex:
    """Find a complex root by the secant method from a start close to it."""
    before, now = start * (1.0 + 1e-6), start
    for _ in range(100):
        low, high = miss(before), miss(now)
        if high == low or abs(now - before) <= 1e-15 * abs(now):
            break
        before, now = now, now - high * (now - before) / (high - low)
    return now
