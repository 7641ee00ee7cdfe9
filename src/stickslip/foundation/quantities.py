"""Physical quantities as dataclass fields: the unit, meaning and range of each are declared once, with the field.

Laws and bodies check their values against this declaration; scenarios, `stickslip new` and the documentation read it.
"""

from __future__ import annotations

import dataclasses
import math
import numbers
from collections.abc import Collection
from dataclasses import dataclass
from typing import Any

from stickslip.foundation.errors import InputError

LARGEST_WHOLE = 16
"""Largest magnitude of a whole-numbered quantity; such quantities are exponents."""
LARGEST, SMALLEST = 1e50, 1e-50
"""Largest magnitude of a quantity, and its smallest distance from an exclusive lower bound (both in SI units).

Within these limits products of several quantities neither overflow nor underflow.
"""


@dataclass(frozen=True)
class Quantity:
    """Unit (SI), meaning and allowed range of a number.

    Parameters
    ----------
    unit : str
        SI unit, "1" for a pure number.
    meaning : str
        Description for people.
    above, at_least : float, optional
        Exclusive and inclusive lower bound, in `unit`.
    infinite : bool
        If True, infinite values and magnitudes above `LARGEST` are allowed.
    whole : bool
        If True, only whole numbers up to `LARGEST_WHOLE` in magnitude are allowed, such as an exponent. In a friction law such a
        number is written into the formula and is not a parameter of it.
    """

    unit: str
    meaning: str
    above: float | None = None
    at_least: float | None = None
    infinite: bool = False
    whole: bool = False

    def check(self, owner: str, name: str, value: Any) -> float:
        """Return the value as a float. Raises InputError, which names owner and field, if it is not allowed."""
        where = f"{owner}: {name}"
        if isinstance(value, bool) or not isinstance(value, numbers.Real):
            raise InputError(f"{where} must be a number in {self.label}, got {value!r}")
        number = as_float(value)
        if math.isnan(number) or (math.isinf(number) and not self.infinite):
            raise InputError(f"{where} must be finite, got {number}")
        if self.whole and not (number.is_integer() and abs(number) <= LARGEST_WHOLE):
            raise InputError(f"{where} must be a whole number up to {LARGEST_WHOLE}, got {number:g}")
        if self.above is not None and not number > self.above:
            raise InputError(f"{where} must be greater than {self.above:g} {self.label}, got {number:g}")
        if self.at_least is not None and not number >= self.at_least:
            raise InputError(f"{where} must be at least {self.at_least:g} {self.label}, got {number:g}")
        if not self.infinite and abs(number) > LARGEST:
            raise InputError(f"{where} must lie within {LARGEST:g} {self.label}, got {number:g}")
        if self.above is not None and number < self.above + SMALLEST:
            raise InputError(f"{where} must be at least {self.above + SMALLEST:g} {self.label}, got {number:g}")
        return number

    @property
    def label(self) -> str:
        """Return the unit as it is shown to people: "(a pure number)" in place of "1"."""
        return "(a pure number)" if self.unit == "1" else self.unit


def as_float(value: Any) -> float:
    """Return a number as a float; an integer that is too large for a float becomes infinite, with its sign."""
    try:
        return float(value)
    except OverflowError:
        return math.inf if value > 0 else -math.inf


def quantity(
    unit: str,
    meaning: str,
    *,
    above: float | None = None,
    at_least: float | None = None,
    infinite: bool = False,
    whole: bool = False,
    default: Any = dataclasses.MISSING,
) -> Any:
    """Declare a dataclass field that holds a physical quantity in SI units.

    Parameters
    ----------
    unit, meaning, above, at_least, infinite, whole
        Fields of the `Quantity` that describes the field.
    default : float or None, optional
        Default value of the field; with None the field is optional.

    Returns
    -------
    dataclasses.Field
        Field with the `Quantity` in its metadata.
    """
    declared = Quantity(unit, meaning, above=above, at_least=at_least, infinite=infinite, whole=whole)
    return dataclasses.field(default=default, metadata={"quantity": declared})


def quantities_of(kind: type) -> dict[str, Quantity]:
    """Return the quantities that a law or body declares, keyed by field name."""
    return {f.name: f.metadata["quantity"] for f in dataclasses.fields(kind) if "quantity" in f.metadata}


def check_quantities(owner: Any, but: Collection[str] = ()) -> None:
    """Check the declared quantities of a frozen dataclass, except those in `but`, and store them as floats.

    A value of None is left as it is if None is the default of the field. Raises InputError for a value that is not allowed.
    """
    optional = {f.name for f in dataclasses.fields(owner) if f.default is None}
    for name, declared in quantities_of(type(owner)).items():
        value = getattr(owner, name)
        if name in but or (value is None and name in optional):
            continue
        object.__setattr__(owner, name, declared.check(type(owner).__name__, name, value))
