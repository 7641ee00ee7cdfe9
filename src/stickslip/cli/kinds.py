"""How the command line runs and shows each kind of run: its whole history, a catalogue of slip events, or an extension's run."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import fields, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from typing_extensions import override

from stickslip.cli.results import EventsOfRun, PlainRun, RunResults, WholeRun
from stickslip.foundation.errors import InputError
from stickslip.run import no_results, progress_line, reader_of, special_solver_of

if TYPE_CHECKING:
    from stickslip.cli.request import Request
    from stickslip.problem import Problem, Status


class KindOfRun(ABC):
    """A kind of run, as `stickslip run` does it."""

    suffix = ".nc"
    """The end of the name of what --out writes."""

    @abstractmethod
    def check(self, request: Request) -> None:
        """Refuse options that this kind of run does not have. Raises InputError."""

    @abstractmethod
    def run(self, request: Request) -> RunResults:
        """Run from the start, or from where a file left the run. Raises InputError."""

    def file(self, request: Request) -> Path | None:
        """Return the file or folder that holds the run afterwards; None if it is not kept."""
        return request.out or request.resume

    def how_to_go_on(self, request: Request, results: RunResults) -> str:
        """Return one line on how a run that ended early goes on from its file; "" if there is nothing to say."""
        return ""


def kind_of_run(request: Request) -> KindOfRun:
    """Return the kind of a run, by its scenario or by the file from which it continues. Raises InputError."""
    if request.resume is not None:
        if (reader := reader_of(request.resume)) is not None:
            return reader.on_command_line()
        if request.resume.is_dir():
            raise no_results(request.resume)
        from stickslip.solution.files import is_catalogue

        return EventsOnly() if is_catalogue(request.resume) else RunOfHistory()
    solver = special_solver_of(request.chosen)
    if solver is None:
        return RunOfHistory() if request.catalogue is None else EventsOnly()
    return PlainKindOfRun() if solver.on_command_line is None else solver.on_command_line()


class RunOfHistory(KindOfRun):
    """A run of the exact solver with its whole history."""

    @override
    def check(self, request: Request) -> None:
        if request.energy:
            raise InputError("run: --energy belongs to --catalogue FILE")

    @override
    def run(self, request: Request) -> WholeRun:
        keep: dict[str, Any] = {"checkpoint": request.out, "max_pieces": request.options.max_pieces}
        if request.resume is None:
            chosen = request.chosen
            request.pictures.check_problem(chosen.problem)
            with progress_line(f"{chosen.name}:") as report:
                from stickslip.run.simulate import simulate  # imports the compiler, which takes a second

                return WholeRun(chosen, simulate(chosen, progress=report, **keep))
        from stickslip.run import CallOptions, resume_run
        from stickslip.solution.files import read_solution

        stopped = read_solution(request.resume)
        check_same(request, stopped.problem)
        with progress_line(f"{request.resume.stem}:") as report:
            others = {"progress": report, "checkpoint": request.out or request.resume, "max_pieces": request.options.max_pieces}
            options = CallOptions.to_continue(stopped, request.duration, max_events=request.events, **others)
            solution = resume_run(stopped, request.resume, options)
        return WholeRun(solution.scenario(request.resume.stem), solution)

    @override
    def how_to_go_on(self, request: Request, results: RunResults) -> str:
        assert isinstance(results, WholeRun)
        return _with_more_room(results.status, self.file(request), len(results.solution.history))


class EventsOnly(KindOfRun):
    """A run of the exact solver that keeps slip events only, in bounded memory."""

    @override
    def check(self, request: Request) -> None:
        for name, file in (("--out", request.out), ("--csv", request.csv)):
            if file is not None:
                raise InputError(f"run: a catalogue keeps slip events only, no history: leave out {name}")
        request.pictures.check_events("run")
        if request.energy and request.catalogue is None:
            raise InputError("run: --energy belongs to --catalogue FILE")
        if request.catalogue is not None:
            from stickslip.solution.files import check_catalogue

            check_catalogue(request.catalogue, "--catalogue")

    @override
    def run(self, request: Request) -> EventsOfRun:
        from stickslip.run import CallOptions, PausedCatalogue, catalogue_of, check_energy

        if request.resume is None:
            chosen = request.chosen
            check_energy(chosen.creep_rtol, request.energy, "run", "--energy and --creep-rtol")
            with progress_line(f"{chosen.name}:") as report:
                options = CallOptions.of(chosen, progress=report, max_pieces=request.options.max_pieces)
                return EventsOfRun(chosen, catalogue_of(chosen.problem, options, request.catalogue, energy=request.energy))
        paused = PausedCatalogue.read(request.resume)
        check_same(request, paused.stopped.problem)
        with progress_line(f"{request.resume.stem}:") as report:
            others = {"progress": report, "max_pieces": request.options.max_pieces}
            options = CallOptions.to_continue(paused.stopped, request.duration, max_events=request.events, **others)
            found = paused.resume(options)
        return EventsOfRun(replace(paused.stopped.scenario(request.resume.stem), duration=options.duration), found)

    @override
    def file(self, request: Request) -> None:
        """Return None: a catalogue says by itself which files it has written."""

    @override
    def how_to_go_on(self, request: Request, results: RunResults) -> str:
        assert isinstance(results, EventsOfRun)
        return _with_more_room(results.status, results.found.files[-1], request.most_pieces)


class PlainKindOfRun(KindOfRun):
    """A run of the solver of an extension that says no more: it is shown, and not kept."""

    @override
    def check(self, request: Request) -> None:
        given = {"--out": request.out, "--energy": request.energy or None, **request.typed}
        if needless := next((name for name, value in given.items() if value is not None), None):
            raise InputError(f"run: {request.chosen.name}: a run of this kind has no {needless}: leave it out")
        PlainRun(request.chosen, None).check(request.pictures, "run")

    @override
    def run(self, request: Request) -> PlainRun:
        from stickslip.run.simulate import simulate

        return PlainRun(request.chosen, simulate(request.chosen))


def _with_more_room(status: Status, file: Path | None, pieces: int) -> str:
    """Return how a run whose history is full goes on from its file, if it has one."""
    from stickslip.problem import SHORT_OF_MEMORY, TOO_MANY

    if file is None or status.name != TOO_MANY:
        return ""
    short = status.message.startswith(SHORT_OF_MEMORY)
    more, once = ("", " once more memory is free") if short else (f" --max-pieces {2 * pieces}", "")
    return f"nothing is lost: stickslip run --resume {file}{more} goes on from there{once}"


def check_same(request: Request, problem: Problem) -> None:
    """Refuse to resume a run of another problem than the scenario named beside it. Raises InputError."""
    if request.scenario is None:
        return
    asked = request.chosen.problem
    if asked != problem:
        differs = next(f.name for f in fields(problem) if getattr(asked, f.name) != getattr(problem, f.name))
        found = f"its {differs} is {getattr(problem, differs)!r}"
        raise InputError(f"{request.resume}: is a run of another problem than {request.scenario}: {found}")
