"""`stickslip run`: simulate a scenario, or resume a run, and report what happened."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, NoReturn

import typer

from stickslip.cli.options import (
    ACCURACY,
    RESULTS,
    SCENARIO,
    Changes,
    Duration,
    Everything,
    argument,
    complete_rule,
    complete_scenario,
    option,
)
from stickslip.cli.output.files import announce, write_files
from stickslip.cli.output.pictures import Pictures

if TYPE_CHECKING:
    from stickslip.problem import Status

CREEP_RTOL = (
    "Leap over slow creep between pulses (under a law of slip) and over steady sliding from the start, with an error of slip of at "
    "most this times the slip so far. Not given: after 200 round trips, or periods of a block, with an error that follows rtol "
    "(1e-6). 0 runs every one."
)
SHORTEST_EVENT = (
    'Lump slip events that are shorter than this, say "1 ms" (a slab under rate weakening ends in ever shorter ones). Not given: '
    "only where a round trip has more than 4096 pieces. 0 resolves them all."
)
MAX_PIECES = (
    "Largest number of pieces of history (0.42 kB each). Not given: two million. A run that needs more, or more than a sixth of "
    "the free memory, ends there; --out keeps what there is, and --resume goes on with a larger number."
)
OUT = "Save the whole solution, with a checkpoint every 30 s: netCDF (.nc), or with a [contact] a new folder (.zarr)."
CATALOGUE = "Keep slip events only, in bounded memory (.csv, .parquet or .nc)."
CSV = "Save the curves at 1001 evenly spaced times; `stickslip export` has other times and formats (.csv)."
RESUME = "Resume the run in a file or folder of --out, or a checkpoint of --catalogue."
ENERGY = "Add the energy of each event to --catalogue (slow)."
RULE = "Override the selection rule."


def run(
    scenario: Annotated[str | None, argument(SCENARIO, complete_scenario)] = None,
    *,
    changes: Changes = None,
    duration: Duration = None,
    events: Annotated[int | None, option("Stop after this number of slip events.")] = None,
    selection: Annotated[str | None, option(RULE, autocompletion=complete_rule)] = None,
    resume: Annotated[Path | None, option(RESUME)] = None,
    out: Annotated[Path | None, option(OUT, "--out", "-o", panel=RESULTS)] = None,
    catalogue: Annotated[Path | None, option(CATALOGUE, panel=RESULTS)] = None,
    csv: Annotated[Path | None, option(CSV, "--csv", panel=RESULTS)] = None,
    energy: Annotated[bool, typer.Option("--energy", help=ENERGY, rich_help_panel=RESULTS)] = False,
    everything: Everything = False,
    pictures: Pictures,
    rtol: Annotated[float | None, option("Override the relative tolerance.", panel=ACCURACY)] = None,
    creep_rtol: Annotated[float | None, option(CREEP_RTOL, panel=ACCURACY)] = None,
    shortest_event: Annotated[str | None, option(SHORTEST_EVENT, panel=ACCURACY)] = None,
    max_pieces: Annotated[int | None, option(MAX_PIECES, min=1, metavar="<int>", panel=ACCURACY)] = None,
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

    replaced = {"duration": duration, "events": events, "rtol": rtol, "creep_rtol": creep_rtol}
    replaced |= {"shortest_event": shortest_event, "selection": selection}
    request = Request(
        scenario=scenario,
        resume=resume,
        changes=changes,
        overrides=replaced,
        max_pieces=max_pieces,
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
