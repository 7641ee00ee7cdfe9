"""Exact factors of the units that scenarios use most, so that these need no library of units, which takes half a second to start.

Factors and dimensions are those of pint (`tests/test_units.py` compares every name); what is not here is left to pint.
"""

from __future__ import annotations

import re
from fractions import Fraction

Dimensions = dict[str, int]
"""Powers of the base dimensions of a unit, by their names in pint; a dimension with the power 0 is left out."""

_NAME = r"[A-Za-zµ][A-Za-zµ_]*"
_FACTOR = rf"{_NAME}(?:\s*(?:\^|\*\*)\s*-?[1-9])?"
UNIT = rf"(?:/\s*)?{_FACTOR}(?:\s*[*/ ]\s*{_FACTOR})*"
"""Grammar of a unit: names with small powers; a stroke applies to the next name only."""
_ONE_FACTOR = re.compile(rf"(?P<stroke>/?)\s*(?P<name>{_NAME})(?:\s*(?:\^|\*\*)\s*(?P<power>-?[1-9]))?")
_WHOLE = re.compile(rf"1?\s*{UNIT}\s*")
_BASES = ("[length]", "[mass]", "[time]")
_PREFIXES = {
    **{"p": -12, "n": -9, "u": -6, "µ": -6, "m": -3, "c": -2, "d": -1, "h": 2, "k": 3, "M": 6, "G": 9, "T": 12},
    **{"pico": -12, "nano": -9, "micro": -6, "milli": -3, "centi": -2, "kilo": 3, "mega": 6, "giga": 9, "tera": 12},
}
"""Powers of ten."""
_SYMBOLS = {
    "m": (1, (1, 0, 0)),
    "g": (1, (0, 1, 0)),
    "s": (1, (0, 0, 1)),
    "N": (1000, (1, 1, -2)),
    "Pa": (1000, (-1, 1, -2)),
    "J": (1000, (2, 1, -2)),
    "W": (1000, (2, 1, -3)),
    "Hz": (1, (0, 0, -1)),
}
"""Symbols that take a prefix: factor to m, g and s, as in pint, and powers of length, mass and time."""
_NAMES = {
    **{"meter": "m", "metre": "m", "gram": "g", "second": "s", "newton": "N", "pascal": "Pa", "joule": "J", "watt": "W"},
    **{"meters": "m", "metres": "m", "grams": "g", "seconds": "s", "newtons": "N", "pascals": "Pa", "joules": "J", "watts": "W"},
    "hertz": "Hz",
}
"""Names that take a prefix that is a name, and their symbols."""
_OTHERS = {
    **dict.fromkeys(("min", "minute", "minutes"), (60, (0, 0, 1))),
    **dict.fromkeys(("h", "hr", "hour", "hours"), (3600, (0, 0, 1))),
    **dict.fromkeys(("d", "day", "days"), (86_400, (0, 0, 1))),
    **dict.fromkeys(("week", "weeks"), (604_800, (0, 0, 1))),
    **dict.fromkeys(("a", "yr", "year", "years"), (31_557_600, (0, 0, 1))),
    **dict.fromkeys(("t", "tonne", "tonnes"), (1_000_000, (0, 1, 0))),
    "bar": (100_000_000, (-1, 1, -2)),
    "mbar": (100_000, (-1, 1, -2)),
    "kbar": (100_000_000_000, (-1, 1, -2)),
}
"""Units that are not taken apart into a prefix and a symbol. A year is the Julian one."""


def _table() -> dict[str, tuple[Fraction, tuple[int, ...]]]:
    """Return every name with what `UNITS` says about it."""
    symbols = {symbol: symbol for symbol in _SYMBOLS}
    names = {"": symbols | _NAMES}
    names |= {prefix: symbols if len(prefix) == 1 else _NAMES for prefix in _PREFIXES}
    table: dict[str, tuple[Fraction, tuple[int, ...]]] = {
        name: (Fraction(factor), powers) for name, (factor, powers) in _OTHERS.items()
    }
    for prefix, those in names.items():
        scale = Fraction(10) ** _PREFIXES.get(prefix, 0)
        table |= {prefix + name: (scale * _SYMBOLS[symbol][0], _SYMBOLS[symbol][1]) for name, symbol in those.items()}
    return table


UNITS = _table()
"""Factor to m, g and s, and powers of length, mass and time, of each name."""


def tabulated(unit: str) -> tuple[Fraction, Dimensions] | None:
    """Return the factor of a unit to m, g and s and its dimensions, or None if it is not made of names of this table alone."""
    factors = list(_ONE_FACTOR.finditer(unit)) if _WHOLE.fullmatch(unit) else []
    if not factors or any(found["name"] not in UNITS for found in factors):
        return None
    total, sums = Fraction(1), [0, 0, 0]
    for found in factors:
        factor, powers = UNITS[found["name"]]
        power = int(found["power"] or 1) * (-1 if found["stroke"] else 1)
        total *= factor**power
        sums = [summed + power * one for summed, one in zip(sums, powers, strict=True)]
    return total, {base: power for base, power in zip(_BASES, sums, strict=True) if power}
