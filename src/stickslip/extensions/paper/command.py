"""`stickslip paper`: reproduce the paper's figures and tables, and judge its claims."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from stickslip.cli.output.files import announce, check_folder


def paper(
    out: Annotated[
        Path, typer.Option("--out", "-o", help="Folder for figures, tables and the report; made if it is missing.", file_okay=False)
    ] = Path("paper"),
) -> None:
    r"""Reproduce the paper: Figs 1-7, tables, and a verdict on every claim.

    The command runs every case of Campillo, Ionescu, Paumier & Renard (1996)
    with the constants as printed and in the readings under which the described
    events appear, and says which claim holds under which.

    \b
      stickslip paper --out paper
    """
    from stickslip.run import progress_line

    check_folder(out, "--out")
    from stickslip.extensions.paper.make import make

    with progress_line("paper") as report:
        announce(make(out, report))
