"""GeoNet V1A and V2A of New Zealand: for each component 16 lines of text, 10 of numbers, and blocks in mm/s^2 of ten in a line.

Source: GNS Science, the description of accelerogram files of GeoNet: number 1 of line 4 counts the samples of a V1A file, 4 to 6
those of acceleration, velocity and displacement of a V2A file; number 6 of line 7 is their interval.
"""

from __future__ import annotations

import re
from collections.abc import Sequence

import numpy as np

from stickslip.extensions.strong_motion.layouts.blocks import Columns, next_block, numbers, samples
from stickslip.extensions.strong_motion.layouts.motion import Component, RecordLayout, said_in, sheet_of
from stickslip.foundation.arrays import Floats
from stickslip.foundation.record_files import Asked, Lines, Sheet

GEONET_LAYOUT = RecordLayout("the header of GeoNet", "a file of GeoNet")
_FIRST_LINE = re.compile(r"(un)?corrected\s+accelerogram.*\bGNS\b", re.IGNORECASE)
_TEXTS, _NUMBERS = 16, 10
_COLUMNS = Columns(10, 8)
_COMPONENT = re.compile(r"component\s+(\w{1,6})", re.IGNORECASE)
_POINTS = re.compile(r"number\s+of\s+points\s+(\d{1,9})", re.IGNORECASE)


def begins(first: Sequence[str]) -> bool:
    """Return True for the first lines of such a file."""
    return bool(first) and _FIRST_LINE.match(said_in(first[0])) is not None


def sheet(lines: Lines, asked: Asked) -> Sheet:
    """Return the accelerations of the components of a file in mm/s^2. Raises InputError."""
    components, steps, at = list[Component](), list[float](), 0
    while _FIRST_LINE.match(said_in(lines.peek())):
        texts = [said_in(next(lines, "")) for _ in range(_TEXTS)]
        table = _numbers(lines, asked)
        at = lines.number
        corrected = not texts[0].lstrip().lower().startswith("un")
        counts = [int(one) for one in (table[3, 3:6] if corrected else (table[3, 0], 0, 0))]
        stated = next((int(found[1]) for text in texts if (found := _POINTS.search(text))), counts[0])
        if stated != counts[0] and not corrected:
            raise GEONET_LAYOUT.fault(asked, at, f"its text says {stated} points, but its numbers {counts[0]}")
        values = samples(GEONET_LAYOUT, asked, at, next_block(lines, counts[0], _COLUMNS), count=counts[0], columns=_COLUMNS)
        for count in counts[1:]:
            next_block(lines, count, _COLUMNS)
        direction = next((found[1] for text in texts if (found := _COMPONENT.match(text))), "")
        components.append(Component(values, "mm/s^2", direction.upper()))
        steps.append(float(table[6, 5]))
        while lines.peek() == "" and next(lines, None) is not None:
            pass
    return sheet_of(GEONET_LAYOUT, asked, at, GEONET_LAYOUT.common(asked, at, steps), components)


def _numbers(lines: Lines, asked: Asked) -> Floats:
    """Return the numbers of a header, ten in a line. Raises InputError."""
    found = list[list[float]]()
    for _ in range(_NUMBERS):
        try:
            found.append(numbers([next(lines, "")], _COLUMNS, _COLUMNS.across).tolist())
        except ValueError:
            found.append([])
        if len(found[-1]) != _COLUMNS.across:
            raise GEONET_LAYOUT.fault(asked, lines.number, f"{_NUMBERS} lines of its header have ten numbers each")
    table = np.array(found)
    if not (table[3] >= 0.0).all() or not np.isfinite(table).all():
        raise GEONET_LAYOUT.fault(asked, lines.number, "a count in its header is below 0")
    return table
