"""Arguments and options that several commands share."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from importlib import import_module
from pathlib import Path
from typing import Annotated, Any

import typer
from typer import Context  # typer evaluates the annotation at run time

RESULT_FILES = (".nc", ".csv", ".parquet")
"""Suffixes of the files that hold results of runs and catalogues."""

Names = Callable[[], list[str]]
"""A function that returns all names that an option accepts."""


def names_in(module: str, table: str) -> Names:
    """Return a function that imports a module and returns the names in one of its tables."""

    def names() -> list[str]:
        found: Iterable[str] = getattr(import_module(f"stickslip.{module}"), table)
        return list(found)

    return names


CHOICES: dict[str, Names] = {}
"""The names that each option with a fixed set of values accepts, by option: its help lists them."""


def choices(option: str, names: Names) -> Callable[[str], list[str]]:
    """Declare the names that an option accepts. Returns the function that completes them."""
    CHOICES[option] = names
    return completion(option)


def completion(option: str) -> Callable[[str], list[str]]:
    """Return the function that completes the names that an option accepts, as far as they have been declared."""
    return lambda incomplete: [name for name in CHOICES.get(option, list)() if name.startswith(incomplete)]


complete_law = choices("friction", names_in("friction", "LAWS"))
complete_pull = choices("pull", names_in("problem.loading", "HISTORIES"))
complete_rule = choices("selection", names_in("problem.selection_rule", "SELECTION_RULES"))
complete_curve = choices("series", names_in("solution.evaluation", "CURVES"))
complete_quantity = completion("quantity")


TABLES = (".csv", ".txt", ".tsv", ".dat", ".lvm", ".las", ".uff", ".unv")
"""How the names of tables of numbers end."""


def is_data(name: str) -> bool:
    """Return True if a file of this name holds measured data, by the end of its name: neither a scenario nor results."""
    suffix = Path(name).suffix.lower()
    return suffix[1:2].isalpha() and " " not in suffix and suffix not in (".toml", ".nc", ".zarr")


def complete_table(incomplete: str) -> list[str]:
    """Return the tables and folders that begin with what is typed."""
    return _files(incomplete, TABLES)


def complete_scenario(incomplete: str) -> list[str]:
    """Return the bundled scenarios, TOML files and folders that begin with what is typed."""
    return _complete_files(incomplete, (".toml",))


def complete_source(incomplete: str) -> list[str]:
    """Return the bundled scenarios, TOML files, files of runs (.nc) and folders that begin with what is typed."""
    return _complete_files(incomplete, (".toml", ".nc"))


def complete_result(incomplete: str) -> list[str]:
    """Return the files and folders that begin with what is typed and may be results: of runs, catalogues and sweeps."""
    return [name.removesuffix("/") if name.endswith(".zarr/") else name for name in _files(incomplete, RESULT_FILES)]


def _complete_files(incomplete: str, suffixes: tuple[str, ...]) -> list[str]:
    return complete_template(incomplete) + _files(incomplete, suffixes)


def _files(incomplete: str, suffixes: tuple[str, ...]) -> list[str]:
    typed = Path(incomplete)
    folder = typed if incomplete.endswith("/") else typed.parent
    files = [str(path) + ("/" if path.is_dir() else "") for path in _listing(folder) if path.is_dir() or path.suffix in suffixes]
    return [name for name in sorted(files) if name.startswith(incomplete)]


def _listing(folder: Path) -> list[Path]:
    try:
        return [path for path in folder.iterdir() if not path.name.startswith(".")]
    except OSError:
        return []


def complete_template(incomplete: str) -> list[str]:
    """Return the starters and bundled scenarios that begin with what is typed."""
    from stickslip.problem.scenarios import library

    return [name for name in [*library.STARTERS, *library.names()] if name.startswith(incomplete)]


def complete_vary(context: Context, incomplete: str) -> list[str]:
    """Return the keys of the scenario on the command line that begin with what is typed, each with the sign before its value."""
    return _before_a_value([name for name in _parameters(context) if name.startswith(incomplete)], "VALUE")


def complete_axis(context: Context, incomplete: str) -> list[str]:
    """Return the parameters of the scenario on the command line that can be an axis of a map, as `complete_vary` does."""
    found = (name for name in _parameters(context) if name.startswith(("body.", "friction.")))
    return _before_a_value([name for name in found if name.startswith(incomplete)], "LOW..HIGH")


def _before_a_value(names: list[str], value: str) -> list[str]:
    """Return names with an equals sign, and for a name that is alone also what may follow.

    After a word that is the only one shells put a space. With a second one that begins like it they stop where the two part, which
    is behind the equals sign, and show both.
    """
    found = [f"{name}=" for name in names]
    return [*found, f"{found[0]}{value}"] if len(found) == 1 else found


def _parameters(context: Context) -> list[str]:
    """Return the keys of the numbers in the scenario on the command line; none if there is no scenario that can be read.

    While the value of an option is typed, typer leaves the words that are no options in `args`, and the scenario is the first.
    """
    from stickslip.foundation.errors import InputError
    from stickslip.problem.scenarios import load_scenario
    from stickslip.problem.scenarios.parameter_paths import parameter_paths

    scenario = context.params.get("scenario") or next(iter(context.args), None)
    if scenario is None:
        return []
    try:
        return [one.name for one in parameter_paths(load_scenario(scenario))]
    except InputError:
        return []


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
COLUMN = 'Say which column is what, with its unit: load_point="Vert_disp (micron)", friction=5; may be repeated.'
Columns = Annotated[list[str] | None, option(COLUMN, "--column", metavar="<name=heading>")]
ScenarioName = Annotated[str, typer.Argument(help=SCENARIO, autocompletion=complete_scenario)]
FigureFile = Annotated[Path | None, option("Save a figure (.png, .pdf or .svg).", "--figure", "-f", panel=FIGURES)]
Dpi = Annotated[float | None, option("Dots per inch of figures (.png): 200 if not given.", panel=FIGURES)]
SIZE_HELP = 'Size of figures: "16 x 10 cm", "3.5 x 5 in", "single column" or "double column".'
Duration = Annotated[str | None, option('Override the duration: s, or with a unit ("480 years").')]
ALL = "Say all that is known of the proof of the run, the energy of its waves and its predictability."
Everything = Annotated[bool, typer.Option("--all", help=ALL)]
Rtol = Annotated[float | None, option("Override the relative tolerance.")]
