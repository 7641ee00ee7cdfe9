"""Arguments and options that several commands share."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Annotated, Any

import typer

from stickslip.cli.names import complete_scenario

AXIS = "NAME=LOW..HIGH[:POINTS][:log]; give two."
"""How the axes of a map are typed, for the help of --map."""

DURATION = 'Override the duration: s, or with a unit ("480 year").'
"""What a duration replaces and how it is typed, for help."""


def argument(text: str, complete: Callable[[str], list[str]]) -> Any:
    """Declare an optional argument; the help does not show that nothing is given by default."""
    return typer.Argument(help=text, autocompletion=complete, show_default=False)


def option(text: str, *names: str, **more: Any) -> Any:
    """Declare an option; the help does not show that nothing is given by default."""
    return typer.Option(*names, help=text, show_default=False, **more)


def picture(what: str, *names: str) -> Any:
    """Declare an option that names the file of a figure."""
    return option(f"Save {what} (.png, .pdf or .svg).", *names)


def table_of(what: str) -> Any:
    """Declare the option that names the file of a table with one row for each of `what`."""
    return option(f"Save the table, a row for each {what} (.csv).", "--out", "-o")


ScenarioName = Annotated[str, typer.Argument(help="A TOML file, or a bundled name.", autocompletion=complete_scenario)]
FigureFile = Annotated[Path | None, picture("a figure", "--figure", "-f")]
Dpi = Annotated[float | None, option("Dots per inch of figures (.png): 200 if not given.")]
SIZE_HELP = 'Size of figures: "16 x 10 cm", "3.5 x 5 in", "single column" or "double column".'
Size = Annotated[str | None, option(SIZE_HELP, "--size", "--figure-size")]
Until = Annotated[str | None, option(DURATION, "--until", "--duration")]
Rtol = Annotated[float | None, option("Override the relative tolerance.")]
