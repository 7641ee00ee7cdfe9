"""Write the motion of a contact of many nodes at its frames: that of one node as CSV, of all as netCDF."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import stickslip
from stickslip.extensions.planar.stations import Station, node_at
from stickslip.foundation.errors import InputError
from stickslip.solution.files import checked_path, heading, write_columns

if TYPE_CHECKING:
    from stickslip.extensions.planar.solution import PlanarSolution


def write_contact(run: PlanarSolution, path: Path, station: Station | None = None) -> Path:
    """Write the motion of a contact of many nodes at its frames, and return the path; see `PlanarSolution.to_csv`."""
    if checked_path(path).suffix.lower() == ".nc":
        from stickslip.foundation.netcdf_file import write

        if station is not None:
            raise InputError(f"to_csv: {path}: netCDF has all nodes: leave out the station, or write .csv")
        about = {"title": repr(run), "source": f"stickslip {stickslip.__version__}"}
        return write(run.dataset().assign_attrs(about), path)
    place = (slice(None), *node_at(run.slab, station))
    units = {"slip": "m", "slip_rate": "m/s", "traction": "Pa", "heat": "J/m^2"}
    curves = {heading(name, unit): getattr(run, name)[place] for name, unit in units.items()}
    return write_columns(path, {heading("time", "s"): run.times} | curves)
