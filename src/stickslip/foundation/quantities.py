"""Physical quantities as dataclass fields: unit, meaning and range stated once, where the field is declared.

Laws and bodies check themselves from it, and scenarios, `stickslip new` and the documentation read it.
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
"""Largest whole quantity: exponents."""
LARGEST, SMALLEST = 1e50, 1e-50
"""Sizes (SI) between which quantities lie: products of several of them neither overflow nor vanish."""


@dataclass(frozen=True)
class Quantity:
    """Unit (SI), meaning and allowed range of a number."""

    unit: str
    meaning: str
    above: float | None = None
    at_least: float | None = None
    infinite: bool = False
    whole: bool = False
    """Only whole numbers, such as an exponent; in a friction law it enters the formula as a number, not as a parameter."""

    def check(self, owner: str, name: str, value: Any) -> float:
        """Return the value as a float, or raise InputError naming owner and field."""
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
        """The unit as it is shown to people: a pure number shows nothing."""
        return "(a pure number)" if self.unit == "1" else self.unit


def as_float(value: Any) -> float:
    """Return a number as a float: a whole number that is too large for one is infinite."""
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
    """Declare a dataclass field that holds a physical quantity in SI."""
    declared = Quantity(unit, meaning, above=above, at_least=at_least, infinite=infinite, whole=whole)
    return dataclasses.field(default=default, metadata={"quantity": declared})


def quantities_of(kind: type) -> dict[str, Quantity]:
    """The quantities that a law or body declares, by field name."""
    return {f.name: f.metadata["quantity"] for f in dataclasses.fields(kind) if "quantity" in f.metadata}


def check_quantities(owner: Any, but: Collection[str] = ()) -> None:
    """Check the declared quantities of a frozen dataclass, but some, and store them as floats; None stays where it is default."""
    optional = {f.name for f in dataclasses.fields(owner) if f.default is None}
    for name, declared in quantities_of(type(owner)).items():
        value = getattr(owner, name)
        if name in but or (value is None and name in optional):
            continue
        object.__setattr__(owner, name, declared.check(type(owner).__name__, name, value))
