"""The results of a sweep in a zarr store that is written chunk by chunk, and can be read by `xarray.open_zarr` at any time.

The store is laid out before the first member is run. After that, only chunks are added, each file under a temporary name that is
changed when the file is complete. The status of a chunk is written after its results: a chunk without a status is not done, and is
run again. Nothing in the store depends on when, in which order or by which process chunks were done. Each file has a checksum (see
below). The checksums of a chunk are written after its status, and a chunk without them is not done either.

A store has a folder `.checksums` with one list for the files that exist from the start (all metadata and coordinates), and one
list for each chunk of members that is done. A list has one line for each file, with its SHA-256 and its name. The SHA-256 is `-`
for a file that does not exist, because zarr writes no file for an empty part of an array. The last line is the SHA-256 of the
lines before it. zarr and xarray ignore this folder.
"""

from __future__ import annotations

import hashlib
import warnings
from collections.abc import Callable, Iterable, Iterator
from contextlib import AbstractContextManager, ExitStack
from pathlib import Path
from types import TracebackType
from typing import Any, Self

import numpy as np
import xarray as xr
import zarr
from zarr.storage import MemoryStore

from stickslip.foundation import zarr_folder
from stickslip.foundation.atomic_write import held, read_bounded, write_atomically
from stickslip.foundation.errors import InputError
from stickslip.sweeps.execution.chunk import NOT_RUN, ChunkResult
from stickslip.sweeps.execution.plan import Plan
from stickslip.sweeps.results.layout import REASON, STATUS, array_of, as_begun, check_contents, in_order, lay_out, reading

FOLDER = ".checksums"
"""Name of the folder of lists inside a store."""
LAYOUT = "layout"
"""Name of the list of the files that exist from the start; the other lists have the number of a chunk as their name."""
LARGEST_LIST = 10_000_000
"""Size (bytes) of the largest list that is read."""
ABSENT = "-"
"""Text in place of the SHA-256 of a file that does not exist."""


def digest_of(path: Path) -> str:
    """Return the SHA-256 of a file, or ABSENT if it does not exist."""
    if not path.is_file():
        return ABSENT
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


def vouch_for(store: Path, name: str, files: Iterable[str]) -> None:
    """Write the list with this name, for the given files as they are now."""
    (store / FOLDER).mkdir(exist_ok=True)
    lines = "".join(f"{digest_of(store / file)} {file}\n" for file in sorted(files))
    text = lines + hashlib.sha256(lines.encode()).hexdigest() + "\n"
    write_atomically(store / FOLDER / name, lambda draft: draft.write_text(text, encoding="utf-8", newline="\n"))


def vouch_for_layout(store: Path) -> None:
    """Write the list LAYOUT of all files that exist now."""
    files = [path.relative_to(store).as_posix() for path in store.rglob("*") if path.is_file()]
    vouch_for(store, LAYOUT, [file for file in files if not file.startswith(FOLDER)])


def is_vouched_for(store: Path, name: str) -> bool:
    """Return True if there is a list with this name."""
    return (store / FOLDER / name).is_file()


def check_all(store: Path) -> set[str]:
    """Check every file that is named in a list of the store, and return the names of these files.

    Raises InputError at the first file that is not as it was written.
    """
    try:
        names = sorted(path.name for path in (store / FOLDER).iterdir() if not path.name.startswith("."))
        return {file for name in names for file in _checked(store, name)}
    except OSError as error:
        raise InputError(f"{ascii(error.filename or str(store))[1:-1]}: cannot be read: {error.strerror or error}") from None


def _checked(store: Path, name: str) -> Iterator[str]:
    """Yield the names of the files of a list, each after the file has been checked. Raises InputError."""
    for line in _lines(store / FOLDER / name):
        wanted, _, file = line.partition(" ")
        parts = Path(file).parts
        if not parts or ".." in parts or Path(file).is_absolute():
            raise InputError(f"{store}: damaged: {FOLDER}/{name} names {file!r}")
        if digest_of(store / file) != wanted:
            again = "copy it from elsewhere, or choose another name"
            if name != LAYOUT:
                again = f"remove {store / FOLDER / name}, and the same sweep runs these members again"
            raise InputError(f"{store}: damaged: {file} is not as it was written: {again}")
        yield file


def _lines(path: Path) -> list[str]:
    """Return the lines of a list except the last. Raises InputError if the last line is not the checksum of the others."""
    try:
        content = read_bounded(path, LARGEST_LIST)
        lines, last = content[:-65], content[-65:]
        if last == hashlib.sha256(lines).hexdigest().encode() + b"\n":
            return lines.decode().splitlines()
        what = "damaged"
    except (UnicodeDecodeError, InputError) as error:
        what = "not a list of checksums" if isinstance(error, UnicodeDecodeError) else str(error)
    raise InputError(f"{path}: {what}: remove it, and the same sweep runs these members again")


