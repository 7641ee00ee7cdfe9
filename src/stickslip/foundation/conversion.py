"""Convert what a user gives for a physical number to SI: a number, a text with a unit, or a quantity of the library pint."""

from __future__ import annotations

import math
from collections.abc import Collection, Sequence
from decimal import Decimal
from typing import Any, Protocol, TypeVar

import numpy as np
from numpy.typing import NDArray

from stickslip.foundation.arguments import as_float, is_number, shown
from stickslip.foundation.errors import InputError
from stickslip.foundation.given import as_given
from stickslip.foundation.units import LONGEST_TEXT, split_quantity, to_si

LARGEST_INTEGER = 10**300
"""Convert a whole number to a float up to this magnitude."""
ONE_UNIT = 1e-12
"""Definitions of a unit in two libraries that differ by less than this (relative) count as the same."""
NO_UNIT = "dimensionless"
"""Name of the unit of a pure number in pint."""


class WithUnit(Protocol):
    """A quantity of pint, or whatever has the same attributes: a number or an array with a unit. pint need not be installed."""

    @property
    def magnitude(self) -> Any:
        """The number, or the array of numbers."""
        ...

    @property
    def units(self) -> Any:
        """The unit; formatted with the code D it is a text such as "meter / second"."""
        ...

    def to(self, units: Any) -> Any:
        """Return the quantity in another unit."""
        ...


_Read = TypeVar("_Read", covariant=True)
_Given = TypeVar("_Given", contravariant=True)


class Converted(Protocol[_Read, _Given]):
    """A field that is given in one type and read in another. It exists in annotations only.

    For a field with this annotation and a value (`quantity`, `declare`), type checkers take the type of the argument of a dataclass
    from `__set__` and that of the attribute from `__get__`. At run time fields are plain attributes, which `check_fields` has
    converted. With a union of types instead, every formula that reads a field would have to assert that it is a float.
    """

    def __get__(self, owner: Any, kind: Any = None) -> _Read: ...

    def __set__(self, owner: Any, value: _Given) -> None: ...


Number = Converted[float, float | str | WithUnit]
"""Annotation of a field that is a float in SI, and may be given as a text with a unit or as a quantity of pint."""
OptionalNumber = Converted[float | None, float | str | WithUnit | None]
"""Annotation of a field that is such a number or None."""
Numbers = Converted[Sequence[float], Sequence[float | str | WithUnit] | NDArray[Any] | WithUnit]
"""Annotation of a field that is a series of such numbers."""
OptionalNumbers = Converted[Sequence[float] | None, Sequence[float | str | WithUnit] | WithUnit | None]
"""Annotation of a field that is such a series or None."""


def has_unit(value: Any) -> bool:
    """Return True for a quantity of pint; a class is none."""
    return hasattr(value, "magnitude") and hasattr(value, "units") and not isinstance(value, type)


def to_number(value: Any, unit: str, infinite: Collection[str] = ()) -> float:
    """Return what a user gave for a number in `unit` (SI, "1" for a pure number, "Pa or N" for one of several) as a float.

    `infinite` has the texts that stand for infinity. Raises InputError with a message that says what was given and why it is
    refused, and is meant to follow "must be ..., got ".
    """
    if type(value) is np.ndarray and value.ndim == 0:  # no subclass: those of other libraries may carry a unit
        value = value.item()
    if isinstance(value, str):
        return math.inf if value in infinite else _from_text(value, unit)
    if has_unit(value):
        if np.ndim(value.magnitude) != 0 or isinstance(value.magnitude, bool | complex | str):
            raise InputError(shown(value))
        try:
            return float(without_unit(value, unit))
        except InputError as error:
            raise InputError(f"{as_text(value)}: {error}") from None
    if not (is_number(value) or (isinstance(value, Decimal) and not value.is_snan())):
        raise InputError(shown(value))
    if isinstance(value, int) and abs(value) > LARGEST_INTEGER:
        raise InputError("a whole number beyond 1e300")
    return as_float(value)


