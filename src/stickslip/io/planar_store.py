"""Runs of planar slabs in a folder of zarr, which grows while a run continues, and from which it can be continued.

The folder holds the frames (`slip` and so on over time, y and z), the profiles of the contact, and as attributes the problem and
the grid: `xarray.open_zarr` opens it at any time. The group `waves` holds what the contact has sent into the slab at each step,
from which the echoes are found again. A checkpoint is the file `state.nc`. It is replaced as a whole, after the frames and waves up
to it are on the disk. What the folder holds beyond it, or half of it, is written again by the run that continues.
"""

from __future__ import annotations

import hashlib
import json
import math
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, Self

import numpy as np
import zarr
from numpy.typing import NDArray
from typing_extensions import override
from zarr.storage import MemoryStore

import stickslip
from stickslip.engine.state.layout import Stop
from stickslip.foundation import netcdf_file, zarr_folder
from stickslip.foundation.atomic_write import held, read_bounded, sync, write_atomically
from stickslip.foundation.errors import InputError, printable
from stickslip.foundation.netcdf_file import Variable
from stickslip.io.netcdf import PAPER
from stickslip.io.soundness import number, whole_number
from stickslip.planar.slab import PlanarSlab
from stickslip.scenarios.contact import GRID, Contact
from stickslip.scenarios.scenario import LARGEST_TEXT, Scenario, read_scenario
from stickslip.solution.planar import FIELDS, Frames, PlanarSolution
from stickslip.trajectory.status import INTERRUPTED, STATUSES, UNDER_WAY, Status, engine

if TYPE_CHECKING:
    from stickslip.planar.solver import Motion, PlanarSolver

Floats = NDArray[np.float64]
FORMAT = 1
"""Version of the layout; a store with another version is refused."""
KIND, STATE, SENT = "stickslip_planar", "state.nc", "waves/sent"
"""Attribute with the version, file of the checkpoint, and array of what the contact has sent."""
CHUNK = 4_000_000
"""Bytes of a chunk of frames or waves, unless a single one is larger."""
WHAT, BUSY = "the run of a planar slab", "another run is writing into it"
CHANGES = ("duration", "residual", "status", "status_message", "status_ok", "digest")
"""Attributes that may change, and the checksum of the others."""
DECIDE = ("bodies", "friction", "loading", "planar", "problem")
"""Folders of the package whose code decides the result of a planar run."""


