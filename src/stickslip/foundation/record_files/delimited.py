"""Delimited text: columns between tabs, semicolons, commas or blanks, notes before the headings, units below; text from xlook."""

from __future__ import annotations

import csv
import re
from collections.abc import Iterator, Mapping, Sequence
from itertools import chain, islice, zip_longest
from typing import NamedTuple

from stickslip.foundation.errors import InputError
from stickslip.foundation.headings import PURE, FoundColumn, factor_of, find, has_unit, is_number
from stickslip.foundation.record_files.sheet import PREAMBLE, Asked, Lines, Sheet

BLANKS = " "
"""The separator of columns that stand apart by blanks."""
XLOOK_WIDTH = 12
"""Number of characters of a heading in text that xlook writes."""
_XLOOK = re.compile(r"\s*(col\s+\d+\s*)+")
_WORD = re.compile(r"[^\s(\[]+(?:\s*[(\[][^()\[\]]*[)\]])?|[(\[][^()\[\]]*[)\]]|[(\[]")
_APART = re.compile(r"\s{2,}")


def sheet(lines: Lines, asked: Asked) -> Sheet:
    """Return what delimited text holds; see `stickslip.foundation.text_columns.read_text`."""
    begin = list(islice(lines, PREAMBLE))
    head = _head(begin, asked)
    at_header = f"{asked.place}, line {head.number}"
    header = asked.header(head.cells, head.number)
    chosen = find(header, asked.wanted, at_header)
    behind = head.behind
    below = next(((i, line) for i, line in enumerate(begin[head.behind :]) if not _is_empty(line)), None)
    if below is not None and _are_units(units := _split(below[1], head.separator), header, chosen):
        header = [name if has_unit(name) else f"{name} ({_bare(unit)})" for name, unit in zip_longest(header, units, fillvalue="")]
        behind += below[0] + 1
    rows = _rows(chain(begin[behind:], lines), behind, head.separator, asked.place)
    hint = "; decimal commas? Then separate columns by semicolons and write decimal points" if head.separator == "," else ""
    return Sheet(header, head.number, rows, [], hint=hint)


def _rows(lines: Iterator[str], number: int, separator: str, place: str) -> Iterator[tuple[int, list[str]]]:
    """Yield the cells of lines that are neither blank nor comments, each with the number of its line; `number` lines are before."""
    if separator == BLANKS:
        yield from ((at, line.split()) for at, line in enumerate(lines, number + 1) if not _is_empty(line))
        return
    read = csv.reader(lines, delimiter=separator)
    try:
        for row in read:
            if any(map(str.strip, row)) and not row[0].lstrip().startswith("#"):
                yield number + read.line_num, row
    except csv.Error as error:
        raise InputError(f"{place}, line {number + read.line_num}: {error}") from None


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


def _head(lines: Sequence[str], asked: Asked) -> _Head:
    """Return the header among the first lines of a text; see `read_text`."""
    rows = [i for i, line in enumerate(lines) if not _is_empty(line)]
    xlook = next((i for i in rows if _XLOOK.fullmatch(lines[i])), None)
    if xlook is not None and xlook + 2 < len(lines):
        return _xlook_head(lines, xlook)
    if not rows:
        return _Head([""], 1, ",", len(lines))
    heads = {i: _header_in(lines, i) for i in rows}
    named = {i: asked.count(head.cells) for i, head in heads.items()}
    headers = [i for i in rows if named[i] > 1]
    first = rows[0]
    if named[first] == 0 and len(headers) == 1:
        return heads[headers[0]]
    comment = lines[first - 1].lstrip().lstrip("#") if first else ""
    if named[first] == 0 and comment and all(map(is_number, _split(lines[first], heads[first].separator))):
        header = _header_in([*lines[: first - 1], comment, *lines[first:]], first - 1)
        if asked.count(header.cells) > 1:  # headings behind a #, as numpy.savetxt writes them
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
