"""Results of a sweep as a zarr store: written chunk by chunk, readable by `xarray.open_zarr` at any time.

The store is laid out before the first member is run, and then only chunks are added, each file under a temporary name that is
changed when it is whole. The status of a chunk is written last: a chunk without it is not done and is run again. Nothing in the
store depends on when, in which order or by whom chunks were done.
"""

from __future__ import annotations

import errno
import os
import shutil
import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from types import TracebackType
from typing import Any, Self
from uuid import uuid4

import numpy as np
import xarray as xr
import zarr
from zarr.storage import MemoryStore

from stickslip.errors import InputError
from stickslip.sweeps.agreement import as_begun
from stickslip.sweeps.chunk import ChunkResult
from stickslip.sweeps.layout import REASON, STATUS, array_of, lay_out
from stickslip.sweeps.outcome import NOT_RUN
from stickslip.sweeps.plan import Plan


class ResultStore:
    """The store of a plan, in memory or in a folder, which it holds against other sweeps until the end of its `with`."""

    def __init__(self, plan: Plan, place: Path | MemoryStore, hold: int | None = None) -> None:
        self.plan, self.place, self._hold = plan, place, hold
        self.group = zarr.open_group(place, mode="r+")

    @classmethod
    def in_memory(cls, plan: Plan) -> Self:
        """An empty one."""
        place = MemoryStore()
        lay_out(plan, place)
        return cls(plan, place)

    @classmethod
    def at(cls, plan: Plan, path: Path) -> Self:
        """A new one, or the one that is there if it is of the same plan. Raises InputError for anything else that is there."""
        if not path.exists():
            _create(plan, path)
        plan, hold = as_begun(plan, path), _held(path)
        for draft in path.rglob("*.partial"):  # of a sweep that was killed while it wrote
            draft.unlink()
        return cls(plan, path, hold)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None) -> None:
        if self._hold is not None:
            os.close(self._hold)
            self._hold = None

    def missing(self) -> list[int]:
        """Chunks that are not done."""
        firsts = self.status[tuple(slice(None, None, part) for part in self.plan.tile)]
        return [int(chunk) for chunk in np.flatnonzero(firsts.ravel() == NOT_RUN)]

    @property
    def status(self) -> np.ndarray[Any, np.dtype[np.int8]]:
        """Codes of all members (`outcome.MEANINGS`), in the shape of the design."""
        return np.asarray(array_of(self.group, STATUS)[...])

    def write(self, chunk: int, result: ChunkResult) -> None:
        """Keep what came of a chunk. Raises InputError where it cannot be written."""
        region = self.plan.region(chunk)
        shape = tuple(one.stop - one.start for one in region)
        reasons = np.full(len(result.status), "", dtype=np.dtypes.StringDType())
        for place, reason in result.reasons.items():
            reasons[place] = reason
        with writing(self.place):
            for name, values in result.results.items():
                array_of(self.group, name)[region] = values.reshape(shape + values.shape[1:])
            array_of(self.group, REASON)[region] = reasons.reshape(shape)
            array_of(self.group, STATUS)[region] = result.status.reshape(shape)

    def dataset(self) -> xr.Dataset:
        """What is there: lazily from a folder, as arrays from memory."""
        found: xr.Dataset = xr.open_zarr(self.place, chunks=None, consolidated=isinstance(self.place, Path))
        ordered = found[[*self.plan.work.names, STATUS, REASON]]
        return ordered if isinstance(self.place, Path) else ordered.load()


@contextmanager
def writing(place: Path | MemoryStore) -> Iterator[None]:
    """Around what writes: an error of the file system becomes one line. Raises InputError."""
    try:
        yield
    except OSError as error:
        full = error.errno in (errno.ENOSPC, errno.EDQUOT)
        kept = "; what is there can be read, and the same command goes on with it when there is room" if full else ""
        raise InputError(f"{place}: cannot be written: {error.strerror or error}{kept}") from None


def _create(plan: Plan, path: Path) -> None:
    publish(path, lambda draft: lay_out(plan, draft))


def publish(path: Path, fill: Callable[[Path], object]) -> None:
    """Let `fill` make a store under another name, then give it its own: whole or not at all. Raises InputError."""
    draft = path.with_name(f".{uuid4().hex}{path.suffix}")
    try:
        with writing(path):
            fill(draft)
            with warnings.catch_warnings():
                warnings.simplefilter("ignore", category=UserWarning)  # not part of the format, but what xarray wishes
                zarr.consolidate_metadata(draft)
            draft.replace(path)
    finally:
        shutil.rmtree(draft, ignore_errors=True)


def _held(path: Path) -> int | None:
    """Hold a store for one sweep, until the number that is returned is closed or the process ends, however it does.

    Raises InputError where another one holds it.
    """
    try:
        import fcntl
    except ImportError:  # Windows
        return None
    folder = os.open(path, os.O_RDONLY)
    try:
        fcntl.flock(folder, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        os.close(folder)
        raise InputError(f"{path}: another sweep is writing into it") from None
    except OSError:  # a file system without locks
        os.close(folder)
        return None
    return folder
