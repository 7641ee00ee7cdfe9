"""USGS SMC: 11 lines of text, 6 of whole and 10 of real numbers, comments behind |, and columns that may touch each other.

Source: National Strong-Motion Program, U.S. Geological Survey, Open-File Report 92-6 and its later additions: whole number 1 and
real number 1 mark missing ones, whole numbers 16 and 17 count comments and samples, real number 2 is samples per second; cm/s^2.
"""

from __future__ import annotations

import re
from collections.abc import Sequence

from stickslip.extensions.strong_motion.layouts.blocks import Columns, numbers, rest, samples
from stickslip.extensions.strong_motion.layouts.motion import Component, RecordLayout, said_in, sheet_of
from stickslip.foundation.record_files import Asked, Lines, Sheet

SMC_LAYOUT = RecordLayout("the header of an SMC file", "a file of the USGS (SMC)")
_FIRST_LINE = re.compile(r"\*\s*$|\d\s+[A-Z]")
_TEXTS, _WHOLE, _REAL = 11, 6, 10
_OF_WHOLE, _OF_REAL, _OF_SAMPLES = Columns(8, 10), Columns(5, 15), Columns(8, 10)
_ANGLES, _COMMENTS, _COUNT, _RATE = (12, 13), 15, 16, 1
"""Places of the angles from the vertical and from north, of the counts, and of the samples per second."""
_NO_ANGLE = 400
_WHOLE_NUMBER = re.compile(r"[+-]?\d{1,10}")


def begins(first: Sequence[str]) -> bool:
    """Return True for the first lines of such a file."""
    head = first[_TEXTS : _TEXTS + _WHOLE]
    return len(head) == _WHOLE and _FIRST_LINE.match(said_in(first[0])) is not None and all(map(_is_whole, head))


def _is_whole(line: str) -> bool:
    """Return True for a line of whole numbers, each in a column of its own."""
    text, width = line.rstrip(), _OF_WHOLE.width
    cells = [text[k : k + width].strip() for k in range(0, min(len(text), 100), width)]
    return len(cells) == _OF_WHOLE.across and all(map(_WHOLE_NUMBER.fullmatch, cells))


def sheet(lines: Lines, asked: Asked) -> Sheet:
    """Return the accelerations of a file in cm/s^2. Raises InputError."""
    first = next(lines)
    SMC_LAYOUT.check_acceleration(asked, 1, first)
    for _ in range(_TEXTS - 1):
        next(lines)
    try:
        whole = numbers([next(lines) for _ in range(_WHOLE)], _OF_WHOLE, 48)
        real = numbers([next(lines, "") for _ in range(_REAL)], _OF_REAL, 50)
    except ValueError:
        raise SMC_LAYOUT.fault(asked, lines.number, "a number of its header is none") from None
    at = lines.number
    if len(whole) != 48 or len(real) != 50 or not 0.0 < real[_RATE] < 1e6:
        raise SMC_LAYOUT.fault(asked, at, "its header must have 48 whole and 50 real numbers, with the samples per second")
    for _ in range(int(whole[_COMMENTS]) if 0 < whole[_COMMENTS] < 10_000 else 0):
        if not lines.peek().startswith("|"):
            break
        next(lines)
    values = samples(SMC_LAYOUT, asked, lines.number, rest(lines), count=int(whole[_COUNT]), columns=_OF_SAMPLES)
    return sheet_of(
        SMC_LAYOUT, asked, at, 1.0 / float(real[_RATE]), [Component(values, "cm/s^2", _direction(*whole[list(_ANGLES)]))]
    )


def _direction(from_vertical: float, from_north: float) -> str:
    if from_vertical in (0.0, 180.0):
        return "UP" if from_vertical == 0.0 else "DOWN"
    return f"{from_north:03.0f}" if 0.0 <= from_north < _NO_ANGLE else ""
