"""Rows of numbers in delimited text, however many notes stand above them: what separates their cells, and their headings."""

from __future__ import annotations

import csv
import re
from collections.abc import Sequence
from typing import NamedTuple

from stickslip.foundation.headings import is_number

BLANKS = " "
"""The separator of columns that stand apart by blanks."""
COMMA_NUMBER = re.compile(r"[+-]?\d+,\d+([eE][+-]?\d+)?")
"""A number with a decimal comma."""
_THOUSANDS = re.compile(r"[+-]?[1-9]\d{0,2},\d{3}")
_ABOVE = 4
"""The headings are at most this many lines above the numbers: names, units and channels have a line each."""
_MARKS = "\t;,"
_WORD = re.compile(r"[^\s(\[]+(?:\s*[(\[][^()\[\]]*[)\]])?|[(\[][^()\[\]]*[)\]]|[(\[]")
_APART = re.compile(r"\s{2,}")


class NumberRows(NamedTuple):
    """Lines of numbers one below the other: which lines, what separates their cells, and the lines above them.

    `width` is the number of columns with numbers, and `most` that of all cells, also of empty ones at the end.
    """

    lines: Sequence[int] = ()
    separator: str = ""
    width: int = 0
    most: int = 0
    above: Sequence[int] = ()
    has_commas: bool = False

    def headings(self, line: str) -> list[str]:
        """Return the cells of a line that may hold the headings of these rows: as many as there are columns, if possible."""
        own = next((mark for mark in _MARKS if mark in line), ",")
        apart = [_WORD.findall(line), _APART.split(line.strip())] if own not in line else []
        ways = [split(line, self.separator or own), split(line, own), *apart]
        return next((cells for cells in ways if self.width <= len(cells) <= self.most), ways[1])


def number_rows(lines: Sequence[str]) -> list[NumberRows]:
    """Return the groups of lines whose cells are mostly numbers, in the order of the text."""
    found, above = list[NumberRows](), list[int]()
    for i, line in enumerate(lines):
        if not line.strip():
            continue
        separator, cells = _as_numbers(line)
        if not separator or line.lstrip().startswith("#"):
            above.append(i)
            continue
        if above or not found or found[-1].separator != separator:
            found.append(NumberRows(above=above[-_ABOVE:], separator=separator))
            above = []
        one = found[-1]
        has_commas = one.has_commas or _has_commas([cell.strip() for cell in cells])
        width, most = max(one.width, len(cells)), max(one.most, len(split(line, separator)))
        found[-1] = one._replace(lines=[*one.lines, i], width=width, most=most, has_commas=has_commas)
    return found


def _as_numbers(line: str) -> tuple[str, list[str]]:
    """Return the separator that makes numbers of most cells of a line, and the cells; no separator if that are half or fewer."""
    best, share, found = "", 0.5, list[str]()
    for mark in (*(mark for mark in _MARKS if mark in line), BLANKS):
        cells = split(line, mark)
        while cells and not cells[-1].strip():
            cells.pop()
        filled = [cell.strip() for cell in cells if cell.strip()]
        part = sum(is_number(cell) or COMMA_NUMBER.fullmatch(cell) is not None for cell in filled) / max(len(filled), 1)
        if part > share:
            best, share, found = mark, part, cells
    return best, found


def _has_commas(cells: Sequence[str]) -> bool:
    """Return True if cells have commas, one or more that cannot group thousands, and no decimal points."""
    commas = [cell for cell in cells if COMMA_NUMBER.fullmatch(cell)]
    return not all(map(_THOUSANDS.fullmatch, commas)) and not any("." in cell and is_number(cell) for cell in cells)


def split(line: str, separator: str) -> list[str]:
    """Return the cells of a line."""
    if separator == BLANKS:
        return line.split()
    try:
        return next(csv.reader([line], delimiter=separator), [])
    except csv.Error:
        return line.split(separator)
