"""Check the files that a command will write before it starts its work, and write them at its end."""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import typer

from stickslip.foundation.atomic_write import write_atomically
from stickslip.foundation.errors import InputError

DPI = 200.0
"""Dots per inch of figures if the user does not say."""
PICTURES = (".png", ".pdf", ".svg")
"""File suffixes of figures."""


@dataclass(frozen=True)
class Look:
    """What a user typed on the look of figures: dots per inch and size."""

    dpi: float | None = None
    size: str | None = None

    @property
    def dots(self) -> float:
        """Dots per inch of the file."""
        return DPI if self.dpi is None else self.dpi

    @property
    def place(self) -> dict[str, Any]:
        """The keywords for functions that draw."""
        return {} if self.size is None else {"size": self.size}

    def check(self, *figures: object) -> None:
        """Refuse a look that no figure can have, or that no figure is there to have. Raises InputError.

        `figures` are the files of figures that are wanted, None for those that are not.
        """
        given = [option for option, value in (("--dpi", self.dpi), ("--size", self.size)) if value is not None]
        if not given:
            return
        if not any(figures):
            raise InputError(f"{given[0]} is the look of a figure: name the file of one, say --figure NAME.png")
        from stickslip.figures.sheet import check_dpi, read_size

        sides = (1.0, 1.0) if self.size is None else read_size(self.size, (1.0, 1.0), "--size")
        check_dpi(self.dots, max(sides), "--dpi")


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


def drawing(draw: Callable[..., object], look: Look) -> Callable[[Path], Path]:
    """Return a function that lets `draw` draw in a new figure of this look, and writes the figure to a file."""

    def write(path: Path) -> Path:
        from stickslip.figures.sheet import StickslipFigure
        from stickslip.figures.style import styled

        figure = StickslipFigure()
        draw(figure=figure, **look.place)
        return write_atomically(path, lambda draft: styled(figure.savefig)(draft, dpi=look.dots))

    return write


def announce(*paths: Path | None) -> None:
    """Say which files were written; None is no file."""
    for path in paths:
        if path is not None:
            typer.echo(f"written: {path}")