def _from_text(text: str, unit: str) -> float:
    parts = split_quantity(text)
    if unit == "1" or parts is None:
        raise InputError(f"{shown(text)}{_hint(text)}")
    try:
        return float(_in_one_of(parts[0], parts[1], unit))
    except InputError as error:
        raise InputError(f"{shown(text)}: {error}") from None


def remembered(value: Any, number: float, unit: str) -> float:
    """Return a number (in `unit`, SI) that `to_number` read from a value; it remembers a unit in which results are to be shown."""
    if not isinstance(value, str) and not has_unit(value):
        return number
    parts = split_quantity(value if isinstance(value, str) else as_text(value))
    if parts is None or (has_unit(value) and not _is_same(*parts, number, unit)):
        return number
    return as_given(number, *parts, unit)


def _is_same(amount: float, written: str, number: float, unit: str) -> bool:
    """Return True if an amount of a unit is a number (in `unit`) here, too: another registry may define its units otherwise."""
    try:
        return to_si(amount, written, unit) == number
    except InputError:
        return False


def unit_among(value: Any, units: str) -> str:
    """Return the unit of "m/s or m/s^2 or Pa or N" that fits a text or a quantity of pint; "" for anything else."""
    parts = split_quantity(value) if isinstance(value, str) else (1.0, _name_of(value.units)) if has_unit(value) else None
    for unit in units.split(" or "):
        try:
            if parts:
                to_si(*parts, unit)
                return unit
        except InputError:
            continue
    return ""


def _in_one_of(number: Any, unit: str, wanted: str) -> Any:
    """Convert to the first of the units "Pa or N" to which `unit` converts. Raises InputError that names both, or the last one."""
    *others, last = wanted.split(" or ")
    for si in others:
        try:
            return to_si(number, unit, si)
        except InputError:
            continue
    try:
        return to_si(number, unit, last)
    except InputError as error:
        if len(others) != 1:  # a longer list is not said twice in a message
            raise
        raise InputError(str(error).replace(f"does not convert to {last}", f"does not convert to {wanted}")) from None


def _hint(text: str) -> str:
    if len(text) > LONGEST_TEXT:
        return f": longer than {LONGEST_TEXT} characters"
    from stickslip.foundation.meant import probably_meant  # patterns that only a mistyped number needs

    if meant := probably_meant(text):
        return f": write {meant}"
    try:
        float(text)
    except ValueError:
        return ""
    return ": write a number without quotes"


def without_unit(value: Any, unit: str) -> Any:
    """Return the number, or the array of numbers, of a quantity of pint in `unit`. Raises InputError if it does not convert.

    A text with the same unit gives the same bits, unless the quantity's own registry defines the unit differently: its definition
    then counts.
    """
    own = _name_of(value.units)
    try:
        magnitude: Any = np.asarray(value.magnitude, float)[()]
    except (TypeError, ValueError):
        raise InputError(f"{shown(value)} in {own}") from None
    if own == NO_UNIT and unit == "1":
        return magnitude
    wanted = NO_UNIT if unit == "1" else unit
    by_registry = _by_registry(value, wanted)
    try:
        exact = _in_one_of(magnitude, own, wanted)
    except InputError:
        if by_registry is None:
            raise
        return by_registry
    return exact if by_registry is None or np.allclose(exact, by_registry, rtol=ONE_UNIT, atol=0.0, equal_nan=True) else by_registry


def as_text(value: WithUnit) -> str:
    """Return a quantity of pint as a text with a unit, such as "0.001 meter / second". Raises InputError for one of an array."""
    if np.ndim(value.magnitude) != 0:
        raise InputError(f"{shown(value)} of an array")
    return f"{as_float(value.magnitude)!r} {_name_of(value.units)}"


def _name_of(units: Any) -> str:
    return f"{units:D}".removeprefix("1 ")  # pint writes "1 / meter", of which our texts have "/ meter"


def _by_registry(value: Any, wanted: str) -> Any:
    """Return the number in the wanted unit as the quantity's own registry converts it; None if it does not."""
    for unit in wanted.split(" or "):
        try:
            return np.asarray(value.to(unit).magnitude, float)[()]
        except Exception:  # a registry raises errors of its own, and of any Python type
            continue
    return None
