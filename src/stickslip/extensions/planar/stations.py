"""Stations on a contact of many nodes: the motion of one node, as other programs exchange it."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

import stickslip
from stickslip.foundation.atomic_write import write_atomically
from stickslip.foundation.conversion import WithUnit
from stickslip.foundation.errors import InputError
from stickslip.foundation.quantities import Quantity
from stickslip.foundation.show import brief
from stickslip.problem.scenarios import to_table

if TYPE_CHECKING:
    from stickslip.extensions.planar.slab import PlanarSlab
    from stickslip.extensions.planar.solution import PlanarSolution

PLACE_OF_STATION = Quantity("m", "place along the contact")
Station = float | str | WithUnit | tuple[float | str | WithUnit, float | str | WithUnit]
"""A place along y, of a plane along y and z: m, or a text with units, as in "8 km" or "8 km, -2 km"."""
STATION_COLUMNS = ("Time (s)", "slip (m)", "slip rate (m/s)", "shear stress (MPa)")
"""Meanings of the columns."""
DATA_FIELDS = "t slip slip-rate shear-stress"
"""Their names in the benchmarks."""


def node_at(slab: PlanarSlab, station: Station | None) -> tuple[int, ...]:
    """Return the node that is closest to a station; that in the middle if none is given. Raises InputError for one elsewhere."""
    if station is None:
        return tuple(count // 2 for count in slab.shape)
    given: tuple[Any, ...] = (station,)
    if isinstance(station, str | tuple):
        given = tuple(station.split(",")) if isinstance(station, str) else station
    axes = {"y": slab.y} | ({"z": slab.z} if slab.is_plane else {})
    if len(given) != len(axes):
        wanted = 'y and z, as in "8 km, 0 km"' if slab.is_plane else 'y, as in "8 km"'
        raise InputError(f"station: needs {wanted}, got {len(given)} number{'s' * (len(given) != 1)}")
    found = []
    for (axis, nodes), one, apart in zip(axes.items(), given, slab.spacing, strict=True):
        place = PLACE_OF_STATION.check("station", axis, one)
        nearest = int(np.abs(nodes - place).argmin())
        if abs(nodes[nearest] - place) > 0.5 * apart * (1.0 + 1e-9):
            ends = f"from {brief(nodes[0], 'm')} to {brief(nodes[-1], 'm')}"
            raise InputError(f"station: {axis} = {place:g} m has no node: nodes lie {ends}")
        found.append(nearest)
    return tuple(found)


def write_station(run: PlanarSolution, path: Path, station: Station | None) -> Path:
    """Write the motion of the node at a station in the layout of the SCEC: see `PlanarSolution.to_scec`."""
    node = node_at(run.slab, station)
    at: Any = (slice(None), *node)
    columns = (run.times, run.slip[at] - run.slip[(0, *node)], run.slip_rate[at], 1e-6 * run.traction[at])
    header = [f"# {line}" for line in _about(run, node)]
    lines = (" ".join((f"{row[0]: .13E}", *(f"{one: .12E}" for one in row[1:]))) for row in np.column_stack(columns).tolist())
    text = "\n".join([*header, DATA_FIELDS, *lines, ""])
    return write_atomically(path, lambda draft: draft.write_text(text, encoding="utf-8", newline="\n"))


def _about(run: PlanarSolution, node: tuple[int, ...]) -> Iterator[str]:
    slab = run.slab
    yield f"problem={run.title or 'stickslip'}"
    yield "code=stickslip"
    yield f"code_version={stickslip.__version__}"
    yield f"body={to_table(slab.problem.body)}"
    yield f"friction={to_table(slab.problem.friction)}"
    yield f"element_size={' x '.join(f'{one:.13g}' for one in slab.spacing)} m, nodes of a spectral method"
    yield f"time_step={slab.body.two_way_time / run.steps_per_round_trip:.13E} s"
    yield f"num_time_steps={len(run.times)}"
    places = zip("yz", (slab.y, slab.z) if slab.is_plane else (slab.y,), node, strict=False)
    yield f"location={', '.join(f'{axis} = {along[n]:.13g} m' for axis, along, n in places)}"
    yield f"Time series in {len(STATION_COLUMNS)} columns: E21.13, then E20.12"
    yield from (f"Column #{number} = {meaning}" for number, meaning in enumerate(STATION_COLUMNS, 1))
    yield "The line below lists the names of the data fields:"
