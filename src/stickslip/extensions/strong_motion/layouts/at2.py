"""PEER's AT2: four lines of header, the last with NPTS and DT, and accelerations in g, five in a line.

Source: files of the NGA databases of the Pacific Earthquake Engineering Research Center, of both headers: "NPTS=  1003, DT=   .0100
SEC" and, before, "1003    .0100    NPTS, DT".
"""

from __future__ import annotations

import re
from collections.abc import Sequence

from stickslip.extensions.strong_motion.layouts.blocks import rest, samples
from stickslip.extensions.strong_motion.layouts.motion import Component, RecordLayout, said_in, sheet_of
from stickslip.foundation.record_files import Asked, Lines, Sheet

AT2_LAYOUT = RecordLayout("PEER's header", "an AT2 file of PEER")
_MOST_LINES = 12
"""The header has at most this many lines."""
_NUMBER = r"(\d{0,9}\.?\d{0,12}(?:[eEdD][+-]?\d{1,3})?)"
_NEW = re.compile(rf"NPTS\s*=?\s*(\d{{1,9}})\s*,?\s*DT\s*=?\s*{_NUMBER}", re.IGNORECASE)
_OLD = re.compile(rf"\s*(\d{{1,9}})\s+{_NUMBER}\s*,?\s*NPTS\s*,\s*DT", re.IGNORECASE)
_UNITS_LINE = re.compile(r"TIME\s+(SERIES|HISTORY)\s+IN\s+UNITS\s+OF", re.IGNORECASE)


def begins(first: Sequence[str]) -> bool:
    """Return True for the first lines of such a file."""
    head = first[:_MOST_LINES]
    return any(_UNITS_LINE.search(said_in(line)) for line in head) and any(_counts(line) for line in head)


def _counts(line: str) -> re.Match[str] | None:
    said = said_in(line)
    return _NEW.search(said) or _OLD.match(said)


def sheet(lines: Lines, asked: Asked) -> Sheet:
    """Return the accelerations of a file, in g as its header says. Raises InputError."""
    kind = unit_text = ""
    for line in map(said_in, lines):
        if found := _UNITS_LINE.search(line):
            kind, unit_text = line[: found.start()], line[found.end() :].partition(".")[0]
        if counts := _counts(line):
            break
    at = lines.number
    if counts is None:
        raise AT2_LAYOUT.fault(asked, at, "no NPTS and DT in its header")
    AT2_LAYOUT.check_acceleration(asked, at, kind)
    unit = AT2_LAYOUT.unit(asked, at, unit_text)
    count, interval = asked.whole(counts[1], at, "NPTS"), asked.number(counts[2], at, "DT")
    return sheet_of(AT2_LAYOUT, asked, at, interval, [Component(samples(AT2_LAYOUT, asked, at, rest(lines), count=count), unit)])