class ResultStore:
    """The store of a plan, in memory or in a folder. A folder is locked against other sweeps until the `with` block ends."""

    def __init__(self, plan: Plan, place: Path | MemoryStore) -> None:
        self.plan, self.place, self._lock = plan, place, ExitStack()
        self.group = zarr_folder.opened(place, "r+") if isinstance(place, Path) else zarr.open_group(place, mode="r+")

    @classmethod
    def in_memory(cls, plan: Plan) -> Self:
        """Create an empty store in memory."""
        place = MemoryStore()
        lay_out(plan, place)
        return cls(plan, place)

    @classmethod
    def at(cls, plan: Plan, path: Path) -> Self:
        """Create a store in a folder, or continue the one in it if it has the same plan. Raises InputError otherwise.

        Temporary files and unverified chunks, left by a sweep that was killed, are removed first.
        """
        zarr_folder.check_folder(path)
        if not path.exists():
            publish(path, lambda draft: lay_out(plan, draft))
        check_store(path)
        store = cls(as_begun(plan, path), path)
        store._lock.enter_context(held(path, f"{path}: another sweep is writing into it"))
        with writing(path):
            for draft in path.rglob("*.partial"):  # left by a sweep that was killed while it wrote
                if draft.is_file():
                    draft.unlink()
            for chunk in store.chunks_without_checksums():
                (path / store.files_of(chunk)[0]).unlink(missing_ok=True)
        return store

    def __enter__(self) -> Self:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None) -> None:
        self._lock.close()

    def files_of(self, chunk: int) -> list[str]:
        """Return the names of the files of a chunk in a folder, the file of its status first."""
        place = [str(int(at)) for at in np.unravel_index(chunk, self.plan.tiles)]
        arrays = ((name, array_of(self.group, name)) for name in (STATUS, REASON, *self.plan.work.names))
        return [f"{name}/c.{'.'.join(place + ['0'] * (array.ndim - len(place)))}" for name, array in arrays]

    def chunks_without_checksums(self) -> list[int]:
        """Return the chunks that have a status but no list of checksums: a writer died there, or the list was lost."""
        if not isinstance(self.place, Path):
            return []
        found = (chunk for chunk in range(self.plan.chunks) if not is_vouched_for(self.place, str(chunk)))
        return [chunk for chunk in found if (self.place / self.files_of(chunk)[0]).exists()]

    def missing(self) -> list[int]:
        """Return the numbers of the chunks of which some member is not done."""
        left = self.status == NOT_RUN
        return [chunk for chunk in range(self.plan.chunks) if left[self.plan.region(chunk)].any()]

    @property
    def status(self) -> np.ndarray[Any, np.dtype[np.int8]]:
        """The status codes of all members (`outcome.MEANINGS`), in the shape of the design."""
        with reading(self.place):
            return np.asarray(array_of(self.group, STATUS)[...])

    def write(self, chunk: int, result: ChunkResult) -> None:
        """Store the results of a chunk, in place of earlier ones if there are any. Raises InputError if they cannot be written."""
        region = self.plan.region(chunk)
        shape = tuple(one.stop - one.start for one in region)
        reasons = np.full(len(result.status), "", dtype=np.dtypes.StringDType())
        for place, reason in result.reasons.items():
            reasons[place] = reason
        with writing(self.place):
            if isinstance(self.place, Path):
                (self.place / FOLDER / str(chunk)).unlink(missing_ok=True)  # its checksums, before its files change
            for name, values in result.results.items():
                array_of(self.group, name)[region] = values.reshape(shape + values.shape[1:])
            array_of(self.group, REASON)[region] = reasons.reshape(shape)
            array_of(self.group, STATUS)[region] = result.status.reshape(shape)
            if isinstance(self.place, Path):
                vouch_for(self.place, str(chunk), self.files_of(chunk))

    def dataset(self) -> xr.Dataset:
        """Return the contents as a dataset, read lazily from a folder, or as arrays from a store in memory."""
        with reading(self.place):
            place = zarr_folder.Folder(self.place) if isinstance(self.place, Path) else self.place
            found: xr.Dataset = xr.open_zarr(place, chunks=None, consolidated=isinstance(self.place, Path))
            ordered = found[[*self.plan.work.names, STATUS, REASON]]
            return ordered if isinstance(self.place, Path) else ordered.load()


def writing(place: Path | MemoryStore) -> AbstractContextManager[None]:
    """Turn an error of the file system in the `with` block into an InputError with a message of one line."""
    begun = isinstance(place, Path) and is_vouched_for(place, LAYOUT)
    kept = "the members so far are kept, and the same command continues when there is room" if begun else "nothing was kept"
    return zarr_folder.writing(place, kept)


def check_store(path: Path) -> set[str]:
    """Check every file of a store against its checksum, and return the names of the files.

    Raises InputError for a damaged file, and for anything that is not the store of a sweep.
    """
    if not is_vouched_for(path, LAYOUT):
        about = path / "zarr.json"
        ours = (path / FOLDER).exists() or (about.is_file() and b"stickslip_sweep" in read_bounded(about, LARGEST_LIST))
        what = "a store without its checksums, of an older version or damaged" if ours else "not the store of a sweep"
        raise InputError(f"{path}: exists and is {what}: choose another name")
    return check_all(path)


def open_store(path: str | Path) -> xr.Dataset:
    """Open the store of a sweep, after checking every file against its checksum.

    The variables of the dataset are read when they are used. Raises InputError if there is no such store, if a file is damaged or
    unreadable, or if chunks of a stopped sweep have no checksums.
    """
    path = Path(path)
    if not path.exists():
        raise InputError(f"{path}: no such store")
    zarr_folder.check_folder(path)
    listed = check_store(path)
    for file in path.glob(f"{STATUS}/c*"):
        if file.relative_to(path).as_posix() not in listed and file.suffix != ".partial":
            raise InputError(f"{path}: has members without checksums, where a sweep was stopped: run the same sweep again")
    with reading(path), warnings.catch_warnings():
        warnings.simplefilter("ignore", category=UserWarning)  # of a dimension that is there twice, which is refused
        zarr_folder.opened(path)
        found: xr.Dataset = xr.open_zarr(zarr_folder.Folder(path), chunks=None)
        check_contents(found)
        return in_order(found)


def publish(path: Path, fill: Callable[[Path], object]) -> None:
    """Let `fill` create a store under a temporary name, then rename it to `path`, so that it appears complete or not at all.

    Raises InputError.
    """

    def write(draft: Path) -> None:
        fill(draft)
        zarr_folder.consolidate(draft)
        vouch_for_layout(draft)

    with writing(path):
        write_atomically(path, write, folder=True)
