"""CSMIP and CESMD V1 and V2 of California: for each channel text, numbers, and blocks behind a line on them.

Source: files of the Center for Engineering Strong Motion Data: "Corrected accelerogram", 25 lines of text, 20 of
numbers, then "4000 points of accel data equally spaced at .020 sec, in cm/sec2. (8f10.3)"; the block of V1 says "at 100 pts/sec".
"""

from __future__ import annotations

import re
from collections.abc import Sequence

from stickslip.extensions.strong_motion.layouts.blocks import Columns, next_block, samples
from stickslip.extensions.strong_motion.layouts.motion import Component, RecordLayout, said_in, sheet_of
from stickslip.foundation.record_files import Asked, Lines, Sheet

CSMIP_LAYOUT = RecordLayout("the header of CSMIP", "a file of CSMIP or CESMD")
_FIRST_LINE = re.compile(r"(un)?corrected\s+accelerogram", re.IGNORECASE)
_BLOCK_LINE = re.compile(r"\s*(\d{1,9})\s+(points|accel|veloc|displ)", re.IGNORECASE)
_KIND = re.compile(r"\b(accel|veloc|displ)", re.IGNORECASE)
_INTERVAL = re.compile(r"(?:spaced\s+at|intervals?\s+of|every)\s*(\d{0,5}\.?\d{1,9})\s*s", re.IGNORECASE)
_RATE = re.compile(r"at\s*(\d{1,6}\.?\d{0,6})\s*(?:pts|points|samples)\s*/\s*s", re.IGNORECASE)
_UNITS_OF_BLOCK = re.compile(r"units\s*(?:of|:|=)?\s*(.{1,20})|,\s*in\s+(.{1,20})", re.IGNORECASE)
_CHANNEL = re.compile(r"\bchan\w*\.?\s*\d{1,3}\s*:\s*([\w-]{1,8})(\s+deg)?", re.IGNORECASE)


def begins(first: Sequence[str]) -> bool:
    """Return True for the first lines of such a file."""
    return (
        bool(first)
        and _FIRST_LINE.match(said_in(first[0])) is not None
        and "GNS" not in first[0]
        and "format v" not in first[0].lower()
    )


def sheet(lines: Lines, asked: Asked) -> Sheet:
    """Return the accelerations of all channels of a file. Raises InputError."""
    components, steps, at, name = list[Component](), list[float](), 0, ""
    for line in map(said_in, lines):
        if _FIRST_LINE.match(line):
            name = ""
        if not name and (found := _CHANNEL.search(line)):
            name = _direction(found)
        found = _BLOCK_LINE.match(line)
        if found is None or (kind := _KIND.search(line)) is None:
            continue
        count, columns = int(found[1]), Columns.of(line, Columns(8, 10))
        if kind[1].lower() != "accel":
            next_block(lines, count, columns)
            continue
        at = lines.number
        steps.append(_step(line, asked, at))
        written = _UNITS_OF_BLOCK.search(line)
        unit = CSMIP_LAYOUT.unit(asked, at, (written[1] or written[2]) if written else "")
        values = samples(CSMIP_LAYOUT, asked, at, next_block(lines, count, columns), count=count, columns=columns)
        components.append(Component(values, unit, name))
    if not components:
        raise CSMIP_LAYOUT.fault(
            asked, lines.number, "no line that says how many points of acceleration follow, and their interval"
        )
    return sheet_of(CSMIP_LAYOUT, asked, at, CSMIP_LAYOUT.common(asked, at, steps), components)


def _step(line: str, asked: Asked, at: int) -> float:
    """Return the interval (s) of a block. Raises InputError if its line does not say it."""
    if found := _INTERVAL.search(line):
        return asked.number(found[1], at, "the interval")
    if (found := _RATE.search(line)) and float(found[1]) > 0.0:
        return 1.0 / float(found[1])
    raise CSMIP_LAYOUT.fault(asked, at, "the line before the numbers does not say their interval")


def _direction(found: re.Match[str]) -> str:
    return f"{int(found[1]):03d}" if found[1].isdigit() and int(found[1]) <= 360 else found[1].upper()
