"""Files of the Central Weather Bureau of Taiwan: lines of "#Key: value", then time and three components in each line.

Source: files of the Taiwan Strong-Motion Instrumentation Program: "#SampleRate(Hz): 200", "#AmplitudeUnit: gal", "#DataSequence:
Time U(+); N(+); E(+)", "#Data: 4F10.3".
"""

from __future__ import annotations

import re
from collections.abc import Sequence

import numpy as np

from stickslip.extensions.strong_motion.layouts.blocks import Columns, numbers, rest
from stickslip.extensions.strong_motion.layouts.motion import Component, RecordLayout, said_in, sheet_of
from stickslip.foundation.record_files import Asked, Lines, Sheet

CWB_LAYOUT = RecordLayout("the header of CWB", "a file of CWB (Taiwan)")
_MOST_LINES = 100
"""The header has at most this many lines."""
_KEY_AND_VALUE = re.compile(r"#\s*(\w+)[^:]{0,20}:\s*(.*)")
_LETTERS = {"u": "UP", "n": "NS", "e": "EW"}
_COMPONENT = re.compile(r"\b([UNE])\s*\(\s*([+-])\s*\)", re.IGNORECASE)
_USUAL = Columns(4, 10)
_ROUNDED = 0.6
"""Times may be off the interval by this share of their last decimal."""


def begins(first: Sequence[str]) -> bool:
    """Return True for the first lines of such a file."""
    keys = {found[1].lower() for line in first[:_MOST_LINES] if (found := _KEY_AND_VALUE.match(said_in(line)))}
    return bool(first) and first[0].lstrip().startswith("#") and {"samplerate", "datasequence", "data"} <= keys


def sheet(lines: Lines, asked: Asked) -> Sheet:
    """Return the accelerations of the three components of a file. Raises InputError."""
    said: dict[str, str] = {}
    for line in lines:
        if found := _KEY_AND_VALUE.match(said_in(line)):
            said[found[1].lower()] = found[2]
        if "data" in said or lines.number > _MOST_LINES:
            break
    at = lines.number
    rate = asked.number(said.get("samplerate", ""), at, "SampleRate(Hz)")
    if not rate > 0.0:
        raise CWB_LAYOUT.fault(asked, at, "SampleRate(Hz) must be above 0")
    unit = CWB_LAYOUT.unit(asked, at, said.get("amplitudeunit", ""))
    parts = _COMPONENT.findall(said.get("datasequence", ""))
    columns = Columns.of(f"({said['data'].strip()})" if "data" in said else "", _USUAL)
    if len(parts) != columns.across - 1:
        raise CWB_LAYOUT.fault(
            asked, at, f"DataSequence must name the {columns.across - 1} components that Data has beside the time"
        )
    texts = [text for text in rest(lines) if text.strip()]
    try:
        found_numbers = numbers(texts, columns, columns.across * len(texts))
    except ValueError:
        raise CWB_LAYOUT.fault(asked, at, "each sample must be a number") from None
    CWB_LAYOUT.check_count(asked, at, columns.across * len(texts), len(found_numbers))
    table = found_numbers.reshape(-1, columns.across)
    _check_clock(table[:, 0], rate, asked, at)
    components = [
        Component(table[:, i] if sign == "+" else -table[:, i], unit, _LETTERS[letter.lower()])
        for i, (letter, sign) in enumerate(parts, 1)
    ]
    return sheet_of(CWB_LAYOUT, asked, at, 1.0 / rate, components)


def _check_clock(times: np.ndarray, rate: float, asked: Asked, at: int) -> None:
    """Raise InputError if the times leave out a sample, or are not those of the rate."""
    off = np.abs(times - times[0] - np.arange(len(times)) / rate) if len(times) else times
    if len(off) and off.max() > max(_ROUNDED / rate, 0.001):
        i = int(np.argmax(off > max(_ROUNDED / rate, 0.001)))
        raise CWB_LAYOUT.fault(
            asked, at + i + 1, f"a gap: sample {i + 1} is at {times[i]:g} s, and SampleRate puts it at {i / rate:g} s"
        )
