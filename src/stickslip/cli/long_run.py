"""The work of `stickslip run`: run from the start or from a checkpoint, with the whole history or as a catalogue of slip events."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, fields, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from stickslip.cli.output.files import check_target
from stickslip.foundation.errors import InputError

if TYPE_CHECKING:
    from stickslip.cli.output.pictures import Pictures
    from stickslip.problem.problem import Problem
    from stickslip.run.catalogue import Catalogue
    from stickslip.run.progress import Progress
    from stickslip.scenarios.scenario import Scenario
    from stickslip.solution.solution import Solution


@dataclass(frozen=True)
class Request:
    """The options of `stickslip run` as they were typed."""

    name: str | None
    until: str | None
    events: int | None
    rtol: float | None
    creep_rtol: float | None
    shortest_event: str | None
    max_pieces: int | None
    selection: str | None
    resume: Path | None
    out: Path | None
    catalog: Path | None
    energies: bool
    pictures: Pictures

    def check(self) -> None:
        """Refuse files that could not be written, and options that exclude each other. Raises InputError."""
        if self.out is not None:
            check_target(self.out, "--out", (".nc",))
        self.pictures.check()
        if self.name is None and self.resume is None:
            raise InputError("run: what is to be run is missing: a SCENARIO, or --resume FILE")
        as_begun = (self.rtol, self.creep_rtol, self.shortest_event, self.selection, self.catalog)
        if self.resume is not None and any(option is not None for option in as_begun):
            options = "--rtol, --creep-rtol, --shortest-event, --selection and --catalog"
            raise InputError(f"run: --resume goes on as the run began: leave {options} away")
        if self.keeps_events_only and (self.out or self.pictures.wanted):
            options = ", ".join(["--out"] * (self.out is not None) + self.pictures.wanted)
            raise InputError(f"run: a catalogue keeps slip events only, no history: leave {options} away")
        if self.energies and self.catalog is None:
            raise InputError("run: --energies belongs to --catalog FILE")
        if self.catalog is not None:
            from stickslip.io.catalogue_rows import SUFFIXES, check_catalogue

            check_target(self.catalog, "--catalog", SUFFIXES)
            check_catalogue(self.catalog, "--catalog")

    @property
    def keeps_events_only(self) -> bool:
        """Return True if only slip events are kept, and no history."""
        if self.resume is None:
            return self.catalog is not None
        from stickslip.io.netcdf import is_catalogue

        return is_catalogue(self.resume)

    def writes(self, solution: Solution) -> bool:
        """Return True if a solution goes into its file: a full history only if --max-pieces was given."""
        return self.max_pieces is not None or solution.status.name != "too many pieces"

    @property
    def duration(self) -> float | None:
        """Return the duration that was typed, s, or None. Raises InputError."""
        from stickslip.scenarios.schema import read_duration

        return None if self.until is None else read_duration(self.until, "run", "--until")

    @property
    def wanted_events(self) -> int | None:
        """Return the number of slip events that was typed, or None. Raises InputError."""
        from stickslip.scenarios.schema import check_events

        return None if self.events is None else check_events(self.events, "run", "--events")

    def scenario(self) -> Scenario:
        """Return the scenario with the changes that the options ask for. Raises InputError."""
        from stickslip.engine_input.creep_limits import check_creep_rtol
        from stickslip.engine_input.lumping_limits import check_shortest_event
        from stickslip.problem.selection_rule import names, unknown
        from stickslip.scenarios.scenario import load_scenario
        from stickslip.scenarios.schema import SHORTEST_EVENT, check_rtol, read_duration

        assert self.name is not None
        loaded = load_scenario(self.name)
        changes: dict[str, Any] = {"duration": self.duration, "max_events": self.wanted_events}
        if self.rtol is not None:
            changes["rtol"] = check_rtol(self.rtol, "run", "--rtol")
        if self.creep_rtol is not None:
            changes["creep_rtol"] = check_creep_rtol(loaded.problem, self.creep_rtol, "run", "--creep-rtol")
        if self.shortest_event is not None:
            shortest = read_duration(self.shortest_event, "run", "--shortest-event", SHORTEST_EVENT)
            changes["shortest_event"] = check_shortest_event(loaded.problem, shortest, "run", "--shortest-event")
        if self.selection is not None:
            if self.selection not in names():
                raise InputError(f"run: --selection '{self.selection}' {unknown(self.selection)}")
            changes["problem"] = replace(loaded.problem, selection=self.selection)
        return replace(loaded, **{name: value for name, value in changes.items() if value is not None})


def solve(request: Request) -> tuple[Scenario, Solution]:
    """Run with the whole history, from the start or from a checkpoint. Raises InputError."""
    if request.resume is None:
        chosen = request.scenario()
        keep: dict[str, Any] = {"checkpoint": request.out, "max_pieces": request.max_pieces}
        with progress(chosen.name) as report:
            return chosen, chosen.run(report, **keep)
    from stickslip.io.netcdf import open_solution
    from stickslip.run.options import RunOptions
    from stickslip.run.resume import resume_run
    from stickslip.scenarios.scenario import Scenario

    stopped = open_solution(request.resume)
    check_same(request, stopped.problem)
    with progress(request.resume.stem) as report:
        others = {"progress": report, "checkpoint": request.out or request.resume, "max_pieces": request.max_pieces}
        options = RunOptions.to_continue(stopped, request.duration, request.wanted_events, **others)
        solution = resume_run(stopped, request.resume, options)
    return Scenario.of(solution, request.resume.stem), solution


def list_events(request: Request) -> tuple[Scenario, Catalogue]:
    """Run and keep only slip events, from the start or from a checkpoint. Raises InputError."""
    from stickslip.run.catalogue import catalogue_of, check_energies
    from stickslip.run.options import RunOptions
    from stickslip.run.resume import PausedCatalogue
    from stickslip.scenarios.scenario import Scenario

    if request.resume is None:
        chosen = request.scenario()
        check_energies(chosen.creep_rtol, request.energies, "run", "--energies and --creep-rtol")
        with progress(chosen.name) as report:
            options = RunOptions.of(chosen, progress=report, max_pieces=request.max_pieces)
            return chosen, catalogue_of(chosen.problem, options, request.catalog, energies=request.energies)
    paused = PausedCatalogue.read(request.resume)
    check_same(request, paused.stopped.problem)
    with progress(request.resume.stem) as report:
        others = {"progress": report, "max_pieces": request.max_pieces}
        options = RunOptions.to_continue(paused.stopped, request.duration, request.wanted_events, **others)
        found = paused.resume(options)
    return replace(Scenario.of(paused.stopped, request.resume.stem), duration=options.duration), found


def check_same(request: Request, problem: Problem) -> None:
    """Refuse to resume a run whose problem differs from that of the scenario that is named beside it. Raises InputError."""
    if request.name is None:
        return
    asked = request.scenario().problem
    if asked != problem:
        differs = next(f.name for f in fields(problem) if getattr(asked, f.name) != getattr(problem, f.name))
        raise InputError(
            f"{request.resume}: is a run of another problem than {request.name}: its {differs} is {getattr(problem, differs)!r}"
        )


@contextmanager
def progress(name: str) -> Iterator[Progress]:
    """Show the progress of a run on a terminal. Yields the callback that receives it."""
    from stickslip.cli.output.show import progress_to, so_far

    with progress_to(f"{name}:") as report:
        yield lambda about: report(so_far(about))
