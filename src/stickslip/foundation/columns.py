"""Read named columns of numbers, with units in their headings, from delimited text and from tables in memory.

No message repeats a text that a file holds, because scenarios from somebody else may name files: messages name lines and columns.
"""

from __future__ import annotations

import csv
import math
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from itertools import chain, zip_longest
from typing import Any

import numpy as np
from numpy.typing import NDArray

from stickslip.foundation.arrays import Floats
from stickslip.foundation.conversion import has_unit
from stickslip.foundation.errors import InputError, nearest, warn
from stickslip.foundation.units import si_factor, split_quantity


@dataclass(frozen=True)
class Column:
    """A column that may be looked for: the SI unit of its numbers, other headings for it, and whether they may be negative."""

    unit: str
    others: tuple[str, ...] = ()
    signed: bool = False


COLUMNS: Mapping[str, Column] = {
    "slip": Column("m", ("u", "displacement", "slip distance", "cumulative slip"), signed=True),
    "slip_rate": Column("m/s", ("v", "rate", "velocity", "slip velocity", "sliding velocity", "speed", "sliding speed")),
    "friction": Column("1", ("mu", "μ", "friction coefficient", "coefficient of friction", "cof")),
    "shear_stress": Column("Pa", ("tau", "τ", "shear", "traction"), signed=True),
    "normal_stress": Column("Pa", ("sigma", "σ", "sigma n", "normal")),
    "time": Column("s", ("t",)),
    "load_point": Column(
        "m",
        (
            "load point displacement",
            "load displacement",
            "loading displacement",
            "driver displacement",
            "piston displacement",
            "lp",
        ),
        signed=True,
    ),
    "load_rate": Column("m/s", ("load point rate", "load point velocity", "loading rate", "loading velocity", "vlp"), signed=True),
    "shear_force": Column("N", ("force", "shear load", "friction force"), signed=True),
    "normal_force": Column("N", ("normal load",)),
    "friction_deviation": Column("1", ("standard deviation", "friction error", "mu error", "sd friction", "sd mu")),
    "shear_stress_deviation": Column("Pa", ("shear stress error", "traction deviation", "tau error", "sd tau")),
    "shear_force_deviation": Column("N", ("shear force error", "force error", "sd force")),
    "slip_deviation": Column("m", ("slip error", "sd slip")),
    "slip_rate_deviation": Column("m/s", ("slip rate error", "sd slip rate")),
    "pull_rate": Column("m/s", signed=True),
    "far_stress": Column("Pa", signed=True),
}
"""The columns that are known, by their plain heading. Capitals, spaces, - and _ make no difference."""
LARGEST: Mapping[str, float] = {"slip": 100.0, "slip_rate": 100.0, "load_point": 100.0, "load_rate": 100.0}
"""Largest values (SI) that no friction test reaches: beyond them the numbers are hardly in SI."""
LONGEST_LINE = 50_000
"""Largest number of characters of a line."""
PREAMBLE = 200
"""Number of lines before the header in which notes of an instrument are looked for."""
NO_NUMBER = ("", "nan", "-", "–", "na", "n/a", "null", "none")
"""What instruments and people write where a number is missing."""
PURE = ("", "-", "–", "1", "none", "no unit", "dimensionless")
"""What people write in place of a unit for a pure number."""
DECIMAL_COMMA = (
    "decimal commas are not read, write points: `tr , . < OLD.csv > NEW.csv` replaces them, "
    "or in Python pass pandas.read_csv(FILE, sep=';', decimal=',')"
)
"""The cure for decimal commas in a file whose columns are not separated by commas."""
_COMMA = re.compile(r"[+-]?\d+,\d+([eE][+-]?\d+)?")
_HEADING = re.compile(r"\s*(?P<name>[^()\[\]]*?)\s*(?:[(\[]\s*(?P<unit>[^()\[\]]*?)\s*[)\]])?\s*")
_SIGNS = str.maketrans({"μ": "µ", "·": " ", "⁻": "-", "⁰": "0", "¹": "1", "²": "2", "³": "3", "−": "-"})
_POWER = re.compile(r"(?<=[A-Za-zµ])(-?\d)")


@dataclass(frozen=True)
class Table:
    """Columns of numbers in SI by their plain heading, and the lines (or rows) from which they come."""

    columns: dict[str, Floats]
    place: str
    lines: NDArray[np.intp] = field(repr=False)
    counted: str = "line"
    """What `lines` counts: the lines of a file, or the rows of a table in memory."""
    header: Sequence[str] = ()
    """All headings, as they are written."""
    at_header: str = ""
    """The place of the headings for a message."""

    def at(self, i: int) -> str:
        """Return the place of row i for a message."""
        return f"{self.place}, {self.counted} {self.lines[i]}"

    def check_ascending(self, column: str) -> None:
        """Raise InputError, with the cure, unless the numbers of a column ascend."""
        numbers = self.columns[column]
        wrong = np.flatnonzero(np.diff(numbers) <= 0.0)
        if len(wrong):
            before, here = numbers[wrong[0] : wrong[0] + 2]
            cure = "sort the rows" if here < before else "keep one row of each, or their mean"
            raise InputError(f"{self.at(int(wrong[0]) + 1)}: {column} must ascend, but {here:g} follows {before:g}; {cure}")


