"""Read what a user typed for a quantity, and show values of a file in messages."""

from __future__ import annotations

from typing import Any

from stickslip.foundation.quantities import Quantity


def read_typed(text: str, declared: Quantity, where: str, name: str) -> float:
    """Return in SI what a user typed, a number or a text with a unit. Raises InputError as `Quantity.check` does."""
    return declared.check(where, name, typed_number(text))


def typed_number(text: str) -> float | str:
    """Return a text as a number if it is one, otherwise the text without leading and trailing spaces."""
    try:
        return float(text)
    except ValueError:
        return text.strip()


def show(value: Any) -> str:
    """Return a value from a file as one short line that is safe to show: quoted, in ASCII, without control characters."""
    shown = ascii(value)
    return shown if len(shown) <= 60 else f"{shown[:57]}..."
