"""The record of an accelerometer in a file, as the fields of `Accelerogram`: in any format of text that is known, or as a table."""

from __future__ import annotations

import hashlib
import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from stickslip.foundation.arguments import shown
from stickslip.foundation.atomic_write import read_bounded
from stickslip.foundation.columns import Table
from stickslip.foundation.errors import InputError
from stickslip.foundation.given import column_given
from stickslip.foundation.headings import KNOWN_COLUMNS, find, missing
from stickslip.foundation.named_columns import NamedColumns
from stickslip.foundation.quantities import MOST_SAMPLES
from stickslip.foundation.record_files import text_in
from stickslip.foundation.show import brief
from stickslip.foundation.text_columns import read_text
from stickslip.problem.accelerogram import LONGEST_ORIGIN, Accelerogram
from stickslip.problem.even_times import interval_of
from stickslip.problem.scenarios.points_of_files import LARGEST_DATA_FILE, content_of

VALUE = "ground_acceleration"
BASELINES = ("mean",)
"""What may be taken off the samples of a record: their mean, as the offset of an instrument."""
BESIDE_FILE = ("file", "columns", "baseline", "checksum")
"""The keys of a table that tell how a record is read from a file."""
_CHECKSUM = re.compile(r"(?:sha256:)?([0-9a-f]{12,64})", re.IGNORECASE)
PLAIN = "a plain text has a heading such as `time (s),acceleration (g)` above two columns of numbers"


def fields_beside_file(raw: Mapping[str, Any], folder: Path | None, where: str) -> dict[str, Any]:
    """Return the fields of a record that a table of a scenario names, with `file` and what goes with it. Raises InputError."""
    name = raw["file"]
    try:
        content = content_of(name, folder)
    except InputError as error:
        raise InputError(f"{where} {shown(name)}: {error}") from None
    _check_sum(raw.get("checksum"), content, f"{where} {shown(name)}")
    found = fields_in(content, name, f"{where}: {shown(name)}", raw.get("columns"), raw.get("baseline"), shows=False)
    if both := next((key for key in found if key in raw), None):
        raise InputError(f"{where} and {both} exclude each other")
    return {"kind": Accelerogram.kind} | {key: value for key, value in raw.items() if key not in BESIDE_FILE} | found


def fields_of_file(path: Path, columns: Mapping[str, Any], baseline: str | None) -> dict[str, Any]:
    """Return the fields of a record in a file, wherever it is. Raises InputError."""
    name = str(path) if str(path).isprintable() else ascii(str(path))
    try:
        content = read_bounded(path, LARGEST_DATA_FILE)
    except FileNotFoundError:
        raise InputError(f"{name}: no such file") from None
    except OSError as error:
        raise InputError(f"{name}: cannot be read: {error.strerror}") from None
    except InputError as error:
        raise InputError(f"{name}: {error}") from None
    return fields_in(content, path.name, name, columns, baseline)


def fields_in(
    content: bytes, name: str, where: str, columns: Any = None, baseline: str | None = None, *, shows: bool = True
) -> dict[str, Any]:
    """Return the fields of a record in the content of a file called `name`. Raises InputError that begins with `where`.

    `columns` says which headings are `time` and `ground_acceleration`. With the baseline "mean" their mean is taken off the
    samples. Unless `shows`, no message repeats a heading of the file.
    """
    if baseline is not None and baseline not in BASELINES:
        raise InputError(f'{where}: baseline must be "{BASELINES[0]}", or left out, got {shown(baseline)}')
    try:
        text = text_in(content)
    except UnicodeDecodeError:
        raise InputError(f"{where}: not a text file in UTF-8; {PLAIN}") from None
    except InputError as error:
        raise InputError(f"{where}: {error}") from None
    named = NamedColumns(columns or {}, shows=shows)
    table = read_text(text, ("time", VALUE), where, MOST_SAMPLES, named=named)
    if VALUE not in table.columns:
        raise InputError(f"{table.at_header}: no column '{VALUE}'; {missing(table.header, VALUE)}; {PLAIN}")
    interval, begins = _interval(table)
    values = table.warned().columns[VALUE].tolist()
    if (unit := find(table.header, (VALUE,), where)[VALUE].unit) is not None:
        values = column_given(values, unit, KNOWN_COLUMNS[VALUE].unit)
    fields = {"values": values, "interval": interval}
    if baseline is not None:
        fields["offset"] = float(table.columns[VALUE].mean())
    return fields | {"origin": _origin(name, content, table, Accelerogram(**fields), begins)}


def _interval(table: Table) -> tuple[float, float]:
    """Return the interval (s) of a table, which the file states or its times have, and the first time. Raises InputError."""
    if table.interval is not None:
        return table.interval, 0.0
    if "time" not in table.columns:
        raise InputError(f"{table.at_header}: no column 'time', and no interval in the heading; {PLAIN}")
    try:
        return interval_of(table.columns["time"]), float(table.columns["time"][0])
    except InputError as error:
        raise InputError(f"{table.place}: {error}") from None


def _origin(name: str, content: bytes, table: Table, record: Accelerogram, begins: float) -> str:
    """Return what a record says of its file: name, checksum, and what was found in it."""
    notes = list(table.notes) or [record.about]
    if begins != 0.0:
        notes.append(f"its first time, {brief(begins, 's')}, is 0 s of the run")
    found = f"{Path(name).name}, sha256 {hashlib.sha256(content).hexdigest()[:16]}: {'; '.join(notes)}"
    return found if len(found) <= LONGEST_ORIGIN else f"{found[: LONGEST_ORIGIN - 4]} ..."


def _check_sum(given: Any, content: bytes, where: str) -> None:
    """Raise InputError unless a checksum, if one is given, is that of the content of a file."""
    if given is None:
        return
    found, wanted = hashlib.sha256(content).hexdigest(), _CHECKSUM.fullmatch(given) if isinstance(given, str) else None
    if wanted is None:
        raise InputError(f'{where}: checksum must be text as "sha256:{found[:16]}", got {shown(given)}')
    if not found.startswith(wanted[1].lower()):
        raise InputError(f"{where}: is another file than that of the checksum: its own is sha256:{found[:16]}")
