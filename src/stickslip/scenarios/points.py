"""Read a data file of a friction law or a loading history, which a scenario names.

A scenario from somebody else must not read private files of the user who runs it. Therefore its data files must lie in its own
folder, and no message quotes a text that one holds. A user who trusts a scenario can lift the first restriction by an environment
variable, which no scenario can set.
"""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path

from stickslip.foundation.atomic_write import read_bounded
from stickslip.foundation.columns import header_of, missing, read_text
from stickslip.foundation.errors import InputError, nearest
from stickslip.foundation.quantities import LARGEST_SERIES
from stickslip.scenarios.values import show

LARGEST = 5_000_000
"""Size (bytes) of the largest data file that is read: scenarios are untrusted."""
ANYWHERE = "STICKSLIP_FILES_ANYWHERE"
"""Environment variable whose value 1 allows data files outside the folder of the scenario."""


def read_points(
    name: str, folder: Path | None, columns: Mapping[str, str], where: str, along: str | None = None
) -> dict[str, list[float]]:
    """Return the numbers (SI) in the CSV file `name` of the scenario's folder, by the field to which they belong.

    `columns` maps headings to fields. The last is that of the dependent variable; exactly one other column must be there, or be
    named by `along`, and holds the ascending slips, slip rates or times at which the values are given. Blank lines, lines that
    begin with #, notes before the headings and unknown columns are ignored; headings may carry units (`foundation.columns`).
    Raises InputError with a message of one line that names the file and the line.
    """
    *others, value = columns
    if along is not None:
        if along not in others:
            at = where.removesuffix(" file")
            raise InputError(f"{at} along: {show(along)} is no column to go along; {nearest(str(along), others)}")
        columns = {column: columns[column] for column in (along, value)}
    try:
        text = _text(name, folder)
    except InputError as error:
        raise InputError(f"{where} {show(name)}: {error}") from None
    return _points_in(text, columns, f"{where}: {show(name)}")


def _points_in(text: str, columns: Mapping[str, str], file: str) -> dict[str, list[float]]:
    """Return the numbers (SI) in CSV text by the field to which they belong, as `read_points` does.

    `file` is the name of the text in messages.
    """
    *others, value = columns
    number, header = header_of(text, file, tuple(columns))
    table = read_text(text, tuple(columns), file, LARGEST_SERIES)
    place, found = f"{file}, line {number}", [column for column in others if column in table.columns]
    if value not in table.columns:
        raise InputError(f"{place}: no column '{value}' in the header; {missing(header, value)}")
    if len(found) != 1:
        got = f'both; choose one with along = "{found[0]}"' if found else f"none; {missing(header, others[0])}"
        raise InputError(f"{place}: the header needs a column {' or '.join(others)}, got {got}")
    count = len(table.columns[value])
    if count < 2:
        raise InputError(f"{table.at(-1)}: at least two rows of numbers are needed, got {count}")
    table.check_ascending(found[0])
    return {columns[column]: numbers.tolist() for column, numbers in table.columns.items()}


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
