"""Print tables that fit the terminal without breaking a number: a wide one is divided into parts, one below the other."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from rich.box import SIMPLE_HEAD
from rich.console import Console
from rich.padding import Padding
from rich.table import Table

from stickslip.cli.output.show import say

Rows = Sequence[Sequence[str]]
GAP = 3
"""Blank columns between two columns of a table."""
INDENT = 4
"""Blank columns before prose that goes below the rest of its row."""
WIDEST = 40
"""Largest width (columns) of a column of short texts: longer ones are broken between words."""
LEAST_PROSE = 24
"""Smallest width (columns) of a column of prose; in less, prose goes below the rest of its row."""


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
    whole = [row for row in rows if len(row) > 1]
    short = [min(_width(heading, whole, j), WIDEST) for j, heading in enumerate(headings[:-1])]
    styled = styles or {}
    if sum(short) + GAP * len(short) + LEAST_PROSE > screen.width:
        _stack(screen, rows, styled)
        return
    made = _table() if any(headings) else Table.grid(padding=(0, GAP - 1, 0, 0))
    for j, heading in enumerate(headings):
        made.add_column(heading, min_width=short[j] if j < len(short) else LEAST_PROSE, overflow="fold")
    for row in rows:
        if len(row) == 1 and made.rows:
            made.add_section()
        made.add_row(*row, style="bold" if len(row) == 1 else styled.get(row[0]))
    screen.print(made)


def _stack(screen: Console, rows: Rows, styles: Mapping[str, str]) -> None:
    for row in rows:
        if len(row) == 1:
            say(screen, f"\n{row[0]}", style="bold")
            continue
        say(screen, "  ".join(filter(None, row[:-1])), style=styles.get(row[0]))
        screen.print(Padding(row[-1], (0, 0, 0, INDENT)), style=styles.get(row[0]))


def _table() -> Table:
    return Table(box=SIMPLE_HEAD, show_edge=False, pad_edge=False)
