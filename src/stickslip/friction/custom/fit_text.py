"""Show results of fits and of smoothing as text and in notebooks."""

from __future__ import annotations

import math
from collections.abc import Sequence

from stickslip.foundation.formatting import html_table

Row = tuple[str, str, str]
"""Name, value and unit or meaning, as text."""


def with_uncertainty(value: float, uncertainty: float | None) -> str:
    """Return a value with the digits that its standard uncertainty leaves, and the uncertainty with two digits.

    Without an uncertainty the value has six digits.
    """
    if uncertainty is None or not math.isfinite(uncertainty):
        return f"{value:.6g}"
    if uncertainty < 1e-12 * abs(value) or uncertainty == 0.0:
        return f"{value:.10g} ± {uncertainty:.1g}"
    size = max(abs(value), uncertainty)
    digits = min(max(2 + math.floor(math.log10(size)) - math.floor(math.log10(uncertainty)), 2), 15)
    if 1e-4 <= size < 1e6:
        decimals = max(1 - math.floor(math.log10(uncertainty)), 0)
        return f"{value:.{decimals}f} ± {uncertainty:.{decimals}f}"
    return f"{value:.{digits - 1}e} ± {uncertainty:.1e}"


def text_of(title: str, rows: Sequence[Row], notes: Sequence[str]) -> str:
    """Return a result as lines of text."""
    names, values = (max((len(row[i]) for row in rows), default=0) for i in (0, 1))
    lines = [f"  {name:<{names}}  {value:<{values}}  {meaning}".rstrip() for name, value, meaning in rows]
    return "\n".join([title, *lines, *(f"  note: {note}" for note in notes)])


def html_of(title: str, rows: Sequence[Row], notes: Sequence[str]) -> str:
    """Return a result as HTML for notebooks."""
    return html_table(title, [*rows, *(("note", note) for note in notes)])
