"""What all folders of zarr share: they appear complete or not at all, say their format, and are checked before they are trusted.

Each chunk ends in its CRC-32C, a codec of zarr, so that every reader of zarr verifies it. The attributes that do not change have a
checksum among them.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable, Iterable, Mapping
from contextlib import AbstractContextManager
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

import google_crc32c
import zarr

from stickslip.foundation import zarr_folder
from stickslip.foundation.atomic_write import read_bounded, write_atomically
from stickslip.foundation.errors import InputError

CRC = 4
"""Bytes of the CRC-32C at the end of a chunk."""
FOLDER_KINDS = {"stickslip_sweep": "the store of a sweep", "stickslip_planar": "the run of a planar slab"}
"""What a folder is in words, by the attribute that holds the version of its layout."""


@dataclass(frozen=True)
class FolderFormat:
    """One of the `FOLDER_KINDS` of folders, with the version of its layout.

    The attributes named in `changes` are not part of the checksum of the others, which is the attribute `digest`.
    """

    kind: str
    version: int
    changes: tuple[str, ...] = ()

    @property
    def what(self) -> str:
        """The name of the kind in messages."""
        return FOLDER_KINDS[self.kind]

    def attributes(self, about: Mapping[str, Any]) -> dict[str, Any]:
        """Return the attributes of a new folder, with its version and the checksum."""
        whole = {**about, self.kind: self.version}
        return whole | {"digest": self.digest_of(whole)}

    def digest_of(self, about: Mapping[str, Any]) -> str:
        """Return the checksum of the attributes that do not change."""
        kept = {name: value for name, value in about.items() if name not in (*self.changes, "digest")}
        return hashlib.sha256(json.dumps(kept, sort_keys=True).encode()).hexdigest()

    def reading(self, place: Any) -> AbstractContextManager[None]:
        """Turn every error in the `with` block, which reads a folder, into an InputError with a message of one line."""
        return zarr_folder.reading(place, self.what)

    def is_in(self, path: Path) -> bool:
        """Return True if a folder says that it is of this kind, whether it is sound or not."""
        try:
            return f'"{self.kind}"'.encode() in read_bounded(path / zarr_folder.METADATA, zarr_folder.LARGEST_METADATA)
        except (InputError, OSError):
            return False

    def opened(self, path: Path, mode: Literal["r", "r+"] = "r", use_consolidated: bool | None = None) -> zarr.Group:
        """Return the group in a folder after checking its attributes. Raises InputError."""
        if not (path / zarr_folder.METADATA).exists():
            why = f"not {self.what}: it is no folder of zarr" if path.exists() else "no such file or folder"
            raise InputError(f"{path}: {why}")
        group = zarr_folder.opened(path, mode, use_consolidated)
        version = group.attrs.get(self.kind, "none")
        if version != self.version:
            older = isinstance(version, int) and version < self.version
            other = next((f"it is {what}" for kind, what in FOLDER_KINDS.items() if kind in group.attrs and kind != self.kind), "")
            found = other or f"found {version}{', which the version that made it reads' if older else ''}"
            raise InputError(f"{path}: not {self.what} of this version of stickslip (format {self.version} expected, {found})")
        if group.attrs.get("digest") != self.digest_of(group.attrs):
            raise InputError(f"{path}: damaged: its attributes do not have their checksum")
        return group


def create(path: Path, lay_out: Callable[[Path], object]) -> None:
    """Let `lay_out` fill a folder under a temporary name, then rename it to `path`, so that it appears complete or not at all."""

    def write(draft: Path) -> None:
        lay_out(draft)
        zarr_folder.consolidate(draft)

    write_atomically(path, write, folder=True)


def check_layout(wanted: zarr.Group, found: zarr.Group, growing: Iterable[str] = ()) -> None:
    """Refuse arrays of another form than those of a layout, but for the number of rows of those that grow. Raises InputError."""
    grows = frozenset(growing)
    for name, array in wanted.members(max_depth=None):
        if not isinstance(array, zarr.Array):
            continue
        other = found.get(name)
        if not isinstance(other, zarr.Array):
            raise InputError(f"its array {name!r} is missing")
        if _form(array, name in grows) != _form(other, name in grows):
            raise InputError(f"its array {name!r} has another form")


def _form(array: zarr.Array[Any], grows: bool) -> dict[str, Any]:
    return {**array.metadata.to_dict(), "shape": array.shape[grows:]}


def is_sound(file: Path) -> bool:
    """Return True if a file is a chunk that ends in its checksum. Raises InputError for a pipe and the like."""
    content = read_bounded(file, zarr_folder.LARGEST_CHUNK)
    return len(content) > CRC and google_crc32c.value(content[:-CRC]) == int.from_bytes(content[-CRC:], "little")
