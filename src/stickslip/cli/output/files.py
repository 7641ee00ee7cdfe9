"""Check the files that a command will write before it starts its work, and write them at its end."""

from __future__ import annotations

import os
import warnings
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, NamedTuple

import typer

from stickslip.cli.options import FIGURES, SIZE_HELP, Dpi, option
from stickslip.foundation.atomic_write import check_replaceable, write_atomically
from stickslip.foundation.errors import InputError, warn

CATALOGUES = (".csv", ".parquet", ".nc")
"""File suffixes of catalogues, those of `solution.files.catalogue_rows`, which takes long to import."""
LARGE_FILE = 10_000_000
"""The size of a file is reported from this size (bytes) on."""
DPI = 200.0
"""Dots per inch of figures if the user does not say."""
CROWDED = "constrained_layout not applied"
"""How matplotlib begins to say that the panels of a figure have no room beside their labels."""
PICTURES = (".png", ".pdf", ".svg")
"""File suffixes of figures."""


@dataclass(frozen=True)
class FigureLook:
    """What a user typed on the look of figures: dots per inch and size."""

    dpi: Dpi = None
    size: Annotated[str | None, option(SIZE_HELP, "--size", "--figure-size", panel=FIGURES)] = None

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
            raise InputError(f"{given[0]} needs a figure: name its file, say --figure NAME.png")
        from stickslip.figures.sheet import check_dpi, read_size

        sides = (1.0, 1.0) if self.size is None else read_size(self.size, (1.0, 1.0), "--size")
        check_dpi(self.dots, max(sides), "--dpi")


class Target(NamedTuple):
    """A file that a command will write: the option that names it, its path (None: not wanted), and the suffixes it may have."""

    option: str
    path: Path | None
    suffixes: tuple[str, ...] = PICTURES


def check_targets(*targets: Target) -> None:
    """Refuse files that could not be written later, and a file that is named twice. Raises InputError."""
    named: dict[Path, str] = {}
    for name, path, suffixes in targets:
        if path is None:
            continue
        check_target(path, name, suffixes)
        place = path.absolute()
        if place in named:
            raise InputError(f"{name} {path}: is already the file of {named[place]}: choose another name")
        named[place] = name


def check_target(path: Path | None, option: str, suffixes: tuple[str, ...] = PICTURES) -> None:
    """Refuse a file that could not be written later; None is no file. Raises InputError."""
    if path is None:
        return
    shown = path if str(path).isprintable() else ascii(str(path))
    if path.suffix.lower() not in suffixes:
        raise InputError(f"{option} {shown}: the name must end in {' or '.join(suffixes)}")
    try:
        _check_place(path, f"{option} {shown}")
    except InputError:
        raise
    except (OSError, ValueError) as error:  # a name that is too long, or that holds a null character
        raise InputError(f"{option} {str(shown)[:60]}: cannot be a file: {getattr(error, 'strerror', None) or error}") from None


def _check_place(path: Path, where: str) -> None:
    if path.is_dir():
        raise InputError(f"{where}: is a folder")
    if not path.parent.is_dir():
        raise InputError(f"{where}: there is no folder {path.parent}")
    if os.path.lexists(path) and not path.is_file():
        raise InputError(f"{where}: exists and is not an ordinary file: choose another name")
    if path.exists() and not os.access(path, os.W_OK):
        raise InputError(f"{where}: exists and is write-protected: choose another name")
    check_replaceable(path, where)
    _check_writable(path.parent, where)


def check_folder(path: Path, option: str) -> None:
    """Refuse a folder that could not be created or written to. Raises InputError."""
    existing = next(folder for folder in (path, *path.absolute().parents) if folder.exists())
    if not existing.is_dir():
        raise InputError(f"{option} {path}: {existing} is not a folder")
    _check_writable(existing, f"{option} {path}")


def _check_writable(folder: Path, where: str) -> None:
    if not os.access(folder, os.W_OK | os.X_OK):
        raise InputError(f"{where}: the folder {folder} is not writable")
    from tempfile import TemporaryFile  # here, because it loads hashes and random numbers

    try:
        with TemporaryFile(dir=folder):  # some file systems refuse only now
            pass
    except OSError as error:
        raise InputError(f"{where}: nothing can be written in the folder {folder}: {error.strerror}") from None


def write_files(*targets: tuple[Path | None, Callable[[Path], object]]) -> list[Path]:
    """Let each function write its file, and return the files; those that are None are not wanted."""
    wanted = [(path, write) for path, write in targets if path is not None]
    for path, write in wanted:
        write(path)
    return [path for path, _ in wanted]


def drawing(draw: Callable[..., object], look: FigureLook) -> Callable[[Path], Path]:
    """Return a function that lets `draw` draw in a new figure of this look, and writes the figure to a file."""

    def write(path: Path) -> Path:
        from stickslip.figures.sheet import StickslipFigure
        from stickslip.figures.style import styled

        figure = StickslipFigure()
        draw(figure=figure, **look.place)
        with warnings.catch_warnings(record=True) as said:
            warnings.filterwarnings("always", CROWDED)
            write_atomically(path, lambda draft: styled(figure.savefig)(draft, dpi=look.dots))
        for other in (one for one in said if not str(one.message).startswith(CROWDED)):
            warnings.warn_explicit(other.message, other.category, other.filename, other.lineno)
        if any(str(one.message).startswith(CROWDED) for one in said):
            warn(f"{path}: the panels and labels of this figure do not fit into its size: give a larger --size")
        return path

    return write


def file_size(count: float) -> str:
    """Format a number of bytes briefly, such as 1.67 GB."""
    factor, unit = next(((f, u) for f, u in ((1e9, "GB"), (1e6, "MB"), (1e3, "kB")) if count >= f), (1.0, "bytes"))
    return f"{count / factor:.3g} {unit}"


def announce(*paths: Path | None) -> None:
    """Say which files were written, and how large they are if they are large; None is no file."""
    for path in paths:
        if path is not None:
            size = path.stat().st_size if path.is_file() else 0
            typer.echo(f"written: {path}" + (f" ({file_size(size)})" if size >= LARGE_FILE else ""))
