"""Write the run of a planar slab into a folder of zarr while it continues, and continue it from there.

`store_layout.py` says what the folder holds. A checkpoint is the file `state.nc` in it, from which the run continues; echoes are
found again from what the contact has sent. The file is replaced as a whole, after the frames and waves up to it are on the disk.
What the folder holds beyond it, or half of it, is written again by the run that continues.
"""

from __future__ import annotations

import shutil
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from functools import cache, cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, Self

import numpy as np
from typing_extensions import override

from stickslip.extensions.planar.slab import PlanarSlab
from stickslip.extensions.planar.solution import FIELDS, Frames, PlanarSolution
from stickslip.extensions.planar.store_layout import (
    PLANAR_FORMAT,
    SENT,
    attributes,
    check_python,
    finite_rows,
    in_attributes,
    lay_out,
    open_planar,
    opened,
    slab_in,
)
from stickslip.foundation import netcdf_file, zarr_folder
from stickslip.foundation.arrays import Floats
from stickslip.foundation.atomic_write import sync
from stickslip.foundation.code_key import key_of_folders
from stickslip.foundation.errors import InputError
from stickslip.foundation.locks import held
from stickslip.foundation.netcdf_file import Variable
from stickslip.problem import INTERRUPTED, STATUSES, UNDER_WAY, Stop
from stickslip.problem.scenarios import Scenario
from stickslip.solution.files import create, number, whole_number

if TYPE_CHECKING:
    from stickslip.extensions.planar.solver import PlanarSolver
    from stickslip.extensions.planar.step import PlanarMotion

STATE_FILE = "state.nc"
"""File of the checkpoint."""
BUSY = "another run is writing into it"
PLANAR_CODE = ("extensions/planar", "foundation/constants.py", "friction", "problem")
"""Folders and files of the package whose code decides the result of a planar run."""


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
        zarr_folder.check_folder(path)
        check_python(path)
        if path.exists() and not _is_unbegun(path):
            raise InputError(f"{path}: exists: stickslip.resume continues the run in it; choose another name, or remove it")
        about = attributes(slab, scenario, frames, run)
        with zarr_folder.writing(path, "choose another disk"), held(path, f"{path}: {BUSY}"):
            if path.exists():  # killed before its first checkpoint
                shutil.rmtree(path)
            create(path, lambda draft: lay_out(draft, slab, about))
        with held(path, f"{path}: {BUSY}"):
            yield cls(slab, run.steps, path=path, duration=scenario.duration, frames=frames, digest=about["digest"])

    @classmethod
    @contextmanager
    def at(cls, path: Path) -> Iterator[Self]:
        """Open the folder of a run to continue it, locked against other processes. Raises InputError for anything else."""
        zarr_folder.check_writable(path)
        with held(path, f"{path}: {BUSY}"):
            with PLANAR_FORMAT.reading(path):
                if _is_unbegun(path):
                    raise InputError(f"{path}: has no checkpoint yet: begin the run again with this name")
                store = cls._opened(path)
            yield store

    @classmethod
    def _opened(cls, path: Path) -> Self:
        group, about = opened(path, use_consolidated=False), netcdf_file.read(path / STATE_FILE, "the state of a planar run").attrs
        if about.get("digest") != group.attrs["digest"] or whole_number(about, PLANAR_FORMAT.kind, path) != PLANAR_FORMAT.version:
            raise InputError(f"its {STATE_FILE} belongs to another run")
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
        store.times = finite_rows(group, "time", slice(store.written)).tolist()
        if len(store.times) != store.written:
            raise InputError(f"it has {len(store.times)} frames, its {STATE_FILE} says {store.written}")
        return store

    def restore(self, run: PlanarSolver) -> None:
        """Set a solver to the state in the folder. Raises InputError if it is damaged."""
        with PLANAR_FORMAT.reading(self.path):
            found, rows = netcdf_file.read(self.path / STATE_FILE), self.steps_per_round_trip + 1
            trip, step = divmod(self.sent - 1, rows)
            state = {str(name): one.to_numpy() for name, one in found.items()}
            wanted = {name: (one.shape, one.dtype) for name, one in run.state().items()}
            if {name: (one.shape, one.dtype) for name, one in state.items()} != wanted or trip >= run.trips:
                raise InputError(f"its {STATE_FILE} has arrays of other shapes than its grid")
            run.restore(
                state, trip, step, lambda n: finite_rows(self._arrays, SENT, slice(n * rows, min((n + 1) * rows, self.sent)))
            )

    # ---- while the run continues -------------------------------------------------------------------------------------------------

    @override
    def add(self, time: float, motion: PlanarMotion) -> float:
        fastest = super().add(time, motion)
        if len(self.times) % self._arrays["slip"].chunks[0] == 0:
            self._write_frames()
        return fastest

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
        with PLANAR_FORMAT.reading(self.path), zarr_folder.writing(self.path, kept):  # a chunk that is not full is read first
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
        about = {name: getattr(self, name) for name in own} | {
            PLANAR_FORMAT.kind: PLANAR_FORMAT.version,
            "engine": _engine(),
            "digest": self.digest,
        }
        netcdf_file.write_variables(state, about, self.path / STATE_FILE)

    def _show(self, code: int) -> None:
        """Let readers see what has been written, with the status that belongs to a code."""
        with PLANAR_FORMAT.reading(self.path):
            zarr_folder.consolidate(self.path)
            # the group that knows the arrays keeps what it knows of them: the file changes at once
            opened(self.path, "r+").attrs.update(
                in_attributes(STATUSES[code]) | {"duration": self.duration, "residual": self.residual}
            )

    @override
    def solution(self, code: int) -> PlanarSolution:
        return open_planar(self.path)


def _is_unbegun(path: Path) -> bool:
    """Return True for the folder of a run that was killed before its first checkpoint: it holds nothing that was calculated."""
    if not PLANAR_FORMAT.is_in(path) or (path / STATE_FILE).exists():
        return False
    with PLANAR_FORMAT.reading(path):
        group: Any = opened(path, use_consolidated=False)
        return not any(group[name].shape[0] for name in ("time", *FIELDS, SENT))


@cache
def _engine() -> str:
    import jax

    return f"{key_of_folders(PLANAR_CODE, sys.version)}, JAX {jax.__version__}"
