"""Write the events of a chain as a table: CSV, parquet, or netCDF."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from stickslip.extensions.chains.run import EVENT_UNITS
from stickslip.foundation.arguments import as_path
from stickslip.foundation.atomic_write import write_atomically, write_table
from stickslip.foundation.errors import InputError

if TYPE_CHECKING:
    from stickslip.extensions.chains.run import ChainRun

FORMATS_OF_EVENTS = (".csv", ".parquet", ".nc")
"""The ends of names of files that are written."""


def write_events(run: ChainRun, path: str | Path) -> Path:
    """Write the events of a run as .csv, .parquet or .nc, with all digits, and return the path. Raises InputError."""
    file = as_path("to_csv: path", path)
    try:
        return _written(run, file)
    except OSError as error:
        raise InputError(f"{file}: cannot be written: {error.strerror or error}") from None


def _written(run: ChainRun, file: Path) -> Path:
    import stickslip

    made = f"stickslip {stickslip.__version__}: events of a chain{f', {run.title}' if run.title else ''}"
    table = run.events_table()
    named = table.rename(columns={name: f"{name} ({unit})" for name, unit in EVENT_UNITS.items() if unit != "1"})
    if file.suffix == ".csv":
        return write_table(file, named, [made])
    if file.suffix == ".nc":
        from stickslip.foundation.netcdf_file import Variable, write_variables

        columns = {name: Variable(("event",), table[name].to_numpy(), {"units": EVENT_UNITS[name]}) for name in EVENT_UNITS}
        return write_variables(columns, {"title": made}, file)
    if file.suffix != ".parquet":
        raise InputError(f"to_csv: {file}: the name must end in {', '.join(FORMATS_OF_EVENTS)}")
    try:
        import pyarrow  # noqa: F401  # pandas would complain in several lines
    except ImportError:
        raise InputError(f"to_csv: {file}: files .parquet need the library pyarrow: pip install pyarrow") from None
    return write_atomically(file, lambda draft: named.to_parquet(draft))
