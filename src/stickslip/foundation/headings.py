"""Understand the headings of columns: the quantity and the unit of each, and suggestions for a missing heading."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from typing import NamedTuple

from stickslip.foundation.errors import InputError, meant
from stickslip.foundation.units import plain_signs, si_factor, split_quantity, tabulated


@dataclass(frozen=True)
class HeadingColumn:
    """A column that may be looked for: the SI unit of its numbers, other headings for it, and whether they may be negative."""

    unit: str
    others: tuple[str, ...] = ()
    signed: bool = False


def _driven(*what: str) -> tuple[str, ...]:
    """Return headings for the motion of the driven end of a machine."""
    ends = ("load point", "lp", "load", "loading", "driver", "driving", "ram", "piston", "actuator", "crosshead", "pull")
    return tuple(f"{end} {one}" for end in ends for one in what)


KNOWN_COLUMNS: Mapping[str, HeadingColumn] = {
    "slip": HeadingColumn(
        "m",
        ("u", "displacement", "slip distance", "cumulative slip", "slip displacement", "fault slip", "h slip"),
        signed=True,
    ),
    "slip_rate": HeadingColumn(
        "m/s",
        ("v", "rate", "velocity", "slip velocity", "sliding velocity", "speed", "sliding speed", "axis velocity", "h slip rate"),
        signed=True,
    ),
    "friction": HeadingColumn(
        "1",
        (
            *("mu", "μ", "friction coefficient", "coefficient of friction", "cof", "co f", "friction coeff", "coeff of friction"),
            *("traction coefficient", "traction coeff", "coefficient of traction", "friction factor"),
            *("mu app", "μ app", "app friction", "apparent friction", "apparent friction coefficient"),
        ),
        signed=True,
    ),
    "slide_roll_ratio": HeadingColumn("1", ("srr", "slide to roll ratio", "slip ratio"), signed=True),
    "rolling_speed": HeadingColumn("m/s", ("mean speed", "entrainment speed", "entraining speed", "mean rolling speed")),
    "shear_stress": HeadingColumn("Pa", ("tau", "τ", "shear", "traction", "shr stress", "h shear stress"), signed=True),
    "normal_stress": HeadingColumn(
        "Pa",
        (
            *("sigma", "σ", "sigma n", "σ n", "σn", "sig n", "normal", "nor stress", "norm stress"),
            *("effective normal stress", "eff normal stress", "effns"),
        ),
    ),
    "time": HeadingColumn(
        "s", ("t", "elapsed time", "time elapsed", "test time", "timestamp", "timestamps", "time stamp", "time stamps")
    ),
    "load_point": HeadingColumn("m", ("lp", "lpd", *_driven("displacement", "disp", "position")), signed=True),
    "load_rate": HeadingColumn("m/s", ("vlp", "v lp", *_driven("rate", "velocity", "speed")), signed=True),
    "rotation_rate": HeadingColumn(
        "rad/s",
        (
            *("rpm", "rotation", "rotation speed", "rotational speed", "angular velocity"),
            *("drive speed", "drive rpm", "top drive speed", "top drive rpm", *_driven("rate", "velocity", "speed")),
            *("srpm", "surface rpm", "surface speed", "rotary speed", "rotary rpm", "average rotary speed", "td rpm", "td speed"),
            *("rpma", "rpm avg", "average rpm", "rpm set point", "rpm setpoint", "set point rpm"),
        ),
        signed=True,
    ),
    "rotation": HeadingColumn("rad", ("angle", "rotation angle", "revolutions", *_driven("position")), signed=True),
    "slip_angle": HeadingColumn("rad", ("slip", "u", "bit angle"), signed=True),
    "slip_rotation": HeadingColumn(
        "rad/s",
        (
            *("slip rate", "v", "rate", "speed", "bit speed", "bit rpm", "bit rotation"),
            *("crpm", "collar rpm", "downhole rpm", "dh rpm", "drpm"),
        ),
        signed=True,
    ),
    "drive_rate": HeadingColumn("rad/s", ("measured drive speed", "measured drive rpm", "actual rpm"), signed=True),
    "torque": HeadingColumn(
        "N m",
        (
            *("friction torque", "torque on bit", "traction", "tau", "τ", "far stress"),
            *("bit torque", "tob", "downhole torque", "dtor", "dh torque"),
        ),
        signed=True,
    ),
    "surface_torque": HeadingColumn(
        "N m",
        (
            *("stor", "tq", "tqa", "torqa", "stq", "tdtq", "surface torque avg", "average surface torque", "torque at surface"),
            *("top drive torque", "td torque", "drive torque", "rotary torque", "quill torque"),
        ),
        signed=True,
    ),
    "normal_torque": HeadingColumn("N m"),
    "weight_on_bit": HeadingColumn("N", ("wob", "swob", "woba", "surface wob", "surface weight on bit", "average weight on bit")),
    "torque_deviation": HeadingColumn("N m", ("torque error", "sd torque")),
    "surface_torque_deviation": HeadingColumn("N m", ("surface torque error", "sd surface torque")),
    "drive_rate_deviation": HeadingColumn("rad/s", ("drive rate error", "sd drive rate")),
    "radius": HeadingColumn("m", ("mean radius", "equivalent radius")),
    "shear_force": HeadingColumn("N", ("force", "shear load", "friction force", "traction"), signed=True),
    "force": HeadingColumn("N", ("shear force", "shear load", "friction force", "traction"), signed=True),
    "normal_force": HeadingColumn("N", ("normal load",)),
    "friction_deviation": HeadingColumn("1", ("standard deviation", "friction error", "mu error", "sd friction", "sd mu")),
    "shear_stress_deviation": HeadingColumn("Pa", ("shear stress error", "traction deviation", "tau error", "sd tau")),
    "shear_force_deviation": HeadingColumn("N", ("shear force error", "force error", "sd force")),
    "slip_deviation": HeadingColumn("m", ("slip error", "sd slip")),
    "slip_rate_deviation": HeadingColumn("m/s", ("slip rate error", "sd slip rate")),
    "pull_rate": HeadingColumn("m/s", signed=True),
    "far_stress": HeadingColumn("Pa", signed=True),
    "driver_reflection": HeadingColumn("1", signed=True),
    "ground_velocity": HeadingColumn("m/s", signed=True),
    "ground_acceleration": HeadingColumn("m/s^2", ("acceleration", "acc"), signed=True),
}
"""The columns that are known, by their plain heading. Capitals, spaces, dots, - and _ make no difference, nor does CamelCase."""
TURNED: Mapping[str, str] = {
    **{"slip": "slip_angle", "slip_rate": "slip_rotation", "load_point": "rotation", "load_rate": "rotation_rate"},
    **{"pull_rate": "rotation_rate", "far_stress": "torque"},
}
"""Columns of a contact that slides, with those that take their place where it turns; both have the same headings."""
OF_SCEC = {"t": "s", "slip": "m", "slip-rate": "m/s", "shear-stress": "MPa"}
"""Units of columns that have none in their headings where the headings are those of the SCEC benchmarks."""
MOST_COLUMNS = 1000
"""Largest number of columns of a table."""
LONGEST_HEADING = 120
"""A heading that is understood has at most this many characters."""
PURE = ("", ".", "-", "–", "1", "none", "no unit", "dimensionless", "unitless")
"""What people write in place of a unit for a pure number."""
ONE_WORD = 5
"""A heading of several words with at least this many letters is also understood in one: "loadpoint", but not "sign" for "sig n"."""
_HEADING = re.compile(r"(?P<name>[^()\[\]]*)(?:[(\[](?P<unit>[^()\[\]]*)[)\]])?\s*")
_BETWEEN = re.compile(r"\s*[\s_,:/]\s*")
_CAMEL = re.compile(r"(?<=[a-zα-ω])(?=[A-Z])|(?<=[A-Z])(?=[A-Z][a-z])")
_NO_LETTER = re.compile(r"[\W_]+")
_POWER = re.compile(r"(?<=[A-Za-zµ])(-?\d)")


class FoundColumn(NamedTuple):
    """Where a column stands in a header, the factor of its unit to SI, and the unit as it is written, or None."""

    place: int
    factor: Fraction
    unit: str | None


def find(header: Sequence[str], wanted: Sequence[str], place: str) -> dict[str, FoundColumn]:
    """Return what a header has of the wanted columns. Raises InputError for two of one kind, and for a unit that does not fit."""
    if len(header) > MOST_COLUMNS:
        raise InputError(f"{place}: more than {MOST_COLUMNS} columns: not a table of numbers")
    cells = [_understood(cell, tuple(wanted)) for cell in header]
    if is_of_scec(header):
        units = [OF_SCEC.get(cell.strip().removeprefix("h-")) for cell in header]
        cells = [one and (*one[:2], unit or one[2]) for one, unit in zip(cells, units, strict=True)]
    found = {}
    for column in wanted:
        at = [i for i, one in enumerate(cells) if one is not None and one[0] == column]
        exact = [i for i in at if plain(cells[i][1]) == plain(column)]  # type: ignore[index] # at has none that are None
        at = exact if len(exact) == 1 else at
        if len(at) > 1:
            cure = "rename or remove one"
            cure = "of two clocks, write each with its columns to a file of its own" if column == "time" else cure
            raise InputError(f"{place}: columns {at[0] + 1} and {at[1] + 1} both are the {column}: {cure}")
        if at:
            unit = cells[at[0]][2]  # type: ignore[index]
            found[column] = FoundColumn(at[0], factor_of(unit, column, f"{place}, column {at[0] + 1}"), unit)
    return {column: found[column] for column in wanted if column in found}


def is_of_scec(header: Sequence[str]) -> bool:
    """Return True if a header has time, slip rate and stress as the SCEC benchmarks spell them, whose stress is in MPa."""
    names = {cell.strip().removeprefix("h-") for cell in header}
    return {"t", "slip-rate", "shear-stress"} <= names


def count_named(cells: Sequence[str], wanted: Sequence[str]) -> int:
    """Return how many cells name a wanted column."""
    return sum(_understood(cell, tuple(wanted)) is not None for cell in cells)


@lru_cache(maxsize=4096)
def _understood(heading: str, wanted: tuple[str, ...]) -> tuple[str, str, str | None] | None:
    """Return the column that a heading names, its name and its unit as they are written; None if it names none.

    A unit stands in brackets, or behind the name as in `slip_rate_m_per_s` and "tau MPa".
    """
    known = _by_heading(wanted)
    name, unit = split_heading(heading)
    fitting = known.get(plain(name), ())
    if fitting:
        unit = "rpm" if unit is None and "rpm" in plain(name) else unit
        best = next((one for one in fitting if len(fitting) > 1 and unit is not None and _fits(unit, one)), fitting[0])
        return best, name, unit
    if unit is None:
        for before, behind in _cuts(name):
            for column in known.get(plain(before), ()):
                if _is_unit_of(behind, column):
                    return column, before, behind
    return None


def _cuts(name: str) -> Iterator[tuple[str, str]]:
    """Yield what may be a name and the unit behind it, the shortest unit first."""
    for cut in reversed(list(_BETWEEN.finditer(name))):
        yield name[: cut.start()], name[cut.end() :].replace("_per_", "/").replace("_", " ")


def _is_unit_of(unit: str, column: str) -> bool:
    return _unit_of(column) != "1" and tabulated(_unit_text(unit)) is not None and _fits(unit, column)


def _unit_of(column: str) -> str:
    return KNOWN_COLUMNS.get(column, HeadingColumn("1")).unit


def understood(heading: str, wanted: Sequence[str]) -> str | None:
    """Return the column that a heading names among the wanted ones, or None."""
    found = _understood(heading, tuple(wanted))
    return found and found[0]


def trailing_unit(heading: str, column: str) -> str | None:
    """Return the unit that stands without brackets behind a name, as in Vert_disp_um, if it is one of the column's; else None."""
    return next((unit for _, unit in _cuts(split_heading(heading)[0]) if _is_unit_of(unit, column)), None)


