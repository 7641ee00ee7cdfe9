"""The kinds of runs, each with its solver and the options that it takes; and the readers of results.

What is solved says of which kind a run is: a `Problem`, which the exact solver of the core takes, or what the table of an extension
makes of a scenario, or an object of an extension. It is asked once, here, by the source of a run or by the path of its results.
"""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol, TypeVar

from stickslip.extension import members
from stickslip.foundation.atomic_write import read_bounded
from stickslip.foundation.errors import InputError
from stickslip.problem import Problem
from stickslip.problem.scenarios import Scenario

if TYPE_CHECKING:
    from stickslip.cli.kinds import KindOfRun
    from stickslip.run.check.examine import Examination
    from stickslip.run.options import CallOptions

ALL_TAKE = frozenset({"duration", "progress", "checkpoint", "checkpoint_every"})
"""Options that each solver takes."""
FILES_OF_CORE = (".nc", ".csv", ".parquet")
"""Suffixes of results that the core reads itself."""
Run_co = TypeVar("Run_co", covariant=True)


class Special(Protocol[Run_co]):
    """A problem of an extension, such as a `PlanarSlab`, that says of what class its runs are."""

    @property
    def run_type(self) -> type[Run_co]:
        """The class of its runs."""


@dataclass(frozen=True)
class SolverKind:
    """One of the solvers of `simulate`, and the options that it takes."""

    solves: Callable[[Any], bool]
    """True for what it solves: see `Scenario.to_solve`."""
    run: Callable[[Any, CallOptions], Any]
    """Run a scenario, or what it solves, from t = 0 with options that are not yet checked."""
    takes: frozenset[str]
    """Names of fields of `CallOptions`, of options of its own, and "selection", which replaces the problem's."""
    refusal: str
    """The message for any other option; the first braces stand for its name, the second, if there are any, for what takes it."""
    on_command_line: Callable[[], KindOfRun] | None = None
    """How the command line runs and shows it; None for the plain way: `PlainRun`."""
    examine: Callable[[Scenario], Examination] | None = None
    """What can be said of a scenario before it is run; None if nothing but what is given."""
    what: str = ""
    """What it solves, for messages: "a PlanarSlab"."""
    summaries: Callable[[], Mapping[str, tuple[str, str, Callable[[Any], float]]]] | None = None
    """Numbers of a run that sweeps keep, by name: unit, meaning and function of the run; None if sweeps cannot run it."""
    code: tuple[str, ...] = ()
    """Folders of its extension whose code decides its runs (`engine.engine_key`)."""

    def check(self, who: str, given: Mapping[str, object]) -> None:
        """Refuse options that are given, not None, and not taken. Raises InputError, which begins with `who`."""
        if needless := [name for name, value in given.items() if value is not None and name not in self.takes]:
            owner = next((one.what for one in special_solvers() if needless[0] in one.takes), "")
            raise InputError(f"{who}: {self.refusal.format(needless[0], owner)}")


class Reader:
    """Reads what an extension leaves in folders, in netCDF files, or in files of its own."""

    what: str
    """What it reads, for messages: "a sweep"."""
    mark = ""
    """The attribute of netCDF files (.nc) that hold what it reads; "" if it reads none."""

    def is_in(self, path: Path) -> bool:
        """Return True if a path that is no file of the core holds what it reads, whether that is sound or not."""
        return False

    def open(self, path: Path) -> Any:
        """Return the run in a path. Raises InputError if it is damaged, or no run."""
        raise InputError(f"{path}: holds {self.what}, which is not a run")

    def resume(self, path: Path, duration: Any, **options: Any) -> Any:
        """Continue a run where its path left it, up to a duration, its own if that is None. Raises InputError."""
        raise InputError(f"{path}: holds {self.what}, which is not continued in this way")

    def stored(self, path: Path) -> Any:
        """Return a `stickslip.cli.results.Stored`, which `stickslip show` shows. Raises InputError if it is damaged."""
        raise InputError(f"{path}: holds {self.what}, which is not shown")

    def on_command_line(self) -> KindOfRun:
        """Return how the command line continues and shows a run. Raises InputError if it cannot."""
        raise InputError(f"run: --resume continues a run, not {self.what}")


def special_solvers() -> list[SolverKind]:
    """Return the solvers of all extensions."""
    return list(members("solvers", SolverKind))


def special_solver_of(source: Any) -> SolverKind | None:
    """Return the solver of a scenario or an object of an extension; None for what the exact solver of the core is for."""
    what = source.to_solve if isinstance(source, Scenario) else source
    if isinstance(what, Problem | str | Path):
        return None
    return next((one for one in special_solvers() if one.solves(what)), None)


def reader_of(path: Path) -> Reader | None:
    """Return the reader of the extension whose results a path holds; None if it holds none that an extension reads."""
    if path.suffix.lower() not in FILES_OF_CORE or path.is_dir():
        return next((one for one in members("readers", Reader) if one.is_in(path)), None)
    from stickslip.foundation.netcdf_file import attributes  # no run needs it

    marks = attributes(path) if path.suffix.lower() == ".nc" else {}
    return next((one for one in members("readers", Reader) if one.mark in marks), None) if marks else None


def no_results(path: Path) -> InputError:
    """Return the error for a folder that no reader reads: whose it is, or why its metadata cannot be read."""
    from stickslip.foundation.zarr_folder import LARGEST_METADATA, METADATA

    if os.path.lexists(path / METADATA):
        try:
            if kind := re.search(rb'"(stickslip_\w+)"', read_bounded(path / METADATA, LARGEST_METADATA)):
                return InputError(f"{path}: holds results of an extension that is not installed, '{kind[1].decode()[:60]}'")
        except (InputError, OSError) as error:
            return InputError(f"{path}: {METADATA}: {error}")
    return InputError(f"{path}: is a folder that holds no results of stickslip")