def read_text(text: str, wanted: Sequence[str], place: str, most: int, *, raw: bool = False) -> Table:
    """Return those of the wanted columns that a text has, as numbers in SI.

    The first line that is neither blank nor a comment (#) is the header. If it names none of the columns and exactly one of the
    lines that follow names two of them, that line is the header, and those before it are notes. Units stand in the headings, or in
    a row of their own below them. Columns are separated by tabs, semicolons or commas, whichever of them the header has, in this
    order. Raises InputError with a message of one line that names `place` and the line; also for more than `most` rows. If `raw`,
    cells without a number become NaN, and no sign is refused.
    """
    lines, separator = _rows(text, place, wanted)
    number, header = next(lines, (1, [""]))
    at_header = f"{place}, line {number}"
    chosen = find(header, wanted, at_header)
    below = next(lines, None)
    if below is not None and _are_units(below[1], header, chosen):
        header = [
            name if _has_unit(name) else f"{name} ({_bare(unit)})" for name, unit in zip_longest(header, below[1], fillvalue="")
        ]
        chosen = find(header, wanted, at_header)
    elif below is not None:
        lines = chain([below], lines)
    if not chosen:  # the caller says what is missing
        return Table({}, place, np.array([number]), "line", header, at_header)
    found: dict[str, list[float]] = {name: [] for name in chosen}
    numbers: list[int] = []
    for number, row in lines:
        at = f"{place}, line {number}"
        if len(numbers) == most:
            raise InputError(f"{at}: more than {most} rows")
        if any(cell.strip() for cell in row[len(header) :]):
            hint = "" if separator != "," else "; decimal commas? Then separate columns by semicolons and write decimal points"
            raise InputError(f"{at}: {len(row)} cells, but the header has {len(header)}{hint}")
        for name, (i, _) in chosen.items():
            cell = row[i].strip() if i < len(row) else ""
            if raw and cell.casefold() in NO_NUMBER:
                found[name].append(math.nan)
                continue
            found[name].append(float(cell) if raw and _is_number(cell) else _number(cell, name, at, first=not numbers))
        numbers.append(number)
    columns = {name: _scaled(np.array(found[name], float), factor) for name, (_, factor) in chosen.items()}
    note_units(header, {name: i for name, (i, _) in chosen.items()}, columns, at_header)
    return Table(columns, place, np.array(numbers or [number]), "line", header, at_header)


def read_mapping(table: Any, wanted: Sequence[str], place: str, *, raw: bool = False) -> Table:
    """Return those of the wanted columns that a DataFrame, or another mapping of headings to numbers, has, as numbers in SI.

    If `raw`, NaN and negative numbers pass. Raises InputError.
    """
    headings = list(table)
    header = [str(heading) for heading in headings]
    chosen = find(header, wanted, place)
    columns: dict[str, Floats] = {}
    plain: dict[str, int] = {}
    for name, (i, factor) in chosen.items():
        given = table[headings[i]]
        try:
            plain |= {} if has_unit(given) else {name: i}
            if has_unit(given):  # a unit of its own outweighs one in the heading
                given, factor = given.to(COLUMNS[name].unit).magnitude, Fraction(1)
            kind = np.asarray(given).dtype.kind
            numbers = np.asarray(given if kind != "c" else np.real(given), dtype=float)
        except (TypeError, ValueError):
            raise InputError(f"{place}: {name} must be a column of numbers") from None
        _check_kind(kind, name, place)
        if numbers.ndim != 1:
            raise InputError(f"{place}: {name} must be a column of numbers, got an array of {numbers.ndim} dimensions")
        columns[name] = _scaled(numbers, factor)
    sizes = {name: len(numbers) for name, numbers in columns.items()}
    if len(set(sizes.values())) > 1:
        raise InputError(f"{place}: columns of different lengths: {', '.join(f'{n} has {size}' for n, size in sizes.items())}")
    made = Table(columns, place, np.arange(max(sizes.values(), default=0)), "row", header, place)
    for name, numbers in ({} if raw else columns).items():
        for i in np.flatnonzero(~np.isfinite(numbers) | ((numbers < 0.0) & (not _signed(name))))[:1].tolist():
            _check(float(numbers[i]), name, made.at(i))
    note_units(header, plain, columns, place)
    return made


