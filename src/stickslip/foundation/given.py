"""Numbers that remember their given unit, and the units of results that follow from it.

What was given in rpm, g, inch or kN m is shown in it. `Quantity.check` makes a `Given` of a text such as "60 rpm"; it is a float in
SI for all that calculates. `problem.given_units` finds what a problem was given in, and `shown_in` tells it to all that is printed
or drawn meanwhile: `names.readable_unit` and `show` ask `preferred`.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, suppress
from contextvars import ContextVar
from fractions import Fraction
from types import MappingProxyType
from typing import Any

from stickslip.foundation.errors import InputError
from stickslip.foundation.units import si_factor, to_si

PLACE = "place"
"""Stands for "m" where a length is one inside a body: a thickness in feet says nothing of slip."""
TORQUE = "N m"
_CALENDAR = re.compile(r"(?<![a-z])(?:year|yr|a|day|d|week|month)s?(?![a-z])", re.IGNORECASE)
"""A rate of a few cm a year is given so, but what happens in an earthquake is not read in it."""
_TENS = {Fraction(10) ** power for power in range(-18, 19)}
_TRADES = re.compile(r"bar\b|gal", re.IGNORECASE)
"""Units of trades that are a power of ten in SI, besides torques with a prefix."""
Units = Mapping[str, tuple[str, float]]
"""A unit (name, size in SI) by the SI unit that it replaces."""
_SHOWN: ContextVar[Units] = ContextVar("units in which results are shown", default=MappingProxyType({}))
LEAST, MOST = 1e-3, 1e6
"""Results whose largest magnitude, in the unit that was given, is not between these have another unit."""


class Given(float):
    """A number in SI that was given as so much of another unit."""

    __slots__ = ("amount", "unit")
    amount: float
    unit: str

    def __new__(cls, number: float, amount: float, unit: str) -> Given:
        """Return a number in SI that was given as an amount of a unit."""
        found = super().__new__(cls, number)
        found.amount, found.unit = amount, unit
        return found

    def __reduce__(self) -> tuple[Any, ...]:
        return Given, (float(self), self.amount, self.unit)

    @property
    def text(self) -> str:
        """The text that gives the same number, to the last bit."""
        return f"{self.amount!r} {self.unit}"


def as_given(number: float, amount: float, unit: str, si: str) -> float:
    """Return a number (in `si`) that remembers its unit, if that is one in which results are to be shown.

    Units that differ from SI by a prefix are not: results have prefixes of their own. A torque in kN m is one, because drillers
    read nothing else.
    """
    if si in ("1", "s") or " or " in si or _CALENDAR.search(unit):
        return number
    size = si_factor(unit, si)
    is_metric = size in _TENS and not (si == TORQUE or _TRADES.search(unit))
    return number if size == 1 or is_metric else Given(number, amount, unit)


def column_given(numbers: list[float], unit: str, si: str) -> list[float]:
    """Return the numbers (in `si`) of a column that was given in a unit; one of them remembers it, for all."""
    if si == "1":
        return numbers  # its unit may be a sign, as in "friction (-)"
    with suppress(InputError):
        size = float(si_factor(unit, si))
        for i, number in enumerate(numbers):
            near = number / size
            tried = (near, math.nextafter(near, math.inf), math.nextafter(near, -math.inf))
            same = (one for one in tried if to_si(one, unit, si) == number)
            amount = next(same, None) if number else None
            if amount is not None:
                return [*numbers[:i], as_given(number, amount, unit, si), *numbers[i + 1 :]]
    return numbers


def display_name(unit: str, si: str) -> str:
    """Return a unit as it is shown: as it was given, but for rpm and kN m, which have many spellings."""
    if si == "rad/s" and si_factor(unit, si) == si_factor("rpm", si):
        return "rpm"
    return re.sub(r"N\s*[.·⋅*-]?\s*m$", "N m", " ".join(unit.split())) if si == TORQUE else " ".join(unit.split())


@contextmanager
def shown_in(units: Units) -> Iterator[None]:
    """Show results in these units until the `with` block ends, in this thread."""
    token = _SHOWN.set(units)
    try:
        yield
    finally:
        _SHOWN.reset(token)


def show_in(units: Units) -> None:
    """Show results in these units from now on, in this thread: for a command, whose work is about one problem."""
    _SHOWN.set(units)


def preferred(si: str, largest: float | None = None) -> tuple[str, float] | None:
    """Return the unit in which results in `si` are shown, if one was given that suits numbers up to `largest` (SI)."""
    found = _SHOWN.get().get(si)
    if found is None or (largest and not LEAST * found[1] <= largest < MOST * found[1]):
        return None
    return found
