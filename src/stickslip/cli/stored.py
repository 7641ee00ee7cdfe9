"""Read results from files and folders for the command line: of runs, of catalogues of slip events, and those of extensions."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from stickslip.cli.results import Stored, StoredEvents, WholeRun
from stickslip.foundation.errors import InputError
from stickslip.run import no_results, reader_of

if TYPE_CHECKING:
    import pandas as pd


def stored(path: Path) -> Stored:
    """Read the results in a file or folder. Raises InputError if there are none that can be read."""
    if (reader := reader_of(path)) is not None:
        found: Stored = reader.stored(path)
        return found
    if path.is_dir():
        raise no_results(path)
    suffix = path.suffix.lower()
    if suffix in (".csv", ".parquet"):
        from stickslip.solution.files import read_table

        return _events(path, read_table(path), _beside(path))
    if suffix != ".nc":
        raise InputError(_not_results(path))
    return _netcdf(path)


def _netcdf(path: Path) -> Stored:
    from stickslip.foundation import netcdf_file
    from stickslip.run import PausedCatalogue
    from stickslip.solution.files import CATALOGUE, read_table, to_solution

    tables = netcdf_file.read_tables(path, "a result")
    if CATALOGUE in tables.attrs:
        rows = PausedCatalogue.read(path).rows
        return _events(path, read_table(rows.path if rows.path.exists() else rows.growing), tables.attrs)
    if "event" in tables.sizes and "history_rate" not in tables.variables:
        return _events(path, read_table(path), tables.attrs)
    solution = to_solution(tables, path)
    return Stored(path, tables.attrs, WholeRun(solution.scenario(path.stem), solution))


def _events(path: Path, table: pd.DataFrame, about: Mapping[str, Any]) -> Stored:
    from stickslip.solution.observables import NEEDED

    missing = [name for name in NEEDED if name not in table]
    if missing:
        raise InputError(f"{path}: not a catalogue of slip events: there is no column {missing[0]}")
    return Stored(path, about, StoredEvents(path, about, table))


def _beside(path: Path) -> Mapping[str, Any]:
    """Return the attributes of the checkpoint beside the table of a catalogue, or nothing if there is none."""
    from stickslip.foundation.netcdf_file import attributes
    from stickslip.run import checkpoint_of
    from stickslip.solution.files import Rows

    return attributes(checkpoint_of(Rows(path)))


def _not_results(path: Path) -> str:
    from stickslip.problem.scenarios import library

    if not path.exists() and str(path) not in (*library.STARTERS, *library.names()):
        return f"{path}: no such file"
    cure = f"`stickslip run {path}` runs a scenario, `stickslip check {path}` explains it"
    return f"{path}: not a file of results, whose names end in .nc, .csv, .parquet or .zarr; {cure}"
