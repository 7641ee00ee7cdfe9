"""Conversion of text such as "10 km" to a number in SI units.

Only a number, unit names and small powers are accepted; nothing is evaluated. The units that scenarios use most have a table here,
with the exact factors and dimensions of pint (`tests/core/foundation/test_quantities.py` compares every name), because pint takes
half a second to start. All others are left to pint.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from fractions import Fraction
from functools import cache, lru_cache
from typing import Any

from stickslip.foundation.errors import InputError, nearest

LONGEST_TEXT = 64
"""Largest number of characters in a quantity; a limit is needed because units come from untrusted files."""
COMMON_UNITS = (
    *("m", "mm", "cm", "km", "s", "ms", "min", "hour", "day", "year", "kg", "tonne", "m/s", "m/year"),
    *("Pa", "kPa", "MPa", "GPa", "bar", "N", "kN", "MN", "GN", "kg/m^3", "g/cm^3", "N/m", "GN/m", "Pa s/m", "1/m", "s/m"),
    *("rad", "deg", "rad/s", "rpm", "kg m^2", "N m", "kN m", "N m s", "N m/rad"),
)
"""Units among which the nearest one to an unknown name is looked for; every unit of the unit library is accepted."""
Dimensions = dict[str, int]
"""Powers of the base dimensions of a unit, by their names in pint; a dimension with the power 0 is left out."""

_NAME_OF_UNIT = r"(?:%g|[A-Za-zµ][A-Za-zµ_]*(?:'s)?)"
_POWER = r"(?:\s*(?:\^|\*\*)\s*-?[1-9]|-?[1-9])"
_FACTOR = rf"{_NAME_OF_UNIT}{_POWER}?"
_PRODUCT = r"(?:\s*[*/ ]\s*|[.·⋅](?=[A-Za-zµ])|-(?=[A-Za-zµ]))"
UNIT = rf"(?:/\s*)?{_FACTOR}(?:{_PRODUCT}{_FACTOR})*"
"""Grammar of a unit: names with small powers, m^3, m3 or s-1, apart or joined as in kN.m and ft-lbf; a stroke applies to the next
name only."""
_ONE_FACTOR = re.compile(rf"(?P<stroke>/?)\s*(?P<name>{_NAME_OF_UNIT})(?:(?:\s*(?:\^|\*\*)\s*)?(?P<power>-?[1-9]))?")
_WHOLE = re.compile(rf"1?\s*{UNIT}\s*")
_RAISED = re.compile(r"(?<=[A-Za-zµ])⁻?[¹²³⁴⁵⁶⁷⁸⁹]")
"""A power as typesetters write it, after a name: N/mm² and s⁻¹, but no 10² m."""
_SIGNS = str.maketrans("μ−⁻¹²³⁴⁵⁶⁷⁸⁹", "µ--123456789")
_QUANTITY = re.compile(rf"\s*(?P<number>[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d{{1,3}})?)(?:\s+1(?=/)|\s*)(?P<unit>{UNIT})\s*")
_PER_TURN = re.compile(r"(Hz|hertz)(?![A-Za-z])")
"""A frequency: the unit library has it as 1/s, where drillers and turners mean turns per second."""
_PER_MINUTE = re.compile(r"/\s*min(?:utes?)?|min(?:\s*(?:\^|\*\*)\s*)?-1")
"""Without an angle: what turns is said to do so many turns, not radians, in a minute."""
_BASES = ("[length]", "[mass]", "[time]")
_PREFIXES = {
    **{"p": -12, "n": -9, "u": -6, "µ": -6, "m": -3, "c": -2, "d": -1, "h": 2, "k": 3, "M": 6, "G": 9, "T": 12},
    **{"pico": -12, "nano": -9, "micro": -6, "milli": -3, "centi": -2, "kilo": 3, "mega": 6, "giga": 9, "tera": 12},
}
"""Powers of ten."""
_PI = Fraction("3.1415926535897932384626433832795028841971693993751")
"""Pi as in pint."""
_INCH, _POUND, _GRAVITY = Fraction(254, 10_000), Fraction(45_359_237, 100_000), Fraction(980_665, 100_000)
"""In m, in g and in m/s^2."""
_SYMBOLS = {
    "rad": (1, (0, 0, 0)),
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
    **{"hertz": "Hz", "radian": "rad", "radians": "rad"},
}
"""Names that take a prefix that is a name, and their symbols."""
_OTHERS: dict[str, tuple[int | Fraction, tuple[int, ...]]] = {
    **dict.fromkeys(("micron", "microns"), (Fraction(1, 10**6), (1, 0, 0))),
    "sec": (1, (0, 0, 1)),
    **dict.fromkeys(("min", "minute", "minutes"), (60, (0, 0, 1))),
    **dict.fromkeys(("h", "hr", "hour", "hours"), (3600, (0, 0, 1))),
    **dict.fromkeys(("d", "day", "days"), (86_400, (0, 0, 1))),
    **dict.fromkeys(("week", "weeks"), (604_800, (0, 0, 1))),
    **dict.fromkeys(("a", "yr", "year", "years"), (31_557_600, (0, 0, 1))),
    **dict.fromkeys(("t", "tonne", "tonnes"), (1_000_000, (0, 1, 0))),
    "bar": (100_000_000, (-1, 1, -2)),
    "mbar": (100_000, (-1, 1, -2)),
    "kbar": (100_000_000_000, (-1, 1, -2)),
    **dict.fromkeys(("deg", "degree", "degrees"), (_PI / 180, (0, 0, 0))),
    **dict.fromkeys(("turn", "turns", "revolution", "revolutions"), (2 * _PI, (0, 0, 0))),
    "rpm": (_PI / 30, (0, 0, -1)),
    **dict.fromkeys(("ft", "foot", "feet"), (_INCH * 12, (1, 0, 0))),
    "kft": (_INCH * 12_000, (1, 0, 0)),
    **dict.fromkeys(("in", "inch", "inches"), (_INCH, (1, 0, 0))),
    **dict.fromkeys(("lb", "pound", "pounds"), (_POUND, (0, 1, 0))),
    "lbf": (_POUND * _GRAVITY, (1, 1, -2)),
    **dict.fromkeys(("klbf", "kip"), (1000 * _POUND * _GRAVITY, (1, 1, -2))),
    "psi": (_POUND * _GRAVITY / _INCH**2, (-1, 1, -2)),
    "ksi": (1000 * _POUND * _GRAVITY / _INCH**2, (-1, 1, -2)),
}
"""Units that are not taken apart into a prefix and a symbol. A year is the Julian one."""
_TORQUES = {"": 0, "m": -3, "da": 1, "k": 3, "M": 6, "G": 9}
"""Powers of ten of Nm, a torque: in the unit library, Nm is the fineness of yarn."""
SPELLINGS = {**dict.fromkeys(("rev", "revs", "r"), "turn"), **dict.fromkeys(("mic", "mics"), "micron"), "RPM": "rpm"}
"""What the trades write, and the name that is meant."""


def _table() -> dict[str, tuple[Fraction, tuple[int, ...]]]:
    """Return every name with what `TABLE_OF_UNITS` says about it."""
    symbols = {symbol: symbol for symbol in _SYMBOLS}
    names = {"": symbols | _NAMES}
    names |= {prefix: symbols if len(prefix) == 1 else _NAMES for prefix in _PREFIXES}
    table: dict[str, tuple[Fraction, tuple[int, ...]]] = {
        name: (Fraction(factor), powers) for name, (factor, powers) in _OTHERS.items()
    }
    for prefix, those in names.items():
        scale = Fraction(10) ** _PREFIXES.get(prefix, 0)
        table |= {prefix + name: (scale * _SYMBOLS[symbol][0], _SYMBOLS[symbol][1]) for name, symbol in those.items()}
    newton, (length, mass, time) = table["N"]
    table |= {f"{prefix}Nm": (newton * Fraction(10) ** power, (length + 1, mass, time)) for prefix, power in _TORQUES.items()}
    return table | {name: table[meant] for name, meant in SPELLINGS.items()}


TABLE_OF_UNITS = _table()
"""Factor to m, g and s, and powers of length, mass and time, of each name."""


def tabulated(unit: str) -> tuple[Fraction, Dimensions] | None:
    """Return the factor of a unit to m, g and s and its dimensions, or None if it is not made of names of this table alone."""
    factors = list(_ONE_FACTOR.finditer(unit)) if _WHOLE.fullmatch(unit) else []
    if not factors or any(found["name"] not in TABLE_OF_UNITS for found in factors):
        return None
    total, sums = Fraction(1), [0, 0, 0]
    for found in factors:
        factor, powers = TABLE_OF_UNITS[found["name"]]
        power = int(found["power"] or 1) * (-1 if found["stroke"] else 1)
        total *= factor**power
        sums = [summed + power * one for summed, one in zip(sums, powers, strict=True)]
    return total, {base: power for base, power in zip(_BASES, sums, strict=True) if power}


def plain_signs(text: str) -> str:
    """Return a text with the micro sign, a minus and powers as a keyboard has them: "10 μm" and "N/mm²" are copied from papers."""
    return _RAISED.sub(lambda found: found[0].translate(_SIGNS), text.replace("μ", "µ").replace("−", "-"))


def split_quantity(text: str) -> tuple[float, str] | None:
    """Return number and unit of a text such as "0.05 m/year", or None if the text is not of that form."""
    found = _QUANTITY.fullmatch(plain_signs(text)) if len(text) <= LONGEST_TEXT else None
    return (float(found["number"]), found["unit"]) if found else None


_ACCELERATIONS = {
    **dict.fromkeys(("g", "G", "g's", "G's"), _GRAVITY),
    "%g": _GRAVITY / 100,
    "mg": _GRAVITY / 1000,
    **dict.fromkeys(("gal", "Gal", "gals", "Gals"), Fraction(1, 100)),
    "mGal": Fraction(1, 100_000),
}
"""Units of acceleration whose names mean another thing elsewhere: g is also a gram, and pint's gal is a gallon."""
_LOGGED = (
    *("m", "mm", "um", "cm", "km", "ft", "kft", "in", "s", "sec", "ms", "min", "hr", "kg", "rad", "deg", "rpm", "rev"),
    *("N", "kN", "MN", "lb", "lbs", "lbf", "klb", "klbs", "klbf", "kip", "Nm", "kNm", "daNm"),
    *("Pa", "kPa", "MPa", "GPa", "bar", "psi", "ksi"),
)
_CAPITALS = {name.upper(): name for name in _LOGGED}
"""What a unit in capitals means, as old loggers write it, where it means nothing else: MPA is never a thousandth of a pascal."""
_OTHERWISE = {**{"lb": "lbf", "lbs": "lbf", "klb": "klbf", "klbs": "klbf"}, **dict.fromkeys(("mil", "mils"), "thou")}
"""What a name means where it does not convert: drillers weigh in pounds, as in ft-lb, and a mil is an angle or a length."""
_WEIGHED = {"g": "gf", "kg": "kgf", "t": "tf", **dict.fromkeys(("ton", "tons", "tonne", "tonnes"), "tf")}
"""The force that is the weight of a mass; it is not read by itself, as a mass may stand there by mistake."""


