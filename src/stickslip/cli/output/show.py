"""Show results on the terminal: one console, plain tables, numbers with units."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

from rich.box import SIMPLE_HEAD
from rich.console import Console
from rich.table import Table

from stickslip.foundation.formatting import clean

if TYPE_CHECKING:
    from stickslip.scenarios.scenario import Scenario


def console(*, errors: bool = False) -> Console:
    """Return the console for results; without a terminal it is 132 columns wide, so that a table in a file keeps its lines."""
    stream = sys.stderr if errors else sys.stdout
    width = None if stream.isatty() else 132
    return Console(file=stream, width=width, highlight=False, markup=False, emoji=False)


def table(*headings: str, numbers: bool = False) -> Table:
    """Return a table without a frame; columns of numbers are aligned to the right."""
    made = Table(box=SIMPLE_HEAD, show_edge=False, pad_edge=False)
    for heading in headings:
        made.add_column(heading, justify="right" if numbers else "left", overflow="fold")
    return made


def titled(scenario: Scenario) -> Console:
    """Print the title of a scenario, or its name, on the console for results, and return the console."""
    screen = console()
    screen.print(clean(scenario.title or scenario.name), style="bold")
    return screen


def print_sentences(screen: Console, *texts: str) -> None:
    """Print texts as sentences, each on a line of its own; empty ones are left out."""
    for text in filter(None, texts):
        screen.print(f"{text[0].upper()}{text[1:]}.", soft_wrap=True)
