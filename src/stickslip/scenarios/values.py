"""Read one value of a scenario, a number in SI or a text with a unit, and check it against the declaration of its field."""

from __future__ import annotations

import math
from typing import Any

from stickslip.foundation.errors import InputError
from stickslip.foundation.quantities import Quantity
from stickslip.foundation.units import LONGEST, split_quantity, to_si


def read_quantity(value: Any, declared: Quantity, where: str, name: str) -> float:
    """Return a value in SI. Raises InputError with the message "where: name must be ..., got ..."."""
    if declared.infinite and isinstance(value, str) and value in ("inf", "rigid"):
        return math.inf
    refusal = f"{where}: {name} must be {allowed(declared)}, got"
    if isinstance(value, str):
        return _read_text(value, declared, where, name, refusal)
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise InputError(f"{refusal} {show(value)}")
    if isinstance(value, int) and abs(value) > 10**300:
        raise InputError(f"{refusal} a whole number beyond 1e300")
    return declared.check(where, name, value)


def read_typed(text: str, declared: Quantity, where: str, name: str) -> float:
    """Return in SI what a user typed, a number or a text with a unit. Raises InputError as `read_quantity` does."""
    try:
        value: float | str = float(text)
    except ValueError:
        value = text.strip()
    return read_quantity(value, declared, where, name)


def _read_text(text: str, declared: Quantity, where: str, name: str, refusal: str) -> float:
    parts = split_quantity(text)
    if declared.unit == "1" or parts is None:
        raise InputError(f"{refusal} {show(text)}{_hint(text)}")
    try:
        number = to_si(*parts, declared.unit)
    except InputError as error:
        raise InputError(f"{refusal} {show(text)}: {error}") from None
    try:
        return declared.check(where, name, number)
    except InputError as error:
        raise InputError(f"{error} (from {show(text)})") from None


def _hint(text: str) -> str:
    if len(text) > LONGEST:
        return f": longer than {LONGEST} characters"
    try:
        float(text)
    except ValueError:
        return ""
    return ": write a number without quotes"


def allowed(declared: Quantity) -> str:
    """Return in words what may be given for a quantity."""
    plain = (
        "a number" if declared.unit == "1" else f'a number in {declared.unit} or a text with a unit such as "10 {declared.unit}"'
    )
    return f'{plain} (or "rigid")' if declared.infinite else plain


def describe(declared: Quantity) -> str:
    """Return the meaning, the unit and the range of a quantity as text for users."""
    bounds = []
    if declared.above is not None:
        bounds.append(f"above {declared.above:g}")
    if declared.at_least is not None:
        bounds.append(f"at least {declared.at_least:g}")
    return ", ".join([declared.meaning, "no unit" if declared.unit == "1" else f"in {declared.unit}", *bounds])


def show(value: Any) -> str:
    """Return a value from a file as one short line that is safe to show: quoted, in ASCII, without control characters."""
    shown = ascii(value)
    return shown if len(shown) <= 60 else f"{shown[:57]}..."
