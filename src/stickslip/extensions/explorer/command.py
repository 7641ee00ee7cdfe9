"""`stickslip explore`: open the explorer, a page on which the system answers while you move its numbers."""

from __future__ import annotations

import re
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from stickslip.cli.options import SCENARIO, Changes, Columns, argument, complete_scenario, option
from stickslip.extension import check_is_there
from stickslip.foundation.errors import InputError

if TYPE_CHECKING:
    from stickslip.extensions.explorer.model.answer import RecordBehind
    from stickslip.problem import Problem

SERVER = "Server"
"""Heading of the options of the server in the help."""
ADDRESS = "Network address to listen on. Not given: 127.0.0.1, which can be reached from this computer only."
ALLOW_ORIGIN = "Another host (NAME or NAME:PORT) under which the page may be reached, as behind a proxy; may be repeated."
PORT = "Port to listen on; 0 for any free port. Not given: the first free port from 5018 on."
RECORD = "Draw a laboratory record behind the runs (CSV, as for `stickslip infer`), and say how far they are from it."
BEHIND = "Record"
"""Heading of the options of a record in the help."""
_HOST = re.compile(r"[\w.-]+(:\d{1,5})?|\[[\da-f:]+\](:\d{1,5})?", re.IGNORECASE)
NO_BROWSER = "Do not open a browser: only print the address."


def explore(
    scenario: Annotated[str | None, argument(SCENARIO, complete_scenario)] = None,
    *,
    changes: Changes = None,
    record: Annotated[Path | None, option(RECORD, panel=BEHIND)] = None,
    begin: Annotated[str | None, option("Take the record from this time on, as `infer` did.", "--from", panel=BEHIND)] = None,
    end: Annotated[str | None, option("Take the record up to this time.", "--to", panel=BEHIND)] = None,
    sensor: Annotated[
        str, typer.Option(help="Where shear was measured: contact, spring (load cell of a block) or drive.", rich_help_panel=BEHIND)
    ] = "contact",
    column: Columns = None,
    port: Annotated[int | None, option(PORT, min=0, max=65535, metavar="<int>", panel=SERVER)] = None,
    address: Annotated[str, option(ADDRESS, panel=SERVER)] = "127.0.0.1",
    allow_origin: Annotated[list[str] | None, option(ALLOW_ORIGIN, panel=SERVER)] = None,
    sessions: Annotated[
        int, typer.Option(help="Largest number of pages open at once.", min=1, metavar="<int>", rich_help_panel=SERVER)
    ] = 8,
    no_browser: Annotated[bool, typer.Option("--no-browser", help=NO_BROWSER, rich_help_panel=SERVER)] = False,
) -> None:
    r"""Open a page in the browser on which a scenario answers while you move its numbers.

    The page shows the law, the contact, the motion, the inside of the slab and
    the energy, linked; a cursor moves through all of them. The printed
    address holds a token, without which nothing is shown. Ctrl-C ends the server.

    \b
      stickslip explore
      stickslip explore fig6-slab
      stickslip explore best.toml --record test17.csv
      stickslip explore mine.toml --no-browser --port 5018

    Needs the extra `explorer`: pip install "stickslip[explorer]".

    Exit code: 0 ended by Ctrl-C, 2 unusable input.
    """
    from stickslip.cli.overrides import load
    from stickslip.extensions.explorer.model.setting import FIRST_SCENARIO, Setting, explorable
    from stickslip.extensions.explorer.notebook import check_extra

    check_extra("explore")
    loaded = explorable(load(scenario or FIRST_SCENARIO, "explore", changes, any_kind=True))
    if not loaded.is_of_core and (loaded.to_solve.is_plane or record is not None):
        raise InputError("explore: a fault in 3D and a record behind a fault are not shown: `stickslip run --figure` draws the run")
    from stickslip.extensions.explorer.server.serve import Endpoint
    from stickslip.extensions.explorer.server.start import start

    setting = Setting.of(loaded)
    for name in allow_origin or ():
        if not _HOST.fullmatch(name):
            raise InputError(f"explore: --allow-origin must be NAME or NAME:PORT, got {name[:60]!a}")
    endpoint = Endpoint(address=address, port=port, origins=tuple(allow_origin or ()), sessions=sessions)
    behind = None if record is None else _behind(record, {"begin": begin, "end": end}, column, sensor, loaded.problem)
    start(setting, endpoint, browser=not no_browser, say=typer.echo, behind=behind)


def _behind(record: Path, ends: dict[str, str | None], column: list[str] | None, sensor: str, problem: Problem) -> RecordBehind:
    """Return the record that is drawn behind all runs. Raises InputError."""
    check_is_there("inference", "explore: --record")
    from stickslip.cli.overrides import typed_columns
    from stickslip.extensions.inference import record_beside
    from stickslip.foundation.quantities import Quantity
    from stickslip.problem.scenarios import typed_number

    time = Quantity("s", "time of the record")
    found = {name: time.check("explore", name, typed_number(text)) for name, text in ends.items() if text is not None}
    return record_beside(record, sensor, problem, "explore", **found, columns=typed_columns(column, "explore: --column"))
