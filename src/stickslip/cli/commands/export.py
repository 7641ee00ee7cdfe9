"""`stickslip export`: write time series of a run for other tools."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from stickslip.cli.options import Duration, complete_source, option
from stickslip.cli.output.files import announce, check_target

if TYPE_CHECKING:
    from stickslip.studies.compare import RunSource

RUN = "A TOML file, a bundled name, a file of `run --out` (.nc), or - for a scenario from standard input."
COMPONENTS = "All eight columns of the three-dimensional benchmarks."


def export(
    run: Annotated[str, typer.Argument(help=RUN, autocompletion=complete_source)],
    file: Annotated[Path, typer.Argument(help="What to write (.txt or .dat).")],
    *,
    sampling_rate: Annotated[float, typer.Option("--sampling-rate", "-r", help="Samples a second.")] = 100.0,
    event: Annotated[int | None, option("Only this slip event, in local time: 0 the first, -1 the last.")] = None,
    antialias: Annotated[bool, typer.Option("--antialias", help="Low-pass to half the sampling rate first.")] = False,
    components: Annotated[bool, typer.Option("--components", help=COMPONENTS)] = False,
    duration: Duration = None,
) -> None:
    r"""Export slip, slip rate and stress of the contact at evenly spaced times, for tools of rupture modellers.

    The file holds on-fault time series as in the SCEC/USGS rupture benchmarks
    (t slip slip-rate shear-stress; s, m, m/s, MPa). Samples are exact, and right
    limits at jumps.

    \b
      stickslip export fig6-slab fig6.txt --sampling-rate 200
      stickslip export second-event-maxwell late.txt --event 1
      stickslip export run.nc run.txt --antialias

    Exit code: 0 done, 1 the run failed, 2 unusable input, 130 interrupted.
    """
    from stickslip.io.scec import write_scec
    from stickslip.run.progress import progress_line

    check_target(file, "FILE", (".txt", ".dat"))
    source = _source(run, duration)
    with progress_line(f"{source.name}:") as report:
        solution = source.solution(report)
    readings = solution if event is None else solution.window(event)
    announce(write_scec(readings, file, sampling_rate, antialias=antialias, problem=source.name, components=components))
    if not solution.status.ok:
        raise typer.Exit(1)


def _source(run: str, duration: str | None) -> RunSource:
    from stickslip.cli.overrides import STDIN, load, read
    from stickslip.scenarios.schema import read_duration
    from stickslip.studies.compare import read_source

    length = read(read_duration, duration, "export", "duration")
    return read_source(load(run, "export") if run == STDIN else run, length, who="export")
