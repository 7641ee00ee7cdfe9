"""Folders of zarr: how their arrays are compressed, how they are read with care, and errors of one line for all that goes wrong.

Somebody else may have written a folder that is read. Only ordinary files are read, of a bounded size, and a chunk whose compressed
content says that it unpacks to more than a bound is refused before it is unpacked.
"""

from __future__ import annotations

import asyncio
import errno
import math
import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, Literal

import zarr
from typing_extensions import override
from zarr.codecs import Crc32cCodec, ZstdCodec
from zarr.core.buffer import default_buffer_prototype
from zarr.storage import LocalStore

from stickslip.foundation.atomic_write import read_bounded
from stickslip.foundation.errors import InputError, never_show
from stickslip.foundation.show import clean

COMPRESSED = (ZstdCodec(), Crc32cCodec())
"""Codecs of every array: compression, then a CRC-32C checksum after each chunk, which every reader of zarr verifies."""
NOT_OF_ZARR = "Object at "
"""How zarr begins to warn of files in a folder that are not its own."""
NO_PART_OF_ZARR = "Consolidated metadata is currently not part"
"""How it begins to warn that this is not part of its format; xarray reads it."""
LARGEST_CHUNK = 2**28
"""Bytes of the largest chunk that is unpacked, and of the largest file that is read: 33 million numbers."""
LARGEST_METADATA = 4_000_000
"""Bytes of the largest file of metadata that is read."""
METADATA = "zarr.json"
"""Name of the files of metadata."""
BYTES_OF_SIZE = {0: 0, 1: 2, 2: 4, 3: 8}
"""Bytes of the field with the size of the content in a frame of Zstandard, by its flag (RFC 8878)."""
IN_ONE_FOLDER: Any = {"name": "default", "separator": "."}
"""Naming of chunks that puts all chunks of an array into one folder."""


class Folder(LocalStore):
    """A folder of zarr. Only ordinary files are read: none that is large, and none that unpacks to more than allowed."""

    @override
    async def get(self, key: str, prototype: Any = None, byte_range: Any = None) -> Any:
        if byte_range is not None:
            raise InputError(f"{self.root}: a part of a file is asked for: not a folder that stickslip has written")
        path = self.root / key
        largest = LARGEST_METADATA if path.name == METADATA else LARGEST_CHUNK
        try:
            content = await asyncio.to_thread(read_bounded, path, largest)
        except (FileNotFoundError, IsADirectoryError, NotADirectoryError):
            return None
        except InputError as error:
            raise InputError(f"{path}: {error}") from None
        if path.name != METADATA and unpacked_size(content) > LARGEST_CHUNK:
            raise InputError(f"{path}: unpacks to more than {LARGEST_CHUNK} bytes")
        return (prototype or default_buffer_prototype()).buffer.from_bytes(content)


def unpacked_size(content: bytes) -> float:
    """Return the number of bytes to which a chunk unpacks as its first frame says; infinity if it is no frame that says so."""
    if content[:4] != b"\x28\xb5\x2f\xfd" or len(content) < 5:
        return math.inf
    kind = content[4]
    is_single, dictionary, flag = kind >> 5 & 1, (0, 1, 2, 4)[kind & 3], kind >> 6
    size = BYTES_OF_SIZE[flag] or is_single
    if not size:
        return math.inf
    begin = 5 + (not is_single) + dictionary
    return int.from_bytes(content[begin : begin + size], "little") + (256 if size == 2 else 0)


def opened(path: Path, mode: Literal["r", "r+"] = "r", use_consolidated: bool | None = None) -> zarr.Group:
    """Open the group in a folder that somebody else may have written: see `Folder`.

    Raises InputError if the folder is a link, or an array in it is not compressed as those of this package are.
    """
    check_folder(path)
    group = zarr.open_group(Folder(path), mode=mode, use_consolidated=use_consolidated)
    never_show(NOT_OF_ZARR, "zarr.", UserWarning)
    arrays = list(group.arrays())
    for name, array in arrays:
        codecs = [one["name"] for one in array.metadata.to_dict().get("codecs", ())]  # type: ignore[union-attr, index, call-overload]
        if codecs[1:] != ["zstd", "crc32c"] or codecs[0] not in ("bytes", "vlen-utf8"):
            raise InputError(f"its array {ascii(name)[:60]} is packed in another way")
    return group


def check_folder(path: Path) -> None:
    """Refuse a folder that is a link: what is written would go elsewhere. Raises InputError."""
    if path.is_symlink():
        raise InputError(f"{path}: is a link: name the folder itself")


def check_writable(path: Path) -> None:
    """Refuse to write into a folder that is a link, or in which anything is one, at whatever depth. Raises InputError."""
    check_folder(path)
    try:
        link = next(_links_in(path), None) if path.is_dir() else None
    except OSError as error:
        raise InputError(f"{error.filename}: cannot be read: {error.strerror}") from None
    if link is not None:
        raise InputError(f"{path}: {clean(os.path.relpath(link, path))} in it is a link: put the folder or the file itself there")


def _links_in(folder: str | Path) -> Iterator[str]:
    with os.scandir(folder) as entries:
        for entry in entries:
            if entry.is_symlink():
                yield entry.path
            elif entry.is_dir(follow_symlinks=False):
                yield from _links_in(entry.path)


def consolidate(place: Any) -> None:
    """Write what is known of all arrays into one file, which readers open first and which changes at once."""
    for warning in (NOT_OF_ZARR, NO_PART_OF_ZARR):
        never_show(warning, "zarr.", UserWarning)
    zarr.consolidate_metadata(place)


@contextmanager
def reading(place: Any, what: str) -> Iterator[None]:
    """Turn every error in the `with` block, which reads a store, into an InputError with a message of one line.

    `what` says in the message what the store should be.
    """
    try:
        yield
    except InputError as error:
        text = str(error)
        raise (error if text.startswith(str(place)) else InputError(f"{place}: not {what}: {text}")) from None
    except Exception as error:  # the libraries raise errors of many kinds for a damaged file
        text = f"{type(error).__name__}: {clean(' '.join(str(error).split()))[:200]}"
        raise InputError(f"{place}: cannot be read: {text}") from None


@contextmanager
def writing(place: Any, kept: str) -> Iterator[None]:
    """Turn an error of the file system in the `with` block into an InputError with a message of one line.

    `kept` ends the message if the disk is full.
    """
    try:
        yield
    except OSError as error:
        full = error.errno in (errno.ENOSPC, errno.EDQUOT)
        where = ascii(error.filename)[1:-1] if error.filename else place
        raise InputError(f"{where}: cannot be written: {error.strerror or error}{f'; {kept}' if full else ''}") from None
