"""Read each kind of field of a body, a friction law or a loading history from a scenario, describe it, and write it back."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

from stickslip.foundation.arguments import shown
from stickslip.foundation.errors import InputError
from stickslip.foundation.given import Given
from stickslip.foundation.quantities import (
    Choice,
    Count,
    Field,
    LawField,
    Named,
    NamedNumbers,
    NumberSeries,
    Quantity,
    Text,
    fields_of,
)


class Source(NamedTuple):
    """The origin of a document: its name in messages and, for a document in a file, the folder of its data files.

    `most_nodes` is the largest number of nodes that whoever reads the document can use: a table of an extension with more is
    refused before anything is made of it. `load_unit` is the unit of the body's loads once it is known: laws and loading then have
    its units.
    """

    file: str
    folder: Path | None = None
    most_nodes: float = math.inf
    load_unit: str = ""


def key_of(name: str, entry: Field) -> str:
    """Return the key of a field in a scenario."""
    return (entry.key if isinstance(entry, NamedNumbers | Count) else "") or name


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
    if isinstance(entry, Quantity | Count):
        return entry.check(file, str(place), value)
    if isinstance(entry, NumberSeries):
        if isinstance(value, str):
            from stickslip.foundation.packed import unpacked  # few scenarios have so many numbers

            try:
                value = unpacked(value, entry.item.unit, entry.most)
            except InputError as error:
                raise InputError(f"{file}: {place} must be a list of numbers in {entry.item.label}, got {error}") from None
        if not isinstance(value, list):
            unit = entry.item.label
            raise InputError(f"{file}: {place} must be a list of numbers in {unit} or of texts with units, got {shown(value)}")
        found = entry.at_once(value)
        return found if found is not None else tuple(entry.item.check(file, f"{place}[{i}]", one) for i, one in enumerate(value))
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
    if isinstance(entry, Text | Count):
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
        if not isinstance(entry, NumberSeries) or entry.lists(value):
            return [as_written(one) for one in value]
        from stickslip.foundation.packed import packed

        return packed(value)
    return to_table(value) if isinstance(entry, LawField) else as_written(value)


def as_written(value: Any) -> Any:
    """Return a value as it stands in a scenario: in SI, or as a text in the unit in which results are to be shown."""
    return value.text if isinstance(value, Given) else value
