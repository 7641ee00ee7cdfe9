"""Check the files that a command will write before it starts its work."""

from __future__ import annotations

import os
from pathlib import Path

from stickslip.foundation.errors import InputError


def check_target(path: Path, option: str, suffixes: tuple[str, ...]) -> None:
    """Refuse a file that could not be written later. Raises InputError."""
    if path.suffix.lower() not in suffixes:
        raise InputError(f"{option} {path}: the name must end in {' or '.join(suffixes)}")
    if path.is_dir():
        raise InputError(f"{option} {path}: is a folder")
    if not path.parent.is_dir():
        raise InputError(f"{option} {path}: there is no folder {path.parent}")
    if not os.access(path.parent, os.W_OK | os.X_OK):
        raise InputError(f"{option} {path}: the folder {path.parent} is not writable")


def check_folder(path: Path, option: str) -> None:
    """Refuse a folder that could not be created or written to. Raises InputError."""
    existing = next(folder for folder in (path, *path.absolute().parents) if folder.exists())
    if not existing.is_dir():
        raise InputError(f"{option} {path}: {existing} is not a folder")
    if not os.access(existing, os.W_OK | os.X_OK):
        raise InputError(f"{option} {path}: the folder {existing} is not writable")