def _check_kind(kind: str, name: str, place: str) -> None:
    """Raise InputError for dates and spans of time, which count nanoseconds, and for truth values and complex numbers."""
    if kind in "mM":
        raise InputError(
            f"{place}: {name} holds dates: write seconds, as (table.time - table.time[0]).dt.total_seconds() gives them"
        )
    if kind in "bc":
        raise InputError(f"{place}: {name} must be a column of numbers, got {'truth values' if kind == 'b' else 'complex numbers'}")


def note_units(header: Sequence[str], chosen: Mapping[str, int], columns: Mapping[str, Floats], place: str) -> None:
    """Issue an `InputWarning` for a column without a unit that is hardly in SI.

    That is so if another heading has a unit other than SI, or if its numbers are larger than any slip or slip rate. `chosen` has
    the places of the columns in the header. The ratio of two stresses needs no unit if both have none.
    """
    units = {name: part["unit"] if (part := _HEADING.fullmatch(header[i])) else None for name, i in chosen.items()}
    if units.get("shear_stress", "") is units.get("normal_stress", "") is None:
        del units["shear_stress"], units["normal_stress"]
    sized = {name: unit for name, unit in units.items() if COLUMNS.get(name, Column("1")).unit != "1"}
    foreign = any(unit is not None and _plain(unit) != _plain(COLUMNS[name].unit) for name, unit in sized.items())
    for name in (name for name, unit in sized.items() if unit is None):
        if foreign or np.max(np.abs(columns[name]), initial=0.0) > LARGEST.get(name, math.inf):
            si = COLUMNS[name].unit
            cure = f"write its unit into the heading, as in {name} ({_OFTEN.get(si, si)})"
            warn(f"{place}: column {chosen[name] + 1}, {name}, has no unit and is read in {si}; if it is in another, {cure}")


_OFTEN = {"m": "mm", "m/s": "mm/s", "s": "ms", "Pa": "MPa", "N": "kN"}
"""Units that laboratories use in place of those of SI."""


def find(header: Sequence[str], wanted: Sequence[str], place: str) -> dict[str, tuple[int, Fraction]]:
    """Return index and factor to SI of each wanted column that a header has. Raises InputError for two of one kind."""
    parts, names = [_HEADING.fullmatch(cell) for cell in header], _names(header)
    found = {}
    for column in wanted:
        at = [i for i, name in enumerate(names) if name in _headings(column)]
        exact = [i for i in at if names[i] == _plain(column)]
        at = exact if len(exact) == 1 else at
        if len(at) > 1:
            raise InputError(f"{place}: columns {at[0] + 1} and {at[1] + 1} both are the {column}: rename or remove one")
        if at:
            part = parts[at[0]]
            found[column] = at[0], _factor(part["unit"] if part else None, column, f"{place}, column {at[0] + 1}")
    return found


def _names(header: Sequence[str]) -> list[str]:
    """Return headings without their units, in the form in which they are compared."""
    return [_plain(part["name"] if (part := _HEADING.fullmatch(cell)) else cell) for cell in header]


def missing(header: Sequence[str], column: str) -> str:
    """Return a hint for a header that lacks a column: the heading that could be meant, or how a header is written."""
    if not any(cell.strip() for cell in header):
        return "there are no headings: is it empty?"
    if len(header) == 1 and len(header[0].split()) > 1:
        return "columns are separated by commas, semicolons or tabs"
    if column == "friction" and not _headings("shear_stress").isdisjoint(_names(header)):
        return "friction is shear stress over normal stress, both in one unit"
    if any(_plain(cell).startswith(("log", "ln")) for cell in header):
        return f"logarithms are not read: write the numbers themselves, as in a column {_example(column)}"
    if any(map(_is_number, header)):
        return f"the first line must name the columns, as {_example(column)}"
    hint = nearest(column, [cell for cell in header if cell.strip()])
    close = hint[14:-2]
    for i, name in enumerate(_names(header)):  # "lambda V", "theta v"
        if name.rpartition(" ")[2] in _headings(column):
            return f"column {i + 1} is not the {column} itself, by its heading; if it is, write {_example(column)} there"
    return f"rename {ascii(close)[:60]}?" if hint.startswith("did") and close != column else f"write it as {_example(column)}"


def _example(column: str) -> str:
    unit = COLUMNS.get(column, Column("1")).unit
    return column if unit == "1" else f"{column} ({unit})"


