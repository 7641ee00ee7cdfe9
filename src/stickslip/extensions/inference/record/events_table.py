"""Read a table of slip events, one row for each: laboratories publish such tables and not the records."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import Any

import numpy as np

from stickslip.extensions.inference.record.features import LEVELS_OF_SHEAR
from stickslip.extensions.inference.record.record import Record
from stickslip.foundation.arguments import as_path
from stickslip.foundation.arrays import Floats
from stickslip.foundation.columns import Table, read_mapping
from stickslip.foundation.errors import InputError, nearest, warn
from stickslip.foundation.headings import names_of, quoted
from stickslip.foundation.named_columns import NamedColumns
from stickslip.foundation.text_columns import read_file

LARGEST_TABLE, MOST_EVENTS = 20_000_000, 100_000
"""Largest size of a table of events (bytes), and its largest number of rows."""
_SHEARS = {
    "friction": ("friction", "mu", "μ", "friction coefficient", "coefficient of friction", "cof"),
    "shear_stress": ("shear stress", "stress", "tau", "τ"),
    "shear_force": ("shear force", "force", "friction force", "load"),
    "torque": ("torque", "friction torque"),
}
_LEVELS = {
    "peak": ("peak", "static", "max", "maximum", "before"),
    "rest": ("rest", "min", "minimum", "residual", "after"),
    "drop": ("drop", "fall", "decrease"),
}
_OTHERS: Mapping[str, tuple[str, tuple[str, ...]]] = {
    "time": ("time", ("t", "event time", "time of event", "onset", "onset time")),
    "recurrence": (
        "time",
        ("recurrence time", "recurrence interval", "interval", "inter event time", "interevent time", "period", "waiting time"),
    ),
    "event_slip": ("slip", ("slip", "slip per event", "slip in the event", "slip distance", "coseismic slip")),
    "peak_rate": ("slip_rate", ("peak slip rate", "max slip rate", "peak slip velocity", "max slip velocity", "peak velocity")),
}
EVENT_COLUMNS = {name: of for name, (of, _) in _OTHERS.items()} | {
    f"{shear}_{level}": shear for shear in _SHEARS for level in LEVELS_OF_SHEAR
}
"""The columns of a table of events, with the column of a record that is in the same unit."""


def _headings() -> dict[str, str]:
    """Return the columns by their plain headings, in either order of words: "peak friction" and "friction peak"."""
    found = {names_of([one])[0]: name for name, (_, others) in _OTHERS.items() for one in (name, *others)}
    for shear, names in _SHEARS.items():
        for level, words in _LEVELS.items():
            both = [(word, name) for word in words for name in names]
            orders = [" ".join(order) for one in both for order in (one, one[::-1])]
            found |= dict.fromkeys(names_of(orders), f"{shear}_{level}")
    return found


EVENT_HEADINGS = _headings()
"""The columns by their plain headings."""


def events_in(source: Any, columns: Any = None) -> Record | None:
    """Return the events in a table as a record at their times; None for what is no table of events. Raises InputError.

    `columns` maps columns to headings, as `Record.read` does. Missing cells are NaN.
    """
    given = NamedColumns(columns or {}).given
    try:
        empty = _read(source, (), None)
    except (InputError, TypeError):
        return None
    header = empty.header
    known = [EVENT_HEADINGS.get(name) for name in names_of(header)]
    places = {name: heading for name, heading in zip(known, header, strict=True) if name is not None}
    places |= {name: heading for name, heading in given.items() if name in EVENT_COLUMNS}
    shears = list(dict.fromkeys(EVENT_COLUMNS[name] for name in places if EVENT_COLUMNS[name] in _SHEARS))
    if not shears:
        levels = {word for words in _LEVELS.values() for word in words}
        bare = [heading for heading, name in zip(header, names_of(header), strict=True) if name in levels]
        if "recurrence" in places and bare:
            asked = f"{quoted(bare[0])} of what? A table of slip events has columns such as {names_of(bare)[0]} force (N)"
            raise InputError(f"{empty.at_header or empty.place}: {asked}, and is fitted with --by features")
        return None
    for name in given:
        if name not in EVENT_COLUMNS:
            raise InputError(f"columns: {name!a:.40} is no column of a table of events; {nearest(name, EVENT_COLUMNS)}")
    passed = [heading for heading in header if heading.strip() and heading not in places.values() and not given]
    found, notes, table = dict[str, Floats](), list[str](), None
    for name, heading in places.items():
        table = _read(source, (EVENT_COLUMNS[name],), NamedColumns({EVENT_COLUMNS[name]: heading}))
        for doubt in table.doubts:
            warn(doubt.replace(f", {EVENT_COLUMNS[name]},", f", {name},"))
        found[name] = table.columns[EVENT_COLUMNS[name]]
        notes += [note.replace(f"{EVENT_COLUMNS[name]} (", f"{name} (") for note in table.notes if note not in notes]
    assert table is not None
    notes += [f"columns that were not understood: {', '.join(map(quoted, passed))}"] if passed else []
    at = table.at_header or table.place
    if len(shears) > 1:
        raise InputError(f"{at}: events with {' and '.join(shears)}: they are one measurement, leave one of them out")
    if not {"time", "recurrence"} & set(found):
        raise InputError(
            f"{at}: a table of events needs a column recurrence (time from event to event) or time, beside {', '.join(found)}"
        )
    return _record(found, shears[0], table.place, tuple(notes))


def _read(source: Any, wanted: tuple[str, ...], named: NamedColumns | None) -> Table:
    if isinstance(source, Mapping) or hasattr(source, "columns"):
        return read_mapping(source, wanted, "table", raw=True, named=named)
    if not isinstance(source, str | os.PathLike):
        raise TypeError
    return read_file(as_path("infer: record", source), wanted, (LARGEST_TABLE, MOST_EVENTS), raw=True, named=named)


def _record(found: dict[str, Floats], shear: str, place: str, notes: tuple[str, ...]) -> Record:
    """Return events as a record, in the order of time. Raises InputError."""
    time = found.pop("time", None)
    if time is not None:
        order = np.argsort(time, kind="stable")
        order = order[np.isfinite(time[order])]
        time, found = time[order], {name: values[order] for name, values in found.items()}
        found.setdefault("recurrence", np.append(np.nan, np.diff(time)))
    else:
        steps = found["recurrence"]
        time = np.cumsum(np.where(np.isfinite(steps), steps, np.nanmedian(steps) if np.isfinite(steps).any() else np.nan))
    for name, values in found.items():
        wrong = np.flatnonzero(values <= 0.0)
        if len(wrong) and not name.endswith("_rest"):
            raise InputError(f"{place}: {name} must be above 0, got {values[wrong[0]]:g} in event {wrong[0] + 1}")
        if np.isfinite(values).sum() < 2:
            raise InputError(f"{place}: {name} has a number in fewer than two events: leave the column out")
    peak, rest, drop = (f"{shear}_{level}" for level in LEVELS_OF_SHEAR)
    if peak in found and rest in found:
        if not np.nanmean(found[peak]) > np.nanmean(found[rest]):
            raise InputError(f"{place}: {rest} is not below {peak}: are the two columns named the wrong way round?")
        found.setdefault(drop, found[peak] - found[rest])
    elif drop in found and peak in found:
        found[rest] = found[peak] - found[drop]
    elif drop in found and rest in found:
        found[peak] = found[rest] + found[drop]
    names = [name for name in (peak, rest, drop, "recurrence", "event_slip", "peak_rate") if name in found]
    return Record(time, {name: found[name] for name in names}, name=place, notes=notes)
