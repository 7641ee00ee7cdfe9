"""The folder of zarr that holds the run of a planar slab: how it is laid out, and how it is read.

It holds the frames (`slip` and so on over time, y and z), the profiles of the contact, and as attributes the problem and the grid:
`xarray.open_zarr` opens it at any time. The group `waves` holds what the contact has sent into the slab at each step.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, cast

import numpy as np
import zarr
from typing_extensions import override
from zarr.storage import MemoryStore

import stickslip
from stickslip.extensions.planar.contact import GRID, Contact
from stickslip.extensions.planar.slab import COUNTS, MOST_NODES, PlanarSlab
from stickslip.extensions.planar.solution import FIELDS, PlanarSolution
from stickslip.extensions.planar.table import CONTACT
from stickslip.foundation import zarr_folder
from stickslip.foundation.arguments import shown
from stickslip.foundation.arrays import Floats
from stickslip.foundation.constants import PAPER
from stickslip.foundation.errors import InputError, printable
from stickslip.problem import STATUSES, UNDER_WAY, Status
from stickslip.problem.scenarios import LARGEST_TEXT, Scenario, read_scenario
from stickslip.solution.files import FolderFormat, check_layout, number, whole_number

if TYPE_CHECKING:
    from stickslip.extensions.planar.solver import PlanarSolver

SENT = "waves/sent"
"""Array of what the contact has sent."""
CHUNK = 4_000_000
"""Bytes of a chunk of frames or waves, unless a single one is larger."""
CHANGES = ("duration", "residual", "status", "status_message", "status_ok")
"""Attributes that may change."""
LONGEST_TITLE = 200
"""Largest number of characters of a title that is read from a folder."""
UNTITLED = "stickslip run: PlanarSlab"
"""Beginning of the title in the folder of a run that has none."""
PLANAR_FORMAT = FolderFormat("stickslip_planar", 1, CHANGES)


def lay_out(place: Any, slab: PlanarSlab, about: Any) -> None:
    """Create all arrays, without frames, and the attributes."""
    made: Any = _arrays(place, slab.shape, about)
    for axis, places in zip("yz", (slab.y, slab.z)[: len(slab.shape)], strict=False):
        made[axis][...] = places
    for name, given in slab.along.items():
        made[f"along.{name}"][...] = slab.at_nodes(name, given)
    made["barrier"][...] = slab.locked


def _arrays(place: Any, shape: tuple[int, ...], about: Any) -> zarr.Group:
    """Create all arrays of a contact of this shape, still empty, and the attributes; return the group."""
    group: Any = zarr.create_group(place, attributes=dict(about))
    axes = dict(zip(("y", "z"), shape, strict=False))
    for axis, count in axes.items():
        _array(group, axis, {axis: count}, units="m")
    for name in about["along"]:
        _array(group, f"along.{name}", axes, long_name=f"{name} along the contact")
    _array(group, "barrier", axes, long_name="1 where the contact is locked")
    _array(group, "time", {"time": 0}, about["frames"], units="s")
    for name, unit in FIELDS.items():
        _array(group, name, {"time": 0} | axes, about["frames"], units=unit)
    modes = dict(zip(("part", *(f"k_{axis}" for axis in axes)), about["modes"], strict=True))
    sent = "what the contact sends at each step of each round trip, by wavenumber"
    _array(group, SENT, {"row": 0} | modes, about["steps_per_round_trip"], units="Pa", long_name=sent)
    return cast(zarr.Group, group)


def attributes(slab: PlanarSlab, scenario: Scenario, frames: int, run: PlanarSolver) -> dict[str, Any]:
    """Return the attributes of a new folder. Raises InputError for a problem that files cannot hold."""
    text = scenario.to_toml()
    if len(text) > LARGEST_TEXT:  # the profiles are in the folder anyway
        text = scenario.with_table(CONTACT, None).to_toml()
    about: dict[str, Any] = {
        "Conventions": "CF-1.11",
        "title": scenario.heading or f"{UNTITLED}, {type(slab.problem.friction).__name__}",
        "source": f"stickslip {stickslip.__version__}",
        "references": PAPER,
        "scenario": text,
        "selection_rule": slab.problem.rule,
        "grid": {name: getattr(slab, name) for name in GRID},
        "along": list(slab.along),
        "modes": list(run.sent(0).shape[1:]),
        "frames": frames,
        "steps_per_round_trip": run.steps,
    }
    return PLANAR_FORMAT.attributes(about) | {"duration": scenario.duration, "residual": 0.0} | in_attributes(STATUSES[UNDER_WAY])


def in_attributes(status: Status) -> dict[str, Any]:
    """Return the attributes that say how a run ended."""
    return {"status": status.name, "status_message": status.message, "status_ok": int(status.ok)}


def _array(group: zarr.Group, name: str, axes: Mapping[str, int], rows: int = 0, **about: Any) -> zarr.Array[Any]:
    """Create an array; one that grows along its first axis has chunks of so many rows, or of fewer if they are large."""
    shape = tuple(axes.values())
    most = max(1, CHUNK // (8 * math.prod(shape[1:])))
    return group.create_array(
        name,
        shape=shape,
        chunks=(min(rows, most), *shape[1:]) if rows else shape,
        dtype="float64",
        dimension_names=tuple(axes),
        attributes=about,
        compressors=zarr_folder.COMPRESSED,
        fill_value=np.nan,  # so that a chunk that is missing is noticed
        chunk_key_encoding=zarr_folder.IN_ONE_FOLDER,
    )


# ---- reading what somebody else may have written -----------------------------------------------------------------------------


class StoredFields(Mapping[str, Floats]):
    """The fields of a run in a folder, each read when it is asked for."""

    def __init__(self, path: Path, group: zarr.Group, frames: int) -> None:
        self.path, self.group, self.frames = path, group, frames

    @override
    def __getitem__(self, name: str) -> Floats:
        with PLANAR_FORMAT.reading(self.path):
            return finite_rows(self.group, name, slice(self.frames))

    @override
    def __iter__(self) -> Iterator[str]:
        return iter(FIELDS)

    @override
    def __len__(self) -> int:
        return len(FIELDS)


def open_planar(path: Path) -> PlanarSolution:
    """Return the run in a folder; its fields are read when they are used. Raises InputError for anything but such a folder."""
    with PLANAR_FORMAT.reading(path):
        group = opened(path)
        steps = whole_number(group.attrs, "steps_per_round_trip", path, 1)
        slab, times = slab_in(group, path), finite_rows(group, "time")
        shapes = {name: getattr(group[name], "shape", None) for name in FIELDS}
        if any(shape != (len(times), *slab.shape) for shape in shapes.values()) or not len(times):
            raise InputError(f"its frames have the shapes {shapes}, its times {times.shape}, its grid {slab.shape}")
        name, why = (printable(str(group.attrs[one])) for one in ("status", "status_message"))
        status, steps = (
            Status(name, why, bool(group.attrs["status_ok"])),
            whole_number(group.attrs, "steps_per_round_trip", path, 1),
        )
        residual = number(group.attrs, "residual", path)
        title = printable(str(group.attrs["title"])[:LONGEST_TITLE])
        fields = StoredFields(path, group, len(times))
        return PlanarSolution(slab, times, fields, steps, status, residual, "" if title.startswith(UNTITLED) else title)


def scenario_in(path: Path) -> Scenario:
    """Return the scenario of the run in a folder. Raises InputError as `open_planar` does."""
    with PLANAR_FORMAT.reading(path):
        group = opened(path)
        about: Any = group.attrs
        found = replace(read_scenario(about["scenario"], str(path), path.stem), duration=about["duration"])
        contact = found.table(CONTACT) or Contact.of(slab_in(group, path))
        return found.with_table(CONTACT, replace(contact, frames=about["frames"]))


def opened(path: Path, mode: Literal["r", "r+"] = "r", use_consolidated: bool | None = None) -> zarr.Group:
    """Return the group in a folder after checking its attributes. Raises InputError."""
    check_python(path)
    return PLANAR_FORMAT.opened(path, mode, use_consolidated)


def check_python(path: Path) -> None:
    """Refuse a Python without assertions, by which zarr cannot read groups inside a group. Raises InputError."""
    if not __debug__:
        raise InputError(
            f"{path}: zarr needs the assertions of Python for {PLANAR_FORMAT.what}: unset PYTHONOPTIMIZE, or leave out python -O"
        )


def slab_in(group: zarr.Group, path: Path) -> PlanarSlab:
    """Return the slab from the attributes and profiles of a folder, whose arrays must have the form that follows from these."""
    about: Any = group.attrs
    grid = dict(about["grid"])
    counts = [grid[name] for name in COUNTS if grid.get(name) is not None]
    if not all(isinstance(count, int) and count > 0 for count in counts) or math.prod(counts) > MOST_NODES:
        raise InputError(f"its grid is {shown(grid)}")
    check_layout(_arrays(MemoryStore(), tuple(counts), about), group, (*FIELDS, "time", SENT))
    problem = read_scenario(about["scenario"], str(path)).problem
    along = {name: finite_rows(group, f"along.{name}") for name in about["along"]}
    slab = PlanarSlab(problem, **grid, along=along, barrier=finite_rows(group, "barrier") > 0.5)
    _check_rows(group, path, slab)
    return slab


def _check_rows(group: Any, path: Path, slab: PlanarSlab) -> None:
    """Refuse more rows than a run of this duration has, or rows without a file."""
    steps, frames = (whole_number(group.attrs, name, path, 1) for name in ("steps_per_round_trip", "frames"))
    trips = slab.round_trips(number(group.attrs, "duration", path))
    most = {"time": trips * (min(frames, steps) * 2 + 1) + 2, SENT: trips * (steps + 1)}
    for name in (*FIELDS, "time", SENT):
        array = group[name]
        files = sum(1 for one in (path / name).glob("c.*")) if array.shape[0] else 0
        if array.shape[0] > min(most.get(name, most["time"]), files * array.chunks[0]):
            raise InputError(f"its array {name!r} has {array.shape[0]} rows, and {files} files of them")


def finite_rows(group: Any, name: str, rows: slice = slice(None)) -> Floats:
    """Return rows of an array. Raises InputError if some of its numbers are missing."""
    found = np.asarray(group[name][rows])
    if not np.isfinite(found).all():
        raise InputError(f"its array {name!r} has numbers that are missing or not finite")
    return found
