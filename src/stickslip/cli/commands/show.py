"""`stickslip show`: summarise a file of results: of a run, a catalogue of slip events, or a sweep."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from stickslip.cli.options import RESULTS, Everything, complete_quantity, complete_result, option
from stickslip.cli.output.files import Target, announce, check_targets, write_files
from stickslip.cli.output.pictures import Pictures
from stickslip.cli.results import Stored, StoredEvents, WholeRun
from stickslip.foundation.errors import InputError
from stickslip.run.kinds import no_results, reader_of

if TYPE_CHECKING:
    import pandas as pd

RESULT = "A file or folder of `run --out`, a catalogue or its checkpoint, or the folder of a sweep."
QUANTITY = "Of a sweep, draw this quantity: by default the first."
CSV = "Save as CSV: the curves of a run at 1001 times, the slip events of a catalogue, or the members of a sweep (.csv)."
SCENARIO_ONLY = "Print the scenario of the results instead, as TOML, in SI or in the units that were given."


def show(
    result: Annotated[Path, typer.Argument(help=RESULT, autocompletion=complete_result)],
    *,
    scenario: Annotated[bool, typer.Option("--scenario", help=SCENARIO_ONLY)] = False,
    quantity: Annotated[str | None, typer.Option("--quantity", "-q", help=QUANTITY, autocompletion=complete_quantity)] = None,
    everything: Everything = False,
    csv: Annotated[Path | None, option(CSV, "--csv", panel=RESULTS)] = None,
    pictures: Pictures,
) -> None:
    r"""Show what is in a file of results, as after the run, and draw figures from it without running it again.

    The summary ends with the version of stickslip that made the file. Of a
    catalogue it shows the slip events; of a sweep, how its members ended and the
    range of each quantity, and --figure draws one of them (--quantity).

    \b
      stickslip show mine.nc
      stickslip show mine.nc --figure mine.png --space-time waves.png
      stickslip show mine.nc --csv curves.csv
      stickslip show mine.nc --scenario > again.toml
      stickslip show events.csv
      stickslip show events.csv --catalogue-figure events.png
      stickslip show map.zarr --figure map.png --quantity slip
      stickslip show fault.zarr --animation fault.gif

    Exit code: 0 done, 2 unusable input.
    """
    check_targets(*pictures.targets(), Target("--csv", csv, (".csv",)))
    pictures.check()
    found = stored(result)
    results = found.results if quantity is None else found.results.of_quantity(quantity, result)
    if scenario:
        typer.echo(found.scenario(), nl=False)
        return
    results.check(pictures, str(result))
    results.summarise(everything=everything)
    found.print_origin()
    announce(*results.draw(pictures), *write_files((csv, results.to_csv)))


def stored(path: Path) -> Stored:
    """Read the results in a file or folder. Raises InputError if there are none that can be read."""
    if (reader := reader_of(path)) is not None:
        found: Stored = reader.stored(path)
        return found
    if path.is_dir():
        raise no_results(path)
    suffix = path.suffix.lower()
    if suffix in (".csv", ".parquet"):
        from stickslip.solution.files.catalogue_rows import read_table

        return _events(path, read_table(path), _beside(path))
    if suffix != ".nc":
        raise InputError(_not_results(path))
    return _netcdf(path)


def _netcdf(path: Path) -> Stored:
    from stickslip.foundation import netcdf_file
    from stickslip.run.resume import PausedCatalogue
    from stickslip.solution.files.catalogue_rows import read_table
    from stickslip.solution.files.netcdf import CATALOGUE, to_solution

    dataset = netcdf_file.read(path, "a result")
    if CATALOGUE in dataset.attrs:
        rows = PausedCatalogue.read(path).rows
        return _events(path, read_table(rows.path if rows.path.exists() else rows.growing), dataset.attrs)
    if "event" in dataset.dims and "history_rate" not in dataset:
        return _events(path, dataset.to_dataframe().reset_index(drop=True), dataset.attrs)
    solution = to_solution(dataset, path)
    return Stored(path, dataset.attrs, WholeRun(solution.scenario(path.stem), solution))


def _events(path: Path, table: pd.DataFrame, about: Mapping[str, Any]) -> Stored:
    from stickslip.solution.observables.event_table import NEEDED

    missing = [name for name in NEEDED if name not in table]
    if missing:
        raise InputError(f"{path}: not a catalogue of slip events: there is no column {missing[0]}")
    return Stored(path, about, StoredEvents(path, about, table))


def _beside(path: Path) -> Mapping[str, Any]:
    """Return the attributes of the checkpoint beside the table of a catalogue, or nothing if there is none."""
    from stickslip.foundation.netcdf_file import attributes
    from stickslip.run.catalogue import checkpoint_of
    from stickslip.solution.files.catalogue_rows import Rows

    return attributes(checkpoint_of(Rows(path)))


def _not_results(path: Path) -> str:
    from stickslip.problem.scenarios import library

    if not path.exists() and str(path) not in library.names():
        return f"{path}: no such file"
    cure = f"`stickslip run {path}` runs a scenario, `stickslip check {path}` explains it"
    return f"{path}: not a file of results, whose names end in .nc, .csv, .parquet or .zarr; {cure}"
