"""`stickslip run`: simulate a scenario, or resume a run, and report what happened."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, NoReturn

import typer

from stickslip.cli.names import complete_rule, complete_scenario

if TYPE_CHECKING:
    from stickslip.trajectory.status import Status


def run(
    scenario: Annotated[
        str | None, typer.Argument(help="A TOML file, or a bundled name.", autocompletion=complete_scenario, show_default=False)
    ] = None,
    out: Annotated[
        Path | None,
        typer.Option(
            "--out", "-o", help="Save the whole solution (netCDF, .nc), with a checkpoint every 30 s.", show_default=False
        ),
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
    energy: Annotated[
        Path | None,
        typer.Option("--energy", help="Save a figure of where the energy is (.png, .pdf or .svg).", show_default=False),
    ] = None,
    space_time: Annotated[
        Path | None,
        typer.Option("--space-time", help="Save a figure of the slab's inside over time (.png, .pdf or .svg).", show_default=False),
    ] = None,
    animation: Annotated[
        Path | None,
        typer.Option("--animation", help="Save the slab in motion (.gif; .mp4 and .webm need ffmpeg).", show_default=False),
    ] = None,
    catalog: Annotated[
        Path | None,
        typer.Option("--catalog", help="Keep slip events only, in bounded memory (.csv, .parquet or .nc).", show_default=False),
    ] = None,
    energies: Annotated[bool, typer.Option("--energies", help="Add the energies of each event to --catalog (slow).")] = False,
    until: Annotated[
        str | None,
        typer.Option("--until", "--duration", help='Override the duration: s, or with a unit ("480 year").', show_default=False),
    ] = None,
    events: Annotated[int | None, typer.Option(help="Stop after this number of slip events.", show_default=False)] = None,
    resume: Annotated[
        Path | None,
        typer.Option(help="Resume the run in a file of --out, or a checkpoint of --catalog.", show_default=False),
    ] = None,
    rtol: Annotated[float | None, typer.Option(help="Override the relative tolerance.", show_default=False)] = None,
    creep_rtol: Annotated[
        float | None,
        typer.Option(
            help="Leap over slow creep between pulses (a slab under a law of slip) from the start, with an error of slip of at "
            "most this times the slip so far. Not given: after 200 round trips, with an error that follows rtol (1e-6). 0 runs "
            "every round trip.",
            show_default=False,
        ),
    ] = None,
    shortest_event: Annotated[
        str | None,
        typer.Option(
            help='Lump slip events that are shorter than this, say "1 ms" (a slab under rate weakening ends in ever '
            "shorter ones). Not given: only where a round trip has more than 4096 pieces. 0 resolves them all.",
            show_default=False,
        ),
    ] = None,
    max_pieces: Annotated[
        int | None,
        typer.Option(
            help="Largest number of pieces of history (0.44 kB each); the history is written whatever ended the run. Not given: a "
            "million, and a run that needs more is not written.",
            min=1,
            show_default=False,
        ),
    ] = None,
    selection: Annotated[
        str | None,
        typer.Option(
            help="Override the selection rule: perfect-delay, maxwell, minimal, maximal.",
            autocompletion=complete_rule,
            show_default=False,
        ),
    ] = None,
) -> None:
    """Simulate a scenario, or resume a run, and report what happened: slip events, shocks, and what ended the run.

    Times are in s, slips in m, slip rates in m/s, tractions in Pa (slab) or
    N (block). Existing files are replaced, each when its content is complete.

    \b
      stickslip run fig6-slab
      stickslip run mine.toml --out mine.nc --figure mine.png
      stickslip run fig6-slab --until "480 years" --selection maxwell
      stickslip run fig6-slab --space-time waves.png --animation slab.gif
      stickslip run fig5-slab-printed --until "3 days"
      stickslip run cycles-block --until "10000 years" --catalog events.csv
      stickslip run --resume mine.nc --until "1000 years"

    Ctrl-C ends a run with a valid file, from which --resume continues. It also
    continues from the last checkpoint of a run that was killed. The result is
    the same, bit for bit, as without the stop.

    Exit code: 0 done, 1 the run failed, 2 unusable input, 130 interrupted.
    """
    from stickslip.cli.long_run import Request, list_events, solve
    from stickslip.cli.output.pictures import Pictures
    from stickslip.cli.output.summary import show_catalogue, show_solution

    drawn = Pictures(figure, path, catalog_figure, energy, space_time, animation)
    how = rtol, creep_rtol, shortest_event, max_pieces, selection
    request = Request(scenario, until, events, *how, resume, out, catalog, energies, drawn)
    request.check()
    if request.keeps_events_only:
        chosen, found = list_events(request)
        show_catalogue(chosen, found)
        _leave(found.status)
    if resume is None:
        drawn.check_problem(request.scenario().problem)
    chosen, solution = solve(request)
    show_solution(chosen, solution)
    if (out or resume) and not request.writes(solution):
        typer.echo(f"not written: {out or resume} ({len(solution.history)} pieces; --max-pieces allows more, and writes them)")
        out = resume = None
    for written in (out or resume, *drawn.draw(solution)):
        if written is not None:
            typer.echo(f"written: {written}")
    _leave(solution.status)


def _leave(status: Status) -> NoReturn:
    if status.name == "interrupted":
        raise KeyboardInterrupt
    raise typer.Exit(0 if status.ok else 1)
