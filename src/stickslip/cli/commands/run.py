"""`stickslip run`: simulate a scenario, or resume a run, and report what happened."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, NoReturn

import typer

from stickslip.cli.options import (
    RESULTS,
    SCENARIO,
    Changes,
    Everything,
    argument,
    complete_scenario,
    option,
)
from stickslip.cli.output.files import announce, write_files
from stickslip.cli.output.pictures import Pictures
from stickslip.cli.typed_options import TypedOptions

if TYPE_CHECKING:
    from stickslip.problem import Status

OUT = "Save the whole solution, with a checkpoint every 30 s: netCDF (.nc), or with a [contact] or a [chain] a new folder (.zarr)."
CATALOGUE = "Keep slip events only, in bounded memory (.csv, .parquet or .nc)."
CSV = "Save the curves at 1001 evenly spaced times; `stickslip export` has other times and formats (.csv)."
RESUME = "Resume the run in a file or folder of --out, or a checkpoint of --catalogue."
ENERGY = "Add the energy of each event to --catalogue (slow)."


def run(
    scenario: Annotated[str | None, argument(SCENARIO, complete_scenario)] = None,
    *,
    changes: Changes = None,
    options: TypedOptions,
    resume: Annotated[Path | None, option(RESUME)] = None,
    out: Annotated[Path | None, option(OUT, "--out", "-o", panel=RESULTS)] = None,
    catalogue: Annotated[Path | None, option(CATALOGUE, panel=RESULTS)] = None,
    csv: Annotated[Path | None, option(CSV, "--csv", panel=RESULTS)] = None,
    energy: Annotated[bool, typer.Option("--energy", help=ENERGY, rich_help_panel=RESULTS)] = False,
    everything: Everything = False,
    pictures: Pictures,
) -> None:
    r"""Simulate a scenario, or resume a run, and report what happened: slip events, shocks, and what ended the run.

    Times are in s, slips in m, slip rates in m/s, tractions in Pa (slab) or
    N (block); of what turns in rad, rad/s and N m. Results and figures of earlier runs are replaced, each when its
    content is complete; data that stickslip did not write are not.

    \b
      stickslip run fig6-slab
      stickslip run mine.toml --out mine.nc --figure mine.png
      stickslip run mine.toml --csv curves.csv
      stickslip run fig6-slab --duration "480 years" --selection maxwell
      stickslip run fig6-slab --set friction.alpha=0.1 --set "body.thickness=5 km"
      stickslip run fig6-slab --space-time waves.png --animation slab.gif
      stickslip run fig5-slab-printed --duration "3 days"
      stickslip run cycles-block --duration "10000 years" --catalogue events.csv
      stickslip run --resume mine.nc --duration "1000 years"
      stickslip run planar-patch --out fault.zarr --animation fault.gif

    Ctrl-C ends a run with a valid file, from which --resume continues. It also
    continues from the last checkpoint of a run that was killed. The result is
    the same, bit for bit, as without the stop.

    Exit code: 0 done, 1 the run failed, 2 unusable input, 130 interrupted.
    """
    from stickslip.cli.kinds import kind_of_run
    from stickslip.cli.request import Request

    request = Request(
        scenario=scenario,
        resume=resume,
        changes=changes,
        options=options,
        out=out,
        catalogue=catalogue,
        csv=csv,
        energy=energy,
        pictures=pictures,
    )
    request.check_source()
    kind = kind_of_run(request)
    request.check(kind.suffix)
    kind.check(request)
    results = kind.run(request)
    results.summarise(everything=everything)
    announce(kind.file(request), *write_files((csv, results.to_csv)), *results.draw(pictures))
    if line := kind.how_to_go_on(request, results):
        typer.echo(line)
    _leave(results.status)


def _leave(status: Status) -> NoReturn:
    if status.name == "interrupted":
        raise KeyboardInterrupt
    raise typer.Exit(0 if status.ok else 1)
