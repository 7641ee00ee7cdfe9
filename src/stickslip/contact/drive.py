"""What drives a contact at a steady slip rate."""

from __future__ import annotations

from typing import NamedTuple


class SteadyDrive(NamedTuple):
    """What drives a contact at a steady slip rate v, pulled at a rate V: traction = far stresses + by_pull V - resists v."""

    resists: float
    """Impedance of drivers and drag of layers together (Pa s/m); inf if the drivers hold the rate."""
    by_pull: float
    """Impedance through which the pull acts (Pa s/m)."""
    shares: tuple[float, ...] = (1.0,)
    """Share (1) in the traction of the far stress on each side."""
