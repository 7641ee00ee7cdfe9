"""Points that stand in a file beside a scenario: the columns of a table of CSV, which the scenario names."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from stickslip.foundation.arguments import shown
from stickslip.foundation.atomic_write import read_bounded
from stickslip.foundation.errors import InputError, nearest
from stickslip.foundation.given import column_given
from stickslip.foundation.headings import KNOWN_COLUMNS, TURNED, find, missing
from stickslip.foundation.named_columns import NamedColumns
from stickslip.foundation.quantities import LARGEST_SERIES
from stickslip.foundation.record_files import text_in
from stickslip.foundation.text_columns import read_text

LARGEST_DATA_FILE = 50_000_000
"""Size (bytes) of the largest data file that is read: scenarios are untrusted."""
ANYWHERE = "STICKSLIP_FILES_ANYWHERE"
"""Environment variable whose value 1 allows data files outside the folder of the scenario."""


def read_points(
    name: str,
    folder: Path | None,
    columns: Mapping[str, str],
    where: str,
    along: str | None = None,
    *,
    named: Any = None,
    turns: bool = False,
    most: int = LARGEST_SERIES,
) -> dict[str, list[float]]:
    """Return the numbers (SI) in the CSV file `name` of the scenario's folder, by field.

    `columns` maps headings to fields. The last belongs to the dependent variable; exactly one other column must be there, or be
    named by `along`, and holds the ascending slips, slip rates or times at which the values are given. Blank lines, lines that
    begin with #, notes before the headings and unknown columns are ignored, and more than `most` rows are refused. Headings may
    carry units (`foundation.headings`), and `named` says what they mean. Of a contact that `turns` they are those of angles and
    torques.
    Raises InputError with a message of one line that names the file and the line.
    """
    if turns:
        columns, along = {TURNED.get(column, column): key for column, key in columns.items()}, TURNED.get(str(along), along)
    *others, value = columns
    if along is not None:
        if along not in others:
            at = where.removesuffix(" file")
            raise InputError(f"{at} along: {shown(along)} is no column to go along; {nearest(str(along), others)}")
        columns = {column: columns[column] for column in (along, value)}
    try:
        given = NamedColumns(named or {}, shows=False)
        text = text_in(content_of(name, folder))
    except UnicodeDecodeError:
        raise InputError(f"{where} {shown(name)}: not a text file in UTF-8") from None
    except InputError as error:
        raise InputError(f"{where} {shown(name)}: {error}") from None
    return _points_in(text, columns, f"{where}: {shown(name)}", given, most)


def _points_in(text: str, columns: Mapping[str, str], file: str, named: NamedColumns, most: int) -> dict[str, list[float]]:
    """Return the numbers (SI) in CSV text by field, as `read_points` does.

    `file` is the name of the text in messages.
    """
    *others, value = columns
    table = read_text(text, tuple(columns), file, most, named=named)
    found = [column for column in others if column in table.columns]
    if value not in table.columns:
        raise InputError(f"{table.at_header}: no column '{value}' in the header; {missing(table.header, value)}")
    if len(found) != 1:
        got = f'both; choose one with along = "{found[0]}"' if found else f"none; {missing(table.header, others[0])}"
        raise InputError(f"{table.at_header}: the header needs a column {' or '.join(others)}, got {got}")
    count = len(table.columns[value])
    if count < 2:
        raise InputError(f"{table.at(-1)}: at least two rows of numbers are needed, got {count}")
    table.check_ascending(found[0])
    points = {columns[column]: numbers.tolist() for column, numbers in table.warned().columns.items()}
    for column, one in find(table.header, (found[0], value), file).items():
        if one.unit is not None:
            points[columns[column]] = column_given(points[columns[column]], one.unit, KNOWN_COLUMNS[column].unit)
    return points


def content_of(name: str, folder: Path | None) -> bytes:
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
        return read_bounded(path, LARGEST_DATA_FILE)
    except OSError as error:
        raise InputError(f"cannot be read: {error.strerror}") from None