@lru_cache(maxsize=256)  # a page of the explorer reads the same units again at each move of a slider
def si_factor(unit: str, si: str) -> Fraction:
    """Return the exact factor that converts a value in `unit` to a value in `si`. A year is the Julian year of 31 557 600 s.

    Raises InputError for an unknown unit and for a unit of another dimension; the message is meant to follow the place of the
    fault.
    """
    if si == "m/s^2" and unit in _ACCELERATIONS:
        return _ACCELERATIONS[unit]
    unit = "rpm" if si == "rad/s" and _PER_MINUTE.fullmatch(unit) else unit
    if "rad" in si and (_PER_TURN.search(unit) or _PER_MINUTE.fullmatch(unit)):
        raise InputError(f"'{unit}' may be turns or radians per second: write rpm or rad/s")
    fault = InputError("")
    meant = dict.fromkeys((unit, in_small := _renamed(unit, _CAPITALS), _renamed(in_small, _OTHERWISE)))
    for text in sorted(meant, key=lambda one: tabulated(one) is None):  # those that need no unit library come first
        try:
            return _convert(text, si)
        except InputError as error:
            fault = error if text is unit else fault
    raise fault


def _renamed(unit: str, names: Mapping[str, str]) -> str:
    """Return a unit with other names for those that have one."""
    return _ONE_FACTOR.sub(lambda found: found[0].replace(found["name"], names.get(found["name"], found["name"])), unit)


