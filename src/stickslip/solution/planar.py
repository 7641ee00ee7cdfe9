"""What a user gets from a run of a planar slab: the motion of the contact at frames in time."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from stickslip.planar.slab import PlanarSlab

if TYPE_CHECKING:
    import xarray as xr

Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class PlanarSolution:
    """The motion of the contact of a planar slab. Arrays have time first, then the axes of the contact.

    Parameters
    ----------
    slab
        What was solved.
    times
        Times of the frames (s).
    slip
        Slip (m).
    slip_rate
        Slip rate (m/s), after a jump where there is one.
    traction
        Friction while a node slips, and the load that it bears while it rests (Pa).
    heat
        Work of friction since the start (J/m^2).
    steps_per_round_trip
        Number of time steps in a two-way travel time.
    status
        What ended the run.
    """

    slab: PlanarSlab
    times: Floats
    slip: Floats
    slip_rate: Floats
    traction: Floats
    heat: Floats
    steps_per_round_trip: int
    status: str = "finished"

    def __repr__(self) -> str:
        nodes = " x ".join(str(count) for count in self.slab.shape)
        return f"PlanarSolution({nodes} nodes, {len(self.times)} frames up to {self.times[-1]:.6g} s, {self.status})"

    def dataset(self) -> xr.Dataset:
        """Return slip, slip rate, traction and heat as an xarray dataset over time, y and, for a plane, z (SI units)."""
        import xarray

        axes = ("time", "y", "z")[: self.slip.ndim]
        units = {"slip": "m", "slip_rate": "m s-1", "traction": "Pa", "heat": "J m-2"}
        fields = {name: (axes, getattr(self, name), {"units": unit}) for name, unit in units.items()}
        places = {"time": self.times, "y": self.slab.y} | ({"z": self.slab.z} if self.slab.is_plane else {})
        made = xarray.Dataset(fields, coords=places)
        for axis in axes:
            made[axis].attrs["units"] = "s" if axis == "time" else "m"
        return made
