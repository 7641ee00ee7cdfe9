"""Read a data file of a friction law or a loading history: CSV with a header, line by line, so that messages can name the line.

A scenario from somebody else must not read private files of the user who runs it. Therefore its data files must lie in its own
folder, and no message quotes a text that one holds. A user who trusts a scenario can lift the first restriction by an environment
variable, which no scenario can set.
"""

from __future__ import annotations

import csv
import math
import os
from collections.abc import Iterator, Mapping
from pathlib import Path

from stickslip.foundation.atomic_write import read_bounded
from stickslip.foundation.errors import InputError, nearest
from stickslip.foundation.quantities import LARGEST_SERIES
from stickslip.problem.problem import MAY_VARY
from stickslip.scenarios.values import show

LARGEST = 5_000_000
"""Size (bytes) of the largest data file that is read: scenarios are untrusted."""
ANYWHERE = "STICKSLIP_FILES_ANYWHERE"
"""Environment variable whose value 1 allows data files outside the folder of the scenario."""
SIGNED = ("slip", *MAY_VARY)
"""Columns whose numbers may be negative; all others must not be."""


def read_points(name: str, folder: Path | None, columns: Mapping[str, str], where: str) -> dict[str, list[float]]:
    """Return the numbers (SI) in the CSV file `name` of the scenario's folder, by the field to which they belong.

    `columns` maps headings to fields. The last is that of the dependent variable; exactly one other column must be there, and
    holds the ascending slips, slip rates or times at which the values are given. Blank lines, lines that begin with # and unknown
    columns are ignored. Raises InputError with a message of one line that names the file and the line.
    """
    *_, value = columns
    try:
        text = _text(name, folder)
    except InputError as error:
        raise InputError(f"{where} {show(name)}: {error}") from None
    file = f"{where}: {show(name)}"
    lines = _rows(text, file)
    number, header = next(lines, (1, []))
    place = f"{file}, line {number}"
    heading = _wanted([cell.strip() for cell in header], columns, value, place)
    found: dict[str, list[float]] = {column: [] for column in heading}
    for number, row in lines:
        place = f"{file}, line {number}"
        for column, i in heading.items():
            found[column].append(_number(row, i, column, place))
        _check_row(found, value, place)
    if len(found[value]) < 2:
        raise InputError(f"{place}: at least two rows of numbers are needed, got {len(found[value])}")
    return {columns[column]: numbers for column, numbers in found.items()}


def _text(name: str, folder: Path | None) -> str:
    """Return the content of a data file. Raises InputError with a message that is meant to follow its name."""
    if folder is None:
        raise InputError("only a scenario in a file can name another file; write the points as lists")
    anywhere, hint = os.environ.get(ANYWHERE) == "1", f"{ANYWHERE}=1 in the environment allows others"
    if not name.isprintable() or (Path(name).is_absolute() and not anywhere):
        raise InputError(f"the path must be relative to the scenario; {hint}")
    try:
        path = (folder / name).resolve()
        if not path.is_relative_to(folder.resolve()) and not anywhere:
            raise InputError(f"the file must be in the folder of the scenario; {hint}")
        if not path.is_file():
            raise InputError("no such file beside the scenario")
        return read_bounded(path, LARGEST).decode("utf-8-sig")
    except OSError as error:
        raise InputError(f"cannot be read: {error.strerror}") from None
    except UnicodeDecodeError:
        raise InputError("not a text file in UTF-8") from None


def _rows(text: str, place: str) -> Iterator[tuple[int, list[str]]]:
    lines = csv.reader(text.splitlines())
    try:
        for row in lines:
            if any(cell.strip() for cell in row) and not row[0].lstrip().startswith("#"):
                yield lines.line_num, row
    except csv.Error as error:
        raise InputError(f"{place}, line {lines.line_num}: {error}") from None


def _wanted(header: list[str], columns: Mapping[str, str], value: str, place: str) -> dict[str, int]:
    """Return the index of each wanted column. Raises InputError unless these are the value and exactly one other."""
    heading = {column: header.index(column) for column in columns if column in header}
    others = [column for column in columns if column != value]
    if value not in heading:
        raise InputError(f"{place}: no column '{value}' in the header; {_close(value, header)}")
    if len(heading) != 2:
        found = "both" if len(heading) > 2 else "none"
        raise InputError(f"{place}: the header needs a column {' or '.join(others)}, got {found}; {_close(others[0], header)}")
    return heading


def _close(column: str, header: list[str]) -> str:
    if len(header) == 1 and any(mark in header[0] for mark in ";\t"):
        return "columns are separated by commas"
    hint = nearest(column, [cell for cell in header if cell])
    return f"rename {show(hint[14:-2])}?" if hint.startswith("did") and hint[14:-2] != column else "values are in SI"


def _number(row: list[str], i: int, column: str, place: str) -> float:
    text = row[i].strip() if i < len(row) else ""
    try:
        value = float(text)
    except ValueError:
        raise InputError(f"{place}: {column} must be a number, got {'text' if text else 'nothing'}") from None
    if not math.isfinite(value):
        raise InputError(f"{place}: {column} must be finite, got {show(text)}")
    if value < 0.0 and column not in SIGNED:
        raise InputError(f"{place}: {column} must not be negative, got {value:g}")
    return value


def _check_row(found: Mapping[str, list[float]], value: str, place: str) -> None:
    for column, numbers in found.items():
        if len(numbers) > LARGEST_SERIES:
            raise InputError(f"{place}: more than {LARGEST_SERIES} rows")
        if column != value and len(numbers) > 1 and not numbers[-2] < numbers[-1]:
            raise InputError(f"{place}: {column} must ascend, but {numbers[-1]:g} follows {numbers[-2]:g}")
