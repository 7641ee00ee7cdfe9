"""Write the run of a chain into a folder of zarr while it continues, and continue it from there.

`store_layout.py` says what the folder holds. A checkpoint replaces the file `state.nc` as a whole, after the rows up to it are on
the disk. Rows beyond it are written again by the run that continues. In memory are the rows since the last chunk that is full.
"""

from __future__ import annotations

import shutil
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, Self

import numpy as np
from typing_extensions import override

from stickslip.engine import engine_key
from stickslip.extensions.chains.chain import Chain
from stickslip.extensions.chains.deciding import DECIDING_CODE
from stickslip.extensions.chains.rows import ChainRows, Snapshots
from stickslip.extensions.chains.store_layout import (
    CHAIN_FORMAT,
    CHANGE,
    EVENT,
    FINAL,
    ROWS_OF_CHUNK,
    SNAPSHOT,
    STATE_FILE,
    attributes,
    chain_in,
    checkpoint_in,
    in_attributes,
    lay_out,
    open_chain,
    opened,
)
from stickslip.foundation import netcdf_file, zarr_folder
from stickslip.foundation.arrays import Floats
from stickslip.foundation.atomic_write import sync
from stickslip.foundation.errors import InputError
from stickslip.foundation.locks import held
from stickslip.foundation.netcdf_file import Variable
from stickslip.problem import STATUSES, UNDER_WAY
from stickslip.problem.scenarios import Scenario
from stickslip.solution.files import create, number

if TYPE_CHECKING:
    from stickslip.extensions.chains.run import ChainRun
    from stickslip.extensions.chains.solver import ChainSolver
    from stickslip.extensions.chains.state import ChainState
    from stickslip.problem import Status

BUSY = "another run is writing into it"
IF_FULL = "stickslip.resume continues from the last checkpoint when there is room"


