"""Read named columns of numbers, with units in their headings, from text: delimited, or in a format of `record_files`.

A text is read by lines, so that memory is that of its numbers and no more. No message repeats a text that a file holds, because
scenarios from somebody else may name files: messages name lines and columns.
"""

from __future__ import annotations

import io
import math
from array import array
from collections.abc import Iterator, Mapping, Sequence
from itertools import islice
from pathlib import Path
from typing import NamedTuple, TextIO

import numpy as np
from numpy.typing import NDArray

from stickslip.foundation.arrays import Floats
from stickslip.foundation.atomic_write import open_bounded
from stickslip.foundation.columns import Table, check_number, scaled
from stickslip.foundation.errors import InputError, warn
from stickslip.foundation.headings import FoundColumn, example, find, is_signed
from stickslip.foundation.marks import marked, sentences
from stickslip.foundation.named_columns import NamedColumns
from stickslip.foundation.record_files import FIRST_BYTES, decoded, form_of
from stickslip.foundation.record_files.delimited import is_words
from stickslip.foundation.record_files.foreign import check_is_text
from stickslip.foundation.record_files.number_rows import COMMA_NUMBER
from stickslip.foundation.record_files.sheet import NO_NUMBER, PREAMBLE, Asked, Lines, Sheet
from stickslip.foundation.unit_doubts import doubts_of

LONGEST_LINE = 50_000
"""Largest number of characters of a line."""
POINTS = "write points: `tr , . < OLD.csv > NEW.csv`, or in Python pass pandas.read_csv(FILE, sep=';', decimal=',')"
"""The cure for commas that may be either."""
LONGEST_FOOTER = 50
"""So many lines without a number may follow the numbers."""


def read_file(
    path: Path,
    wanted: Sequence[str],
    limits: tuple[int, int],
    *,
    raw: bool = False,
    skip: bool = False,
    named: NamedColumns | None = None,
) -> Table:
    """Return those of the wanted columns that a text file has, as `read_text` does.

    `limits` are its largest size in bytes and its largest number of rows. Raises InputError.
    """
    name, (largest, most) = str(path) if str(path).isprintable() else ascii(str(path)), limits
    try:
        with open_bounded(path, largest) as stream:
            begin = stream.read(FIRST_BYTES)
            check_is_text(begin)
            stream.seek(0)
            encoding, errors = decoded(begin)
            with io.TextIOWrapper(stream, encoding, errors) as text:
                return _read(text, Asked(name, wanted, named or NamedColumns({}), most), raw=raw, skip=skip)
    except FileNotFoundError:
        raise InputError(f"{name}: no such file") from None
    except UnicodeError:
        raise InputError(f"{name}: not a text file in UTF-8; save it as CSV in UTF-8") from None
    except OSError as error:
        raise InputError(f"{name}: cannot be read: {error.strerror}") from None
    except InputError as error:
        raise InputError(str(error) if str(error).startswith(name) else f"{name}: {error}") from None


def read_text(
    text: str,
    wanted: Sequence[str],
    place: str,
    most: int,
    *,
    raw: bool = False,
    skip: bool = False,
    named: NamedColumns | None = None,
) -> Table:
    """Return those of the wanted columns that a text has, as numbers in SI.

    Texts in a format of an extension, such as LabVIEW's, are known by their first lines. In any other text the headings are found
    by the numbers below them: of the few lines above a group of numbers, that which names most of the columns is the header, and
    what stands before it are notes. Units stand in the headings, or in a row of their own below them. Columns are separated by
    tabs, semicolons, commas or blanks, whichever makes numbers of the cells; then decimal commas are read, too, unless each of
    them may group thousands. Lines of words behind the numbers are passed over. The text that xlook writes, with numbers of
    columns, names, units and counts, is understood. `named` are headings that the user has named, and `Table.doubts` name the
    columns without a unit.

    Raises InputError with a message of one line that names `place` and the line; also for more than `most` rows. If `raw`, cells
    without a number and marks of missing numbers, as -999.25, become NaN, `Table.notes` say so, and no sign is refused. If `skip`,
    rows with such a mark are left out, with a warning. Otherwise they are refused.
    """
    asked = Asked(place, wanted, named or NamedColumns({}), most)
    return _read(io.StringIO(text.lstrip("\ufeff"), newline=None), asked, raw=raw, skip=skip)


def _read(stream: TextIO, asked: Asked, *, raw: bool, skip: bool) -> Table:
    more = _lines(stream, asked.place)
    begin = list(islice(more, PREAMBLE))
    sheet = form_of(begin)(Lines(begin, more), asked)
    at_header = f"{asked.place}, line {sheet.line}"
    chosen = find(sheet.header, asked.wanted, at_header)
    if not chosen:  # the caller says what is missing
        return Table({}, asked.place, np.array([sheet.line]), sheet.counted, sheet.header, at_header)
    rows = _Rows(asked, sheet, chosen, raw)
    at_lines, found = rows.read()
    at_lines, found, notes = rows.without_marks(at_lines, found, skip)
    columns = {name: scaled(found[:, k], one.factor) for k, (name, one) in enumerate(chosen.items())}
    if not len(at_lines):
        at_lines = np.array([sheet.line])
    doubts = doubts_of(chosen, columns, at_header)
    told = (*sheet.notes, *notes)
    return Table(columns, asked.place, at_lines, sheet.counted, sheet.header, at_header, told, doubts, sheet.interval)


