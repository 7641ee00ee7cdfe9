"""`stickslip compare`: compare runs side by side."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from stickslip.cli.names import complete_source
from stickslip.foundation.errors import InputError

if TYPE_CHECKING:
    from stickslip.studies.compare import Comparison

PICTURES = (".png", ".pdf", ".svg")
"""File suffixes of figures."""


def compare(
    runs: Annotated[
        list[str],
        typer.Argument(help="Two or more: TOML files, bundled names, files of `run --out` (.nc).", autocompletion=complete_source),
    ],
    out: Annotated[
        Path | None, typer.Option("--out", "-o", help="Save the table, a row for each run (.csv).", show_default=False)
    ] = None,
    figure: Annotated[
        Path | None, typer.Option("--figure", "-f", help="Save a figure (.png, .pdf or .svg).", show_default=False)
    ] = None,
    event: Annotated[
        int | None,
        typer.Option(help="Draw this slip event of each, in local time: 0 the first, -1 the last.", show_default=False),
    ] = None,
    until: Annotated[
        str | None,
        typer.Option(
            "--until", "--duration", help='Override the duration of all runs: s, or with a unit ("480 year").', show_default=False
        ),
    ] = None,
    rtol: Annotated[float | None, typer.Option(help="Override the relative tolerance.", show_default=False)] = None,
) -> None:
    """Compare runs: one table, and one figure of slip, slip rate and traction against time.

    The table gives for each run its body, law, selection rule and regime, the
    number of slip events, the largest one with its stress drops, the duration
    of the first one, and whether the slip rate is smooth or jumps. Slabs can
    be compared with blocks: drops are then in Pa and N, and the figure shows
    friction over the normal load. Runs of very different lengths are drawn
    over the share of their own time; late events are best seen with --event.

    \b
      stickslip compare fig6-block-reconstructed fig6-slab --figure fig6.png
      stickslip compare second-event-maxwell second-event-maximal --event 1
      stickslip compare mine.toml yesterday.nc --out table.csv

    Exit code: 0 done, 1 a run failed, 2 unusable input, 130 interrupted.
    """
    from stickslip.cli.output.files import check_target

    for path, option, suffixes in ((out, "--out", (".csv",)), (figure, "--figure", PICTURES)):
        if path is not None:
            check_target(path, option, suffixes)
    found = _compared(runs, until, rtol, event)
    _show(found)
    for line in _save(found, out, figure):
        typer.echo(line)
    if not all(solution.status.ok for solution in found.runs.values()):
        raise typer.Exit(1)


def _compared(names: list[str], until: str | None, rtol: float | None, event: int | None) -> Comparison:
    """Read all sources before any of them is run, then run them. Raises InputError."""
    from stickslip.cli.long_run import progress
    from stickslip.scenarios.schema import check_rtol, read_duration
    from stickslip.studies.compare import Comparison, distinct, read_source

    if len(names) < 2:
        raise InputError(f"compare: needs two runs or more, got {len(names)}; `stickslip new --list` lists the bundled ones")
    duration = None if until is None else read_duration(until, "compare", "--until")
    tolerance = None if rtol is None else check_rtol(rtol, "compare", "--rtol")
    sources = [read_source(name, duration, tolerance) for name in names]
    runs = {}
    for name, source in zip(distinct([source.name for source in sources]), sources, strict=True):
        with progress(name) as report:
            runs[name] = source.solution(report)
    return Comparison(runs, event)


def _show(found: Comparison) -> None:
    from stickslip.cli.output.show import clean, console, number, table

    screen, rows = console(), found.table.to_dict("records")
    about = table("", "body", "friction", "rule", "regime", "status")
    for row in rows:
        about.add_row(clean(row["name"]), *(str(row[name]) for name in ("body", "friction", "rule", "regime", "status")))
    screen.print(about)
    screen.print()
    headings = ("events", "largest\nslip\nm", "its\npulses", "peak\nrate\nm/s", "static\ndrop", "dynamic\ndrop", "first\nlasts\ns")
    came = table("", *headings, "shocks", "slip\nrate", numbers=True)
    came.columns[0].justify = "left"
    for row in rows:
        drops = (_drop(row[name], row["load_unit"]) for name in ("static_drop", "dynamic_drop"))
        pulses, rate = f"{row['pulses']:g}", number(row["peak_rate"], 6)
        sizes = (number(row["slip"], 6), pulses, rate, *drops, number(row["duration"], 6))
        came.add_row(clean(row["name"]), str(row["events"]), *sizes, str(row["shocks"]), row["slip_rate"])
    screen.print(came)


def _drop(value: float, unit: str) -> str:
    """Format a drop with five significant digits, or as a dash if there is no event."""
    from stickslip.cli.output.show import with_unit

    return "-" if math.isnan(value) else with_unit(float(f"{value:.5g}"), unit)


def _save(found: Comparison, out: Path | None, figure: Path | None) -> list[str]:
    from stickslip.foundation.atomic_write import write_atomically

    written = []
    if out is not None:
        written.append(f"written: {found.save(out)}")
    if figure is not None:
        write_atomically(figure, found.plot().savefig)
        written.append(f"written: {figure}")
    return written
