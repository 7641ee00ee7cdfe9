"""Read named columns of numbers, with units in their headings, from delimited text.

A text is read by lines, so that memory is that of its numbers and no more. No message repeats a text that a file holds, because
scenarios from somebody else may name files: messages name lines and columns.
"""

from __future__ import annotations

import csv
import io
import math
import re
from array import array
from collections.abc import Iterator, Mapping, Sequence
from itertools import chain, islice, zip_longest
from pathlib import Path
from typing import NamedTuple, TextIO

import numpy as np
from numpy.typing import NDArray

from stickslip.foundation.arrays import Floats
from stickslip.foundation.atomic_write import open_bounded
from stickslip.foundation.columns import Table, check_number, scaled
from stickslip.foundation.errors import InputError
from stickslip.foundation.headings import (
    MOST_COLUMNS,
    PURE,
    FoundColumn,
    count_named,
    example,
    factor_of,
    find,
    has_unit,
    is_number,
    note_units,
)

LONGEST_LINE = 50_000
"""Largest number of characters of a line."""
PREAMBLE = 200
"""Notes of an instrument may take this many lines before the header."""
NO_NUMBER = ("", "nan", "-", "–", "na", "n/a", "null", "none")
"""What instruments and people write where a number is missing."""
DECIMAL_COMMA = (
    "decimal commas are not read, write points: `tr , . < OLD.csv > NEW.csv` replaces them, "
    "or in Python pass pandas.read_csv(FILE, sep=';', decimal=',')"
)
"""The cure for decimal commas in a file whose columns are not separated by commas."""
BLANKS = " "
"""The separator of columns that stand apart by blanks."""
XLOOK_WIDTH = 12
"""Number of characters of a heading in text that xlook writes."""
_COMMA = re.compile(r"[+-]?\d+,\d+([eE][+-]?\d+)?")
_XLOOK = re.compile(r"\s*(col\s+\d+\s*)+")
_WORD = re.compile(r"[^\s(\[]+(?:\s*[(\[][^()\[\]]*[)\]])?|[(\[][^()\[\]]*[)\]]|[(\[]")
_APART = re.compile(r"\s{2,}")


def read_file(path: Path, wanted: Sequence[str], limits: tuple[int, int], *, raw: bool = False) -> Table:
    """Return those of the wanted columns that a text file has, as `read_text` does.

    `limits` are its largest size in bytes and its largest number of rows. Raises InputError.
    """
    name, (largest, most) = str(path) if str(path).isprintable() else ascii(str(path)), limits
    try:
        with open_bounded(path, largest) as stream:
            mark = stream.read(2)
            stream.seek(0)
            encoding = "utf-16" if mark in (b"\xff\xfe", b"\xfe\xff") else "utf-8-sig"
            with io.TextIOWrapper(stream, encoding) as text:
                return _read(text, wanted, name, most, raw=raw)
    except FileNotFoundError:
        raise InputError(f"{name}: no such file") from None
    except UnicodeError:
        raise InputError(f"{name}: not a text file in UTF-8; save it as CSV in UTF-8") from None
    except OSError as error:
        raise InputError(f"{name}: cannot be read: {error.strerror}") from None
    except InputError as error:
        raise InputError(str(error) if str(error).startswith(name) else f"{name}: {error}") from None


def read_text(text: str, wanted: Sequence[str], place: str, most: int, *, raw: bool = False) -> Table:
    """Return those of the wanted columns that a text has, as numbers in SI.

    The first line that is neither blank nor a comment (#) is the header. If it names none of the columns and exactly one of the
    lines that follow names two of them, that line is the header, and those before it are notes. Units stand in the headings, or in
    a row of their own below them. Columns are separated by tabs, semicolons or commas, whichever of them the header has, in this
    order, or else by blanks. The text that xlook writes, with numbers of columns, names, units and counts, is understood.

    Raises InputError with a message of one line that names `place` and the line; also for more than `most` rows. If `raw`, cells
    without a number become NaN, and no sign is refused.
    """
    return _read(io.StringIO(text.lstrip("\ufeff"), newline=None), wanted, place, most, raw=raw)


