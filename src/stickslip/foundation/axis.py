"""An axis: a parameter with its numbers from a lower to an upper end, and the text of a typed range."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from stickslip.foundation.arrays import Floats
from stickslip.foundation.errors import InputError
from stickslip.foundation.headings import is_number
from stickslip.foundation.units import split_quantity

MOST_POINTS = 1000
"""Largest number of points on an axis; the cost of a map grows with the product of both."""
_RANGE = re.compile(r"(?P<low>.+?)\.\.(?P<high>[^:]+)(?::(?P<points>\d{1,9}))?(?P<log>:log)?")


class TypedRange(NamedTuple):
    """A range as it is typed, LOW..HIGH[:POINTS][:log]: its ends as texts, and the number of points, None if it has none.

    A unit at one end is that of both: 40..120 rpm begins at 40 rpm.
    """

    low: str
    high: str
    points: int | None
    log: bool

    @classmethod
    def of(cls, text: str) -> TypedRange | None:
        """Return the range in a text, or None if it has another form."""
        found = _RANGE.fullmatch(text.strip())
        if found is None:
            return None
        low, high = _in_one_unit(found["low"], found["high"]), _in_one_unit(found["high"], found["low"])
        return cls(low, high, int(found["points"]) if found["points"] else None, bool(found["log"]))


def _in_one_unit(end: str, other: str) -> str:
    """Return the text of an end with the unit of the other one, if it is a number without a unit."""
    quantity = split_quantity(other)
    return f"{end.strip()} {quantity[1]}" if quantity and is_number(end) else end


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
