"""Text that states the interval of its samples, and has accelerations alone, one or several in a line.

As many programs write it: free lines, where one says "dt = 0.005 s", "Sampling interval (s): 0.02" or "NPTS= 4000 DT= .005 SEC",
and the unit in one of them.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from itertools import takewhile

import numpy as np

from stickslip.extensions.strong_motion.layouts.blocks import rest, samples
from stickslip.extensions.strong_motion.layouts.motion import UNITS, Component, RecordLayout, said_in, sheet_of, unit_in
from stickslip.foundation.record_files import Asked, Lines, Sheet

PLAIN_LAYOUT = RecordLayout("its heading", "a text with an interval in its heading")
_MOST_LINES = 60
"""The heading has at most this many lines."""
_VALUE = r"\s*[:=]?\s*(\d{0,6}\.?\d{1,12}(?:[eE][+-]?\d{1,3})?)\s*(ms(?:ec)?|s(?:ec(?:ond)?s?)?|hz)?\b"
_INTERVAL = re.compile(
    r"(?:\bdt|\bdelta[ _-]?t|\bdelta|(?:sampling|sample|time)[ _-]*(?:interval|step|period|spacing))"
    rf"\s*(?:[(\[]\s*(ms|s|sec|seconds?)\s*[)\]])?{_VALUE}",
    re.IGNORECASE,
)
_RATE = re.compile(
    rf"(?:sampling|sample)[ _-]*(?:rate|freq(?:uency)?)\s*(?:[(\[]\s*(hz|sps|samples/s)\s*[)\]])?{_VALUE}", re.IGNORECASE
)
_COUNT = re.compile(r"\b(?:npts|n(?:umber|o\.?)?\s*of\s*(?:points|samples|data))\s*[:=]?\s*(\d{1,9})\b", re.IGNORECASE)
_MARKS = re.compile(r"^[\s#%!*/;]+")


def begins(first: Sequence[str]) -> bool:
    """Return True for the first lines of such a file: an interval is stated, and numbers follow that are no table with headings."""
    head = list(takewhile(lambda line: not _is_numbers(line), first[:_MOST_LINES]))
    rows = [line.split() for line in first[len(head) : len(head) + 3] if line.strip()]
    if not rows or not any(_INTERVAL.search(line) or _RATE.search(line) for line in map(said_in, head)):
        return False
    width = len(rows[0])
    if width == 1:
        return True
    above = _MARKS.sub("", next((line for line in reversed(head) if line.strip()), ""))
    is_header = len(re.split(r"[\t;,]", above)) == width or len(re.split(r"\s{2,}", above)) == width or len(above.split()) == width
    stated = _INTERVAL.search(said_in(above)) or _RATE.search(said_in(above))
    return (not is_header or stated is not None) and not _is_clock(rows)


def _is_numbers(line: str) -> bool:
    cells = line.split()
    try:
        return bool(cells) and all(map(np.isfinite, map(float, cells)))
    except ValueError:
        return False


def _is_clock(rows: Sequence[Sequence[str]]) -> bool:
    """Return True if the first numbers of some rows ascend in even steps, as times do."""
    steps = np.diff([float(row[0]) if _is_numbers(row[0]) else np.nan for row in rows])
    return len(steps) > 1 and bool(steps[0] > 0.0) and bool(np.ptp(steps) < 1e-6 * steps[0])


def sheet(lines: Lines, asked: Asked) -> Sheet:
    """Return the samples of a file. Raises InputError, also if it does not say their unit and the user does not, either."""
    head = list[str]()
    while lines.peek() is not None and not _is_numbers(lines.peek()):
        head.append(said_in(next(lines)))
    at = lines.number
    said = "\n".join(head)
    PLAIN_LAYOUT.check_acceleration(asked, at, said)
    interval = _interval(said, asked, at)
    texts = rest(lines)
    count = found[1] if (found := _COUNT.search(said)) else None
    stated = int(count) if count else sum(map(len, map(str.split, texts)))
    values = samples(PLAIN_LAYOUT, asked, at, texts, count=stated)
    return sheet_of(PLAIN_LAYOUT, asked, at, interval, [Component(values, _unit(said, asked, at))])


def _interval(said: str, asked: Asked, at: int) -> float:
    """Return the interval (s). Raises InputError for two that differ."""
    found = {_seconds(*one.groups()) for one in _INTERVAL.finditer(said)}
    found |= {1.0 / float(one[2]) for one in _RATE.finditer(said) if float(one[2]) > 0.0}
    if len(found) != 1 and (not found or max(found) - min(found) > 1e-6 * max(found)):
        what = f"two intervals, {min(found):g} s and {max(found):g} s" if found else "no interval above 0"
        raise PLAIN_LAYOUT.fault(asked, at, f"it states {what}")
    return min(found)


def _seconds(before: str | None, number: str, behind: str | None) -> float:
    return float(number) * (1e-3 if (before or behind or "s").lower().startswith("ms") else 1.0)


def _unit(said: str, asked: Asked, at: int) -> str:
    """Return the unit that the user gives, or else that of the heading. Raises InputError if none does."""
    given = unit_in(asked.header(["time (s)", "ground_acceleration"], at)[1].partition("(")[2].rstrip(")"))
    if given in UNITS:
        return given
    if unit_in(said) in ("", "velocity"):
        way = 'say it as columns = { ground_acceleration = "ground_acceleration (g)" }'
        raise PLAIN_LAYOUT.fault(asked, at, f"it does not say the unit of its numbers ({', '.join(UNITS)}): {way}")
    return PLAIN_LAYOUT.unit(asked, at, said)