def _read(stream: TextIO, wanted: Sequence[str], place: str, most: int, *, raw: bool) -> Table:
    lines = _lines(stream, place)
    begin = list(islice(lines, PREAMBLE))
    head = _head(begin, wanted)
    at_header = f"{place}, line {head.number}"
    chosen = find(head.cells, wanted, at_header)
    body, number = chain(begin[head.behind :], lines), head.behind
    header = list(head.cells)
    below = next(((i, line) for i, line in enumerate(begin[head.behind :]) if not _is_empty(line)), None)
    if below is not None and _are_units(units := _split(below[1], head.separator), header, chosen):
        header = [name if has_unit(name) else f"{name} ({_bare(unit)})" for name, unit in zip_longest(header, units, fillvalue="")]
        chosen = find(header, wanted, at_header)
        body, number = chain(begin[head.behind + below[0] + 1 :], lines), head.behind + below[0] + 1
    if not chosen:  # the caller says what is missing
        return Table({}, place, np.array([head.number]), "line", header, at_header)
    rows = _Rows(place, head.separator, len(header), chosen, raw)
    at_lines, found = rows.read(body, number, most)
    columns = {name: scaled(found[:, k], one.factor) for k, (name, one) in enumerate(chosen.items())}
    note_units(chosen, columns, at_header)
    return Table(columns, place, at_lines if len(at_lines) else np.array([head.number]), "line", header, at_header)


def _lines(stream: TextIO, place: str) -> Iterator[str]:
    """Yield the lines of a text without their ends. Raises InputError for one that is too long, before it is read to its end."""
    number = 0
    while line := stream.readline(LONGEST_LINE + 2):
        number += 1
        if len(line) > LONGEST_LINE + 1:
            raise InputError(f"{place}, line {number}: longer than {LONGEST_LINE} characters: not a table of points")
        yield line.rstrip("\n")


def _is_empty(line: str) -> bool:
    """Return True for a line that is blank or a comment."""
    text = line.lstrip()
    return not text or text[0] == "#"


class _Head(NamedTuple):
    """The headings of a text, the number of their line, the separator of columns, and how many lines stand before the rows."""

    cells: Sequence[str]
    number: int
    separator: str
    behind: int


def _head(lines: Sequence[str], wanted: Sequence[str]) -> _Head:
    """Return the header among the first lines of a text; see `read_text`."""
    rows = [i for i, line in enumerate(lines) if not _is_empty(line)]
    xlook = next((i for i in rows if _XLOOK.fullmatch(lines[i])), None)
    if xlook is not None and xlook + 2 < len(lines):
        return _xlook_head(lines, xlook)
    if not rows:
        return _Head([""], 1, ",", len(lines))
    heads = {i: _header_in(lines, i) for i in rows}
    named = {i: count_named(head.cells[:MOST_COLUMNS], wanted) for i, head in heads.items()}
    headers = [i for i in rows if named[i] > 1]
    first = rows[0]
    if named[first] == 0 and len(headers) == 1:
        return heads[headers[0]]
    comment = lines[first - 1].lstrip().lstrip("#") if first else ""
    if named[first] == 0 and comment and all(map(is_number, _split(lines[first], heads[first].separator))):
        header = _header_in([*lines[: first - 1], comment, *lines[first:]], first - 1)
        if count_named(header.cells[:MOST_COLUMNS], wanted) > 1:  # headings behind a #, as numpy.savetxt writes them
            return header
    return heads[first]


def _header_in(lines: Sequence[str], i: int) -> _Head:
    """Return line i of a text as a header; blanks separate columns if they make as many headings as there are cells below."""
    line = lines[i]
    separator = next((mark for mark in "\t;," if mark in line), None)
    if separator is None and len(line.split()) > 1:
        below = next((len(one.split()) for one in lines[i + 1 : i + 4] if not _is_empty(one)), 0)
        for cells in (_WORD.findall(line), _APART.split(line.strip())):
            if len(cells) == below:
                return _Head(cells, i + 1, BLANKS, i + 1)
    return _Head(_split(line, separator or ","), i + 1, separator or ",", i + 1)


def _xlook_head(lines: Sequence[str], i: int) -> _Head:
    """Return the header of text from xlook: line i numbers the columns, and names, units and counts of records follow.

    Names and units have twelve characters each and may touch each other. Rows begin with their number, which has no heading.
    """
    count = len(lines[i].split()) // 2
    names, units = (_of_width(lines[i + k], count) for k in (1, 2))
    behind = i + 4 if i + 3 < len(lines) and "recs" in lines[i + 3] else i + 3
    cells = len(lines[behind].split()) if behind < len(lines) else count
    numbered = [""] if cells == count + 1 else []
    pure = [name if unit in PURE else f"{name} ({unit})" for name, unit in zip(names, units, strict=True)]
    return _Head([*numbered, *pure], i + 2, BLANKS, behind)


