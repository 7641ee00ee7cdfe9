"""Read a series of slip, slip rate and traction that any program has written, as CSV or in the layout of the SCEC benchmarks."""

from __future__ import annotations

import io
from pathlib import Path

import numpy as np
import pandas as pd

from stickslip.foundation.atomic_write import read_bounded
from stickslip.foundation.errors import InputError
from stickslip.schemes.contract import Series

LARGEST_FILE = 200_000_000
"""Largest size of a file, bytes."""
NAMES: dict[str, dict[str, float]] = {
    "time": {"time_s": 1.0, "time": 1.0, "t": 1.0},
    "slip": {"slip_m": 1.0, "slip": 1.0, "h-slip": 1.0},
    "rate": {"slip_rate_m_per_s": 1.0, "slip_rate": 1.0, "rate": 1.0, "slip-rate": 1.0, "h-slip-rate": 1.0},
    "traction": {"traction_Pa": 1.0, "traction": 1.0, "shear-stress": 1e6, "h-shear-stress": 1e6},
}
"""Names of columns that are understood, each with its unit in SI: shear stress is in MPa, as in the SCEC benchmarks."""


def read_series(path: str | Path, *, cells: int = 0) -> Series:
    """Read a series, named after the file; `cells` is the number of cells in the thickness, if it is known.

    The text has lines of comment that begin with #, one line with the names of columns (NAMES lists those that are understood), and
    a line for each time; columns are separated by commas or spaces. Slip counts from t = 0. Of two lines with the same time, as at
    a shock, the last one counts. Raises InputError if the file cannot be read, if a column is missing, if a value is not a finite
    number, or if times do not ascend.
    """
    file = Path(path)
    try:
        text = read_bounded(file, LARGEST_FILE).decode("utf-8-sig")
    except (OSError, UnicodeDecodeError) as error:
        raise InputError(f"{file}: cannot be read as text: {getattr(error, 'strerror', None) or 'not UTF-8'}") from None
    lines = [line for line in text.splitlines() if line.strip() and not line.lstrip().startswith("#")]
    if not lines:
        raise InputError(f"{file}: no series: the file has no lines but comments")
    try:
        table = pd.read_csv(io.StringIO("\n".join(lines)), sep="," if "," in lines[0] else r"\s+")
    except ValueError as error:  # pandas' errors of parsing are of this kind
        raise InputError(f"{file}: no series: {str(error).splitlines()[0][:80]!a}") from None
    columns = {name: _column(file, table, name) for name in NAMES}
    last = np.append(np.diff(columns["time"]) != 0.0, True)
    return Series(**{name: values[last] for name, values in columns.items()}, name=file.stem, cells=cells)


def _column(file: Path, table: pd.DataFrame, name: str) -> np.ndarray[tuple[int], np.dtype[np.float64]]:
    """Return a column in SI. Raises InputError if it is missing or holds something else than numbers."""
    known = NAMES[name]
    found = next((one for one in known if one in table.columns), None)
    if found is None:
        wanted = f"no column for the {name.replace('rate', 'slip rate')}: call it {' or '.join(known)}"
        there = ", ".join(str(one) for one in table.columns)
        raise InputError(f"{file}: {wanted}; its columns are {ascii(there)[1:-1][:80]}")
    values = pd.to_numeric(table[found], errors="coerce").to_numpy(float) * known[found]
    if not np.isfinite(values).all():
        raise InputError(f"{file}: column {found}: line {int(np.argmin(np.isfinite(values))) + 1} is not a finite number")
    return values
