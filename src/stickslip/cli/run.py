"""`stickslip run`: simulate a scenario, or go on with a run, and say what happened."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, NoReturn

import typer

from stickslip.cli.names import complete_rule, complete_scenario
from stickslip.errors import InputError

if TYPE_CHECKING:
    from stickslip.evolution.solution import Solution
    from stickslip.evolution.status import Status
    from stickslip.problem import Problem


def run(
    scenario: Annotated[
        str | None, typer.Argument(help="A TOML file, or a bundled name.", autocompletion=complete_scenario, show_default=False)
    ] = None,
    out: Annotated[
        Path | None,
        typer.Option("--out", "-o", help="Save the whole solution (netCDF, .nc), now and then on the way too.", show_default=False),
    ] = None,
    figure: Annotated[
        Path | None, typer.Option("--figure", "-f", help="Save a figure (.png, .pdf or .svg).", show_default=False)
    ] = None,
    path: Annotated[
        Path | None,
        typer.Option("--path", help="Save a figure of the run's path in the set K (.png, .pdf or .svg).", show_default=False),
    ] = None,
    catalog_figure: Annotated[
        Path | None,
        typer.Option("--catalog-figure", help="Save a figure of the slip events (.png, .pdf or .svg).", show_default=False),
    ] = None,
    catalog: Annotated[
        Path | None,
        typer.Option("--catalog", help="Keep slip events only, in bounded memory (.csv, .parquet or .nc).", show_default=False),
    ] = None,
    until: Annotated[
        str | None,
        typer.Option("--until", "--duration", help='Run this long instead: s, or with a unit ("480 year").', show_default=False),
    ] = None,
    events: Annotated[int | None, typer.Option(help="Stop when so many slip events are over.", show_default=False)] = None,
    resume: Annotated[
        Path | None,
        typer.Option(help="Go on with the run in a file of --out, or a checkpoint of --catalog.", show_default=False),
    ] = None,
    rtol: Annotated[float | None, typer.Option(help="Relative tolerance instead.", show_default=False)] = None,
    creep_rtol: Annotated[
        float | None,
        typer.Option(
            help="Leap over slow creep between pulses (a slab under a law of slip), with an error of slip of at most this "
            "times the slip so far: 1e-6, say. 0 runs every round trip.",
            show_default=False,
        ),
    ] = None,
    selection: Annotated[
        str | None,
        typer.Option(
            help="Selection rule instead: perfect-delay, maxwell, minimal, maximal.",
            autocompletion=complete_rule,
            show_default=False,
        ),
    ] = None,
) -> None:
    """Simulate a scenario, or go on with a run, and say what happened: slip events, shocks, and what ended the run.

    Times are in s, slips in m, slip rates in m/s, tractions in Pa (slab) or
    N (block). Existing files are replaced, each when its content is complete.

    \b
      stickslip run fig6-slab
      stickslip run mine.toml --out mine.nc --figure mine.png
      stickslip run fig6-slab --until "480 years" --selection maxwell
      stickslip run fig5-slab-printed --until "3 days" --creep-rtol 1e-6
      stickslip run cycles-block --until "10000 years" --catalog events.csv
      stickslip run --resume mine.nc --until "1000 years"

    Ctrl-C ends a run with a valid file that --resume takes up; so does the
    last state of a run that was killed. Nobody can tell from the result.

    Exit code: 0 done, 1 the run failed, 2 unusable input, 130 interrupted.
    """
    from stickslip.cli.long_run import Request, list_events, solve
    from stickslip.cli.summary import show_catalogue, show_solution

    request = Request(scenario, until, events, rtol, creep_rtol, selection, resume, out, catalog, figure, path, catalog_figure)
    request.check()
    if request.keeps_events_only:
        chosen, found = list_events(request)
        show_catalogue(chosen, found)
        _leave(found.status)
    if path is not None and resume is None:
        _check_path(request.scenario().problem)
    chosen, solution = solve(request)
    show_solution(chosen, solution)
    for line in _draw(solution, out or resume, figure, path, catalog_figure):
        typer.echo(line)
    _leave(solution.status)


def _leave(status: Status) -> NoReturn:
    if status.name == "interrupted":
        raise KeyboardInterrupt
    raise typer.Exit(0 if status.ok else 1)


def _check_path(problem: Problem) -> None:
    """Refuse a figure that cannot be drawn before the run. Raises InputError."""
    from stickslip.contact.uniqueness import uniqueness

    if uniqueness(problem).resistance is None:
        raise InputError("run: --path needs a slab without contact mass: with inertia the slip rate is a state, there is no set K")


def _draw(solution: Solution, out: Path | None, figure: Path | None, path: Path | None, catalog_figure: Path | None) -> list[str]:
    from stickslip.files import write_atomically

    written = [] if out is None else [f"written: {out}"]
    if figure is not None:
        write_atomically(figure, solution.plot().savefig)
        written.append(f"written: {figure}")
    if path is not None:
        from stickslip.figures import admissible

        write_atomically(path, admissible.draw(admissible.data(solution.problem, solution)).savefig)
        written.append(f"written: {path}")
    if catalog_figure is not None:
        from stickslip.figures import catalogue

        write_atomically(catalog_figure, catalogue.draw(catalogue.data(solution)).savefig)
        written.append(f"written: {catalog_figure}")
    return written
