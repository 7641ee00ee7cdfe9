"""`stickslip export`: write time series of a run for other tools."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from stickslip.cli.names import complete_source
from stickslip.foundation.errors import InputError

if TYPE_CHECKING:
    from stickslip.solution.evaluation import Readings

TEXT = (".txt", ".dat")
"""File suffixes of text in the SCEC layout."""
SUFFIXES = (*TEXT, ".mseed", ".sac")
"""File suffixes of all formats."""


def export(
    run: Annotated[
        str, typer.Argument(help="A TOML file, a bundled name, or a file of `run --out` (.nc).", autocompletion=complete_source)
    ],
    file: Annotated[Path, typer.Argument(help="What to write: .txt or .dat (SCEC), .mseed, .sac.")],
    sampling_rate: Annotated[float, typer.Option("--sampling-rate", "-r", help="Samples a second.")] = 100.0,
    event: Annotated[
        int | None, typer.Option(help="Only this slip event, in local time: 0 the first, -1 the last.", show_default=False)
    ] = None,
    x: Annotated[
        str | None,
        typer.Option(
            "--x",
            help='Seismograms: distance from the contact, m or with a unit ("5 km"); default the contact.',
            show_default=False,
        ),
    ] = None,
    antialias: Annotated[bool, typer.Option("--antialias", help="Low-pass to half the sampling rate first.")] = False,
    components: Annotated[
        bool, typer.Option("--components", help="SCEC: all eight columns of the three-dimensional benchmarks.")
    ] = False,
    until: Annotated[
        str | None,
        typer.Option("--until", "--duration", help='Override the duration: s, or with a unit ("480 year").', show_default=False),
    ] = None,
) -> None:
    """Export slip, slip rate and stress of the contact at evenly spaced times, for tools of seismologists and rupture modellers.

    .txt and .dat are on-fault time series as in the SCEC/USGS rupture benchmarks
    (t slip slip-rate shear-stress; s, m, m/s, MPa); .mseed and .sac are
    seismograms of slip rate and traction in SI (need ObsPy). Samples are exact,
    and right limits at jumps.

    \b
      stickslip export fig6-slab fig6.txt --sampling-rate 200
      stickslip export second-event-maxwell late.txt --event 1
      stickslip export run.nc run.mseed --antialias

    Exit code: 0 done, 1 the run failed, 2 unusable input, 130 interrupted.
    """
    from stickslip.cli.output.files import check_target

    check_target(file, "FILE", SUFFIXES)
    if file.suffix.lower() not in TEXT:
        from stickslip.io.seismogram import import_obspy

        import_obspy()
        if components:
            raise InputError("export: --components is for .txt and .dat")
    elif x is not None:
        raise InputError("export: --x is for .mseed and .sac: .txt and .dat are on-fault time series")
    place = 0.0 if x is None else _place(x)
    name, found, ok = _readings(run, until, event)
    for written in _write(name, found, file, sampling_rate, antialias, components, place):
        typer.echo(f"written: {written}")
    if not ok:
        raise typer.Exit(1)


def _place(text: str) -> float:
    """Return a distance (m) from the text that was typed. Raises InputError."""
    from stickslip.foundation.quantities import Quantity
    from stickslip.scenarios.values import read_quantity

    declared = Quantity("m", "distance from the contact", at_least=0)
    try:
        typed: float | str = float(text)
    except ValueError:
        typed = text
    return read_quantity(typed, declared, "export", "--x")


def _readings(run: str, until: str | None, event: int | None) -> tuple[str, Readings, bool]:
    from stickslip.cli.long_run import progress
    from stickslip.scenarios.schema import read_duration
    from stickslip.studies.compare import read_source

    source = read_source(run, None if until is None else read_duration(until, "export", "--until"))
    with progress(source.name) as report:
        solution = source.solution(report)
    return source.name, solution if event is None else solution.window(event), solution.status.ok


def _write(name: str, run: Readings, file: Path, rate: float, antialias: bool, components: bool, x: float) -> list[Path]:
    if file.suffix.lower() in TEXT:
        from stickslip.io.scec import write_scec

        return [write_scec(run, file, rate, antialias=antialias, problem=name, components=components)]
    from stickslip.io.seismogram import write_seismogram

    return write_seismogram(run, file, rate, antialias=antialias, x=x)
