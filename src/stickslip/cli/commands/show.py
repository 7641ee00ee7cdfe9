"""`stickslip show`: summarise a file of results."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from stickslip.cli.names import complete_quantity, complete_result
from stickslip.cli.options import (
    Animation,
    CatalogueFigure,
    Dpi,
    EnergyFigure,
    FrictionFigure,
    PathFigure,
    RunFigure,
    Size,
    SpaceTime,
)

RESULT = "A file of `run --out`, a catalogue or its checkpoint, or the folder of a sweep."
QUANTITY = "Of a sweep, draw this quantity: by default the one that was refined, or the first."
SCENARIO_ONLY = "Print the scenario of the results instead, as TOML with every value in SI."


def show(
    result: Annotated[Path, typer.Argument(help=RESULT, autocompletion=complete_result)],
    *,
    scenario: Annotated[bool, typer.Option("--scenario", help=SCENARIO_ONLY)] = False,
    figure: RunFigure = None,
    quantity: Annotated[str | None, typer.Option("--quantity", "-q", help=QUANTITY, autocompletion=complete_quantity)] = None,
    path: PathFigure = None,
    catalogue_figure: CatalogueFigure = None,
    energy_figure: EnergyFigure = None,
    friction_figure: FrictionFigure = None,
    space_time: SpaceTime = None,
    animation: Animation = None,
    dpi: Dpi = None,
    size: Size = None,
) -> None:
    r"""Show what is in a file of results, as after the run, and draw figures from it without running it again.

    The summary ends with the version of stickslip that made the file. Of a
    catalogue it shows the slip events; of a sweep, how its members ended and the
    range of each quantity, and --figure draws one of them (--quantity).

    \b
      stickslip show mine.nc
      stickslip show mine.nc --figure mine.png --space-time waves.png
      stickslip show mine.nc --scenario > again.toml
      stickslip show events.csv
      stickslip show events.csv --catalogue-figure events.png
      stickslip show map.zarr --figure map.png --quantity slip

    Exit code: 0 done, 2 unusable input.
    """
    from stickslip.cli.output.files import Look, check_targets
    from stickslip.cli.output.pictures import Pictures
    from stickslip.cli.stored import stored

    look = Look(dpi, size)
    pictures = Pictures(figure, path, catalogue_figure, energy_figure, friction_figure, space_time, animation, look)
    check_targets(*pictures.targets())
    pictures.check()
    found = stored(result, quantity)
    if scenario:
        typer.echo(found.scenario(), nl=False)
        return
    found.check(pictures)
    found.summarise()
    found.draw(pictures)
