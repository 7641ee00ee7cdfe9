"""Show results on the terminal: one console, sentences and tables that fit it without breaking a number.

What needs rich or numpy is imported when the first of them is shown, because help does without both.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from rich.console import Console
    from rich.table import Table

    from stickslip.problem.scenarios import Scenario

WIDTH_OF_FILES = 132
"""Width (columns) of tables that go to a file, so that their rows keep their lines."""
Rows = Sequence[Sequence[str]]
GAP = 3
"""Blank columns between two columns of a table."""
INDENT = 4
"""Blank columns before prose that goes below the rest of its row."""
WIDEST = 40
"""Largest width (columns) of a column of short texts: longer ones are broken between words."""
LEAST_PROSE = 24
"""Smallest width (columns) of a column of prose; in less, prose goes below the rest of its row."""


def console(*, errors: bool = False) -> Console:
    """Return the console for results, as wide as the terminal or as COLUMNS says; else, as in a file, `WIDTH_OF_FILES` columns."""
    from rich.console import Console

    stream = sys.stderr if errors else sys.stdout
    width = None if fits_lines(stream) else WIDTH_OF_FILES
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
    from stickslip.foundation.given import show_in
    from stickslip.foundation.show import clean
    from stickslip.problem import units_given

    screen = console()
    show_in(units_given(scenario.problem))
    say(screen, clean(scenario.title or scenario.name), style="bold")
    return screen


def print_sentences(screen: Console, *texts: str) -> None:
    """Print texts as sentences, each on a line of its own; empty ones are left out."""
    from stickslip.foundation.show import sentence

    say(screen, *(sentence(text) for text in texts if text))


def print_numbers(screen: Console, headings: Sequence[str], rows: Rows, *, text: int = 0) -> None:
    """Print a table of numbers, of whose columns the first `text` hold words. A narrow terminal gets it in several parts.

    Each part begins with the first column, which tells the rows apart. A heading may have several lines.
    """
    parts = _parts([_width(heading, rows, j) for j, heading in enumerate(headings)], screen.width)
    for i, part in enumerate(parts):
        made = _table()
        for j in part:
            made.add_column(headings[j], justify="left" if j < text else "right", no_wrap=True)
        for row in rows:
            made.add_row(*(row[j] for j in part))
        if i:
            screen.print()
        screen.print(made)


def fits(screen: Console, headings: Sequence[str], rows: Rows) -> bool:
    """Return True if a table fits the width of the console in one part."""
    return len(_parts([_width(heading, rows, j) for j, heading in enumerate(headings)], screen.width)) == 1


def _parts(widths: list[int], available: int) -> list[list[int]]:
    """Divide columns into parts that fit, each with the first column and at least one more."""
    parts: list[list[int]] = [[0]]
    for j in range(1, len(widths)):
        used = sum(widths[k] + GAP for k in parts[-1])
        if used + widths[j] > available and len(parts[-1]) > 1:
            parts.append([0])
        parts[-1].append(j)
    return parts


def _width(heading: str, rows: Rows, column: int) -> int:
    """Return the width of a column, from its widest line."""
    return max(len(line) for text in (heading, *(row[column] for row in rows)) for line in (text.splitlines() or [""]))


def print_words(screen: Console, headings: Sequence[str], rows: Rows, styles: Mapping[str, str] | None = None) -> None:
    """Print a table of words whose last column is prose. Where that would be too narrow, prose goes below the rest of its row.

    A row of a single text is a heading. `styles` gives the style of rows by their first text.
    """
    from rich.table import Table

    whole = [row for row in rows if len(row) > 1]
    short = [min(_width(heading, whole, j), WIDEST) for j, heading in enumerate(headings[:-1])]
    styled = styles or {}
    if sum(short) + GAP * len(short) + LEAST_PROSE > screen.width:
        _stack(screen, rows, styled, headings if len(headings) > 3 else [""] * len(headings))
        return
    made = _table() if any(headings) else Table.grid(padding=(0, GAP - 1, 0, 0))
    for j, heading in enumerate(headings):
        made.add_column(heading, min_width=short[j] if j < len(short) else LEAST_PROSE, overflow="fold")
    for row in rows:
        if len(row) == 1 and made.rows:
            made.add_section()
        made.add_row(*row, style="bold" if len(row) == 1 else styled.get(row[0]))
    screen.print(made)


def _stack(screen: Console, rows: Rows, styles: Mapping[str, str], headings: Sequence[str]) -> None:
    from rich.padding import Padding

    for row in rows:
        if len(row) == 1:
            say(screen, f"\n{row[0]}", style="bold")
            continue
        others = (f"{heading} {text}".lstrip() for heading, text in zip(headings[1:-1], row[1:-1], strict=True) if text)
        say(screen, "  ".join((row[0], *others)), style=styles.get(row[0]))
        if row[-1]:
            screen.print(Padding(row[-1], (0, 0, 0, INDENT)), style=styles.get(row[0]))


def _table() -> Table:
    from rich.box import SIMPLE_HEAD
    from rich.table import Table

    return Table(box=SIMPLE_HEAD, show_edge=False, pad_edge=False)