def heading_of(name: str, unit: str | None) -> str:
    """Return a name with its unit in brackets, if it has one."""
    return name if unit is None else f"{name} ({unit})"


@lru_cache(maxsize=64)
def _by_heading(wanted: tuple[str, ...]) -> dict[str, tuple[str, ...]]:
    """Return the columns that each plain heading may name, in the order of `wanted`."""
    found: dict[str, tuple[str, ...]] = {}
    for column in wanted:
        for heading in headings(column):
            found[heading] = (*found.get(heading, ()), column)
    return found


def headings(column: str) -> set[str]:
    """Return the plain headings of a column."""
    names = [plain(column), *map(plain, KNOWN_COLUMNS[column].others if column in KNOWN_COLUMNS else ())]
    words = [name.replace(" ", "") for name in names]
    return {*names, *(word for word in words if len(word) >= ONE_WORD)}


@lru_cache(maxsize=4096)
def plain(heading: str) -> str:
    """Return the words of a heading in small letters, with single blanks between them."""
    return _NO_LETTER.sub(" ", _CAMEL.sub(" ", unicodedata.normalize("NFKC", heading[:LONGEST_HEADING])).casefold()).strip()


def names_of(header: Sequence[str]) -> list[str]:
    """Return plain headings without their units in brackets."""
    return [plain(split_heading(cell)[0]) for cell in header]


