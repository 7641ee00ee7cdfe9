"""`stickslip show`: summarise a file of results: of a run, a catalogue of slip events, or a sweep."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property, partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from stickslip.cli.options import RESULTS, Everything, complete_quantity, complete_result, option
from stickslip.cli.output.files import Target, announce, check_targets, drawing
from stickslip.cli.output.pictures import Pictures
from stickslip.cli.output.show import console, say
from stickslip.foundation.errors import InputError
from stickslip.foundation.show import clean

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr

    from stickslip.extensions.planar.solution import PlanarSolution
    from stickslip.problem.problem import Problem
    from stickslip.problem.scenarios.scenario import Scenario
    from stickslip.solution.solution import Solution

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
    found = stored(result, quantity)
    if scenario:
        typer.echo(found.scenario(), nl=False)
        return
    found.check(pictures)
    found.summarise(everything=everything)
    found.draw(pictures)
    if csv is not None:
        announce(found.to_csv(csv))


@dataclass(frozen=True)
class Stored(ABC):
    """The results in a file, with the attributes that say where they come from."""

    path: Path
    about: Mapping[str, Any]

    def scenario(self) -> str:
        """Return the scenario as TOML text. Raises InputError if the file does not hold it."""
        if "scenario" not in self.about:
            raise InputError(f"{self.path}: does not hold its scenario: its checkpoint does, if it is beside it")
        return str(self.about["scenario"])

    @abstractmethod
    def check(self, pictures: Pictures) -> None:
        """Refuse pictures that these results do not have. Raises InputError."""

    @abstractmethod
    def summarise(self, *, everything: bool = False) -> None:
        """Print the summary on standard output; of a run `everything` that is known of its proof, waves and predictability."""

    @abstractmethod
    def to_csv(self, path: Path) -> Path:
        """Write the numbers as CSV, with a unit in each heading, and return the path."""

    def draw(self, pictures: Pictures) -> None:
        """Draw the pictures and say which files were written."""
        announce(*pictures.wanted.values())

    def print_origin(self) -> None:
        """Print which version made the results."""
        if "source" in self.about:
            made = clean(str(self.about["source"]))
            say(console(), f"made by {made}; `stickslip show {self.path} --scenario` prints its scenario")


@dataclass(frozen=True)
class StoredRun(Stored):
    """A run with its whole history."""

    solution: Solution

    def check(self, pictures: Pictures) -> None:
        """Refuse pictures that these results do not have. Raises InputError."""
        pictures.check_problem(self.solution.problem, "show")

    def summarise(self, *, everything: bool = False) -> None:
        """Print the summary on standard output; of a run `everything` that is known of its proof, waves and predictability."""
        from stickslip.cli.output.summary import show_solution

        show_solution(self.solution.scenario(self.path.stem), self.solution, everything=everything)
        self.print_origin()

    def draw(self, pictures: Pictures) -> None:
        """Draw the pictures and say which files were written."""
        announce(*pictures.draw(self.solution))

    def to_csv(self, path: Path) -> Path:
        """Write the curves at evenly spaced times, and return the path."""
        return self.solution.to_csv(path)


@dataclass(frozen=True)
class StoredContact(Stored):
    """A run with a contact of many nodes."""

    solution: PlanarSolution
    own: Scenario

    def scenario(self) -> str:
        """Return the scenario as TOML text."""
        return self.own.to_toml()

    def check(self, pictures: Pictures) -> None:
        """Refuse pictures that these results do not have. Raises InputError."""
        pictures.check_contact(str(self.path))

    def summarise(self, *, everything: bool = False) -> None:
        """Print the summary on standard output; of a run `everything` that is known of its proof, waves and predictability."""
        from stickslip.extensions.planar.summary import announce_run, show_run

        announce_run(self.own, streamed=True)
        show_run(self.solution)
        self.print_origin()

    def draw(self, pictures: Pictures) -> None:
        """Draw the pictures and say which files were written."""
        announce(*pictures.draw_contact(self.solution))

    def to_csv(self, path: Path) -> Path:
        """Write the motion of the node in the middle at the frames, and return the path."""
        return self.solution.to_csv(path)


@dataclass(frozen=True)
class StoredEvents(Stored):
    """A catalogue of slip events."""

    table: pd.DataFrame

    @cached_property
    def problem(self) -> Problem | None:
        """The problem of the run; None if neither the catalogue nor a checkpoint beside it holds the scenario."""
        from stickslip.problem.scenarios.scenario import read_scenario

        return read_scenario(self.scenario(), self.path.stem).problem if "scenario" in self.about else None

    def check(self, pictures: Pictures) -> None:
        """Refuse pictures that these results do not have. Raises InputError."""
        pictures.check_events(str(self.path))

    def summarise(self, *, everything: bool = False) -> None:
        """Print the summary on standard output; of a run `everything` that is known of its proof, waves and predictability."""
        from stickslip.cli.output.summary import show_events

        show_events(self.path.stem, dict(self.table.items()), self.about, self.problem)
        self.print_origin()

    def draw(self, pictures: Pictures) -> None:
        """Draw the pictures and say which files were written."""
        announce(*pictures.draw_events(self.table, self.path.stem, "Pa" if self.problem is None else self.problem.load_unit))

    def to_csv(self, path: Path) -> Path:
        """Write the slip events with the units of their columns, and return the path. Raises InputError if these are not known."""
        from stickslip.foundation.atomic_write import write_table
        from stickslip.solution.observables.event_table import with_units

        if self.problem is None:
            raise InputError(f"{self.path}: does not say of what body it is, so that its units are not known: leave out --csv")
        return write_table(path, with_units(self.table, self.problem.load_unit), [made_by(self.about)])


@dataclass(frozen=True)
class StoredSweep(Stored):
    """The results of a sweep."""

    dataset: xr.Dataset
    quantity: str | None = None

    def check(self, pictures: Pictures) -> None:
        """Refuse pictures that these results do not have. Raises InputError."""
        others = [option for option in pictures.wanted if option != "--figure"]
        if others:
            raise InputError(f"{self.path}: the results of a sweep have no {', '.join(others)}: --figure draws a quantity")
        if self.quantity is not None:
            from stickslip.extensions.sweeps.figures.sweep import data

            data(self.dataset, self.quantity)

    def summarise(self, *, everything: bool = False) -> None:
        """Print the summary on standard output; of a run `everything` that is known of its proof, waves and predictability."""
        from stickslip.extensions.sweeps.summary import show_sweep

        show_sweep(self.path.stem, self.dataset)
        self.print_origin()

    def draw(self, pictures: Pictures) -> None:
        """Draw the pictures and say which files were written."""
        if pictures.figure is not None:
            from stickslip.extensions.sweeps.figures.sweep import plot_sweep

            drawing(partial(plot_sweep, self.dataset, self.quantity), pictures.look)(pictures.figure)
        super().draw(pictures)

    def to_csv(self, path: Path) -> Path:
        """Write a row for each member, with the units of the columns, and return the path."""
        from stickslip.extensions.sweeps.results.layout import table_of
        from stickslip.foundation.atomic_write import write_table

        return write_table(path, table_of(self.dataset), [made_by(self.about)])


def made_by(about: Mapping[str, Any]) -> str:
    """Return the version that made results, as the comment of a file says it."""
    return clean(str(about.get("source", "written by stickslip")))


def stored(path: Path, quantity: str | None = None) -> Stored:
    """Read the results in a file or folder; `quantity` is the one of a sweep that is drawn.

    Raises InputError if there are none that can be read, and for a quantity of what is no sweep.
    """
    is_planar = path.is_dir() and _is_planar(path)
    if quantity is not None and (is_planar or not path.is_dir()):
        raise InputError(f"show: --quantity chooses what is drawn of a sweep, and {path} is not a sweep")
    if is_planar:
        from stickslip.extensions.planar.store_layout import open_planar, opened, scenario_in

        return StoredContact(path, opened(path).attrs, open_planar(path), scenario_in(path))
    if path.is_dir():
        from stickslip.extensions.sweeps.results.layout import FORMAT
        from stickslip.extensions.sweeps.results.store import open_store

        with FORMAT.reading(path):
            dataset = open_store(path).load()
        return StoredSweep(path, dataset.attrs, dataset, quantity)
    suffix = path.suffix.lower()
    if suffix in (".csv", ".parquet"):
        from stickslip.solution.files.catalogue_rows import read_table

        return _events(path, read_table(path), _beside(path))
    if suffix != ".nc":
        raise InputError(_not_results(path))
    return _netcdf(path)


def _is_planar(path: Path) -> bool:
    from stickslip.extensions.planar.store_layout import FORMAT

    return FORMAT.is_in(path)


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
    return StoredRun(path, dataset.attrs, to_solution(dataset, path))


def _events(path: Path, table: pd.DataFrame, about: Mapping[str, Any]) -> StoredEvents:
    from stickslip.solution.observables.event_table import NEEDED

    missing = [name for name in NEEDED if name not in table]
    if missing:
        raise InputError(f"{path}: not a catalogue of slip events: there is no column {missing[0]}")
    return StoredEvents(path, about, table)


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
