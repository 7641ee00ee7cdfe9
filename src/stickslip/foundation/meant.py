"""What is probably meant by a text that is no number with one unit: "10 000 m", "6 1/8 in", "1 h 30 min", '5"'."""

from __future__ import annotations

import re
from collections.abc import Callable
from fractions import Fraction

from stickslip.foundation.errors import InputError
from stickslip.foundation.units import LONGEST_TEXT, UNIT, si_factor, split_quantity

# patterns are compiled when a text is first mistyped
_COMMA = r"(?P<whole>[+-]?[\d_]+),(?P<part>\d+)(?P<rest>(?:[eE][+-]?\d+)?(?:\s*[^\d\s,][^,]*)?)"
"""A number with a decimal comma, and what may follow it."""
_GROUPED = r"(?P<number>[+-]?\d{1,3}(?P<mark>[\s'’_,])\d{3}(?:(?P=mark)\d{3})*(?:\.\d+)?)(?P<rest>\s*[^\d\s].*)?"
"""A number whose thousands are set apart, all by the same mark."""
_FRACTION = r"(?:(?P<whole>\d{1,6})[\s-]+)?(?P<above>\d{1,4})/(?P<below>[1-9]\d{0,3})(?P<rest>\s*[^\d\s/].*)?"
_MARK = r"(?<=\d)\s*(''|['\"′″])(?!\d{3})"
"""The sign of feet or inches after a number; 10'000 is a number whose thousands are set apart."""
_MARKS = {"'": " ft", "′": " ft", '"': " in", "″": " in", "''": " in"}
_ONE = rf"\s*(?P<one>[\d.]+\s*(?:{UNIT}))(?=\s*\d|\s*$)"


def probably_meant(text: str) -> str | None:
    """Return how a text is written as a number with one unit, and what changes, as "'10.5 m', with a decimal point"; else None."""
    if len(text) > LONGEST_TEXT:
        return None
    named = re.sub(_MARK, lambda found: _MARKS[found[1]], text.strip())
    written = [f"{number!a}, {change}" for reading, change in _READINGS for number in (reading(named),) if number]
    if not written and named != text.strip():
        return f"{named!a}, with the name of the unit"
    return ", or ".join(written) or None


def decimal_point(text: str) -> str | None:
    """Return a text that begins with a number with a decimal comma, with a point in its place; None if it is no such text."""
    found = re.fullmatch(_COMMA, text.strip())
    return f"{found['whole']}.{found['part']}{found['rest']}" if found else None


def _joined(text: str) -> str | None:
    found = re.fullmatch(_GROUPED, text)
    return found["number"].replace(found["mark"], "") + (found["rest"] or "") if found else None


def _divided(text: str) -> str | None:
    found = re.fullmatch(_FRACTION, text)
    if found is None:
        return None
    number = float(int(found["whole"] or 0) + Fraction(int(found["above"]), int(found["below"])))
    return f"{number:.10g}{found['rest'] or ''}"


def _summed(text: str) -> str | None:
    """Return the sum of a text such as "5 ft 6 in", in the first of its units."""
    parts, place = [], 0
    while found := re.compile(_ONE).match(text, place):
        part = split_quantity(found["one"])
        if part is None:
            return None
        parts.append(part)
        place = found.end()
    if place < len(text) or len(parts) < 2:
        return None
    first = parts[0][1]
    try:
        return f"{sum(number * float(si_factor(unit, first)) for number, unit in parts):.10g} {first}"
    except InputError:
        return None


_READINGS: tuple[tuple[Callable[[str], str | None], str], ...] = (
    (decimal_point, "with a decimal point"),
    (_joined, "without marks between digits"),
    (_divided, "without a fraction"),
    (_summed, "in one unit"),
)
"""Functions that read what is no number with one unit, and what each changes; 10,500 is ten and a half to one reader, 10500 to
another."""
