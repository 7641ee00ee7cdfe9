"""TSPAIR and SLIST, as ObsPy and data centres write them: a line "TIMESERIES ...", then times and samples, or samples alone.

Source: the formats of the web service "timeseries" of IRIS (EarthScope): name, samples, rate, start, layout, type, unit.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from datetime import datetime
from typing import NamedTuple

import numpy as np

from stickslip.extensions.strong_motion.layouts.blocks import samples
from stickslip.extensions.strong_motion.layouts.motion import Component, RecordLayout, said_in, sheet_of
from stickslip.foundation.record_files import Asked, Lines, Sheet

OBSPY_LAYOUT = RecordLayout("the header of ObsPy's text", "a file of ObsPy (TSPAIR or SLIST)")
_FIRST_LINE = re.compile(
    r"TIMESERIES\s+(?P<name>\S{1,40}?),?\s+(?P<count>\d{1,9})\s+samples,\s*(?P<rate>[\d.eE+-]{1,24})\s+sps,\s*(?P<start>\S{1,32}?),"
    r"\s*(?P<layout>TSPAIR|SLIST),\s*\w{1,12},?\s*(?P<unit>.{0,40})",
    re.IGNORECASE,
)
_PARTS = re.compile(r"[A-Z0-9]{0,4}")


class _Piece(NamedTuple):
    """The samples behind one header, with the name, the rate (Hz), the start, the unit, and the line of the header."""

    name: str
    rate: float
    start: str
    unit: str
    at: int
    samples: np.ndarray


def begins(first: Sequence[str]) -> bool:
    """Return True for the first lines of such a file."""
    return next((line for line in first if line.strip()), "").lstrip().upper().startswith("TIMESERIES ")


def sheet(lines: Lines, asked: Asked) -> Sheet:
    """Return the samples of a file, each channel a column. Raises InputError, also for counts and for a gap."""
    pieces = list[_Piece]()
    for line in lines:
        if not line.strip():
            continue
        found = _FIRST_LINE.match(said_in(line))
        if found is None:
            raise OBSPY_LAYOUT.fault(
                asked, lines.number, "its header must say TIMESERIES, name, samples, sps, start, layout, type, unit"
            )
        pieces.append(_piece(found, lines, asked))
    first = pieces[0]
    for one in pieces[1:]:
        if one.name == first.name:
            raise OBSPY_LAYOUT.fault(
                asked, one.at, f"a gap: a second piece of one channel begins {_later(first, one)}; fill it first"
            )
        if (one.rate, len(one.samples)) != (first.rate, len(first.samples)):
            raise OBSPY_LAYOUT.fault(
                asked, one.at, "channels with different rates or numbers of samples: write each to a file of its own"
            )
    components = [Component(one.samples, one.unit, _channel(one.name)) for one in pieces]
    interval = OBSPY_LAYOUT.common(asked, first.at, [1.0 / one.rate for one in pieces])
    return sheet_of(OBSPY_LAYOUT, asked, first.at, interval, components)


def _piece(found: re.Match[str], lines: Lines, asked: Asked) -> _Piece:
    at, count = lines.number, int(found["count"])
    rate = asked.number(found["rate"], at, "the sampling rate")
    if not rate > 0.0:
        raise OBSPY_LAYOUT.fault(asked, at, "the sampling rate must be above 0")
    unit = OBSPY_LAYOUT.unit(asked, at, found["unit"])
    texts = list[str]()
    while lines.peek() and not lines.peek().startswith("TIMESERIES"):
        texts.append(next(lines))
    if found["layout"].upper() == "TSPAIR":
        texts = [text.rstrip().rpartition(" ")[2] for text in texts]
    return _Piece(found["name"], rate, found["start"], unit, at, samples(OBSPY_LAYOUT, asked, at, texts, count=count))


def _channel(name: str) -> str:
    """Return the channel in a name such as NZ_KHZ_10_HNE_D."""
    parts = name.upper().split("_")
    return parts[3] if len(parts) > 3 and parts[3] and _PARTS.fullmatch(parts[3]) else ""


def _later(first: _Piece, second: _Piece) -> str:
    try:
        ends = datetime.fromisoformat(first.start[:26])
        after = (datetime.fromisoformat(second.start[:26]) - ends).total_seconds() - len(first.samples) / first.rate
    except ValueError:
        return "later"
    return f"{after:g} s after the first one ends"