@dataclass(eq=False)
class PlanarStore(Frames):
    """The frames of a run in a folder, with what the run needs to be continued. In memory are the frames of one chunk at most."""

    path: Path = field(kw_only=True)
    duration: float = field(kw_only=True)
    """Time (s) at the end of the run."""
    frames: int = field(kw_only=True)
    """Frames in a two-way travel time."""
    digest: str = field(kw_only=True)
    """Checksum of the attributes that do not change."""
    written: int = 0
    """Number of frames in the folder."""
    sent: int = 0
    """Number of rows of `waves/sent`: steps + 1 for each round trip."""

    @cached_property
    def _arrays(self) -> dict[str, Any]:
        """The arrays that grow, by name."""
        group: Any = opened(self.path, "r+", use_consolidated=False)
        return {name: group[name] for name in ("time", *FIELDS, SENT)}

    # ---- begin, or go on ---------------------------------------------------------------------------------------------------------

    @classmethod
    @contextmanager
    def new(cls, path: Path, slab: PlanarSlab, scenario: Scenario, frames: int, run: PlanarSolver) -> Iterator[Self]:
        """Create the folder of a run, locked against other processes. Raises InputError if the name exists."""
        if path.exists():
            raise InputError(f"{path}: exists: stickslip.resume continues the run in it; choose another name, or remove it")
        about = attributes(slab, scenario, frames, run)
        with zarr_folder.writing(path, "choose another disk"), held(path, f"{path}: {BUSY}"):
            write_atomically(path, lambda draft: lay_out(draft, slab, about), folder=True)
        with held(path, f"{path}: {BUSY}"):
            yield cls(slab, run.steps, path=path, duration=scenario.duration, frames=frames, digest=about["digest"])

    @classmethod
    @contextmanager
    def at(cls, path: Path) -> Iterator[Self]:
        """Open the folder of a run to continue it, locked against other processes. Raises InputError for anything else."""
        with held(path, f"{path}: {BUSY}"):
            with reading(path):
                store = cls._opened(path)
            yield store

    @classmethod
    def _opened(cls, path: Path) -> Self:
        group, about = opened(path, use_consolidated=False), netcdf_file.read(path / STATE, "the state of a planar run").attrs
        if about.get("digest") != group.attrs["digest"] or whole_number(about, KIND, path) != FORMAT:
            raise InputError(f"its {STATE} belongs to another run")
        if about["engine"] != _engine():
            raise InputError(
                f"{path}: cannot be resumed: another version of stickslip or of JAX made it ({about['engine']}; this is"
                f" {_engine()}), which would go on in other digits; run it again from the start"
            )
        frames, steps = (whole_number(group.attrs, name, path, 1) for name in ("frames", "steps_per_round_trip"))
        keywords = {"duration": number(group.attrs, "duration", path), "frames": frames, "digest": about["digest"]}
        store = cls(slab_in(group, path), steps, path=path, **keywords)
        store.written, store.sent = (whole_number(about, name, path, 1) for name in ("written", "sent"))
        store.largest_slip, store.fastest = (number(about, name, path) for name in ("largest_slip", "fastest"))
        store.times = _finite(group, "time", slice(store.written)).tolist()
        return store

    def restore(self, run: PlanarSolver) -> None:
        """Set a solver to the state in the folder. Raises InputError if it is damaged."""
        with reading(self.path):
            found, rows = netcdf_file.read(self.path / STATE), self.steps_per_round_trip + 1
            trip, step = divmod(self.sent - 1, rows)
            state = {str(name): one.to_numpy() for name, one in found.items()}
            wanted = {name: (one.shape, one.dtype) for name, one in run.state().items()}
            if {name: (one.shape, one.dtype) for name, one in state.items()} != wanted or trip >= run.trips:
                raise InputError(f"its {STATE} has arrays of other shapes than its grid")
            run.restore(state, trip, step, lambda n: _finite(self._arrays, SENT, slice(n * rows, min((n + 1) * rows, self.sent))))

    # ---- while the run continues -------------------------------------------------------------------------------------------------

    @override
    def add(self, time: float, motion: Motion) -> None:
        super().add(time, motion)
        if len(self.times) % self._arrays["slip"].chunks[0] == 0:
            self._write_frames()

    def drop_last(self) -> None:
        """Forget the last frame, which a longer run would not have."""
        self.written -= 1
        self.times.pop()

    def _write_frames(self) -> None:
        fields = {name: np.stack(frames) for name, frames in self.waiting.items() if frames}
        for name, values in (fields | {"time": np.array(self.times[self.written :])}).items():
            self._append(name, self.written, values)
            self.waiting[name] = []
        self.written = len(self.times)

    def _append(self, name: str, first: int, values: Floats) -> None:
        """Write rows of an array from a row on, and have them on the disk."""
        if not len(values):
            return
        array = self._arrays[name]
        end, size = first + len(values), array.chunks[0]
        kept = "stickslip.resume continues from the last checkpoint when there is room"
        with reading(self.path), zarr_folder.writing(self.path, kept):  # a chunk that is not full is read first
            if end > array.shape[0]:
                array.resize((end, *array.shape[1:]))
            array[first:end] = values
            for chunk in range(first // size, -(-end // size)):
                file = self.path / name / ".".join(["c", str(chunk), *["0"] * (array.ndim - 1)])
                if file.exists():  # zarr writes no file for a chunk in which nothing differs from its fill value
                    sync(file)

    @override
    def end_round_trip(self, run: PlanarSolver) -> None:
        since = self.sent - run.trip * (run.steps + 1)
        rows = run.sent(since)
        self._append(SENT, self.sent, rows)
        self.sent += len(rows)

    @override
    def save(self, run: PlanarSolver) -> None:
        self._save(run)
        self._show(UNDER_WAY)

    @override
    def end(self, run: PlanarSolver, code: int) -> None:
        if code in (Stop.FINISHED, INTERRUPTED):
            self._save(run)
        else:  # the solver is in no state to continue from: that of the last checkpoint stays
            self._write_frames()
        self._show(code)

    def _save(self, run: PlanarSolver) -> None:
        """Write a checkpoint."""
        self._write_frames()
        self.end_round_trip(run)
        state = {
            name: Variable(tuple(f"{name}_{n}" for n in range(one.ndim)), np.asarray(one)) for name, one in run.state().items()
        }
        own = ("written", "sent", "largest_slip", "fastest")
        about = {name: getattr(self, name) for name in own} | {KIND: FORMAT, "engine": _engine(), "digest": self.digest}
        netcdf_file.write_variables(state, about, self.path / STATE)

    def _show(self, code: int) -> None:
        """Let readers see what has been written, with the status that belongs to a code."""
        with reading(self.path):
            zarr_folder.consolidate(self.path)
            # the group that knows the arrays keeps what it knows of them: the file changes at once
            zarr.open_group(self.path, mode="r+").attrs.update(
                _status(STATUSES[code]) | {"duration": self.duration, "residual": self.residual}
            )

    @override
    def solution(self, code: int) -> PlanarSolution:
        return open_planar(self.path)


def lay_out(place: Any, slab: PlanarSlab, about: Any) -> None:
    """Create all arrays, without frames, and the attributes."""
    group: Any = zarr.create_group(place, attributes=dict(about))
    axes = dict(zip(("y", "z"), slab.shape, strict=False))
    for axis, places in zip(axes, (slab.y, slab.z), strict=False):
        _array(group, axis, {axis: len(places)}, units="m")[...] = places
    for name, given in slab.along.items():
        values = slab.at_nodes(name, given)
        _array(group, f"along.{name}", axes, long_name=f"{name} along the contact")[...] = values
    _array(group, "barrier", axes, long_name="1 where the contact is locked")[...] = slab.locked
    _array(group, "time", {"time": 0}, about["frames"], units="s")
    for name, unit in FIELDS.items():
        _array(group, name, {"time": 0} | axes, about["frames"], units=unit)
    modes = dict(zip(("part", *(f"k_{axis}" for axis in axes)), about["modes"], strict=True))
    sent = "what the contact sends at each step of each round trip, by wavenumber"
    _array(group, SENT, {"row": 0} | modes, about["steps_per_round_trip"], units="Pa", long_name=sent)
    zarr_folder.consolidate(place)


def attributes(slab: PlanarSlab, scenario: Scenario, frames: int, run: PlanarSolver) -> dict[str, Any]:
    """Return the attributes of a new folder. Raises InputError for a problem that files cannot hold."""
    text = scenario.to_toml()
    if len(text) > LARGEST_TEXT:  # the profiles are in the folder anyway
        text = replace(scenario, contact=None).to_toml()
    about: dict[str, Any] = {
        "Conventions": "CF-1.11",
        "title": scenario.heading or f"stickslip run: PlanarSlab, {type(slab.problem.friction).__name__}",
        "source": f"stickslip {stickslip.__version__}",
        "references": PAPER,
        "scenario": text,
        "selection_rule": slab.problem.rule,
        "grid": {name: getattr(slab, name) for name in GRID},
        "along": list(slab.along),
        "modes": list(run.sent(0).shape[1:]),
        "frames": frames,
        "steps_per_round_trip": run.steps,
        KIND: FORMAT,
    }
    return about | {"digest": _digest(about), "duration": scenario.duration, "residual": 0.0} | _status(STATUSES[UNDER_WAY])


def _status(status: Status) -> dict[str, Any]:
    return {"status": status.name, "status_message": status.message, "status_ok": int(status.ok)}


def _digest(about: Mapping[str, Any]) -> str:
    kept = {name: value for name, value in about.items() if name not in CHANGES}
    return hashlib.sha256(json.dumps(kept, sort_keys=True).encode()).hexdigest()


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


def _engine() -> str:
    import jax

    return f"{engine(DECIDE)}, JAX {jax.__version__}"


# ---- reading what somebody else may have written -----------------------------------------------------------------------------


def reading(path: Path) -> Any:
    """Turn every error in the `with` block, which reads the folder of a run, into an InputError with a message of one line."""
    return zarr_folder.reading(path, WHAT)


class StoredFields(Mapping[str, Floats]):
    """The fields of a run in a folder, each read when it is asked for."""

    def __init__(self, path: Path, group: zarr.Group, frames: int) -> None:
        self.path, self.group, self.frames = path, group, frames

    @override
    def __getitem__(self, name: str) -> Floats:
        with reading(self.path):
            return _finite(self.group, name, slice(self.frames))

    @override
    def __iter__(self) -> Iterator[str]:
        return iter(FIELDS)

    @override
    def __len__(self) -> int:
        return len(FIELDS)


def open_planar(path: Path) -> PlanarSolution:
    """Return the run in a folder; its fields are read when they are used. Raises InputError for anything but such a folder."""
    with reading(path):
        group = opened(path)
        steps = whole_number(group.attrs, "steps_per_round_trip", path, 1)
        slab, times = slab_in(group, path), _finite(group, "time")
        shapes = {name: getattr(group[name], "shape", None) for name in FIELDS}
        if any(shape != (len(times), *slab.shape) for shape in shapes.values()) or not len(times):
            raise InputError(f"its frames have the shapes {shapes}, its times {times.shape}, its grid {slab.shape}")
        name, why = (printable(str(group.attrs[one])) for one in ("status", "status_message"))
        status, steps = (
            Status(name, why, bool(group.attrs["status_ok"])),
            whole_number(group.attrs, "steps_per_round_trip", path, 1),
        )
        residual = number(group.attrs, "residual", path)
        return PlanarSolution(slab, times, StoredFields(path, group, len(times)), steps, status, residual)


def scenario_in(path: Path) -> Scenario:
    """Return the scenario of the run in a folder. Raises InputError as `open_planar` does."""
    with reading(path):
        group = opened(path)
        about: Any = group.attrs
        found = replace(read_scenario(about["scenario"], str(path), path.stem), duration=about["duration"])
        contact = found.contact or Contact.of(slab_in(group, path))
        return replace(found, contact=replace(contact, frames=about["frames"]))


def is_planar(path: Path) -> bool:
    """Return True if a folder says that it holds the run of a planar slab."""
    try:
        return KIND in json.loads(read_bounded(path / "zarr.json", LARGEST_TEXT))["attributes"]
    except (InputError, OSError, ValueError, KeyError, TypeError):
        return False


def opened(path: Path, mode: Literal["r", "r+"] = "r", use_consolidated: bool | None = None) -> zarr.Group:
    """Return the group in a folder after checking its attributes. Raises InputError."""
    if not (path / "zarr.json").is_file():
        raise InputError(f"{path}: not {WHAT}: it is no folder of zarr")
    group = zarr.open_group(path, mode=mode, use_consolidated=use_consolidated)
    if group.attrs.get(KIND) != FORMAT:
        found = "it is the store of a sweep" if "stickslip_sweep" in group.attrs else f"found {group.attrs.get(KIND, 'none')}"
        raise InputError(f"{path}: not {WHAT} of this version of stickslip (format {FORMAT} expected, {found})")
    if group.attrs.get("digest") != _digest(group.attrs):
        raise InputError(f"{path}: damaged: its attributes do not have their checksum")
    return group


def slab_in(group: zarr.Group, path: Path) -> PlanarSlab:
    """Return the slab from the attributes and profiles of a folder."""
    given: Any = group
    about: Any = group.attrs
    problem = read_scenario(about["scenario"], str(path)).problem
    along = {name: _finite(group, f"along.{name}") for name in about["along"]}
    slab = PlanarSlab(problem, **about["grid"], along=along, barrier=_finite(group, "barrier") > 0.5)
    wanted = MemoryStore()
    lay_out(wanted, slab, about)
    ours: Any = zarr.open_group(wanted, mode="r")
    for name in (*ours.array_keys(), SENT):
        one, other = (found[name].metadata.to_dict() | {"shape": found[name].shape[1:]} for found in (ours, given))
        if one != other:
            raise InputError(f"its array {name!r} has another form")
    return slab


def _finite(group: Any, name: str, rows: slice = slice(None)) -> Floats:
    """Return rows of an array. Raises InputError if some of its numbers are missing."""
    found = np.asarray(group[name][rows])
    if not np.isfinite(found).all():
        raise InputError(f"its array {name!r} has numbers that are missing or not finite")
    return found