def _rows(text: str, place: str, wanted: Sequence[str]) -> tuple[Iterator[tuple[int, list[str]]], str]:
    """Return the rows of a text from its header on, with their line numbers, and the separator of columns.

    Rows that are blank or comments are left out.
    """
    lines = text.lstrip("\ufeff").splitlines()
    long = next((n for n, line in enumerate(lines, 1) if len(line) > LONGEST_LINE), None)
    if long is not None:
        raise InputError(f"{place}, line {long}: longer than {LONGEST_LINE} characters: not a table of points")
    first = _header_line(lines, wanted)
    separator = _separator(lines[first]) if lines else ","
    lines[:first] = [""] * first

    def rows() -> Iterator[tuple[int, list[str]]]:
        read = csv.reader(lines, delimiter=separator)
        try:
            for row in read:
                if any(cell.strip() for cell in row) and not row[0].lstrip().startswith("#"):
                    yield read.line_num, row
        except csv.Error as error:
            raise InputError(f"{place}, line {read.line_num}: {error}") from None

    return rows(), separator


def _are_units(row: Sequence[str], header: Sequence[str], chosen: Mapping[str, tuple[int, Fraction]]) -> bool:
    """Return True if a row below the headings holds the units of the chosen columns, and contradicts none of the headings."""
    cells = {name: _bare(row[i]) if i < len(row) else "" for name, (i, _) in chosen.items()}
    try:
        for name, cell in cells.items():
            _factor(cell, name, "")
    except InputError:
        return False
    agrees = all(not _has_unit(header[i]) or cells[name] in header[i] for name, (i, _) in chosen.items())
    return agrees and any(cell.casefold() not in PURE for cell in cells.values())


def _has_unit(heading: str) -> bool:
    return "(" in heading or "[" in heading


def _bare(unit: str) -> str:
    return unit.strip(" ()[]")


def _header_line(lines: Sequence[str], wanted: Sequence[str]) -> int:
    """Return the index of the header among the lines of a text; see `read_text`."""
    known = set().union(*map(_headings, wanted))
    rows = [i for i, line in enumerate(lines[:PREAMBLE]) if line.strip() and not line.lstrip().startswith("#")]
    named = {i: _named(lines[i], known) for i in rows}
    headers = [i for i in rows if named[i] > 1]
    first = rows[0] if rows else 0
    return headers[0] if rows and named[first] == 0 and len(headers) == 1 else first


def _named(line: str, known: set[str]) -> int:
    parts = (_HEADING.fullmatch(cell.strip().strip('"')) for cell in line.split(_separator(line)))
    return sum(_plain(part["name"]) in known for part in parts if part)


def _separator(header: str) -> str:
    return next((mark for mark in "\t;" if mark in header), ",")


def _plain(heading: str) -> str:
    return " ".join(heading.casefold().replace("µ", "μ").replace("_", " ").replace("-", " ").split())


def _headings(column: str) -> set[str]:
    return {_plain(column), *map(_plain, COLUMNS[column].others if column in COLUMNS else ())}


def _factor(unit: str | None, column: str, place: str) -> Fraction:
    """Return the factor from the unit in a heading to SI. Raises InputError, which does not repeat the unit."""
    known = COLUMNS.get(column, Column("1"))
    if unit is None or (known.unit == "1" and unit.strip().casefold() in PURE):
        return Fraction(1)
    if known.unit == "1":
        raise InputError(f"{place}: {column} is a pure number: no unit in its heading (a percentage is not converted)")
    text = _POWER.sub(r"^\1", unit.translate(_SIGNS).replace("^", "").replace("**", ""))
    try:
        if split_quantity(f"1 {text}") is None:
            raise InputError("")
        return si_factor(text, known.unit)
    except InputError:
        raise InputError(f"{place}: the unit in the heading does not convert to {known.unit}; write it like {known.unit}") from None


def _scaled(numbers: Floats, factor: Fraction) -> Floats:
    """Return numbers times a factor, to the last digit where the factor allows it: 0.05 mm gives 0.05 / 1000."""
    if max(factor.numerator, factor.denominator) < 2**53:
        return np.asarray(numbers * float(factor.numerator) / float(factor.denominator))
    return np.asarray(numbers * float(factor))


def _number(text: str, column: str, place: str, first: bool) -> float:
    try:
        value = float(text)
    except ValueError:
        if _COMMA.fullmatch(text):
            raise InputError(f"{place}: {column} has a decimal comma; {DECIMAL_COMMA}") from None
        hint = f"; a unit belongs in the heading, as in {_example(column)}" if first and text else ""
        hint = "; times of day are not read, write seconds from the start" if column == "time" and ":" in text else hint
        raise InputError(f"{place}: {column} must be a number, got {'text' if text else 'nothing'}{hint}") from None
    return _check(value, column, place)


def _check(value: float, column: str, place: str) -> float:
    if not math.isfinite(value):
        raise InputError(f"{place}: {column} must be finite, got '{value}'; leave out such rows")
    if value < 0.0 and not _signed(column):
        raise InputError(f"{place}: {column} must not be negative, got {value:g}")
    return value


def _signed(column: str) -> bool:
    return COLUMNS.get(column, Column("1")).signed


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True
