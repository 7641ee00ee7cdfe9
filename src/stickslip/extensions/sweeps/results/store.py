"""The results of a sweep: in memory as a dataset, or in a zarr store that is written chunk by chunk and can be read at any time.

The dataset in memory is what a store holds that has just been laid out; its arrays are filled in place, because calls of zarr for
each variable of each chunk take longer than the members themselves.

In a folder, the store is laid out before the first member is run. After that, only chunks are added, each file under a temporary
name that is changed when the file is complete. The status of a chunk is written after its results: a chunk without a status is not
done, and is run again. A chunk that is done has all its files, and each file ends in its checksum. Nothing in the store depends on
when, in what order or by what process chunks were done.
"""

from __future__ import annotations

import json
from contextlib import AbstractContextManager, ExitStack
from pathlib import Path
from types import TracebackType
from typing import Any, Self

import numpy as np
import xarray as xr
import zarr
from zarr.storage import MemoryStore

from stickslip.extensions.sweeps.execution.chunk import NOT_RUN, SAMPLE_TIME, ChunkResult
from stickslip.extensions.sweeps.execution.plan import Plan
from stickslip.extensions.sweeps.results.layout import (
    REASON,
    STATUS,
    SWEEP_FORMAT,
    array_of,
    as_begun,
    check_contents,
    in_order,
    lay_out,
    read_design,
)
from stickslip.foundation import zarr_folder
from stickslip.foundation.atomic_write import read_bounded
from stickslip.foundation.errors import InputError, never_show
from stickslip.foundation.locks import held
from stickslip.solution.files import create, is_sound


class ResultStore:
    """The store of a plan, in memory or in a folder. A folder is locked against other sweeps until the `with` block ends."""

    def __init__(self, plan: Plan, place: Path | MemoryStore) -> None:
        self.plan, self.place, self._lock = plan, place, ExitStack()
        self.names = (*plan.work.names, STATUS, REASON)
        self.loaded: xr.Dataset | None = None
        self.arrays: dict[str, Any]
        if isinstance(place, Path):
            group = zarr_folder.opened(place, "r+")
            with zarr.config.set({"array.write_empty_chunks": True}):  # taken when opened: a file that is missing is noticed
                self.arrays = {name: array_of(group, name) for name in self.names}
        else:
            self.loaded = self._opened().load()
            self.arrays = {name: self.loaded[name].values for name in self.names}

    @classmethod
    def in_memory(cls, plan: Plan) -> Self:
        """Create an empty store in memory."""
        place = MemoryStore()
        lay_out(plan, place)
        return cls(plan, place)

    @classmethod
    def at(cls, plan: Plan, path: Path) -> Self:
        """Create a store in a folder, or continue the one in it if it has the same plan. Raises InputError otherwise.

        Temporary files, left by a sweep that was killed, are removed first.
        """
        zarr_folder.check_writable(path)
        if not path.exists():
            with writing(path):
                create(path, lambda draft: lay_out(plan, draft))
        with SWEEP_FORMAT.reading(path):
            store = cls(as_begun(plan, path, check_store(path)), path)
        store._lock.enter_context(held(path, f"{path}: another sweep is writing into it"))
        with writing(path):
            for draft in path.rglob("*.partial"):  # left by a sweep that was killed while it wrote
                if draft.is_file():
                    draft.unlink()
        return store

    def __enter__(self) -> Self:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None) -> None:
        self._lock.close()

    def missing(self) -> list[int]:
        """Return the numbers of the chunks with members that are not done."""
        left = self.status == NOT_RUN
        return [chunk for chunk in range(self.plan.chunks) if left[self.plan.region(chunk)].any()]

    @property
    def status(self) -> np.ndarray[Any, np.dtype[np.int8]]:
        """The status codes of all members (`outcome.MEANINGS`), in the shape of the design."""
        with SWEEP_FORMAT.reading(self.place):
            return np.array(self.arrays[STATUS][...])

    def write(self, chunk: int, result: ChunkResult) -> None:
        """Store the results of a chunk, in place of earlier ones if there are any. Raises InputError if they cannot be written."""
        region = self.plan.region(chunk)
        shape = tuple(one.stop - one.start for one in region)
        reasons = np.full(len(result.status), "", dtype=np.dtypes.StringDType())
        for place, reason in result.reasons.items():
            reasons[place] = reason
        with writing(self.place):
            for name, values in result.results.items():
                self.arrays[name][region] = values.reshape(shape + values.shape[1:])
            self.arrays[REASON][region] = reasons.reshape(shape)
            self.arrays[STATUS][region] = result.status.reshape(shape)

    def dataset(self) -> xr.Dataset:
        """Return the contents as a dataset, read lazily from a folder, or as arrays from a store in memory."""
        return self._opened() if self.loaded is None else self.loaded

    def _opened(self) -> xr.Dataset:
        with SWEEP_FORMAT.reading(self.place):
            place = zarr_folder.Folder(self.place) if isinstance(self.place, Path) else self.place
            found: xr.Dataset = xr.open_zarr(place, chunks=None, consolidated=isinstance(self.place, Path))
            return found[list(self.names)]


