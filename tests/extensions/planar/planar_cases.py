"""Cases for the reference methods of the planar slab, in units in which rho = c = h = 1."""

from __future__ import annotations

from math import inf
from typing import Any

import numpy as np

from tests.extensions.planar.planar_methods import PlanarCase, PlanarSeries, SlipWeakeningAtNodes


def weakening_patch(nodes: int = 64, driver_impedance: float = inf, **more: Any) -> PlanarCase:
    """Linear slip weakening; a smooth peak of the load starts slip, which then spreads, is loaded by echoes, and arrests."""
    y = np.arange(nodes) / nodes * 4.0 - 2.0
    load = 1.0 + 0.3 * np.exp(-((y / 0.4) ** 2)) + 0.03 * np.sin(0.5 * np.pi * y)
    friction = SlipWeakeningAtNodes((nodes,), 1.1, 0.55 + 0.05 * np.cos(np.pi * y), 0.8)
    return PlanarCase(1.0, 1.0, 1.0, (4.0,), load, friction, driver_impedance=driver_impedance, **more)


def weakening_plane(nodes: int = 16) -> PlanarCase:
    """The same in 3D, with a load that depends on y and z in different ways."""
    y, z = np.meshgrid(np.arange(nodes) / nodes * 4.0 - 2.0, np.arange(nodes) / nodes * 3.0 - 1.5, indexing="ij")
    load = 1.0 + 0.4 * np.exp(-((y / 0.5) ** 2) - (z / 0.7) ** 2) + 0.03 * np.sin(0.5 * np.pi * y)
    return PlanarCase(1.0, 1.0, 1.0, (4.0, 3.0), load, SlipWeakeningAtNodes((nodes, nodes), 1.1, 0.5, 0.8))


def slip_difference(one: PlanarSeries, other: PlanarSeries) -> float:
    """Largest difference of slip at the times that both share, over the largest slip."""
    every = [max((len(run.times) - 1) // (min(len(one.times), len(other.times)) - 1), 1) for run in (one, other)]
    return float(np.abs(one.slip[:: every[0]] - other.slip[:: every[1]]).max() / np.abs(other.slip).max())
