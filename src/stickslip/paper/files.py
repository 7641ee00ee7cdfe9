"""Writers of the report's files, one for each kind of file; a file appears whole or not at all."""

from __future__ import annotations

import io
from pathlib import Path
from typing import TYPE_CHECKING

from stickslip.foundation.atomic_write import write_atomically

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr
    from matplotlib.figure import Figure


def save_text(path: Path, text: str) -> Path:
    """Write text in UTF-8 with line feeds as line ends, and return the path."""
    return write_atomically(path, lambda partial: partial.write_text(text, encoding="utf-8", newline="\n"))


def save_bytes(path: Path, content: bytes) -> Path:
    """Write bytes unchanged, and return the path."""
    return write_atomically(path, lambda partial: partial.write_bytes(content))


def save_table(path: Path, table: pd.DataFrame) -> Path:
    """Write a table as CSV with all digits, and return the path."""
    return save_text(path, table.to_csv(index=False, lineterminator="\n"))


def save_data(path: Path, dataset: xr.Dataset) -> Path:
    """Write a dataset as netCDF-4 with a checksum at the end of the file, and return the path."""
    from stickslip.foundation.netcdf_file import write

    return write(dataset, path)


def image(figure: Figure, kind: str) -> bytes:
    """Return a figure as the bytes of a "png" or "svg" file, the same for the same input: without date and random names."""
    import matplotlib as mpl

    from stickslip.figures.style import STYLE

    stream = io.BytesIO()
    with mpl.rc_context(STYLE):
        figure.savefig(stream, format=kind, metadata={"Date": None} if kind == "svg" else {"Software": None})
    return stream.getvalue()
