"""The work of `stickslip run`: run from the start or from a checkpoint, with the whole history or as a catalogue of slip events."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields, replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

from stickslip.cli.output.files import CATALOGUES, Target, check_targets
from stickslip.cli.overrides import load_with, read
from stickslip.extensions.planar.summary import announce_run
from stickslip.foundation.errors import InputError
from stickslip.foundation.memory import chosen_memory
from stickslip.problem.scenarios.scenario import Scenario
from stickslip.problem.scenarios.schema import check_events, read_duration
from stickslip.run.progress import progress_line

if TYPE_CHECKING:
    from stickslip.cli.output.pictures import Pictures
    from stickslip.extensions.planar.solution import PlanarSolution
    from stickslip.problem.problem import Problem
    from stickslip.run.catalogue import Catalogue
    from stickslip.solution.solution import Solution


@dataclass(frozen=True, kw_only=True)
class Request:
    """The options of `stickslip run` as they were typed.

    `changes` are the values of --set.
    `overrides` are those that replace numbers of the scenario: duration, events, rtol, creep_rtol, shortest_event and selection.
    """

    scenario: str | None
    resume: Path | None
    changes: Sequence[str] | None
    overrides: Mapping[str, Any]
    max_pieces: int | None
    out: Path | None
    catalogue: Path | None
    csv: Path | None
    energy: bool
    pictures: Pictures

    def check(self) -> None:
        """Refuse files that could not be written, options that exclude each other, and a size of memory that is none.

        Raises InputError.
        """
        chosen_memory()
        if self.scenario is None and self.resume is None:
            raise InputError("run: nothing to run: give a SCENARIO, or --resume FILE")
        if self.has_contact and self.out is not None and self.out.exists():
            raise InputError(
                f"--out {self.out}: exists: --resume {self.out} continues the run in it; choose another name, or remove it"
            )
        results = Target("--out", self.out, (".zarr",) if self.has_contact else (".nc",))
        tables = Target("--catalogue", self.catalogue, CATALOGUES), Target("--csv", self.csv, (".csv",))
        check_targets(results, *tables, *self.pictures.targets())
        self.pictures.check()
        as_begun = [self.overrides[name] for name in ("rtol", "creep_rtol", "shortest_event", "selection")]
        if self.resume is not None and any(option is not None for option in (self.changes, self.catalogue, *as_begun)):
            options = "--set, --rtol, --creep-rtol, --shortest-event, --selection and --catalogue"
            raise InputError(f"run: --resume goes on as the run began: leave out {options}")
        if self.has_contact:
            self._check_contact()
        if self.keeps_events_only:
            for name, file in (("--out", self.out), ("--csv", self.csv)):
                if file is not None:
                    raise InputError(f"run: a catalogue keeps slip events only, no history: leave out {name}")
            self.pictures.check_events("run")
        if self.energy and self.catalogue is None:
            raise InputError("run: --energy belongs to --catalogue FILE")
        if self.catalogue is not None:
            from stickslip.solution.files.catalogue_rows import check_catalogue

            check_catalogue(self.catalogue, "--catalogue")

    def _check_contact(self) -> None:
        """Refuse what a contact of many nodes does not have. Raises InputError."""
        self.pictures.check_contact("run")
        typed = {f"--{name.replace('_', '-')}": value for name, value in self.overrides.items() if name != "duration"}
        typed |= {"--max-pieces": self.max_pieces, "--catalogue": self.catalogue}
        needless = [option for option, value in typed.items() if value is not None]
        if needless:
            raise InputError(
                f"run: {needless[0]} has no effect with a [contact], whose nodes and courant set the accuracy: leave it out"
            )

    @cached_property
    def has_contact(self) -> bool:
        """True if the contact has many nodes, in 2D or 3D."""
        return self.chosen.contact is not None if self.resume is None else self.resume.suffix == ".zarr"

    @property
    def keeps_events_only(self) -> bool:
        """True if only slip events are kept, and no history."""
        if self.resume is None:
            return self.catalogue is not None
        from stickslip.solution.files.netcdf import is_catalogue

        return is_catalogue(self.resume)

    @property
    def duration(self) -> float | None:
        """The duration that was typed, s, or None."""
        typed: float | None = read(read_duration, self.overrides["duration"], "run", "duration")
        return typed

    @property
    def events(self) -> int | None:
        """The number of slip events that was typed, or None."""
        typed: int | None = read(check_events, self.overrides["events"], "run", "events")
        return typed

    @cached_property
    def chosen(self) -> Scenario:
        """The scenario with the changes that the options ask for. Raises InputError."""
        assert self.scenario is not None
        return load_with("run", self.scenario, self.changes, contact=True, **self.overrides)

    @property
    def most_pieces(self) -> int:
        """The largest number of pieces that the history of a catalogue may have."""
        from stickslip.run.catalogue import CAPACITY
        from stickslip.run.options import MAX_PIECES

        return max(self.max_pieces or MAX_PIECES, CAPACITY)

    @property
    def file(self) -> Path | None:
        """The file into which the run writes its solution, or None."""
        return self.out or self.resume


def solve_contact(request: Request) -> PlanarSolution:
    """Run with a contact of many nodes, and say before the start how large the run is. Raises InputError."""
    if request.resume is not None:
        return _resume_contact(request, request.resume)
    chosen = request.chosen
    announce_run(chosen, streamed=request.out is not None)
    with progress_line(f"{chosen.name}:") as report:
        from stickslip.extensions.planar.run import simulate_planar
        from stickslip.run.options import options_of

        return simulate_planar(chosen, options_of(chosen, progress=report, checkpoint=request.out))


def _resume_contact(request: Request, folder: Path) -> PlanarSolution:
    from stickslip.extensions.planar.contact import Contact
    from stickslip.extensions.planar.run import resume_planar
    from stickslip.extensions.planar.store_layout import open_planar, scenario_in

    if request.out is not None:
        raise InputError(f"run: --resume {folder} continues in its own folder: leave out --out")
    stopped, began = open_planar(folder), scenario_in(folder)
    check_same(request, stopped.slab.problem)
    if request.scenario is not None and Contact.of(request.chosen.planar_slab) != Contact.of(stopped.slab):
        raise InputError(f"{folder}: is a run of another problem than {request.scenario}: its [contact] differs")
    announce_run(began if request.duration is None else replace(began, duration=request.duration), streamed=True)
    with progress_line(f"{folder.stem}:") as report:
        return resume_planar(folder, request.duration, progress=report)


def solve(request: Request) -> tuple[Scenario, Solution]:
    """Run with the whole history, from the start or from a checkpoint. Raises InputError."""
    keep: dict[str, Any] = {"checkpoint": request.out, "max_pieces": request.max_pieces}
    if request.resume is None:
        chosen = request.chosen
        request.pictures.check_problem(chosen.problem)
        with progress_line(f"{chosen.name}:") as report:
            from stickslip.run.simulate import simulate  # imports the compiler, which takes a second

            return chosen, simulate(chosen, progress=report, **keep)
    from stickslip.run.options import RunOptions
    from stickslip.run.resume import resume_run
    from stickslip.solution.files.netcdf import read_solution

    stopped = read_solution(request.resume)
    check_same(request, stopped.problem)
    with progress_line(f"{request.resume.stem}:") as report:
        others = {"progress": report, "checkpoint": request.out or request.resume, "max_pieces": request.max_pieces}
        options = RunOptions.to_continue(stopped, request.duration, request.events, **others)
        solution = resume_run(stopped, request.resume, options)
    return solution.scenario(request.resume.stem), solution


def list_events(request: Request) -> tuple[Scenario, Catalogue]:
    """Run and keep only slip events, from the start or from a checkpoint. Raises InputError."""
    from stickslip.run.catalogue import catalogue_of, check_energy
    from stickslip.run.options import RunOptions
    from stickslip.run.resume import PausedCatalogue

    if request.resume is None:
        chosen = request.chosen
        check_energy(chosen.creep_rtol, request.energy, "run", "--energy and --creep-rtol")
        with progress_line(f"{chosen.name}:") as report:
            options = RunOptions.of(chosen, progress=report, max_pieces=request.max_pieces)
            return chosen, catalogue_of(chosen.problem, options, request.catalogue, energy=request.energy)
    paused = PausedCatalogue.read(request.resume)
    check_same(request, paused.stopped.problem)
    with progress_line(f"{request.resume.stem}:") as report:
        others = {"progress": report, "max_pieces": request.max_pieces}
        options = RunOptions.to_continue(paused.stopped, request.duration, request.events, **others)
        found = paused.resume(options)
    return replace(paused.stopped.scenario(request.resume.stem), duration=options.duration), found


def check_same(request: Request, problem: Problem) -> None:
    """Refuse to resume a run of another problem than the scenario named beside it. Raises InputError."""
    if request.scenario is None:
        return
    asked = request.chosen.problem
    if asked != problem:
        differs = next(f.name for f in fields(problem) if getattr(asked, f.name) != getattr(problem, f.name))
        found = f"its {differs} is {getattr(problem, differs)!r}"
        raise InputError(f"{request.resume}: is a run of another problem than {request.scenario}: {found}")
