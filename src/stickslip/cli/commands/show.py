"""`stickslip show`: summarise a file of results: of a run, a catalogue of slip events, or a sweep."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from stickslip.cli.options import RESULTS, Everything, complete_quantity, complete_result, option
from stickslip.cli.output.files import Target, announce, check_targets, write_files
from stickslip.cli.output.pictures import Pictures

RESULT = "A file or folder of `run --out`, a catalogue or its checkpoint, or the folder of a sweep."
QUANTITY = "Of a sweep, draw this quantity: by default the first."
CSV = "Save as CSV: the curves of a run at 1001 times, the slip events of a catalogue, or the members of a sweep (.csv)."
SCENARIO_ONLY = "Print the scenario of the results instead, as TOML, in SI or in the units that were given."


def show(
    result: Annotated[Path, typer.Argument(help=RESULT, autocompletion=complete_result)],
    *,
    scenario: Annotated[bool, typer.Option("--scenario", help=SCENARIO_ONLY)] = False,
    quantity: Annotated[str | None, typer.Option("--quantity", "-q", help=QUANTITY, autocompletion=complete_quantity)] = None,
    everything: Everything = False,
    csv: Annotated[Path | None, option(CSV, "--csv", panel=RESULTS)] = None,
    pictures: Pictures,
) -> None:
    r"""Show what is in a file of results, as after the run, and draw figures from it without running it again.

    The summary ends with the version of stickslip that made the file. Of a
    catalogue it shows the slip events; of a sweep, how its members ended and the
    range of each quantity, and --figure draws one of them (--quantity).

    \b
      stickslip show mine.nc
      stickslip show mine.nc --figure mine.png --space-time waves.png
      stickslip show mine.nc --csv curves.csv
      stickslip show mine.nc --scenario > again.toml
      stickslip show events.csv
      stickslip show events.csv --catalogue-figure events.png
      stickslip show map.zarr --figure map.png --quantity slip
      stickslip show fault.zarr --animation fault.gif

    Exit code: 0 done, 2 unusable input.
    """
    from stickslip.cli.stored import stored  # with problems, which help does without

    check_targets(*pictures.targets(), Target("--csv", csv, (".csv",)))
    pictures.check()
    found = stored(result)
    results = found.results if quantity is None else found.results.of_quantity(quantity, result)
    if scenario:
        typer.echo(found.scenario(), nl=False)
        return
    results.check(pictures, str(result))
    results.summarise(everything=everything)
    found.print_origin()
    announce(*results.draw(pictures), *write_files((csv, results.to_csv)))