def _convert(unit: str, si: str) -> Fraction:
    factor, dimensionality = _read_unit(unit, f"; write it like {si}")
    target, wanted = _read_unit(si)
    if dimensionality != wanted:
        weight = _WEIGHED.get(unit) if si == "N" else None
        raise InputError(f"'{unit}' does not convert to {si}" + (f": it is a mass; a weight is in {weight}" if weight else ""))
    return factor / target


def _read_unit(unit: str, hint: str = "") -> tuple[Fraction, dict[str, Any]]:
    """Return the factor of a unit to SI base units and its powers of dimensions, by name.

    Raises InputError for a unit that is unknown, and for one that cannot be read, with `hint` at the end of the message.
    """
    return tabulated(unit) or _looked_up(unit, hint)


def _looked_up(unit: str, hint: str) -> tuple[Fraction, dict[str, Any]]:
    import pint

    registry = _registry()
    try:
        parsed = registry.parse_units(_as_product(unit))  # the parser understands 1/m and m^3, but neither / m nor m3 nor kN.m
        for name in (one.removeprefix("delta_") for one in parsed._units):
            if name in registry._units and registry._units[name].is_logarithmic:
                raise pint.UndefinedUnitError(name)  # no factor converts decibels to SI units, although pint gives them one
        return Fraction(registry.get_root_units(parsed)[0]), dict(parsed.dimensionality)
    except pint.UndefinedUnitError as error:
        name = str(error.args[0])
        alike = [one for one in (*COMMON_UNITS, *TABLE_OF_UNITS) if one.casefold() == name.casefold()][:1]
        known = f"did you mean '{alike[0]}'?" if alike else nearest(name, COMMON_UNITS)
        examples = known if known.startswith("did") else "examples: km, s, year, kg, MPa, GN, kg/m^3, Pa s/m"
        raise InputError(f"'{name}' is not a unit; {examples}") from None
    except (pint.PintError, ValueError):  # ValueError for the unit "nan", from fractions
        raise InputError(f"'{unit}' is not a unit{hint}") from None


