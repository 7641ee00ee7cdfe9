"""What all layouts of strong motion share: samples at one interval, in a unit, as a sheet, with notes and refusals."""

from __future__ import annotations

import math
import re
from collections import Counter
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from stickslip.foundation.arrays import Floats
from stickslip.foundation.constants import GRAVITY
from stickslip.foundation.record_files import Asked, Sheet

UNITS = {"g": GRAVITY, "mg": 1e-3 * GRAVITY, "gal": 1e-2, "cm/s^2": 1e-2, "mm/s^2": 1e-3, "m/s^2": 1.0, "in/s^2": 0.0254}
"""Units of acceleration, each in m/s^2."""
OFFSET_TOLD = 1e-3
"""The mean is told if it is more than this share of the peak."""
NO_SAMPLE = 1e20
"""Numbers of this size mark a missing sample, as 1.7e38 does."""
SINGLE = 2.0**-24
"""Numbers of single precision are off by up to this share."""
LONGEST_SAID = 400
"""A line of a header says what it says in its first characters, at most so many."""
FEW_DIGITS = 4
"""An interval that was meant has at most this many digits."""
_A_SECOND_TWICE = r"s(ec|econd)?\s*(\^|\*\*)?\s*2\b|s(ec|econd)?\s*(/|\*|-|\s)\s*s(ec|econd)?\b|s(ec)?²"
_PATTERNS = (
    *((unit, re.compile(rf"(?<![a-z]){length}\s*/\s*\(?\s*({_A_SECOND_TWICE})")) for unit, length in (
        ("mm/s^2", "mm"), ("cm/s^2", "cm"), ("m/s^2", "m"), ("in/s^2", "in(ch)?")
    )),
    ("gal", re.compile(r"(?<![a-z])gals?(?![a-z])")),
    ("mg", re.compile(r"(?<![a-z])mg(?![a-z])")),
    ("g", re.compile(r"(?<![a-z/*\d])g('?s)?(?![a-z/*'])")),
    ("counts", re.compile(r"(?<![a-z])counts?(?![a-z])|(?<![a-z])digits?(?![a-z])")),
    ("velocity", re.compile(r"(?<![a-z])(mm|cm|m|in)\s*/\s*s(ec)?(?![a-z])")),
)  # fmt: skip
"""How headers write units, the most special first."""
OTHER_MOTION = re.compile(r"\b(veloc|displ)", re.IGNORECASE)
"""What says that numbers are no accelerations."""


class Component(NamedTuple):
    """The samples of one direction in a unit of `UNITS`, and the name of the direction ("" if there is only one)."""

    samples: Floats
    unit: str
    name: str = ""


class RecordLayout(NamedTuple):
    """What a layout is called in a note ("1003 samples ... from PEER's header"), and what a file in it is called in a message."""

    header: str
    file: str

    def fault(self, asked: Asked, line: int, what: str) -> Exception:
        """Return an error at a line, which names the layout."""
        return asked.fault(line, f"{self.file}: {what}")

    def check_count(self, asked: Asked, line: int, stated: int, found: int) -> None:
        """Raise InputError unless there are as many samples as the header says."""
        if stated != found:
            cure = "the end is missing" if found < stated else "remove what is no sample"
            raise self.fault(asked, line, f"its header says {stated} samples, but {found} follow: {cure}")

    def check_acceleration(self, asked: Asked, line: int, text: str) -> None:
        """Raise InputError for a text that names a velocity or a displacement, and no acceleration."""
        found = OTHER_MOTION.search(text)
        if found and "accel" not in text.lower():
            what = "velocity" if found[1].lower() == "veloc" else "displacement"
            raise self.fault(asked, line, f"it holds {what}: give the file of the acceleration")

    def common(self, asked: Asked, line: int, intervals: Sequence[float]) -> float:
        """Return the interval of all channels (s). Raises InputError if they differ."""
        if len(set(intervals)) > 1:
            raise self.fault(asked, line, "channels with different intervals: write each to a file of its own")
        return intervals[0]

    def unit(self, asked: Asked, line: int, text: str) -> str:
        """Return the unit that a header writes. Raises InputError if it is none of acceleration, or missing."""
        found = unit_in(text)
        if found in UNITS:
            return found
        if found == "counts":
            raise self.fault(asked, line, "it is in counts without a factor to an acceleration: convert it first")
        if found == "velocity":
            raise self.fault(asked, line, "it is in a unit of velocity: give the file of the acceleration")
        raise self.fault(asked, line, f"no unit of acceleration; {', '.join(UNITS)} are known")


def said_in(line: str) -> str:
    """Return what a line of a header says, with single blanks, so that no pattern tries all ways through many of them."""
    return " ".join(line[:LONGEST_SAID].split())


