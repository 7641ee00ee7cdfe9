"""Columns of numbers by their headings: from a table in memory, and what those from a text are."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction
from typing import Any

import numpy as np
from numpy.typing import NDArray

from stickslip.foundation.arrays import Floats
from stickslip.foundation.conversion import has_unit as is_quantity
from stickslip.foundation.errors import InputError, warn
from stickslip.foundation.headings import KNOWN_COLUMNS, FoundColumn, find, is_signed
from stickslip.foundation.marks import marked, sentences
from stickslip.foundation.named_columns import NamedColumns
from stickslip.foundation.unit_doubts import doubts_of


@dataclass(frozen=True)
class Table:
    """Columns of numbers in SI by their plain heading, and the lines (or rows) of their origin."""

    columns: dict[str, Floats]
    place: str
    lines: NDArray[np.intp] = field(repr=False)
    counted: str = "line"
    """What `lines` counts: the lines of a file, or the rows of a table in memory."""
    header: Sequence[str] = ()
    """All headings, as they are written, with a unit in brackets if it stood in a row below them."""
    at_header: str = ""
    """The place of the headings for a message."""
    notes: tuple[str, ...] = ()
    """Sentences on what was passed over."""
    doubts: tuple[str, ...] = ()
    """Sentences on columns without a unit."""
    interval: float | None = None
    """Time between samples (s), where the header of a file states it."""

    def at(self, i: int) -> str:
        """Return the place of row i for a message."""
        return f"{self.place}, {self.counted} {self.lines[i]}"

    def warned(self) -> Table:
        """Issue the doubts as warnings, once it is clear that the table is of use, and return it."""
        for doubt in self.doubts:
            warn(doubt)
        return self

    def check_ascending(self, column: str) -> None:
        """Raise InputError, with the cure, unless the numbers of a column ascend."""
        numbers = self.columns[column]
        wrong = np.flatnonzero(np.diff(numbers) <= 0.0)
        if len(wrong):
            before, here = numbers[wrong[0] : wrong[0] + 2]
            cure = "sort the rows" if here < before else "keep one row of each, or their mean"
            raise InputError(f"{self.at(int(wrong[0]) + 1)}: {column} must ascend, but {here:g} follows {before:g}; {cure}")


def read_mapping(table: Any, wanted: Sequence[str], place: str, *, raw: bool = False, named: NamedColumns | None = None) -> Table:
    """Return those of the wanted columns that a DataFrame, or another mapping of headings to numbers, has, as numbers in SI.

    If `raw`, NaN and negative numbers pass, and marks of missing numbers become NaN. `named` are headings that the user has named.
    Raises InputError.
    """
    headings, notes = list(table), list[str]()
    header = [str(heading) for heading in headings]
    header = header if named is None else named.renamed(header, wanted, place)
    chosen = find(header, wanted, place)
    columns: dict[str, Floats] = {}
    without: dict[str, FoundColumn] = {}
    for name, one in chosen.items():
        given, factor = table[headings[one.place]], one.factor
        try:
            if is_quantity(given):  # a unit of its own outweighs one in the heading
                given, factor = given.to(KNOWN_COLUMNS[name].unit).magnitude, Fraction(1)
            else:
                without[name] = one
            kind = np.asarray(given).dtype.kind
            numbers = np.asarray(given if kind != "c" else np.real(given), dtype=float)
        except (TypeError, ValueError):
            raise InputError(f"{place}: {name} must be a column of numbers") from None
        _check_kind(kind, name, place)
        if numbers.ndim != 1:
            raise InputError(f"{place}: {name} must be a column of numbers, got an array of {numbers.ndim} dimensions")
        if raw and numbers.ndim == 1 and (marks := marked(numbers)).any():
            notes += sentences(numbers, marks, name)
            numbers = np.where(marks, np.nan, numbers)
        columns[name] = scaled(numbers, factor)
    sizes = {name: len(numbers) for name, numbers in columns.items()}
    if len(set(sizes.values())) > 1:
        raise InputError(f"{place}: columns of different lengths: {', '.join(f'{n} has {size}' for n, size in sizes.items())}")
    made = Table(columns, place, np.arange(max(sizes.values(), default=0)), "row", header, place, tuple(notes))
    for name, numbers in ({} if raw else columns).items():
        for i in np.flatnonzero(~np.isfinite(numbers) | ((numbers < 0.0) & (not is_signed(name))))[:1].tolist():
            check_number(float(numbers[i]), name, made.at(i))
    return replace(made, doubts=doubts_of(without, columns, place, of_file=False))


def _check_kind(kind: str, name: str, place: str) -> None:
    """Raise InputError for dates and spans of time, which count nanoseconds, and for truth values and complex numbers."""
    if kind in "mM":
        raise InputError(
            f"{place}: {name} holds dates: write seconds, as (table.time - table.time[0]).dt.total_seconds() gives them"
        )
    if kind in "bc":
        raise InputError(f"{place}: {name} must be a column of numbers, got {'truth values' if kind == 'b' else 'complex numbers'}")


def scaled(numbers: Floats, factor: Fraction) -> Floats:
    """Return numbers times a factor, to the last digit where the factor allows it: 0.05 mm gives 0.05 / 1000."""
    if max(factor.numerator, factor.denominator) < 2**53:
        return np.asarray(numbers * float(factor.numerator) / float(factor.denominator))
    return np.asarray(numbers * float(factor))


def check_number(value: float, column: str, place: str) -> float:
    """Return a number of a column. Raises InputError if it is not finite, or is below 0 and must not be."""
    if not math.isfinite(value):
        raise InputError(f"{place}: {column} must be finite, got '{value}'; leave out such rows")
    if value < 0.0 and not is_signed(column):
        cure = "; subtract the first time from all of them" if column == "time" else ""
        raise InputError(f"{place}: {column} must not be negative, got {value:g}{cure}")
    return value
