"""Quantities in the sentences of the explorer: a few digits, and a readable unit."""

from __future__ import annotations

from stickslip.foundation.show import brief

DIGITS_IN_WORDS = 4
"""Number of significant digits."""


def short(value: float, unit: str) -> str:
    """Return a quantity (SI) briefly, such as "2.721 m"."""
    return brief(float(value), unit, DIGITS_IN_WORDS).replace(" um", " µm")


def several(count: int, thing: str) -> str:
    """Return a number of things: "no pulse", "one pulse", "3 pulses"."""
    return f"{ {0: 'no', 1: 'one'}.get(count, count) } {thing}{'' if count in (0, 1) else 's'}"
