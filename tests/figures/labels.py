"""The labels of a figure, and whether they name a unit."""

from __future__ import annotations

import re

from matplotlib.figure import Figure

import stickslip as ss

SIZES = {"year": ss.YEAR, "day": 86_400.0, "s/m": 1.0} | {
    prefix + unit: size
    for unit in ("s", "m", "m/s", "Pa", "N", "J", "J/m²")
    for prefix, size in {"": 1.0, "T": 1e12, "G": 1e9, "M": 1e6, "k": 1e3, "m": 1e-3, "µ": 1e-6, "n": 1e-9}.items()
}
"""Size in SI units of each unit that a label may name."""
UNIT = re.compile(rf"\(({'|'.join(map(re.escape, SIZES))})\)$")


def labels(figure: Figure) -> list[str]:
    """Return the axis labels that are shown."""
    return [text for axes in figure.axes if axes.axison for text in (axes.get_xlabel(), axes.get_ylabel()) if text]


def has_unit(text: str) -> bool:
    """Return True if a label ends with a unit, or names a number without one."""
    return bool(UNIT.search(text)) or text.startswith("friction coefficient")


def size_of(text: str) -> float:
    """Return the size, in SI units, of the unit that a label names."""
    found = UNIT.search(text)
    assert found is not None, text
    return SIZES[found.group(1)]