def split_heading(heading: str) -> tuple[str, str | None]:
    """Return the name in a heading and the unit in brackets, or None; no name if it is too long for a heading."""
    if len(heading) > LONGEST_HEADING:
        return "", None
    part = _HEADING.fullmatch(heading)
    return (part["name"].strip(), part["unit"] and part["unit"].strip()) if part else (heading, None)


def has_unit(heading: str) -> bool:
    """Return True if a heading has a unit in brackets."""
    return "(" in heading or "[" in heading


def quoted(heading: str) -> str:
    """Return a heading of a file for a message, with its Greek letters as they are; what cannot be printed is escaped."""
    return repr(heading.strip())[:60]


def _fits(unit: str, column: str) -> bool:
    try:
        factor_of(unit, column, "")
    except InputError:
        return False
    return True


def _unit_text(unit: str) -> str:
    return _POWER.sub(r"^\1", plain_signs(unit).replace("·", " ").replace("^", "").replace("**", ""))


def factor_of(unit: str | None, column: str, place: str) -> Fraction:
    """Return the factor from the unit in a heading to SI. Raises InputError, which does not repeat the unit."""
    known = KNOWN_COLUMNS.get(column, HeadingColumn("1"))
    if unit is None or (known.unit == "1" and unit.strip().casefold() in PURE):
        return Fraction(1)
    if column == "slide_roll_ratio" and unit.strip() == "%":
        return Fraction(1, 100)
    if known.unit == "1":
        force = "; a force is shear_force and needs --normal-force" if column == "friction" else ""
        raise InputError(f"{place}: {column} is a pure number: no unit in its heading (a percentage is not converted){force}")
    text = _unit_text(unit)
    try:
        if split_quantity(f"1 {text}") is None:
            raise InputError("")
        return si_factor(text, known.unit)
    except InputError:
        raise InputError(f"{place}: the unit in the heading does not convert to {known.unit}; write it like {known.unit}") from None