def writing(place: Path | MemoryStore) -> AbstractContextManager[None]:
    """Turn an error of the file system in the `with` block into an InputError with a message of one line."""
    begun = isinstance(place, Path) and SWEEP_FORMAT.is_in(place)
    kept = "the members so far are kept, and the same command continues when there is room" if begun else "nothing was kept"
    return zarr_folder.writing(place, kept)


def check_store(path: Path) -> zarr.Group:
    """Check every file of a store, and return its group. Raises InputError for a damaged file, and for what is no such store."""
    if not SWEEP_FORMAT.is_in(path):
        raise InputError(f"{path}: exists and is not the store of a sweep: choose another name")
    group = SWEEP_FORMAT.opened(path)
    _check_metadata(path, group)
    arrays = dict(group.arrays())
    others = {*read_design(group.attrs)[1], SAMPLE_TIME} & set(arrays)
    for name in sorted(others):
        _check_file(path, _first_file_of(arrays.pop(name)), "copy it from elsewhere, or choose another name")
    ends = {name: ".0" * (array.ndim - array_of(group, STATUS).ndim) for name, array in arrays.items()}
    for status in path.glob(f"{STATUS}/c.*"):
        if status.suffix != ".partial":
            for name, end in ends.items():
                _check_file(path, f"{name}/{status.name}{end}", f"remove {status}, and the same sweep runs these members again")
    return group


def _check_file(store: Path, name: str, again: str) -> None:
    try:
        sound = is_sound(store / name)
    except FileNotFoundError:
        sound = False
    except (InputError, OSError) as error:
        raise InputError(f"{store}: {name}: {getattr(error, 'strerror', None) or error}: {again}") from None
    if not sound:
        raise InputError(f"{store}: damaged: {name} is not as it was written: {again}")


def open_store(path: str | Path) -> xr.Dataset:
    """Open the store of a sweep, after checking every file against its checksum.

    The variables of the dataset are read when they are used. Raises InputError if there is no such store, or if a file is damaged
    or unreadable.
    """
    path = Path(path)
    if not path.exists():
        raise InputError(f"{path}: no such store")
    never_show("Duplicate dimension names present", category=UserWarning)  # they are refused
    with SWEEP_FORMAT.reading(path):
        check_store(path)
        found: xr.Dataset = xr.open_zarr(zarr_folder.Folder(path), chunks=None)
        check_contents(found)
        return in_order(found)


def _first_file_of(array: zarr.Array[Any]) -> str:
    """Return the name of the file of the first chunk of an array inside its folder."""
    name: str = array.metadata.encode_chunk_key((0,) * array.ndim)
    return f"{array.path}/{name}"


def _check_metadata(path: Path, group: zarr.Group) -> None:
    """Compare what is known of each array in its own file with what was gathered from these files. Raises InputError."""
    for name, array in group.arrays():
        content = json.loads(read_bounded(path / name / zarr_folder.METADATA, zarr_folder.LARGEST_METADATA))
        if content != json.loads(json.dumps(array.metadata.to_dict())):
            raise InputError(f"{path}: damaged: {name}/{zarr_folder.METADATA} is not as it was written")
