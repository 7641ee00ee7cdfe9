"""Checksums of the store of a sweep: a file that is not as it was written is detected, and named in an error.

A store has a folder `.checksums` with one list for the files that exist from the start (all metadata and coordinates), and one
list for each chunk of members that is done. A list has one line for each file, with its SHA-256 and its name. The SHA-256 is `-`
for a file that does not exist, because zarr writes no file for an empty part of an array. The last line is the SHA-256 of the
lines before it. zarr and xarray ignore this folder.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterable, Iterator
from pathlib import Path

from stickslip.foundation.atomic_write import read_bounded, write_atomically
from stickslip.foundation.errors import InputError

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