def unit_in(text: str) -> str:
    """Return the unit in a text, "counts" or "velocity"; "" if there is none."""
    plain = said_in(text).lower()
    return next((unit for unit, pattern in _PATTERNS if pattern.search(plain)), "")


def interval_of(seconds: float, notes: list[str]) -> float:
    """Return an interval (s) without the error of the single precision that some programs keep it in; a note says so.

    0.004999999888 is 0.005 then: the shortest number of single precision with the same bits has few digits.
    """
    short = float(str(np.float32(seconds)))
    if short == seconds or abs(short - seconds) > SINGLE * seconds or float(f"{short:.{FEW_DIGITS}g}") != short:
        return seconds
    notes.append(f"the interval {seconds:.10g} s is {short:g} s in single precision")
    return short


def sheet_of(
    layout: RecordLayout, asked: Asked, line: int, interval: float, components: Sequence[Component], *, notes: Sequence[str] = ()
) -> Sheet:
    """Return samples as a sheet with a column of time. `line` is that of the header that states the `interval` (s).

    Channels may have different numbers of samples; the table is as long as the one that is chosen.

    Raises InputError for an interval that is none, for missing samples, and for several components if none is chosen.
    """
    told = list(notes)
    if not (math.isfinite(interval) and interval > 0.0):
        raise layout.fault(asked, line, "the sampling interval must be above 0")
    interval = interval_of(interval, told)
    names = _names([one.name for one in components])
    for one in components:
        _check_samples(layout, asked, line, one)
    asked.check_columns(len(components) + 1, line, "components")
    headings = ["ground_acceleration"] if len(components) == 1 else names
    header = ["time (s)", *(f"{name} ({one.unit})" for name, one in zip(headings, components, strict=True))]
    header = asked.header(header, line, [["", *names]])
    chosen = _chosen(layout, asked, line, header, names)
    count = len(components[chosen].samples)
    if count < 2:
        raise layout.fault(asked, line, f"at least two samples are needed, got {count}")
    told = [_sentence(layout, components[chosen], names[chosen], interval), *told, *_offset(components[chosen])]
    table = np.column_stack((interval * np.arange(count), *(np.resize(one.samples, count) for one in components)))
    return Sheet(header, line, iter(()), told, counted="sample", table=table, interval=interval)


def _names(names: Sequence[str]) -> list[str]:
    """Return names that differ: those that stand twice get the number of their channel."""
    often = Counter(names)
    return [name if name and often[name] == 1 else f"channel {i + 1} {name}".strip() for i, name in enumerate(names)]


def _check_samples(layout: RecordLayout, asked: Asked, line: int, one: Component) -> None:
    bad = np.flatnonzero(~(np.abs(one.samples) < NO_SAMPLE))
    if len(bad):
        where = f"sample {bad[0] + 1} of {len(one.samples)}" + (f" of {one.name}" if one.name else "")
        raise layout.fault(
            asked, line, f"{where} is missing ({one.samples[bad[0]]:g}), and {len(bad) - 1} more: fill the gap first"
        )


def _chosen(layout: RecordLayout, asked: Asked, line: int, header: Sequence[str], names: Sequence[str]) -> int:
    """Return which component is the acceleration of the ground. Raises InputError if it is asked for and none is chosen."""
    if len(names) == 1:
        return 0
    found = [i for i, cell in enumerate(header[1:]) if cell.partition(" (")[0] == "ground_acceleration"]
    if not found and "ground_acceleration" in asked.wanted:
        there = ", ".join(f"'{name}'" for name in names)
        cure = f'choose one, as columns = {{ ground_acceleration = "{names[0]}" }}'
        raise layout.fault(asked, line, f"{len(names)} components, {there}: {cure}")
    return found[0] if found else 0


def _sentence(layout: RecordLayout, one: Component, name: str, interval: float) -> str:
    peak = float(np.max(np.abs(one.samples)))
    size = f"{peak:.4g} {one.unit}" + ("" if one.unit == "g" else f" ({peak * UNITS[one.unit] / GRAVITY:.4g} g)")
    direction = f", {name}" if one.name else ""
    return f"{len(one.samples)} samples every {interval:.10g} s, {size} at most, from {layout.header}{direction}"


def _offset(one: Component) -> list[str]:
    """Return a sentence on the mean of the samples, if it is more than noise."""
    mean, peak = float(np.mean(one.samples)), float(np.max(np.abs(one.samples)))
    if abs(mean) <= OFFSET_TOLD * peak:
        return []
    return [f"the mean of the samples is {mean:.4g} {one.unit}, {100.0 * abs(mean) / peak:.2g} % of the peak"]
