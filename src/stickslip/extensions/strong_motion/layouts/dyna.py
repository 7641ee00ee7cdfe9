"""DYNA 1.2 of the databases ESM and ITACA: 64 lines of "KEY: value", and one sample in a line.

Source: Engineering Strong-Motion Database, www.esm-db.eu (Luzi et al. 2016, Seismol. Res. Lett. 87, 987).
"""

from __future__ import annotations

import re
from collections.abc import Sequence

from stickslip.extensions.strong_motion.layouts.blocks import rest, samples
from stickslip.extensions.strong_motion.layouts.motion import Component, RecordLayout, said_in, sheet_of
from stickslip.foundation.record_files import Asked, Lines, Sheet

DYNA_LAYOUT = RecordLayout("the header of ESM", "a file of ESM or ITACA (DYNA)")
_MOST_LINES = 120
"""The header has at most this many lines."""
_KEY_AND_VALUE = re.compile(r"\s*([A-Z][A-Z0-9_\[\]/]*)\s*:\s*(.*)", re.IGNORECASE)
_STREAM = re.compile(r"[A-Z0-9]{1,4}")


def begins(first: Sequence[str]) -> bool:
    """Return True for the first lines of such a file."""
    keys = [found[1].upper() for line in first[:_MOST_LINES] if (found := _KEY_AND_VALUE.match(said_in(line)))]
    return keys[:1] == ["EVENT_NAME"] and "SAMPLING_INTERVAL_S" in keys


def sheet(lines: Lines, asked: Asked) -> Sheet:
    """Return the accelerations of a file in the unit that it names. Raises InputError."""
    said, at = dict[str, tuple[str, int]](), 0
    while found := _KEY_AND_VALUE.match(said_in(lines.peek())):
        next(lines)
        said[found[1].upper()] = found[2].strip(), lines.number
    at = lines.number

    def value(key: str) -> tuple[str, int]:
        return said.get(key, ("", at))

    kind, at_kind = value("DATA_TYPE")
    DYNA_LAYOUT.check_acceleration(asked, at_kind, kind)
    text, at_units = value("UNITS")
    unit = DYNA_LAYOUT.unit(asked, at_units, text)
    count = asked.whole(*value("NDATA"), "NDATA")
    interval = asked.number(*value("SAMPLING_INTERVAL_S"), "SAMPLING_INTERVAL_S")
    stream = value("STREAM")[0].upper()
    values = samples(DYNA_LAYOUT, asked, at, rest(lines), count=count)
    return sheet_of(DYNA_LAYOUT, asked, at, interval, [Component(values, unit, stream if _STREAM.fullmatch(stream) else "")])
