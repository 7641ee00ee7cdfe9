"""`stickslip export`: write time series of a run for other tools."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from stickslip.cli.options import Duration, complete_source, option
from stickslip.cli.output.files import announce, check_target
from stickslip.foundation.errors import InputError

if TYPE_CHECKING:
    from stickslip.run import Reader, RunSource
    from stickslip.solution import Solution

RUN = "A TOML file, a bundled name, a file or folder of `run --out`, or - for a scenario from standard input."
FILE = "What to write: curves (.csv or .nc), or the text of the SCEC (.txt or .dat)."
RATE = "Samples a second. Not given: 100 in the text of the SCEC; for curves 1001 times from start to end."
COMPONENTS = "All eight columns of the three-dimensional benchmarks."
AREA = 'Area of a block\'s contact ("0.75 m^2"): the text of the SCEC then has its stresses.'
STATION = 'Of a contact of many nodes: the node at y, as in "8 km", or at y and z (by default that in the middle).'
OF_SCEC = (".txt", ".dat")
"""File suffixes of the text of the SCEC."""
SCEC_RATE = 100.0
"""Samples a second of the text of the SCEC, unless the user says otherwise."""


def export(
    run: Annotated[str, typer.Argument(help=RUN, autocompletion=complete_source)],
    file: Annotated[Path, typer.Argument(help=FILE)],
    *,
    sampling_rate: Annotated[float | None, option(RATE, "--sampling-rate", "-r")] = None,
    points: Annotated[int | None, option("Number of evenly spaced times of curves, both ends included.", "--points", "-n")] = None,
    event: Annotated[int | None, option("Only this slip event, in local time: 0 the first, -1 the last.")] = None,
    antialias: Annotated[bool, typer.Option("--antialias", help="Low-pass to half the sampling rate first.")] = False,
    components: Annotated[bool, typer.Option("--components", help=COMPONENTS)] = False,
    area: Annotated[str | None, option(AREA)] = None,
    station: Annotated[str | None, option(STATION)] = None,
    duration: Duration = None,
) -> None:
    r"""Export the curves of the contact at evenly spaced times, for a spreadsheet, a script or a rupture modeller.

    A file .csv has the columns time, slip, slip rate, load, traction and the
    states of the law, each with its unit in the heading; .nc has the same as
    netCDF. A file .txt holds on-fault time series as in the SCEC/USGS rupture
    benchmarks (t slip slip-rate shear-stress; s, m, m/s, MPa; of a block without
    --area the shear force in N). Samples are values of the run
    itself, not interpolated, and right limits at jumps.

    \b
      stickslip export fig6-slab curves.csv
      stickslip export run.nc curves.nc --points 5000
      stickslip export fig6-slab fig6.txt --sampling-rate 200
      stickslip export direct-shear-block shear.txt --area "0.75 m^2"
      stickslip export second-event-maxwell late.csv --event 1
      stickslip export fault.zarr 8km.txt --station "8 km"

    Of a contact of many nodes a folder of `run --out` is read: .csv and the text
    of the SCEC then have the motion of one node, .nc that of all, at the frames
    of the run.

    Exit code: 0 done, 1 the run failed, 2 unusable input, 130 interrupted.
    """
    from stickslip.cli.overrides import STDIN
    from stickslip.problem.scenarios import is_scenario_name
    from stickslip.run import progress_line, reader_of

    if is_scenario_name(str(file)):
        raise InputError(f"export: the run comes first, and then the file: `stickslip export {file} {run}`")
    check_target(file, "FILE", (".csv", ".nc", *OF_SCEC))
    for_scec = {"--components": components, "--area": area is not None}
    _check_fitting(file, for_scec, {"--points": points is not None})
    reader = None if run == STDIN else reader_of(Path(run))
    if reader is not None:
        given = {"--sampling-rate": sampling_rate, "--points": points, "--event": event, "--duration": duration}
        of_curves = {"--antialias": antialias or None, "--components": components or None, "--area": area}
        _export_special(reader, Path(run), file, given | of_curves, {} if station is None else {"station": station})
        return
    if station is not None:
        raise InputError("export: --station is for the folder of a contact of many nodes: leave it out")
    source = _source(run, duration)
    with progress_line(f"{source.name}:") as report:
        solution = source.solution(report)
    readings: Any = solution if event is None else solution.window(event)
    if file.suffix.lower() in OF_SCEC:
        rate = SCEC_RATE if sampling_rate is None else sampling_rate
        readings.to_scec(file, rate, antialias=antialias, problem=source.name, components=components, area=area)
    else:
        readings.to_csv(file, sampling_rate=sampling_rate, points=points, antialias=antialias)
    announce(file)
    _leave(solution)


def _check_fitting(file: Path, for_scec: dict[str, bool], for_curves: dict[str, bool]) -> None:
    """Refuse options that the file's format does not have. Raises InputError."""
    is_scec = file.suffix.lower() in OF_SCEC
    wrong = [name for name, given in (for_curves if is_scec else for_scec).items() if given]
    if wrong:
        others = ".csv and .nc" if is_scec else " and ".join(OF_SCEC)
        raise InputError(f"export: {wrong[0]} is for files {others}, not for {file.suffix.lower()}: leave it out")


def _export_special(reader: Reader, path: Path, file: Path, given: dict[str, Any], station: dict[str, str]) -> None:
    """Write the results of an extension at their own times. Raises InputError for options that choose others."""
    run, in_scec = reader.open(path), file.suffix.lower() in OF_SCEC
    has_stations = hasattr(run, "to_scec")
    wrong = [name for name, value in given.items() if value is not None] + ["--station"] * bool(station and not has_stations)
    if wrong or (in_scec and not has_stations):
        what = f"leave out {wrong[0]}" if wrong else f"write .csv or .nc, not {file.suffix.lower()}"
        raise InputError(f"export: {path} holds {reader.what}, which is written at its own times: {what}")
    if not hasattr(run, "to_csv"):
        raise InputError(f"export: {path} holds {reader.what}, which has no table")
    announce((run.to_scec if in_scec else run.to_csv)(file, **station) or file)


def _source(run: str, duration: str | None) -> RunSource:
    from stickslip.cli.overrides import STDIN, load, typed_option
    from stickslip.run import run_source

    length = typed_option("duration", duration, "export")
    return run_source(load(run, "export") if run == STDIN else run, length, who="export")


def _leave(solution: Solution) -> None:
    if not solution.status.ok:
        raise typer.Exit(1)