@dataclass(eq=False)
class ChainStore(ChainRows):
    """The rows of a run in a folder, with what the run needs to be continued."""

    path: Path = field(kw_only=True)
    duration: float = field(kw_only=True)
    """Time (s) at the end of the run."""
    digest: str = field(kw_only=True)
    """Checksum of the attributes that do not change."""
    written: dict[str, int] = field(default_factory=lambda: {EVENT: 0, CHANGE: 0})
    """Numbers of rows in the folder."""
    start: ChainState | None = None
    """The state that the run continues from."""
    reached: float = 0.0
    """The time (s) up to which the run is in the folder."""

    # ---- begin, or go on ---------------------------------------------------------------------------------------------------------

    @classmethod
    @contextmanager
    def new(cls, path: Path, chain: Chain, scenario: Scenario, keeps_changes: bool, title: str) -> Iterator[Self]:
        """Create the folder of a run, locked against other processes. Raises InputError if the name exists."""
        zarr_folder.check_folder(path)
        about = attributes(chain, scenario, keeps_changes, title)
        if path.exists() and not _is_unbegun(path):
            raise InputError(f"{path}: exists: stickslip.resume continues the run in it; choose another name, or remove it")
        with zarr_folder.writing(path, "choose another disk"), held(path, f"{path}: {BUSY}"):
            if path.exists():  # killed before its first checkpoint
                shutil.rmtree(path)
            create(path, lambda draft: lay_out(draft, about))
        with held(path, f"{path}: {BUSY}"):
            yield cls(chain, title, keeps_changes, path=path, duration=float(scenario.duration), digest=about["digest"])

    @classmethod
    @contextmanager
    def at(cls, path: Path) -> Iterator[Self]:
        """Open the folder of a run to continue it, locked against other processes. Raises InputError for anything else."""
        zarr_folder.check_writable(path)
        with held(path, f"{path}: {BUSY}"):
            with CHAIN_FORMAT.reading(path):
                store = cls._opened(path)
            yield store

    @classmethod
    def _opened(cls, path: Path) -> Self:
        about: Any = opened(path, use_consolidated=False).attrs
        chain = chain_in(path)
        found = checkpoint_in(path, chain)
        if found.engine != engine_key(*DECIDING_CODE):
            raise InputError(
                f"{path}: cannot be resumed: another version of stickslip made it, and this one would go on in other digits; run it"
                " again from the start"
            )
        of_run = str(about["title"]), bool(about["keeps_changes"])
        duration, digest = number(about, "duration", path), str(about["digest"])
        store = cls(chain, *of_run, path=path, duration=duration, digest=digest)
        store.written |= found.rows
        store.count_of_events, store.count_of_changes = store.written[EVENT], store.written[CHANGE]
        store.snapshots = Snapshots(found.snapshots, found.every, found.calls)
        store.start, store.reached = found.state, found.reached
        return store

    @property
    def state(self) -> ChainState:
        """The state that the run continues from."""
        assert self.start is not None  # as long as the folder has a checkpoint
        return self.start

    # ---- while the run continues -------------------------------------------------------------------------------------------------

    @cached_property
    def _arrays(self) -> dict[str, Any]:
        """The arrays of rows, by name."""
        group: Any = opened(self.path, "r+", use_consolidated=False)
        return dict(group.arrays())

    @override
    def take(self, events: Floats, changes: Floats) -> None:
        super().take(events, changes)
        for kind, parts in ((EVENT, self.events), (CHANGE, self.changes)):
            if sum(map(len, parts)) >= ROWS_OF_CHUNK:
                self._write(kind, parts)

    def _write(self, kind: str, parts: list[Floats]) -> None:
        """Write rows that wait, and have them on the disk."""
        rows = np.concatenate(parts)
        if not len(rows):
            return
        first, end = self.written[kind], self.written[kind] + len(rows)
        array = self._arrays[kind]
        with (
            CHAIN_FORMAT.reading(self.path),
            zarr_folder.writing(self.path, IF_FULL),
        ):  # a chunk that is not full is read first
            if array.shape[0] != end:
                array.resize((end, array.shape[1]))
            array[first:end] = rows
            for chunk in range(first // ROWS_OF_CHUNK, -(-end // ROWS_OF_CHUNK)):
                sync(self.path / kind / f"c.{chunk}.0")
        self.written[kind] = end
        parts[:] = [rows[:0]]

    @override
    def save(self, state: ChainState) -> None:
        self._save(state, state, state.time)
        self._show(STATUSES[UNDER_WAY])

    def _save(self, state: ChainState, final: ChainState, reached: float) -> None:
        """Write a checkpoint."""
        self._write(EVENT, self.events)
        self._write(CHANGE, self.changes)
        kept = self.snapshots.states or [state]
        arrays: dict[str, Variable] = {}
        for name, one in state.arrays.items():
            dims = ("number",) if one.ndim == 1 else (f"row_of_{name}", "block")
            arrays[name], arrays[FINAL + name] = Variable(dims, one), Variable(dims, final.arrays[name])
            arrays[SNAPSHOT + name] = Variable(("snapshot", *dims), np.stack([each.arrays[name] for each in kept]))
        about: Mapping[str, Any] = {
            CHAIN_FORMAT.kind: CHAIN_FORMAT.version,
            "engine": engine_key(*DECIDING_CODE),
            "digest": self.digest,
            EVENT: self.written[EVENT],
            CHANGE: self.written[CHANGE],
            "reached": reached,
            "every": self.snapshots.every,
            "calls": self.snapshots.calls,
        }
        netcdf_file.write_variables(arrays, about, self.path / STATE_FILE)

    def _show(self, status: Status) -> None:
        """Let readers see what has been written, with a status."""
        with CHAIN_FORMAT.reading(self.path), zarr_folder.writing(self.path, IF_FULL):
            zarr_folder.consolidate(self.path)
            opened(self.path, "r+").attrs.update(in_attributes(status) | {"duration": self.duration})

    @override
    def run(self, solver: ChainSolver, reached: float, status: Status) -> ChainRun:
        self._save(solver.state, solver.at(reached), reached)
        self._show(status)
        return open_chain(self.path)


def _is_unbegun(path: Path) -> bool:
    """Return True for the folder of a run that was killed before its first checkpoint."""
    return CHAIN_FORMAT.is_in(path) and not (path / STATE_FILE).exists()
