"""An axis: a parameter with its numbers from a lower to an upper end, and the text of a typed range."""

from __future__ import annotations

import re
from contextlib import suppress
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from stickslip.foundation.arrays import Floats
from stickslip.foundation.errors import InputError
from stickslip.foundation.headings import is_number
from stickslip.foundation.units import LONGEST_TEXT, split_quantity

MOST_POINTS = 1000
"""Largest number of points on an axis; the cost of a map grows with the product of both."""
_RANGE = re.compile(r"(?P<low>.+?)\.\.(?P<high>[^:]+?)(?P<log>\s*:\s*log)?", re.DOTALL)
_BETWEEN = r"\s*(?:(?<![eE])[-–]|\bto\b|:|\.\.\.+)\s*"
_MISTYPED = re.compile(rf"(?P<low>[^:]*?\d[^:]*?){_BETWEEN}(?P<high>[\d.][^:]*?)(?P<rest>\s*:.*)?", re.DOTALL)
"""Two ends with something else than two points between them; of three points one would be read as a decimal point."""
_COUNTED = re.compile(r"(?P<low>.+?)\.\.(?P<high>[^:]+?)\s*:(?P<points>.*?)(?P<log>:\s*log)?", re.DOTALL)


class TypedRange(NamedTuple):
    """A range as it is typed, LOW..HIGH[:POINTS][:log]: its ends as texts, and the number of points, None if it has none.

    A unit at one end is that of both: 40..120 rpm begins at 40 rpm.
    """

    low: str
    high: str
    points: int | None
    log: bool

    @classmethod
    def of(cls, text: str, where: str) -> TypedRange | None:
        """Return the range in a text, or None if it has another form.

        Raises InputError, which begins with `where`, for a number of points that is not whole; 1e3 is.
        """
        if "..." in text:
            raise InputError(f"{where}: {range_meant(text) or 'a range is LOW..HIGH, with two points'}, got {ascii(text)[:60]}")
        if found := _RANGE.fullmatch(text.strip()):
            return cls(*_in_one_unit(found["low"], found["high"]), None, bool(found["log"]))
        if counted := _COUNTED.fullmatch(text.strip()):
            ends = _in_one_unit(counted["low"], counted["high"])
            return cls(*ends, _count(counted["points"].strip(), where), bool(counted["log"]))
        return None


def range_meant(text: str) -> str:
    """Return how a range that is typed as 1-50 km, 1 to 50 km or 1:50 km, or a list without commas, is written; else nothing."""
    if len(text) > LONGEST_TEXT:
        return ""
    found = _MISTYPED.fullmatch(text.strip())
    if found and all(is_number(one) or split_quantity(one) for one in (found["low"], found["high"])):
        return f"a range is written {found['low']}..{found['high']}{(found['rest'] or '').strip()}"
    parts = re.split(r"\s*[;|]\s*|\s+", text.strip())
    if len(parts) > 1 and all(is_number(one) or split_quantity(one) for one in parts):
        return f"values are written with commas, as {','.join(parts)}"
    return ""


def _count(text: str, where: str) -> int:
    """Return a number of points that was typed. Raises InputError, which begins with `where`."""
    with suppress(ValueError):
        if float(text).is_integer():
            return int(text) if text.isdecimal() else int(float(text))
    more = "; equal ratios end in :log, equal steps in nothing" if ":" in text else ""
    raise InputError(
        f"{where}: the number of points of a range must be a whole number, as in LOW..HIGH:40, got {ascii(text)[:60]}{more}"
    )


def _in_one_unit(low: str, high: str) -> tuple[str, str]:
    """Return two ends as texts; one that is a number without a unit gets that of the other one."""
    if is_number(low) == is_number(high):  # of 1e3 alone `split_quantity` would take the exponent for a unit
        return low, high
    if is_number(high):
        first = split_quantity(low)
        return low, f"{high.strip()} {first[1]}" if first else high
    last = split_quantity(high)
    return f"{low.strip()} {last[1]}" if last else low, high


def check_ends(name: str, low: float, high: float, *, log: bool = False, unit: str = "") -> None:
    """Raise InputError, which begins with `name`, unless two ends are finite, ascending and, with `log`, above 0."""
    if not (np.isfinite([low, high]).all() and low < high):
        raise InputError(f"{name} must go from a smaller to a larger number, got {low:g} to {high:g} {unit}".rstrip())
    if log and not low > 0.0:
        raise InputError(f"{name} must begin above 0 for equal ratios (log), got {low:g} {unit}".rstrip())


def spaced(low: float, high: float, points: int, *, log: bool) -> Floats:
    """Return numbers from one end to the other, both included, in equal steps or, with `log`, in equal ratios."""
    return np.asarray(np.geomspace(low, high, points) if log else np.linspace(low, high, points))


@dataclass(frozen=True)
class Axis:
    """A parameter of a problem (a key of `problem.parameters`), and the 2 to 1000 values (SI) that it takes along an axis of a map.

    With `log` the values are evenly spaced in their logarithm. Raises InputError for ends or numbers that make no axis.
    """

    parameter: str
    low: float
    high: float
    points: int = 40
    log: bool = False

    def __post_init__(self) -> None:
        check_ends(f"axis: {self.parameter}", self.low, self.high, log=self.log)
        if not 2 <= self.points <= MOST_POINTS:
            raise InputError(f"axis: {self.parameter} must have 2 to {MOST_POINTS} points, got {self.points}")

    @property
    def values(self) -> Floats:
        """The values along the axis (SI), ascending, shape (points,)."""
        return spaced(self.low, self.high, self.points, log=self.log)
