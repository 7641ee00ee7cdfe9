"""Delimited text: columns between tabs, semicolons, commas or blanks, notes before the headings, units below; text from xlook."""

from __future__ import annotations

import csv
import re
from collections.abc import Iterator, Mapping, Sequence
from itertools import chain, islice, takewhile, zip_longest
from typing import NamedTuple

from stickslip.foundation.errors import InputError
from stickslip.foundation.headings import PURE, FoundColumn, factor_of, find, has_unit, is_number
from stickslip.foundation.record_files.number_rows import BLANKS, COMMA_NUMBER, NumberRows, number_rows
from stickslip.foundation.record_files.sheet import NO_NUMBER, PREAMBLE, Asked, Lines, Sheet

XLOOK_WIDTH = 12
"""Number of characters of a heading in text that xlook writes."""
_XLOOK = re.compile(r"\s*(col\s+\d+\s*)+")


def sheet(lines: Lines, asked: Asked) -> Sheet:
    """Return what delimited text holds; see `stickslip.foundation.text_columns.read_text`."""
    begin = list(islice(lines, PREAMBLE))
    head = _head(begin, asked)
    header = asked.header(head.cells, head.number)
    chosen = find(header, asked.wanted, f"{asked.place}, line {head.number}")
    notes, behind = list[str](), head.behind
    for i in head.between:
        row = head.rows.headings(begin[i].lstrip("#"))
        if said := _units_in(row, header, chosen, f"{asked.place}, line {i + 1}"):
            notes.append(f"{', '.join(said)}, as the row of units in line {i + 1} says")
            both = zip_longest(header, row, fillvalue="")
            header = [name if has_unit(name) or not _bare(unit) else f"{name} ({_bare(unit)})" for name, unit in both]
            behind = head.between[-1] + 1
            break
    rows = _rows(chain(begin[behind:], lines), behind, head.separator, asked.place)
    if head.rows.has_commas:
        notes.append("decimal commas are read as points")
        rows = _with_points(rows, [one.place for one in chosen.values()], asked.place)
    hint = "; decimal commas? Then separate columns by semicolons" if head.separator == "," else ""
    return Sheet(header, head.number, rows, notes, hint=hint)


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


def _with_points(rows: Iterator[tuple[int, list[str]]], places: Sequence[int], where: str) -> Iterator[tuple[int, list[str]]]:
    """Yield rows with decimal commas as points. Raises InputError if a column, of those at `places`, has numbers with both.

    There "1.000" may be 1 or a thousand.
    """
    seen = dict[tuple[int, str], str]()
    for at, row in rows:
        for place, cell in ((place, row[place].strip()) for place in places if place < len(row)):
            mark = "," if COMMA_NUMBER.fullmatch(cell) else "." if "." in cell and is_number(cell) else ""
            seen.setdefault((place, mark), cell)
            if mark and (other := seen.get((place, ",."[mark == ","]))):
                mixed = f"numbers with decimal commas and with points are mixed, {other!a:.40} and {cell!a:.40}"
                raise InputError(f"{where}, line {at}, column {place + 1}: {mixed}: write all with one mark")
        yield at, [cell.replace(",", ".") for cell in row]


def _is_empty(line: str) -> bool:
    """Return True for a line that is blank or a comment."""
    text = line.lstrip()
    return not text or text[0] == "#"


class _Head(NamedTuple):
    """The headings of a text, the number of their line, the separator of columns, and how many lines stand before the rows.

    `rows` are the first numbers below them, and `between` the lines of words that stand between.
    """

    cells: Sequence[str]
    number: int
    separator: str
    behind: int
    rows: NumberRows = NumberRows()
    between: Sequence[int] = ()


def _head(lines: Sequence[str], asked: Asked) -> _Head:
    """Return the header among the first lines of a text: of the lines above numbers, the one that names most wanted columns."""
    rows = [i for i, line in enumerate(lines) if not _is_empty(line)]
    xlook = next((i for i in rows if _XLOOK.fullmatch(lines[i])), None)
    if xlook is not None and xlook + 2 < len(lines):
        return _xlook_head(lines, xlook)
    if not rows:
        return _Head([""], 1, ",", len(lines))
    groups = number_rows(lines)
    heads = [head for group in groups for i in group.above if is_words((head := _head_at(lines, i, group)).cells)]
    named = [asked.count(head.cells) for head in heads]
    named = [0 if count == 1 and _is_empty(lines[head.number - 1]) else count for count, head in zip(named, heads, strict=True)]
    if any(named):  # a line in front of two that name as much is the one
        fits = [head.rows.width <= len(head.cells) <= head.rows.most for head in heads]
        return heads[max(range(len(heads)), key=lambda i: (named[i] > 0, fits[i], named[i]))]
    longest = max(groups, key=lambda group: len(group.lines), default=NumberRows())
    first = _head_at(lines, rows[0], longest)
    others = [head for i in rows if asked.count((head := _head_at(lines, i, NumberRows())).cells) > 1]
    others += [head for head in heads if head.rows is longest and longest.width <= len(head.cells) <= longest.most]
    return first if asked.count(first.cells) or not others else others[0]


def _head_at(lines: Sequence[str], i: int, rows: NumberRows) -> _Head:
    """Return line i of a text as the header of rows of numbers below it."""
    text = lines[i].lstrip("#% ")
    separator = rows.separator or next((mark for mark in "\t;," if mark in text), ",")
    below = list(takewhile(lambda j: is_words(rows.headings(lines[j])), (j for j in rows.above if j > i)))
    return _Head(rows.headings(text), i + 1, separator, i + 1, rows, below)


def is_words(cells: Sequence[str]) -> bool:
    """Return True for cells without a number, some of them more than marks of missing ones."""
    words = [cell.strip().casefold() for cell in cells]
    return not any(map(is_number, words)) and not set(words) <= set(NO_NUMBER)


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


def _units_in(row: Sequence[str], header: Sequence[str], chosen: Mapping[str, FoundColumn], at: str) -> list[str]:
    """Return what a row below the headings says of the units of chosen columns; nothing if it contradicts one of the headings.

    Raises InputError if it holds units of some and something else for others.
    """
    faults, said = list[InputError](), list[str]()
    for name, one in chosen.items():
        cell = _bare(row[one.place]) if one.place < len(row) else ""
        try:
            factor = factor_of(cell, name, f"{at}, column {one.place + 1}")
        except InputError as error:
            faults.append(error)
            continue
        if not (one.unit is None or cell in header[one.place] or factor == one.factor):
            return []
        said += [f"{name} (column {one.place + 1}) is in {cell}"] if cell.casefold() not in PURE else []
    if said and faults:
        raise faults[0]
    return said


def _bare(unit: str) -> str:
    return unit.strip(" ()[]")