def is_signed(column: str) -> bool:
    """Return True if the numbers of a column may be negative."""
    return KNOWN_COLUMNS.get(column, HeadingColumn("1")).signed


def example(column: str) -> str:
    """Return a heading for a column, with its unit in SI."""
    unit = _unit_of(column)
    return column if unit == "1" else f"{column} ({unit})"


def missing(header: Sequence[str], column: str) -> str:
    """Return a hint for a header that lacks a column: the heading that could be meant, or how a header is written."""
    if not any(cell.strip() for cell in header):
        return "there are no headings: is it empty?"
    if len(header) == 1 and len(header[0].split()) > 1:
        return "columns are separated by commas, semicolons, tabs or blanks"
    if column == "friction" and not headings("shear_stress").isdisjoint(names_of(header)):
        return "friction is shear stress over normal stress, both in one unit"
    if any(plain(cell).startswith(("log", "ln")) for cell in header):
        return f"logarithms are not read: write the numbers themselves, as in a column {example(column)}"
    if any(map(is_number, header)):
        return f"the first line must name the columns, as {example(column)}"
    if column == "ground_acceleration" and not headings("slip_rate").isdisjoint(names_of(header)):
        return "a velocity is not differentiated: give the acceleration itself"
    close = next(iter(meant(column, [cell for cell in header if cell.strip()])), column)
    for i, name in enumerate(names_of(header)):  # "lambda V", "theta v"
        if name.rpartition(" ")[2] in headings(column):
            return f"column {i + 1} is not the {column} itself, by its heading; if it is, write {example(column)} there"
    return f"rename {quoted(close)}?" if close != column else f"write it as {example(column)}"


def is_number(text: str) -> bool:
    """Return True for a text that is a number, as Python reads it."""
    try:
        float(text)
    except ValueError:
        return False
    return True
