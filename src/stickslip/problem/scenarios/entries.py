"""Read each kind of field of a body, a friction law or a loading history from a scenario, describe it, and write it back."""

from __future__ import annotations

import math
import os
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, NamedTuple

from stickslip.foundation.arguments import shown
from stickslip.foundation.atomic_write import read_bounded
from stickslip.foundation.errors import InputError, nearest
from stickslip.foundation.given import Given, column_given
from stickslip.foundation.headings import COLUMNS, find, missing
from stickslip.foundation.named_columns import NamedColumns
from stickslip.foundation.quantities import (
    LARGEST_SERIES,
    Choice,
    Field,
    LawField,
    Named,
    NamedNumbers,
    NumberSeries,
    Quantity,
    Text,
    fields_of,
)
from stickslip.foundation.record_files.foreign import text_in
from stickslip.foundation.text_columns import read_text


class Source(NamedTuple):
    """The origin of a document: its name in messages and, for a document in a file, the folder of its data files.

    `most_nodes` is the largest number of nodes of a [contact] that whoever reads the document can use; a contact with more of them
    is refused before it is made. `load_unit` is the unit of the body's loads once that is known: laws and loading then have its
    units.
    """

    file: str
    folder: Path | None = None
    most_nodes: float = math.inf
    load_unit: str = ""


def key_of(name: str, entry: Field) -> str:
    """Return the key of a field in a scenario."""
    return entry.key if isinstance(entry, NamedNumbers) else name


class DocumentPlace(NamedTuple):
    """The place of a value in a document: a table, which may be inside another as "friction.slip", and a key in it."""

    source: Source
    table: str
    key: str

    @property
    def inner(self) -> str:
        """The name of the table that the key would have."""
        return f"{self.table}.{self.key}"

    def __str__(self) -> str:
        return f"[{self.table}] {self.key}"


def typed_number(text: str) -> float | str:
    """Return a text as a number if it is one, otherwise the text without leading and trailing spaces."""
    try:
        return float(text)
    except ValueError:
        return text.strip()


def read_typed(text: str, declared: Quantity, where: str, name: str) -> float:
    """Return in SI what a user typed, a number or a text with a unit. Raises InputError as `Quantity.check` does."""
    return declared.check(where, name, typed_number(text))


def read_entry(value: Any, entry: Field, place: DocumentPlace, law: Callable[[dict[str, Any], Source, str], Any]) -> Any:
    """Return a value of a scenario in the form that its field takes, with numbers in SI.

    Texts, choices, and the length and order of a series are checked by the law that has the field. `law` is the function that reads
    a law inside a law. Raises InputError with the place in the document.
    """
    file = place.source.file
    if isinstance(entry, Quantity):
        return entry.check(file, str(place), value)
    if isinstance(entry, NumberSeries):
        if not isinstance(value, list):
            unit = entry.item.label
            raise InputError(f"{file}: {place} must be a list of numbers in {unit} or of texts with units, got {shown(value)}")
        return tuple(entry.item.check(file, f"{place}[{i}]", one) for i, one in enumerate(value))
    if isinstance(entry, NamedNumbers):
        return _named(value, place)
    if isinstance(entry, LawField):
        if not isinstance(value, dict):
            raise InputError(f"{file}: [{place.inner}] must be a table, got {shown(value)}")
        return law(value, place.source, place.inner)
    return value


def _named(value: Any, place: DocumentPlace) -> tuple[Named, ...]:
    file, table = place.source.file, f"[{place.inner}]"
    if not isinstance(value, dict):
        raise InputError(f"{file}: {table} must be a table of names and values, got {shown(value)}")
    for name, one in value.items():
        if isinstance(one, bool) or not isinstance(one, int | float | str):
            raise InputError(f"{file}: {table} {shown(name)} must be a number or a text with a unit, got {shown(one)}")
        if isinstance(one, int) and abs(one) > 10**300:
            raise InputError(f"{file}: {table} {shown(name)} must be a number, got a whole number beyond 1e300")
    return tuple(Named.read(name, one, f"{file}: [{place.table}]") for name, one in value.items())


def describe(entry: Field) -> str:
    """Return the meaning, the unit and the range of a field as text for users."""
    if isinstance(entry, Quantity):
        return entry.described
    if isinstance(entry, NumberSeries):
        return f"{entry.item.described}, a list" + (", ascending" if entry.ascending else "")
    if isinstance(entry, Choice):
        return f"{entry.meaning}: {' or '.join(entry.allowed)}"
    if isinstance(entry, Text):
        return entry.meaning
    return f"{entry.meaning}, a table"


def to_table(owner: Any) -> dict[str, Any]:
    """Return a body, a law or a loading history as a table of a scenario, with numbers that read back to the last digit.

    An object of a user's class is written, too, but not read: its kind is unknown. A class that inherits the kind of another one is
    written by its own name, so that the file is not read back as the other.
    """
    own = type(owner)
    table: dict[str, Any] = {"kind": owner.kind if "kind" in vars(own) else own.__name__}
    for name, (entry, _) in fields_of(type(owner)).items():
        value = getattr(owner, name)
        if value not in (None, (), ""):
            table[key_of(name, entry)] = _written(value, entry)
    return table


def _written(value: Any, entry: Field) -> Any:
    if isinstance(entry, NamedNumbers):
        return {one.name: f"{one.value!r} {one.unit}" if one.unit else one.value for one in value}
    if isinstance(value, tuple):
        return [as_written(one) for one in value]
    return to_table(value) if isinstance(entry, LawField) else as_written(value)


def as_written(value: Any) -> Any:
    """Return a value as it stands in a scenario: in SI, or as a text in the unit in which results are to be shown."""
    return value.text if isinstance(value, Given) else value


LARGEST_DATA_FILE = 5_000_000
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
) -> dict[str, list[float]]:
    """Return the numbers (SI) in the CSV file `name` of the scenario's folder, by field.

    `columns` maps headings to fields. The last belongs to the dependent variable; exactly one other column must be there, or be
    named by `along`, and holds the ascending slips, slip rates or times at which the values are given. Blank lines, lines that
    begin with #, notes before the headings and unknown columns are ignored; headings may carry units (`foundation.headings`), and
    `named` says what headings mean.
    Raises InputError with a message of one line that names the file and the line.
    """
    *others, value = columns
    if along is not None:
        if along not in others:
            at = where.removesuffix(" file")
            raise InputError(f"{at} along: {shown(along)} is no column to go along; {nearest(str(along), others)}")
        columns = {column: columns[column] for column in (along, value)}
    try:
        given = NamedColumns(named or {}, shows=False)
        text = _text(name, folder)
    except InputError as error:
        raise InputError(f"{where} {shown(name)}: {error}") from None
    return _points_in(text, columns, f"{where}: {shown(name)}", given)


def _points_in(text: str, columns: Mapping[str, str], file: str, named: NamedColumns) -> dict[str, list[float]]:
    """Return the numbers (SI) in CSV text by field, as `read_points` does.

    `file` is the name of the text in messages.
    """
    *others, value = columns
    table = read_text(text, tuple(columns), file, LARGEST_SERIES, named=named)
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
    unit = find(table.header, (value,), file)[value].unit
    if unit is not None:
        points[columns[value]] = column_given(points[columns[value]], unit, COLUMNS[value].unit)
    return points


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
        return text_in(read_bounded(path, LARGEST_DATA_FILE))
    except OSError as error:
        raise InputError(f"cannot be read: {error.strerror}") from None
    except UnicodeDecodeError:
        raise InputError("not a text file in UTF-8") from None
