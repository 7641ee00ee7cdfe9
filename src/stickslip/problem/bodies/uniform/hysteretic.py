"""A damper at the free top of a column that damps its first two modes alike, as the hysteresis of soil does.

A mass hangs on the top through a dashpot D: it resists slow motion as a mass and fast motion as the dashpot. So a column that
slides as a whole is not braked. With s in units of the travel time, d = D/Z, and m the share of the mass, which is taken from the
column, mode n of a column that sticks at its base is a root of

    1 + r(s) exp(-2 s (1 - m)) = 0,    r = (1 - z) / (1 + z),    z = d s m / (d + s m)

That modes 1 and 2 are w (-zeta + i sqrt(1 - zeta^2)) makes two complex equations for d, m and both w (docs/theory).
"""

from __future__ import annotations

import math
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from stickslip.foundation.arrays import Floats

LARGEST_DAMPING, EASY, APART = 0.2, 0.15, 0.005
"""Largest damping ratio of modes 1 and 2 that one damper gives (1): none does soon above it, where two roots meet. Up to the second
the root is found from that of small ratios; beyond it is followed in steps of the third."""


class Damper(NamedTuple):
    """Numbers of the damper of a column, each a share of one of the column's."""

    dashpot: float
    """Its D over the impedance Z of the waves."""
    mass: float
    """Its mass over that of the column."""
    stretch: float
    """Factor of the travel time that gives mode 1 the period 4 h/c."""


@lru_cache(maxsize=256)
def damper_of(damping_ratio: float) -> Damper:
    """Return the damper that gives modes 1 and 2 a damping ratio (1), at most LARGEST_DAMPING; without damping there is none."""
    if damping_ratio == 0.0:
        return Damper(0.0, 0.0, 1.0)
    from scipy.optimize import fsolve  # here, because it takes a quarter of a second to import

    easy = min(damping_ratio, EASY)
    d = 2.0 * math.pi * easy / (1.0 + easy)
    found = np.array([1.0, 0.37, 0.5 * math.pi * (1.0 + 0.55 * easy), 1.5 * math.pi * (1.0 + 1.5 * easy)])
    for zeta in np.linspace(easy, damping_ratio, max(math.ceil((damping_ratio - EASY) / APART), 0) + 1):
        found = fsolve(_missed, found, (zeta, d), xtol=1e-12)
    return Damper(d * float(found[0]), d * float(found[1]), float(found[2]) / (0.5 * math.pi))


def _missed(unknown: Floats, zeta: float, unit: float) -> Floats:
    """Return by how much modes 1 and 2 miss their equation; d and m are in a unit of their size."""
    (d, m), s = unit * unknown[:2], unknown[2:] * complex(-zeta, math.sqrt(1.0 - zeta * zeta))
    slower, way = s * m / d, np.exp(s * (1.0 - m))
    missed = (((1.0 + d) * slower + 1.0) * way + ((1.0 - d) * slower + 1.0) / way) / unit
    return np.concatenate([missed.real, missed.imag])
