"""The folder of zarr that holds the run of a chain: how it is laid out, and how it is read.

It holds the array `events`, a row for each, if they are kept the array `changes`, both with names and units of their columns, and
as attributes the scenario and how the run ended: `xarray.open_zarr` opens it at any time. The file `state.nc` in it is the
checkpoint, with the state that the run continues from, and how many rows belong to it.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, NamedTuple

import numpy as np
import zarr
from typing_extensions import override
from zarr.storage import MemoryStore

import stickslip
from stickslip.extensions.chains.chain import Chain
from stickslip.extensions.chains.compiled import memory as at
from stickslip.extensions.chains.run import CHANGE_TYPE, EVENT_UNITS, ChainRun
from stickslip.extensions.chains.state import ChainState
from stickslip.extensions.chains.table import CHAIN, given_of
from stickslip.foundation import netcdf_file, zarr_folder
from stickslip.foundation.arrays import Floats
from stickslip.foundation.errors import InputError, printable
from stickslip.problem import STATUSES, UNDER_WAY, Problem, Status
from stickslip.problem.bodies import SpringBlock
from stickslip.problem.scenarios import LARGEST_TEXT, Scenario, read_scenario
from stickslip.solution.files import FolderFormat, check_layout, number, whole_number

if TYPE_CHECKING:
    from stickslip.run import CallOptions

STATE_FILE = "state.nc"
"""File of the checkpoint."""
ROWS_OF_CHUNK = 65_536
"""Rows in a chunk of a column."""
EVENT, CHANGE = "events", "changes"
"""The arrays of rows."""
COLUMNS_OF_ROWS = {
    EVENT: dict(EVENT_UNITS),
    CHANGE: dict(zip(CHANGE_TYPE.names or (), ("s", "s", "1", "1", "m"), strict=True)),
}
"""Units of the columns of rows."""
VARIABLE_ATTRIBUTES = ("duration", "status", "status_message", "status_ok")
"""Attributes that may change."""
LONGEST_TITLE = 200
"""Read at most this many characters of a title from a folder."""
SNAPSHOT = "snapshot_"
"""How the names of arrays of snapshots begin in the checkpoint."""
FINAL = "final_"
"""How the names of arrays begin that say where blocks are when the run ends."""


@dataclass(frozen=True)
class ChainFormat(FolderFormat):
    """The format of a folder that holds the run of a chain."""

    @property
    @override
    def what(self) -> str:
        return "the run of a chain"


CHAIN_FORMAT = ChainFormat("stickslip_chain", 1, VARIABLE_ATTRIBUTES)


def scenario_of_chain(chain: Chain, options: CallOptions) -> Scenario:
    """Return a chain as a scenario, which a folder can hold. Raises InputError for a chain that no scenario file can say."""
    law = chain.laws[0][0]
    if len(chain.laws[0]) > 1:
        raise InputError("simulate: a Chain whose blocks have different laws cannot be kept in a folder: leave out checkpoint")
    problem = Problem(SpringBlock(1.0, 1.0, 1.0), law, pull_rate=0.0, initial_load=0.0)  # as `table.UNUSED`
    try:
        return Scenario(problem, options.duration, title=options.title).with_table(CHAIN, given_of(chain))
    except InputError as error:
        raise InputError(f"simulate: a Chain cannot be kept in a folder: {error}: leave out checkpoint") from None


def lay_out(place: Any, about: Mapping[str, Any]) -> None:
    """Create all arrays, without rows, and the attributes."""
    group: Any = zarr.create_group(place, attributes=dict(about))
    for kind in kinds_in(about):
        columns = COLUMNS_OF_ROWS[kind]
        group.create_array(
            kind,
            shape=(0, len(columns)),
            chunks=(ROWS_OF_CHUNK, len(columns)),
            dtype="float64",
            dimension_names=(f"row_of_{kind}", f"column_of_{kind}"),
            attributes={"columns": list(columns), "units_of_columns": list(columns.values())},
            compressors=zarr_folder.COMPRESSED,
            fill_value=np.nan,  # so that a chunk that is missing is noticed
            chunk_key_encoding=zarr_folder.IN_ONE_FOLDER,
        )


def kinds_in(about: Mapping[str, Any]) -> tuple[str, ...]:
    """Return the kinds of rows in a folder with these attributes."""
    return (EVENT, CHANGE) if about["keeps_changes"] else (EVENT,)


def attributes(chain: Chain, scenario: Scenario, keeps_changes: bool, title: str) -> dict[str, Any]:
    """Return the attributes of a new folder. Raises InputError for a chain that files cannot hold."""
    text = scenario.to_toml()
    if len(text) > LARGEST_TEXT:
        raise InputError(
            f"simulate: a folder holds chains whose scenario has up to {LARGEST_TEXT} characters, and this one has {len(text)}:"
            " draw the numbers of its blocks by a seed (Drawn), or leave out checkpoint"
        )
    try:
        read_scenario(text, "scenario")
    except InputError as error:
        raise InputError(f"simulate: the folder of a run cannot hold this chain, whose {error}: leave out checkpoint") from None
    about: dict[str, Any] = {
        "Conventions": "CF-1.11",
        "title": title,
        "source": f"stickslip {stickslip.__version__}",
        "scenario": text,
        "keeps_changes": keeps_changes,
    }
    return CHAIN_FORMAT.attributes(about) | {"duration": scenario.duration} | in_attributes(STATUSES[UNDER_WAY])


def in_attributes(status: Status) -> dict[str, Any]:
    """Return the attributes that say how a run ended."""
    return {"status": status.name, "status_message": status.message, "status_ok": int(status.ok)}


# ---- reading what somebody else may have written -----------------------------------------------------------------------------


class ChainCheckpoint(NamedTuple):
    """What the checkpoint of a run says: the engine that made it, numbers of rows, states, and the time that is reached (s)."""

    engine: str
    rows: Mapping[str, int]
    state: ChainState
    final: ChainState
    snapshots: list[ChainState]
    reached: float
    every: int
    calls: int


@dataclass(frozen=True, eq=False)
class RowsInFolder:
    """Rows of a run in a folder, which are read when a column is asked for: `rows[:, 2]`."""

    path: Path
    kind: str
    count: int

    def __len__(self) -> int:
        return self.count

    def __getitem__(self, where: Any) -> Floats:
        return np.asarray(self._all[where])

    @cached_property
    def _all(self) -> Floats:
        with CHAIN_FORMAT.reading(self.path):
            return finite_rows(opened(self.path), self.kind, self.count)


def opened(path: Path, mode: Literal["r", "r+"] = "r", use_consolidated: bool | None = None) -> zarr.Group:
    """Return the group in a folder after checking its attributes. Raises InputError."""
    return CHAIN_FORMAT.opened(path, mode, use_consolidated)


def finite_rows(group: Any, name: str, count: int) -> Floats:
    """Return the first rows of an array. Raises InputError if some of its numbers are missing."""
    found = np.asarray(group[name][:count])
    if len(found) != count or not np.isfinite(found).all():
        raise InputError(f"its array {name!r} has numbers that are missing or not finite")
    return found


def scenario_in(path: Path) -> Scenario:
    """Return the scenario of the run in a folder. Raises InputError as `open_chain` does."""
    with CHAIN_FORMAT.reading(path):
        about: Any = opened(path).attrs
        duration = number(about, "duration", path)
        return replace(read_scenario(str(about["scenario"]), str(path), path.stem), duration=duration)


def chain_in(path: Path) -> Chain:
    """Return the chain of the run in a folder. Raises InputError as `open_chain` does."""
    found = scenario_in(path)
    if found.table(CHAIN) is None:
        raise InputError(f"{path}: its scenario has no [chain]")
    chain: Chain = found.to_solve
    return chain


def open_chain(path: Path) -> ChainRun:
    """Return the run in a folder; its rows are read when they are used. Raises InputError for anything but such a folder."""
    with CHAIN_FORMAT.reading(path):
        group = opened(path)
        about: Any = group.attrs
        chain = chain_in(path)
        found = checkpoint_in(path, chain)
        rows: Any = {kind: RowsInFolder(path, kind, found.rows[kind]) for kind in kinds_in(about)}
        name, why = (printable(str(about[one])) for one in ("status", "status_message"))
        title, status = printable(str(about["title"])[:LONGEST_TITLE]), Status(name, why, bool(about["status_ok"]))
        states = found.snapshots, found.state, found.final
        return ChainRun(chain, found.reached, rows[EVENT], rows.get(CHANGE), *states, status=status, title=title)


def checkpoint_in(path: Path, chain: Chain) -> ChainCheckpoint:
    """Return the checkpoint in a folder. Raises InputError if it is missing, damaged, or that of another run."""
    group, file = opened(path, use_consolidated=False), path / STATE_FILE
    if not file.exists():
        raise InputError(f"{path}: has no checkpoint yet: begin the run again with this name")
    variables, _, about = netcdf_file.read_tables(file, "the state of a chain")
    if about.get("digest") != group.attrs["digest"] or whole_number(about, CHAIN_FORMAT.kind, path) != CHAIN_FORMAT.version:
        raise InputError(f"its {STATE_FILE} belongs to another run")
    wanted = MemoryStore()
    lay_out(wanted, dict(group.attrs))
    kinds = kinds_in(group.attrs)
    check_layout(zarr.open_group(wanted), group, kinds)
    rows = {kind: whole_number(about, kind, path, 0) for kind in kinds}
    _check_rows(path, group, rows)
    arrays = {name: np.asarray(one.values) for name, one in variables.items()}
    empty = ChainState.empty(chain.count)
    many = len(arrays[f"{SNAPSHOT}now"])
    snapshots = [checked_state({name: arrays[SNAPSHOT + name][i] for name in empty.arrays}, chain) for i in range(many)]
    state, final = (checked_state({name: arrays[of + name] for name in empty.arrays}, chain) for of in ("", FINAL))
    told = {EVENT: state.now[at.EVENTS], CHANGE: state.now[at.COUNT_OF_CHANGES]}
    if wrong := next((kind for kind, count in rows.items() if told[kind] != count), None):
        raise InputError(f"its {STATE_FILE} has {rows[wrong]} rows of {wrong}, and a state after {told[wrong]:.0f} of them")
    counts = whole_number(about, "every", path, 1), whole_number(about, "calls", path, 0)
    return ChainCheckpoint(str(about["engine"]), rows, state, final, snapshots, number(about, "reached", path), *counts)


def _check_rows(path: Path, group: Any, rows: Mapping[str, int]) -> None:
    """Refuse more rows than an array has, or rows without a file. Raises InputError."""
    for name, count in rows.items():
        array = group[name]
        files = sum(1 for _ in (path / name).glob("c.*")) if count else 0
        if count > min(array.shape[0], files * array.chunks[0]):
            raise InputError(f"its array {name!r} has {array.shape[0]} rows in {files} files, and its {STATE_FILE} says {count}")


def checked_state(arrays: Mapping[str, Any], chain: Chain) -> ChainState:
    """Return a state from the arrays of a file: compiled code goes by their whole numbers. Raises InputError for others."""
    empty = ChainState.empty(chain.count)
    for name, like in empty.arrays.items():
        if arrays[name].shape != like.shape or arrays[name].dtype != like.dtype:
            raise InputError(f"its {STATE_FILE} has the array {name!r} in another form than that of {chain.count} blocks")
    state = ChainState(**{name: np.array(one, order="C") for name, one in arrays.items()})
    moving = state.blocks[[at.SLIP, at.RATE_NOW, at.COUNTED, at.STRENGTH, at.SLIP_BEFORE]]
    if not (np.isfinite(state.now).all() and np.isfinite(moving).all() and not np.isnan(state.blocks).any()):
        raise InputError(f"its {STATE_FILE} has numbers that are not finite")
    pieces = max(len(law.pieces) for law in chain.laws[0])
    bounds = {at.MODE: (-1, 2), at.PIECE: (0, pieces - 1), at.AT_STRENGTH: (-1, 1), at.SLIPPED: (0, 1)}
    wrong = any((state.whole[row] < low).any() or (state.whole[row] > high).any() for row, (low, high) in bounds.items())
    if wrong or not 0 <= state.now[at.FIRST_BLOCK] < chain.count:
        raise InputError(f"its {STATE_FILE} has whole numbers that no state has")
    return state
