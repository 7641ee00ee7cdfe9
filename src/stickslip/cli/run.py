"""`stickslip run`: simulate a scenario and say what happened."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from stickslip.cli.names import complete_rule, complete_scenario
from stickslip.errors import InputError

if TYPE_CHECKING:
    from stickslip.evolution.solution import Solution
    from stickslip.problem import Problem
    from stickslip.scenarios.scenario import Scenario


def run(
    scenario: Annotated[str, typer.Argument(help="A TOML file, or a bundled name.", autocompletion=complete_scenario)],
    out: Annotated[
        Path | None, typer.Option("--out", "-o", help="Save the whole solution (netCDF, .nc).", show_default=False)
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
    duration: Annotated[
        str | None, typer.Option(help='Run this long instead: s, or with a unit ("480 year").', show_default=False)
    ] = None,
    rtol: Annotated[float | None, typer.Option(help="Relative tolerance instead.", show_default=False)] = None,
    selection: Annotated[
        str | None,
        typer.Option(
            help="Selection rule instead: perfect-delay, maxwell, minimal, maximal.",
            autocompletion=complete_rule,
            show_default=False,
        ),
    ] = None,
) -> None:
    """Simulate a scenario and say what happened: slip events, shocks, and what ended the run.

    Times are in s, slips in m, slip rates in m/s, tractions in Pa (slab) or
    N (block). Existing files are replaced, once the new ones are complete.

    \b
      stickslip run fig6-slab
      stickslip run mine.toml --out mine.nc --figure mine.png
      stickslip run fig6-slab --duration "480 year" --selection maxwell

    Exit code: 0 done, 1 the run failed, 2 unusable input, 130 interrupted.
    """
    from stickslip.cli.files import check_target
    from stickslip.cli.summary import show_solution

    pictures = (".png", ".pdf", ".svg")
    drawn = ((figure, "--figure"), (path, "--path"), (catalog_figure, "--catalog-figure"))
    for target, option, suffixes in ((out, "--out", (".nc",)), *((*one, pictures) for one in drawn)):
        if target is not None:
            check_target(target, option, suffixes)
    chosen = _adjusted(scenario, duration, rtol, selection)
    if path is not None:
        _check_path(chosen.problem)
    solution = _simulate(chosen)
    show_solution(chosen, solution)
    for line in _save(solution, out, figure, path, catalog_figure):
        typer.echo(line)
    if solution.status.name == "interrupted":
        raise KeyboardInterrupt
    raise typer.Exit(0 if solution.status.ok else 1)


def _adjusted(name: str, duration: str | None, rtol: float | None, selection: str | None) -> Scenario:
    """The scenario with what the options change. Raises InputError."""
    from stickslip.scenarios.scenario import load_scenario
    from stickslip.scenarios.schema import check_rtol, read_duration
    from stickslip.selection import names, unknown

    loaded = load_scenario(name)
    changes: dict[str, Any] = {}
    if duration is not None:
        changes["duration"] = read_duration(duration, "run", "--duration")
    if rtol is not None:
        changes["rtol"] = check_rtol(rtol, "run", "--rtol")
    if selection is not None:
        if selection not in names():
            raise InputError(f"run: --selection '{selection}' {unknown(selection)}")
        changes["problem"] = replace(loaded.problem, selection=selection)
    return replace(loaded, **changes)


def _simulate(scenario: Scenario) -> Solution:
    from stickslip.cli.show import number, progress_to

    with progress_to(f"{scenario.name}:") as report:

        def progress(time: float, pieces: int, doing: str) -> None:
            report(f"{number(time, 6)} of {number(scenario.duration, 6)} s, {pieces} pieces, {doing}")

        return scenario.run(progress)


def _check_path(problem: Problem) -> None:
    """Refuse a figure that cannot be drawn before the run. Raises InputError."""
    from stickslip.contact.uniqueness import uniqueness

    if uniqueness(problem).resistance is None:
        raise InputError("run: --path needs a slab without contact mass: with inertia the slip rate is a state, there is no set K")


def _save(solution: Solution, out: Path | None, figure: Path | None, path: Path | None, catalog_figure: Path | None) -> list[str]:
    from stickslip.files import write_atomically

    written = []
    if out is not None:
        solution.save(out)
        written.append(f"written: {out}")
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