def _as_product(unit: str) -> str:
    """Return a unit of our grammar as the unit library reads it: "1*ft**1*lbf**1"; anything else as it is."""
    if not _WHOLE.fullmatch(unit):
        return unit
    factors = ((SPELLINGS.get(one["name"], one["name"]), one["power"] or "1", one["stroke"]) for one in _ONE_FACTOR.finditer(unit))
    return "1" + "".join(f"{stroke or '*'}{name}**{power}" for name, power, stroke in factors)


def to_si(number: float, unit: str, si: str) -> float:
    """Convert `number` from `unit` to `si`; 0.05 m/year gives 0.05 / 31557600 to the last digit. Raises as `si_factor` does."""
    factor = si_factor(unit, si)
    if max(factor.numerator, factor.denominator) < 2**53:
        return number * factor.numerator / factor.denominator
    return number * float(factor)


_BASE = {"[length]": "m", "[mass]": "kg", "[time]": "s"}
"""SI base unit of each dimension that a mechanical quantity can have, by its name in the unit library."""


def si_base(text: str) -> tuple[float, str]:
    """Return the number in SI units and the unit in powers of m, kg and s of a text: "1 mm/s" gives 0.001 and "m s^-1".

    Raises InputError for a text that is not a number with a unit made of whole powers of m, kg and s.
    """
    parts = split_quantity(text)
    if parts is None:
        raise InputError(
            f"{ascii(text)[:60]} is not a number with a unit" + (f" up to {LONGEST_TEXT} characters" * (len(text) > LONGEST_TEXT))
        )
    _, powers = _read_unit(parts[1])
    if not set(powers) <= set(_BASE) or any(power != int(power) or abs(power) > 9 for power in powers.values()):
        raise InputError(f"'{parts[1]}' is not made of whole powers of m, kg and s")
    named = sorted((_BASE[base], int(power)) for base, power in powers.items())
    si = " ".join(name if power == 1 else f"{name}^{power}" for name, power in named)
    return to_si(*parts, si), si


@cache
def _registry() -> Any:
    import pint  # takes half a second to load and to build, which only a unit that is not in the table should cost

    return pint.UnitRegistry(non_int_type=Fraction)
