"""A table of text as its file format writes it: headings, and rows of cells that are read one after the other."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import NamedTuple

from stickslip.foundation.arrays import Floats
from stickslip.foundation.errors import InputError
from stickslip.foundation.headings import MOST_COLUMNS, count_named
from stickslip.foundation.named_columns import NamedColumns

PREAMBLE = 200
"""Notes of an instrument may take this many lines before the header."""
NO_NUMBER = ("", "nan", "-", "–", "na", "n/a", "null", "none")
"""What instruments and people write where a number is missing."""


class Sheet(NamedTuple):
    """Headings with units in brackets, the number of their line, and rows of cells, each with the number of its line.

    `null` is the number that the file names as the mark of a missing one. `notes` are sentences about what was passed over; they
    are complete once the rows are read. `counted` is what the rows are counted in. `hint` ends the message on a row with too many
    cells. `table` has the numbers, shape (rows, columns), where a file holds them as a block that is read at once; `rows` are
    empty then, and rows are counted from 1. `interval` (s) is that of the samples, where the header of the file states it.
    """

    header: list[str]
    line: int
    rows: Iterator[tuple[int, Sequence[str]]]
    notes: list[str]
    null: float | None = None
    counted: str = "line"
    hint: str = ""
    table: Floats | None = None
    interval: float | None = None


class Lines:
    """The lines of a text without their ends, each read once, with the number of the last one that was read."""

    def __init__(self, begin: Sequence[str], more: Iterator[str]) -> None:
        self.begin, self.more, self.number = begin, more, 0
        self.peeked: str | None = None

    def __iter__(self) -> Iterator[str]:
        return self

    def __next__(self) -> str:
        line = self.peeked if self.peeked is not None else self._next()
        self.peeked = None
        self.number += 1
        return line

    def _next(self) -> str:
        return self.begin[self.number] if self.number < len(self.begin) else next(self.more)

    def peek(self) -> str:
        """Return the next line, which stays the next one; nothing at the end."""
        if self.peeked is None:
            try:
                self.peeked = self._next()
            except StopIteration:
                return ""
        return self.peeked


class Asked(NamedTuple):
    """What is looked for in a table: the place for messages, the wanted columns, those that the user names, and the most rows."""

    place: str
    wanted: Sequence[str]
    named: NamedColumns
    most: int

    def count(self, cells: Sequence[str]) -> int:
        """Return how many cells may be headings of the columns that are looked for."""
        few = cells[:MOST_COLUMNS]
        return count_named(few, self.wanted) + self.named.among(few)

    def header(self, cells: Sequence[str], line: int, others: Sequence[Sequence[str]] = ()) -> list[str]:
        """Return a header with the user's names; `others` are further names of its columns. Raises InputError."""
        at = f"{self.place}, line {line}"
        if len(cells) > MOST_COLUMNS:
            raise InputError(f"{at}: more than {MOST_COLUMNS} columns: not a table of numbers")
        return self.named.renamed(cells, self.wanted, at, others)

    def best(self, names: Sequence[str], unit: str) -> str:
        """Return the first of several names of a column that is looked for, or else the first, with its unit in brackets."""
        said = [name for name in names if name.strip()]
        headings = [name if not unit or "(" in name or "[" in name else f"{name} ({unit})" for name in said]
        return next((one for one in headings if count_named([one], self.wanted)), headings[0] if headings else "")

    def fault(self, line: int, what: str) -> InputError:
        """Return an error at a line."""
        return InputError(f"{self.place}, line {line}: {what}")

    def check_columns(self, count: int, line: int, what: str) -> None:
        """Raise InputError for too many columns; `what` they are in the file."""
        if count > MOST_COLUMNS:
            raise self.fault(line, f"more than {MOST_COLUMNS} {what}")

    def number(self, text: str, line: int, what: str) -> float:
        """Return a number of a file's own header. Raises InputError."""
        try:
            return float(text.strip().replace("D", "E").replace("d", "e"))
        except ValueError:
            raise self.fault(line, f"{what} must be a number") from None

    def whole(self, text: str, line: int, what: str) -> int:
        """Return a whole number of a file's own header, at least 0. Raises InputError."""
        if not (text.strip().isascii() and text.strip().isdigit() and len(text.strip()) <= 10):
            raise self.fault(line, f"{what} must be a whole number")
        return int(text)


class RecordForm(NamedTuple):
    """A format of text: what knows it by the first lines of a file, and what reads such a file as a sheet.

    `begins` gets the first 200 lines, or those of the first 4096 bytes.
    """

    begins: Callable[[Sequence[str]], bool]
    sheet: Callable[[Lines, Asked], Sheet]