def _of_width(line: str, count: int) -> list[str]:
    """Return the cells of a line that are separated by blanks, or, if these are too few, twelve characters wide."""
    cells = line.split()
    if len(cells) == count:
        return cells
    begin = max(len(line.rstrip()) - XLOOK_WIDTH * count, 0)
    return [line[begin + XLOOK_WIDTH * k : begin + XLOOK_WIDTH * (k + 1)].strip() for k in range(count)]


def _split(line: str, separator: str) -> list[str]:
    if separator == BLANKS:
        return line.split()
    try:
        return next(csv.reader([line], delimiter=separator), [])
    except csv.Error:
        return line.split(separator)


def _are_units(row: Sequence[str], header: Sequence[str], chosen: Mapping[str, FoundColumn]) -> bool:
    """Return True if a row below the headings holds the units of the chosen columns, and contradicts none of the headings."""
    cells = {name: _bare(row[one.place]) if one.place < len(row) else "" for name, one in chosen.items()}
    try:
        factors = {name: factor_of(cell, name, "") for name, cell in cells.items()}
    except InputError:
        return False
    agrees = all(
        one.unit is None or cells[name] in header[one.place] or factors[name] == one.factor for name, one in chosen.items()
    )
    return agrees and any(cell.casefold() not in PURE for cell in cells.values())


def _bare(unit: str) -> str:
    return unit.strip(" ()[]")


class _Rows(NamedTuple):
    """How the rows of a text are read: the place for messages, the separator, the number of headings, and the columns."""

    place: str
    separator: str
    width: int
    chosen: Mapping[str, FoundColumn]
    raw: bool

    def read(self, lines: Iterator[str], number: int, most: int) -> tuple[NDArray[np.int64], Floats]:
        """Return the lines of the rows of a text, and their numbers as they are written, shape (rows, columns).

        `number` lines stand before the rows. Raises InputError for the first row that cannot be read, and for one too many.
        """
        at_lines, numbers = array("q"), array("d")
        for at, row in self._split(lines, number):
            if len(at_lines) == most:
                raise InputError(f"{self.place}, line {at}: more than {most} rows")
            numbers.extend(self._numbers(row, at, first=not at_lines))
            at_lines.append(at)
        return np.array(at_lines), np.array(numbers).reshape(-1, len(self.chosen))

    def _split(self, lines: Iterator[str], number: int) -> Iterator[tuple[int, list[str]]]:
        """Yield the cells of lines that are neither blank nor comments, each with the number of its line."""
        if self.separator == BLANKS:
            yield from ((at, line.split()) for at, line in enumerate(lines, number + 1) if not _is_empty(line))
            return
        read = csv.reader(lines, delimiter=self.separator)
        try:
            for row in read:
                if any(map(str.strip, row)) and not row[0].lstrip().startswith("#"):
                    yield number + read.line_num, row
        except csv.Error as error:
            raise InputError(f"{self.place}, line {number + read.line_num}: {error}") from None

    def _numbers(self, row: Sequence[str], at_line: int, *, first: bool) -> list[float]:
        """Return the numbers of the chosen columns in a row, the first one or another, in their unit. Raises InputError."""
        at = f"{self.place}, line {at_line}"
        if any(cell.strip() for cell in row[self.width :]):
            hint = "" if self.separator != "," else "; decimal commas? Then separate columns by semicolons and write decimal points"
            raise InputError(f"{at}: {len(row)} cells, but the header has {self.width}{hint}")
        cells = {name: row[one.place].strip() if one.place < len(row) else "" for name, one in self.chosen.items()}
        if not self.raw:
            return [check_number(_as_written(cell, name, at, first), name, at) for name, cell in cells.items()]
        return [math.nan if cell.casefold() in NO_NUMBER else _as_written(cell, name, at, first) for name, cell in cells.items()]


def _as_written(text: str, column: str, place: str, first: bool) -> float:
    try:
        return float(text)
    except ValueError:
        if _COMMA.fullmatch(text):
            raise InputError(f"{place}: {column} has a decimal comma; {DECIMAL_COMMA}") from None
        hint = f"; a unit belongs in the heading, as in {example(column)}" if first and text else ""
        hint = "; times of day are not read, write seconds from the start" if column == "time" and ":" in text else hint
        raise InputError(f"{place}: {column} must be a number, got {'text' if text else 'nothing'}{hint}") from None
