"""Check the files that a command will write before it starts its work, and write them at its end."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

import typer

from stickslip.foundation.atomic_write import write_atomically
from stickslip.foundation.errors import InputError

if TYPE_CHECKING:
    from matplotlib.figure import Figure

PICTURES = (".png", ".pdf", ".svg")
"""File suffixes of figures."""


def check_target(path: Path | None, option: str, suffixes: tuple[str, ...] = PICTURES) -> None:
    """Refuse a file that could not be written later; None is no file. Raises InputError."""
    if path is None:
        return
    if path.suffix.lower() not in suffixes:
        raise InputError(f"{option} {path}: the name must end in {' or '.join(suffixes)}")
    if path.is_dir():
        raise InputError(f"{option} {path}: is a folder")
    if not path.parent.is_dir():
        raise InputError(f"{option} {path}: there is no folder {path.parent}")
    _check_writable(path, path.parent, option)


def check_folder(path: Path, option: str) -> None:
    """Refuse a folder that could not be created or written to. Raises InputError."""
    existing = next(folder for folder in (path, *path.absolute().parents) if folder.exists())
    if not existing.is_dir():
        raise InputError(f"{option} {path}: {existing} is not a folder")
    _check_writable(path, existing, option)


def _check_writable(path: Path, folder: Path, option: str) -> None:
    if not os.access(folder, os.W_OK | os.X_OK):
        raise InputError(f"{option} {path}: the folder {folder} is not writable")


def write_files(*targets: tuple[Path | None, Callable[[Path], object]]) -> list[Path]:
    """Let each function write its file, and return the files; those that are None are not wanted."""
    wanted = [(path, write) for path, write in targets if path is not None]
    for path, write in wanted:
        write(path)
    return [path for path, _ in wanted]


def drawing(figure: Callable[[], Figure]) -> Callable[[Path], Path]:
    """Return a function that draws a figure and writes it to a file."""
    return lambda path: write_atomically(path, figure().savefig)


def announce(*paths: Path | None) -> None:
    """Say which files were written; None is no file."""
    for path in paths:
        if path is not None:
            typer.echo(f"written: {path}")
