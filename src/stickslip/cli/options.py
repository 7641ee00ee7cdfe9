"""Arguments and options that several commands share."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Annotated, Any

import typer

from stickslip.cli.names import complete_axis, complete_scenario, complete_vary

AXIS = "NAME=LOW..HIGH[:POINTS][:log]; give two."
"""How the axes of a map are typed, for the help of --map."""
SCENARIO = "A TOML file, a bundled name, or - for standard input."
"""What a scenario is, for help."""

RESULTS, FIGURES, ACCURACY = "Files of results", "Figures", "Accuracy and size"
"""Headings of groups of options in the help."""


def argument(text: str, complete: Callable[[str], list[str]]) -> Any:
    """Declare an optional argument; the help does not show that nothing is given by default."""
    return typer.Argument(help=text, autocompletion=complete, show_default=False)


def option(text: str, *names: str, panel: str | None = None, **more: Any) -> Any:
    """Declare an option; the help does not show that nothing is given by default."""
    return typer.Option(*names, help=text, show_default=False, rich_help_panel=panel, **more)


def picture(what: str, *names: str) -> Any:
    """Declare an option that names the file of a figure."""
    return option(f"Save {what} (.png, .pdf or .svg).", *names, panel=FIGURES)


def table_of(what: str) -> Any:
    """Declare the option that names the file of a table with one row for each of `what`."""
    return option(f"Save the table, a row for each {what} (.csv).", "--out", "-o")


def axes_of(what: str) -> Any:
    """Declare the option --map, which is given twice."""
    return option(f"Axis of {what}: {AXIS}", "--map", autocompletion=complete_axis)


CHANGES = 'Give a parameter of the scenario another value: "friction.alpha=2", "body.thickness=5 km"; may be repeated.'
Changes = Annotated[list[str] | None, option(CHANGES, "--set", metavar="<name=value>", autocompletion=complete_vary)]
ScenarioName = Annotated[str, typer.Argument(help=SCENARIO, autocompletion=complete_scenario)]
FigureFile = Annotated[Path | None, option("Save a figure (.png, .pdf or .svg).", "--figure", "-f", panel=FIGURES)]
Dpi = Annotated[float | None, option("Dots per inch of figures (.png): 200 if not given.", panel=FIGURES)]
SIZE_HELP = 'Size of figures: "16 x 10 cm", "3.5 x 5 in", "single column" or "double column".'
Size = Annotated[str | None, option(SIZE_HELP, "--size", "--figure-size", panel=FIGURES)]
Duration = Annotated[str | None, option('Override the duration: s, or with a unit ("480 years").')]
Rtol = Annotated[float | None, option("Override the relative tolerance.")]

RunFigure = Annotated[Path | None, picture("slip, slip rate and traction over time", "--figure", "-f")]
PathFigure = Annotated[Path | None, picture("the path of the run in the set K", "--path")]
CatalogueFigure = Annotated[Path | None, picture("the slip events", "--catalogue-figure")]
EnergyFigure = Annotated[Path | None, picture("where the energy is", "--energy-figure")]
FrictionFigure = Annotated[Path | None, picture("the friction coefficient against slip", "--friction-figure")]
SpaceTime = Annotated[Path | None, picture("the inside of the slab over time", "--space-time")]
Animation = Annotated[Path | None, option("Save the slab in motion (.gif; .mp4 and .webm need ffmpeg).", panel=FIGURES)]
