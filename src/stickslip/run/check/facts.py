"""A fact about a scenario, as `stickslip check` shows it."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Fact:
    """A number with its unit, or a word, with its name and its meaning."""

    name: str
    value: float | str
    unit: str
    meaning: str
