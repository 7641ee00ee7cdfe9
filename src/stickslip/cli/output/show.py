"""Show results on the terminal: one console, sentences that fit it, numbers with units."""

from __future__ import annotations

import os
import sys
from typing import TYPE_CHECKING, Any

from rich.console import Console

from stickslip.foundation.formatting import clean

if TYPE_CHECKING:
    from stickslip.scenarios.scenario import Scenario

WIDE = 132
"""Width (columns) of tables that go to a file, so that their rows keep their lines."""


def console(*, errors: bool = False) -> Console:
    """Return the console for results, as wide as the terminal or as COLUMNS says; else, as in a file, `WIDE` columns."""
    stream = sys.stderr if errors else sys.stdout
    width = None if fits_lines(stream) else WIDE
    return Console(file=stream, width=width, highlight=False, markup=False, emoji=False)


def fits_lines(stream: Any) -> bool:
    """Return True if lines must fit a width: on a terminal, or if COLUMNS is set. In a file a sentence keeps its line."""
    return stream.isatty() or bool(os.environ.get("COLUMNS"))


def say(screen: Console, *texts: str, style: str | None = None) -> None:
    """Print texts, each from the start of a line; lines that must fit a width are broken between words."""
    for text in texts:
        screen.print(text, style=style, soft_wrap=not fits_lines(screen.file))


def titled(scenario: Scenario) -> Console:
    """Print the title of a scenario, or its name, on the console for results, and return the console."""
    screen = console()
    say(screen, clean(scenario.title or scenario.name), style="bold")
    return screen


def print_sentences(screen: Console, *texts: str) -> None:
    """Print texts as sentences, each on a line of its own; empty ones are left out."""
    say(screen, *(f"{text[0].upper()}{text[1:]}." for text in texts if text))
