"""The labels of a figure, and whether they name a unit."""

from __future__ import annotations

import re

from matplotlib.figure import Figure

UNIT = re.compile(r"\((m|m/s|s|year|MPa|Pa|TN|N)\)$")


def labels(figure: Figure) -> list[str]:
    """Return the axis labels that are shown."""
    return [text for axes in figure.axes if axes.axison for text in (axes.get_xlabel(), axes.get_ylabel()) if text]


def has_unit(text: str) -> bool:
    """Return True if a label ends with a unit, or names a number without one."""
    return bool(UNIT.search(text)) or text.startswith("friction coefficient")
