"""COSMOS V1 and V2: for each channel lines of text, whole and real numbers, comments, and blocks with unit and columns.

Source: COSMOS Strong Motion Data Format, version 1.20 (2001): codes of units and of angles; real 62 is the interval in ms.
"""

from __future__ import annotations

import re
from collections.abc import Sequence

import numpy as np

from stickslip.extensions.strong_motion.layouts.blocks import Columns, next_block, numbers, samples
from stickslip.extensions.strong_motion.layouts.motion import UNITS, Component, RecordLayout, said_in, sheet_of
from stickslip.foundation.record_files import Asked, Lines, Sheet

COSMOS_LAYOUT = RecordLayout("the header of COSMOS", "a file of COSMOS")
UNITS_BY_CODE = {2: "g", 4: "cm/s^2", 7: "in/s^2", 10: "gal", 11: "mg", 50: "counts"}
"""Units of acceleration by their code, and counts."""
ANGLES = {400: "UP", 401: "DOWN", 402: "VERT", 500: "RADL", 501: "TRAN", 600: "LONG", 601: "TANG", 700: "H1", 701: "H2"}
"""Directions by their code; others are azimuths in degrees."""
_FIRST_LINE = re.compile(r"(raw|uncorrected|corrected)\s+(accel|veloc|displ)\w*.*\(\s*format\s+v", re.IGNORECASE)
_TEXTS = re.compile(r"with\s+(\d{1,3})\s+text\s+lines", re.IGNORECASE)
_HEAD = re.compile(r"\s*(\d{1,5})\s+(integer|real)\S*\s.*?on\s+(\d{1,4})\s+lines", re.IGNORECASE)
_COMMENTS = re.compile(r"\s*(\d{1,4})\s+comment", re.IGNORECASE)
_BLOCK_LINE = re.compile(r"\s*(\d{1,9})\s+(accel|veloc|displ|raw)", re.IGNORECASE)
_CODE = re.compile(r"units\s*=?\s*[^(,]{0,20}\(\s*(\d{1,3})\s*\)", re.IGNORECASE)
_ANGLE, _INTERVAL = 53, 61
"""Places of the angle among the whole numbers, and of the interval among the real ones."""
_INTERVAL_OF_RAW = 33


def begins(first: Sequence[str]) -> bool:
    """Return True for the first lines of such a file."""
    return bool(first) and _FIRST_LINE.match(said_in(first[0])) is not None


def sheet(lines: Lines, asked: Asked) -> Sheet:
    """Return the accelerations of all channels of a file. Raises InputError."""
    components, intervals, at = list[Component](), list[float](), 1
    while _FIRST_LINE.match(said_in(lines.peek())):
        COSMOS_LAYOUT.check_acceleration(asked, lines.number + 1, lines.peek())
        whole, real = _head(lines, asked)
        found, at = _acceleration(lines, asked)
        intervals.append(_interval(real, asked, at))
        components.append(found._replace(name=_direction(whole)))
        _skip_to_next(lines)
    return sheet_of(COSMOS_LAYOUT, asked, at, COSMOS_LAYOUT.common(asked, at, intervals), components)


def _head(lines: Lines, asked: Asked) -> tuple[list[float], list[float]]:
    """Read the lines of text and both lists of numbers of a channel. Raises InputError if they are not there."""
    said = _TEXTS.search(said_in(next(lines)))
    for _ in range(int(said[1]) - 1 if said else 0):
        next(lines, "")
    lists = list[list[float]]()
    for line in map(said_in, lines):
        if found := _HEAD.match(line):
            count, at = int(found[1]), lines.number
            columns = Columns.of(line, Columns(10, 8))
            texts = [next(lines, "") for _ in range(int(found[3]))]
            try:
                lists.append(numbers(texts, columns, count).tolist())
            except ValueError:
                raise COSMOS_LAYOUT.fault(asked, at, "a number of its header is none") from None
            if len(lists) == 2:
                return lists[0], lists[1]
        elif lines.number > 10_000:
            break
    raise COSMOS_LAYOUT.fault(asked, lines.number, "no lists of whole and real numbers in its header")


def _acceleration(lines: Lines, asked: Asked) -> tuple[Component, int]:
    """Read the block of accelerations, and return it with its line. Raises InputError if it is not there."""
    for line in map(said_in, lines):
        if found := _COMMENTS.match(line):
            for _ in range(int(found[1])):
                next(lines, "")
        elif found := _BLOCK_LINE.match(line):
            count, at = int(found[1]), lines.number
            columns = Columns.of(line, Columns(8, 10))
            COSMOS_LAYOUT.check_acceleration(asked, at, line)
            code = _CODE.search(line)
            unit = UNITS_BY_CODE.get(int(code[1]), "") if code else ""
            unit = (
                unit
                if unit in UNITS
                else COSMOS_LAYOUT.unit(asked, at, unit or line.lower().partition("units")[2].partition("format")[0])
            )
            values = samples(COSMOS_LAYOUT, asked, at, next_block(lines, count, columns), count=count, columns=columns)
            return Component(values, unit), at
    raise COSMOS_LAYOUT.fault(asked, lines.number, "no block of accelerations")


def _skip_to_next(lines: Lines) -> None:
    """Pass over the blocks of velocity and displacement, and the line that ends a channel."""
    for line in map(said_in, lines):
        if found := _BLOCK_LINE.match(line):
            next_block(lines, int(found[1]), Columns.of(line, Columns(8, 10)))
        if _FIRST_LINE.match(said_in(lines.peek())):
            return


def _interval(real: Sequence[float], asked: Asked, at: int) -> float:
    """Return the interval (s), which a header may give in ms only for the series, or only for the recorder, in s."""
    if len(real) > _INTERVAL and np.isfinite(real[_INTERVAL]) and real[_INTERVAL] > 0.0:
        return real[_INTERVAL] / 1000.0
    if len(real) > _INTERVAL_OF_RAW and real[_INTERVAL_OF_RAW] > 0.0:
        return real[_INTERVAL_OF_RAW]
    raise COSMOS_LAYOUT.fault(asked, at, "no sampling interval among the real numbers of its header")


def _direction(whole: Sequence[float]) -> str:
    angle = int(whole[_ANGLE]) if len(whole) > _ANGLE else -1
    return ANGLES.get(angle, f"{angle:03d}" if 0 <= angle <= 360 else "")
