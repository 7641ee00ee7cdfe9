"""Checksums of the store of a sweep: what was written is what is read, or a line says which file is not.

A store has a folder `.checksums` with one list for what is laid out at the start (all metadata and coordinates), and one for each
chunk of members that is done. A list has a line a file, its SHA-256 and its name, `-` for one that there is not (zarr writes no
file for a part that is empty), and at its end the SHA-256 of these lines. zarr and xarray do not look at this folder.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterable, Iterator
from pathlib import Path

from stickslip.foundation.atomic_write import write_atomically
from stickslip.foundation.errors import InputError

FOLDER = ".checksums"
LAYOUT = "layout"
ABSENT = "-"


def digest_of(path: Path) -> str:
    """Return the SHA-256 of a file, or ABSENT."""
    if not path.is_file():
        return ABSENT
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


def vouch_for(store: Path, name: str, files: Iterable[str]) -> None:
    """Write the list of this name, of files as they are now."""
    (store / FOLDER).mkdir(exist_ok=True)
    lines = "".join(f"{digest_of(store / file)} {file}\n" for file in sorted(files))
    text = lines + hashlib.sha256(lines.encode()).hexdigest() + "\n"
    write_atomically(store / FOLDER / name, lambda draft: draft.write_text(text, encoding="utf-8", newline="\n"))


def vouch_for_layout(store: Path) -> None:
    """Write the list of all files that there are."""
    files = [path.relative_to(store).as_posix() for path in store.rglob("*") if path.is_file()]
    vouch_for(store, LAYOUT, [file for file in files if not file.startswith(FOLDER)])


def is_vouched_for(store: Path, name: str) -> bool:
    """Return True if there is a list of this name."""
    return (store / FOLDER / name).is_file()


def check_all(store: Path) -> set[str]:
    """Check every file that a list of the store names, and return their names.

    Raises InputError at the first file that is not as it was written.
    """
    try:
        names = sorted(path.name for path in (store / FOLDER).iterdir() if not path.name.startswith("."))
        return {file for name in names for file in _checked(store, name)}
    except OSError as error:
        raise InputError(f"{store}: cannot be read: {error.strerror or error}") from None


def _checked(store: Path, name: str) -> Iterator[str]:
    """Yield the files of a list, each after it has been checked. Raises InputError."""
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
    """Return the lines of a list but the last. Raises InputError for a list that does not have its checksum."""
    content = path.read_bytes()
    lines, last = content[:-65], content[-65:]
    if last != hashlib.sha256(lines).hexdigest().encode() + b"\n":
        raise InputError(f"{path}: damaged: remove it, and the same sweep runs these members again")
    return lines.decode().splitlines()
