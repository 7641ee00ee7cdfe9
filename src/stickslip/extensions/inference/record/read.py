"""Read a laboratory record from files and tables: columns on one clock or two, sorted by time, and notes on what was done."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from stickslip.extensions.inference.record.doubts import checked
from stickslip.extensions.inference.record.events_table import events_in
from stickslip.extensions.inference.record.record import LOADING, MEASURED, SHEAR, Record
from stickslip.extensions.inference.record.repeats import without_repeats
from stickslip.foundation.arguments import as_path, shown
from stickslip.foundation.arrays import Floats
from stickslip.foundation.columns import Table, read_mapping
from stickslip.foundation.errors import InputError, warn
from stickslip.foundation.headings import TURNED, find, missing, names_of, quoted
from stickslip.foundation.named_columns import NamedColumns
from stickslip.foundation.quantities import Quantity
from stickslip.foundation.text_columns import read_file
from stickslip.problem.scenarios import typed_number

LARGEST_FILE = 500_000_000
"""Largest file to read (bytes)."""
MOST_SAMPLES = 5_000_000
"""Largest number of samples of a record."""
NORMAL = ("normal_stress", "normal_force", "normal_torque", "weight_on_bit")
"""Columns of the normal load: they make friction of shear, and may say how the contact is pressed."""
BY_ANGLE = {TURNED[name]: name for name in ("slip", "slip_rate", *LOADING)}
"""Columns of angles and their rates, with what they are of a contact that turns."""
SERVING_COLUMNS = (*NORMAL, *reversed(BY_ANGLE), "radius")
"""Columns that serve to compute others."""
WANTED = ("time", *LOADING, *MEASURED, *SERVING_COLUMNS, *(f"{name}_deviation" for name in MEASURED))
"""All known columns."""
DRILL_FLOOR: Mapping[str, str] = {
    **dict.fromkeys(("hkld", "hkla", "hkl", "hook load", "hookload"), "hook load"),
    **dict.fromkeys(("dbtm", "dept", "depth", "bit depth", "bd", "bit position"), "depth of the bit"),
    **dict.fromkeys(("dmea", "hole depth", "td", "md", "measured depth"), "depth of the hole"),
    **dict.fromkeys(("rop", "ropa", "rop avg", "rate of penetration"), "rate of penetration"),
    **dict.fromkeys(("sppa", "spp", "standpipe pressure", "pump pressure"), "pressure of the mud"),
    **dict.fromkeys(("bpos", "block position"), "height of the travelling block"),
    **dict.fromkeys(("mfia", "mfi", "mfo", "flwi", "flow in", "mud flow in", "mud flow out"), "flow of the mud"),
    **dict.fromkeys(("dwob", "dhwob", "downhole wob"), "weight on the bit, measured there"),
}
"""Further columns of the log of a drill floor, by their mnemonics in WITS and in logs while drilling, and what they are."""
LATER = Quantity("s", "time by which the second clock begins later")
HEADINGS_NAMED = 6
"""A message names at most this many headings."""


class _Columns(NamedTuple):
    """Columns (SI) by name, on one clock and sorted by time; place, ignored headings, and doubts about units."""

    columns: dict[str, Floats]
    place: str
    at_header: str
    header: tuple[str, ...]
    passed: tuple[str, ...]
    notes: list[str]
    doubts: tuple[str, ...] = ()


def read_record(source: Any, beside: Any = None, later: float = 0.0, columns: Any = None) -> Record:
    """Read a record, or a table of events, as `Record.read` describes, the whole of it. Raises InputError."""
    if beside is not None:
        return _samples_in(source, beside, later, columns)
    try:
        found = _samples_in(source, beside, later, columns)
        return found if found.shear is not None else events_in(source, columns) or found
    except InputError:
        if (events := events_in(source, columns)) is not None:
            return events
        raise


def _samples_in(source: Any, beside: Any, later: float, columns: Any) -> Record:
    """Return the samples of a record. Raises InputError."""
    source, beside, later = _two_in(source) if beside is None else (source, beside, later)
    named = NamedColumns(columns or {}, optional=beside is not None)
    read = _ordered(source, named)
    if beside is not None:
        read = _joined(read, _ordered(beside, named), later)
        named.check_used(read.place)
    found, notes = read.columns, read.notes
    _take_ratio(found, "shear_stress", "normal_stress")
    _take_ratio(found, "shear_force", "normal_force")
    _take_ratio(found, "torque", "normal_torque")
    slips_in = _motion_in(found, notes, read.place)
    notes += _passed_over(read)
    measured = {name: found[name] for name in MEASURED if name in found}
    if not measured:
        raise InputError(f"{read.at_header}: nothing measured; {missing(read.header, 'friction')}{_there(read.passed)}")
    deviations = {name: found[f"{name}_deviation"] for name in measured if f"{name}_deviation" in found}
    for name, values in deviations.items():
        if not (np.isfinite(values) & (values > 0.0)).all():
            raise InputError(f"{read.place}: {name}_deviation must be above 0 in each row")
    for doubt in read.doubts:
        warn(doubt)
    driven = {name: found.get(name) for name in LOADING}
    normal = next((name for name in NORMAL if name in found), "")
    return checked(
        Record(
            found["time"],
            measured,
            deviations,
            **driven,
            name=read.place,
            notes=tuple(notes),
            normal=found.get(normal),
            normal_name=normal,
            slips_in=slips_in,
        )
    )


def _two_in(source: Any) -> tuple[Any, Any, float]:
    """Return the two files that a text like "shear.csv+load.csv@2.5" names, and how much later (s) the second clock begins."""
    if not isinstance(source, str) or "+" not in source or Path(source).exists():
        return source, None, 0.0
    first, _, second = source.partition("+")
    file, at, seconds = second.rpartition("@")
    return first, file if at else second, LATER.check("record", "@", typed_number(seconds)) if at else 0.0


def _ordered(source: Any, named: NamedColumns) -> _Columns:
    """Return the columns of a source in order of time. Raises InputError."""
    table = _table_in(source, named)
    used = {one.place for one in find(table.header, WANTED, table.place).values()}
    passed = tuple(heading for i, heading in enumerate(table.header) if i not in used and heading.strip())
    at_header = table.at_header or table.place
    if "time" not in table.columns:
        motion = not {"slip", "slip_rate"}.isdisjoint(table.columns)
        cure = "points of friction without time are for `stickslip fit`" if motion else missing(table.header, "time")
        raise InputError(f"{at_header}: no column 'time'; {cure}{_there(passed)}")
    notes = list(table.notes)
    columns = without_repeats(_in_order(dict(table.columns), table.place, notes), notes)
    return _Columns(columns, table.place, at_header, tuple(table.header), passed, notes, table.doubts)


def _table_in(source: Any, named: NamedColumns) -> Table:
    """Return the known columns of a source. Raises InputError."""
    if isinstance(source, Mapping) or hasattr(source, "columns"):
        return read_mapping(source, WANTED, "record", raw=True, named=named)
    if not isinstance(source, str | os.PathLike):
        raise InputError(f"infer: record must be a CSV file, a DataFrame, or a mapping of headings to numbers, got {shown(source)}")
    return read_file(as_path("infer: record", source), WANTED, (LARGEST_FILE, MOST_SAMPLES), raw=True, named=named)


def _there(passed: tuple[str, ...]) -> str:
    """Return the end of a message: the headings that were not understood."""
    return f"; not understood: {_listed(passed)}" if passed else ""


def _listed(unknown: tuple[str, ...]) -> str:
    more = f" and {len(unknown) - HEADINGS_NAMED} more" if len(unknown) > HEADINGS_NAMED else ""
    return ", ".join(quoted(one) for one in unknown[:HEADINGS_NAMED]) + more


def _passed_over(read: _Columns) -> Iterator[str]:
    """Yield sentences on unused columns: headings that were not understood, and measured quantities other than shear."""
    columns = read.columns
    known = {heading: DRILL_FLOOR[name] for heading in read.passed if (name := names_of([heading])[0]) in DRILL_FLOOR}
    strange = tuple(heading for heading in read.passed if heading not in known)
    if known:
        yield f"columns that no fit needs: {', '.join(f'{quoted(heading)} ({what})' for heading, what in known.items())}"
    if strange:
        cure = "the displacement of the machine is called load_point, and its rate load_rate"
        cure = "" if set(LOADING) & set(columns) else f"; {cure}"
        yield f"columns that were not understood: {_listed(strange)}{cure}"
    shear, *others = [name for name in MEASURED if name in columns] or [""]
    others = [name for name in others if name not in SHEAR[:4] and shear in SHEAR]
    if others:
        yield f"{shear} is what is fitted, unless observe names {' or '.join(others)}, which the record has too"


def _joined(first: _Columns, second: _Columns, later: float) -> _Columns:
    """Return the columns of two sources on the clock of the first, at the times of the source with shear, or else of the first.

    Raises InputError if both have a column, or if the two clocks have no time in common.
    """
    twice = sorted((set(first.columns) & set(second.columns)) - {"time"})
    if twice:
        raise InputError(f"{first.place}+{second.place}: both have {', '.join(twice)}: remove one")
    second.columns["time"] = second.columns["time"] + later
    has_more = sum(name in second.columns for name in MEASURED) > sum(name in first.columns for name in MEASURED)
    main, other = (second, first) if has_more else (first, second)
    time, clock = main.columns["time"], other.columns["time"]
    inside = (time >= clock[0]) & (time <= clock[-1])
    place = f"{first.place}+{second.place}"
    if inside.sum() < 2:
        spans = " and ".join(f"{one.columns['time'][0]:g} to {one.columns['time'][-1]:g} s" for one in (first, second))
        cure = "give how much later the zero of the second one is: FIRST+SECOND@SECONDS, or later=SECONDS in Python"
        raise InputError(f"{place}: the two clocks have no time in common, {spans}: {cure}")
    columns = {name: values[inside] for name, values in main.columns.items()}
    for name, values in other.columns.items():
        known = np.isfinite(values)
        if name != "time" and known.any():
            columns[name] = np.interp(time[inside], clock[known], values[known])
    named = ", ".join(name for name in other.columns if name != "time")
    told = f"{named} of {other.place} {'are' if ',' in named else 'is'} taken at the times of {main.place}"
    notes = [*first.notes, *second.notes, told + (f", {inside.sum()} of {len(time)} samples" if not inside.all() else "")]
    doubts = first.doubts + second.doubts
    return _Columns(columns, place, place, first.header + second.header, first.passed + second.passed, notes, doubts)


def _take_ratio(found: dict[str, Floats], shear: str, normal: str) -> None:
    """Replace shear and normal stress (or force) by friction, unless friction itself is there."""
    if shear in found and normal in found and "friction" not in found:
        with np.errstate(divide="ignore", invalid="ignore"):
            ratio = found.pop(shear) / found[normal]
            if f"{shear}_deviation" in found:
                found["friction_deviation"] = found.pop(f"{shear}_deviation") / np.abs(found[normal])
        found["friction"] = np.where(np.isfinite(ratio), ratio, np.nan)


def _motion_in(found: dict[str, Floats], notes: list[str], place: str) -> str:
    """Return the unit of slip in a record, and give columns of angles the names of what they are of a contact that turns.

    A rotation of the machine with the radius of the contact makes the load point, or its rate, unless that is there. Raises
    InputError if slip is an angle and anything else a length.
    """
    lengths = [name for name in BY_ANGLE.values() if name in found]
    turned = next((name for name in ("rotation", "rotation_rate") if name in found), "")
    made = BY_ANGLE.get(turned, "")
    if turned and "radius" in found and not set(LOADING) & set(found):
        found[made] = found.pop(turned) * float(np.nanmedian(found["radius"]))
        notes.append(f"{made} is {turned} times the radius")
        lengths.append(made)
    elif turned and lengths and not set(LOADING) & set(found):
        notes.append(f"{turned} is passed over: a column radius (mm), the mean radius of the contact, makes it the load point")
    angles = [name for name in BY_ANGLE if name in found and not (lengths and name in ("rotation", "rotation_rate"))]
    angles += [name for name in ("drive_rate",) if name in found]
    if lengths and angles:
        other = BY_ANGLE.get(angles[0], angles[0])
        raise InputError(f"{place}: {lengths[0]} is a length, and {other} an angle: a contact slides, or it turns")
    found |= {BY_ANGLE.get(name, name): found[name] for name in angles}
    return "rad" if angles else "m" if lengths else ""


def _in_order(found: dict[str, Floats], place: str, notes: list[str]) -> dict[str, Floats]:
    """Return columns sorted by time, with one row for each time. Raises InputError for fewer than two rows with a time."""
    known = np.isfinite(found["time"])
    if not known.all():
        lost = int((~known).sum())
        notes.append(f"{lost} rows without a time are left out" if lost > 1 else "1 row without a time is left out")
        found = {name: values[known] for name, values in found.items()}
    time = found["time"]
    if len(time) < 2:
        raise InputError(f"{place}: at least two rows with a time are needed, got {len(time)}")
    for name, values in found.items():
        lost = int((~np.isfinite(values)).sum())
        if lost and name != "time":
            notes.append(f"{name} has no number in {lost} of {len(values)} rows: left out")
            found[name] = np.where(np.isfinite(values), values, np.nan)
    if (np.diff(time) < 0.0).any():
        notes.append("the rows were not in the order of time: they were sorted")
        order = np.argsort(time, kind="stable")
        found = {name: values[order] for name, values in found.items()}
        time = found["time"]
    if (np.diff(time) == 0.0).any():
        first = np.flatnonzero(np.append(True, np.diff(time) > 0.0))
        again = len(time) - len(first)
        notes.append(f"{again} rows repeat a time: means were taken" if again > 1 else "1 row repeats a time: the mean was taken")
        if len(first) < 2:
            raise InputError(f"{place}: all rows have one time, {time[0]:g} s")
        found = {name: _means(values, first) for name, values in found.items()}
    return found


def _means(values: Floats, first: NDArray[np.intp]) -> Floats:
    """Return means over groups of rows, given the first row of each; missing numbers do not count."""
    known = np.isfinite(values)
    count = np.add.reduceat(known.astype(float), first)
    with np.errstate(invalid="ignore"):
        return np.asarray(np.add.reduceat(np.where(known, values, 0.0), first) / count)
