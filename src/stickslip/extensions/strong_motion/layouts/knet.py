"""K-NET and KiK-net ASCII: 17 lines of header, and counts, which a factor makes gal; the offset of the instrument is in them.

Source: the description of the format by NIED, Tsukuba: "Scale Factor 7845(gal)/8223790", eight counts in a line.
"""

from __future__ import annotations

import re
from collections.abc import Sequence

from stickslip.extensions.strong_motion.layouts.blocks import rest, samples
from stickslip.extensions.strong_motion.layouts.motion import Component, RecordLayout, said_in, sheet_of
from stickslip.foundation.record_files import Asked, Lines, Sheet

KNET_LAYOUT = RecordLayout("the header of K-NET", "a file of K-NET or KiK-net")
_MOST_LINES = 40
"""The header has at most this many lines."""
_KEY_AND_VALUE = re.compile(r"(Sampling Freq|Duration Time|Dir\.|Scale Factor|Memo)[^\d\s]{0,8}\s*(.*)", re.IGNORECASE)
_FACTOR = re.compile(r"([\d.]+)\s*\(\s*gal\s*\)\s*/\s*([\d.]+)", re.IGNORECASE)
_DIRECTIONS = {"N-S": "NS", "E-W": "EW", "U-D": "UD"}


def begins(first: Sequence[str]) -> bool:
    """Return True for the first lines of such a file."""
    head = [said_in(line).lower() for line in first[:_MOST_LINES]]
    return head[:1] != [] and head[0].startswith("origin time") and any(line.startswith("scale factor") for line in head)


def sheet(lines: Lines, asked: Asked) -> Sheet:
    """Return the accelerations of a file in gal. Raises InputError."""
    said: dict[str, str] = {}
    for line in lines:
        if key := _KEY_AND_VALUE.match(said_in(line)):
            said[key[1].lower()] = key[2].strip()
        if "memo" in said or lines.number > _MOST_LINES:
            break
    at = lines.number
    factor = _FACTOR.match(said.get("scale factor", ""))
    if factor is None:
        raise KNET_LAYOUT.fault(asked, at, "no Scale Factor from counts to gal, as 7845(gal)/8223790")
    gal, counts = (asked.number(factor[k], at, "Scale Factor") for k in (1, 2))
    rate = asked.number(re.match(r"[\d.]*", said.get("sampling freq", ""))[0], at, "Sampling Freq(Hz)")  # type: ignore[index]
    if not (gal > 0.0 and counts > 0.0 and rate > 0.0):
        raise KNET_LAYOUT.fault(asked, at, "Scale Factor and Sampling Freq(Hz) must be above 0")
    texts = rest(lines)
    found = samples(KNET_LAYOUT, asked, at, texts, count=sum(map(len, map(str.split, texts))))
    length = asked.number(said.get("duration time", "") or "nan", at, "Duration Time(s)")
    if length == length and abs(len(found) - rate * length) >= rate:
        KNET_LAYOUT.check_count(asked, at, round(rate * length), len(found))
    direction = said.get("dir.", "")
    name = _DIRECTIONS.get(direction, f"direction {direction}" if direction.isdigit() and len(direction) < 3 else "")
    return sheet_of(KNET_LAYOUT, asked, at, 1.0 / rate, [Component(found * gal / counts, "gal", name)])