def _lines(stream: TextIO, place: str) -> Iterator[str]:
    """Yield the lines of a text without their ends. Raises InputError for one that is too long, before it is read to its end."""
    number, longest, read = 0, LONGEST_LINE + 1, stream.readline
    while line := read(longest + 1):
        number += 1
        if len(line) > longest:
            raise InputError(f"{place}, line {number}: longer than {LONGEST_LINE} characters: not a table of points")
        yield line[:-1] if line[-1] == "\n" else line


class _Rows(NamedTuple):
    """How the rows of a text are read: what is asked for, what the file is, and the columns; see `read_text` for `raw`."""

    asked: Asked
    sheet: Sheet
    chosen: Mapping[str, FoundColumn]
    raw: bool

    def at(self, line: int) -> str:
        """Return the place of a row for messages."""
        return f"{self.asked.place}, {self.sheet.counted} {line}"

    def read(self) -> tuple[NDArray[np.int64], Floats]:
        """Return the lines of the rows of a text, and their numbers as they are written, shape (rows, columns).

        Raises InputError for the first row that cannot be read, and for one too many.
        """
        at_lines, numbers, most, footer = array("q"), array("d"), self.asked.most, list[InputError]()
        width, places = len(self.sheet.header), [one.place for one in self.chosen.values()]
        if (table := self.sheet.table) is not None:
            if len(table) > most:
                raise InputError(f"{self.at(most + 1)}: more than {most} rows")
            return np.arange(1, len(table) + 1), np.ascontiguousarray(table[:, places])
        for at, row in self.sheet.rows:
            if len(at_lines) == most:
                raise InputError(f"{self.at(at)}: more than {most} rows")
            try:
                found = [float(row[place]) for place in places] if len(row) <= width else None
            except (ValueError, IndexError):
                found = None
            try:
                found = self._numbers(row, at, first=not at_lines) if found is None else found
            except InputError as error:
                if len(at_lines) < 2 or len(footer) == LONGEST_FOOTER or not is_words(row):
                    raise footer[0] if footer else error from None
                footer.append(error)
                continue
            if footer:
                raise footer[0]
            numbers.extend(found)
            at_lines.append(at)
        if footer:
            told = f"what follows {self.sheet.counted} {at_lines[-1]} has no numbers: passed over"
            self.sheet.notes.append(told) if self.raw else warn(f"{self.asked.place}: {told}")
        return np.array(at_lines), np.array(numbers).reshape(-1, len(self.chosen))

    def _numbers(self, row: Sequence[str], line: int, *, first: bool) -> list[float]:
        """Return the numbers of the chosen columns in a row with other cells too, the first row or another. Raises InputError."""
        at, width = self.at(line), len(self.sheet.header)
        if any(cell.strip() for cell in row[width:]):
            raise InputError(f"{at}: {len(row)} cells, but the header has {width}{self.sheet.hint}")
        cells = {name: row[one.place].strip() if one.place < len(row) else "" for name, one in self.chosen.items()}
        if not self.raw:
            return [_as_written(cell, name, at, first) for name, cell in cells.items()]
        return [math.nan if cell.casefold() in NO_NUMBER else _as_written(cell, name, at, first) for name, cell in cells.items()]

    def without_marks(
        self, at_lines: NDArray[np.int64], found: Floats, skip: bool
    ) -> tuple[NDArray[np.int64], Floats, tuple[str, ...]]:
        """Return lines and numbers without marks of missing numbers, and sentences on those. Raises InputError; see `read_text`."""
        notes, gone = list[str](), np.zeros(len(found), bool)
        for k, name in enumerate(self.chosen):
            marks = marked(found[:, k], self.sheet.null)
            for i in np.flatnonzero(marks & (not self.raw) & (not skip))[:1].tolist():
                what = f"{name} is {found[i, k]:.7g}, which marks a missing number"
                raise InputError(f"{self.at(int(at_lines[i]))}: {what}; leave out such rows")
            notes += sentences(found[:, k], marks, name)
            found[marks, k] = math.nan
            gone |= marks
        if self.raw:
            return at_lines, found, tuple(notes)
        if gone.any():
            warn(f"{self.asked.place}: {'; '.join(notes)}: left out")
            at_lines, found = at_lines[~gone], found[~gone]
        self._check(at_lines, found)
        return at_lines, found, ()

    def _check(self, at_lines: NDArray[np.int64], found: Floats) -> None:
        """Raise InputError for the first number that is not finite, or is below 0 and must not be."""
        signed = np.array([is_signed(name) for name in self.chosen])
        for i in np.flatnonzero((~np.isfinite(found) | ((found < 0.0) & ~signed)).any(axis=1))[:1].tolist():
            for k, name in enumerate(self.chosen):
                check_number(float(found[i, k]), name, self.at(int(at_lines[i])))


def _as_written(text: str, column: str, place: str, first: bool) -> float:
    try:
        return float(text)
    except ValueError:
        if COMMA_NUMBER.fullmatch(text):
            raise InputError(f"{place}: {column} has a decimal comma, or one that groups thousands; {POINTS}") from None
        hint = f"; a unit belongs in the heading, as in {example(column)}" if first and text else ""
        hint = "; times of day are not read, write seconds from the start" if column == "time" and ":" in text else hint
        raise InputError(f"{place}: {column} must be a number, got {'text' if text else 'nothing'}{hint}") from None
