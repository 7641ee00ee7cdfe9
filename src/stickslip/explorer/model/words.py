"""Quantities as they stand in the sentences of the explorer: a few digits, and the unit in which they are readable."""

from __future__ import annotations

from stickslip.foundation.formatting import brief

DIGITS = 4
"""Number of significant digits."""


def short(value: float, unit: str) -> str:
    """Return a quantity (SI) briefly, such as "2.721 m"."""
    return brief(float(value), unit, DIGITS)


def several(count: int, thing: str) -> str:
    """Return a number of things: "no pulse", "1 pulse", "3 pulses"."""
    return f"{count or 'no'} {thing}{'' if count in (0, 1) else 's'}"
