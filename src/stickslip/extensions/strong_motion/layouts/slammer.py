"""Two columns, time in s and acceleration in g, below the heading "Acceleration (g's)", as the sample records of pySLAMMER.

Source: pySLAMMER 0.2 (Arnold 2024), whose records begin "# Time (s),Acceleration (g's)".
"""

from __future__ import annotations

import re
from collections.abc import Sequence

import numpy as np

from stickslip.extensions.strong_motion.layouts.blocks import rest, samples
from stickslip.extensions.strong_motion.layouts.motion import Component, RecordLayout, said_in, sheet_of
from stickslip.foundation.record_files import Asked, Lines, Sheet

SLAMMER_LAYOUT = RecordLayout("the headings of pySLAMMER", "a record of pySLAMMER")
_HEADINGS = re.compile(r"#?\s*time\s*\(\s*s(ec)?\s*\)\s*[,; ]\s*acc\w*\s*\(\s*g'?s\s*\)\s*", re.IGNORECASE)
_MOST_LINES = 5
"""The headings are among this many lines."""
_EVEN = 1e-6
"""Intervals that differ by less than this share are one."""


def begins(first: Sequence[str]) -> bool:
    """Return True for the first lines of such a file."""
    return any(_HEADINGS.fullmatch(said_in(line)) for line in first[:_MOST_LINES])


def sheet(lines: Lines, asked: Asked) -> Sheet:
    """Return times and accelerations in g; even times are said to be so. Raises InputError."""
    for line in map(said_in, lines):
        if _HEADINGS.fullmatch(line):
            break
    at = lines.number
    texts = [re.sub("[,;\t]", " ", text) for text in rest(lines) if not text.lstrip().startswith("#")]
    table = samples(SLAMMER_LAYOUT, asked, at, texts, count=2 * len(texts)).reshape(-1, 2)
    steps = np.diff(table[:, 0])
    if len(steps) and steps.min() > 0.0 and np.ptp(steps) <= _EVEN * steps.max():
        step = float(f"{(table[-1, 0] - table[0, 0]) / len(steps):.9g}")
        made = sheet_of(SLAMMER_LAYOUT, asked, at, step, [Component(table[:, 1], "g")])
        return made._replace(table=table, interval=made.interval if table[0, 0] == 0.0 else None)
    header = asked.header(["time (s)", "ground_acceleration (g)"], at)
    return Sheet(header, at, iter(()), [], counted="sample", table=table)
