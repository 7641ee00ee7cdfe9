"""What the panels show of one answer, as small as a page without Python needs it: columns in whole numbers of 8 or 16 bits."""

from __future__ import annotations

import json
import zlib
from base64 import b64encode
from collections.abc import Mapping
from typing import Any

import numpy as np

from stickslip.explorer.page.view import View

SHORT = 8
"""Columns of at most this many numbers are written as they are."""
LEVELS = {8: 2**8 - 2, 16: 2**16 - 2}
"""The largest whole number of a packed column by its bits; the one after it stands for NaN."""
COARSE = {"velocity", "stress"}
"""Images that are only drawn in colours, for which 8 bits are enough."""


def packed_view(view: View) -> dict[str, Any]:
    """Return a view as tables and lists for JSON, which `static.js` unpacks."""
    return {
        "columns": {source: packed_columns(columns) for source, columns in view.columns.items()},
        "limits": view.limits,
        "labels": view.labels,
        "hidden": sorted(view.hidden),
        "fastest": view.fastest or 1.0,
        "facts": view.facts,
    }


def packed_columns(columns: Mapping[str, Any]) -> dict[str, Any]:
    """Return the columns of one source for JSON."""
    return {name: packed(values, 8 if name in COARSE else 16) for name, values in columns.items()}


def packed(values: Any, bits: int = 16) -> Any:
    """Return one column for JSON: a list if it is short or holds lines, otherwise whole numbers in base64 with their range.

    An image, the only array in a list, also has its shape. The error is at most half a step of the range: 1e-5 of it with 16 bits,
    0.2 % with 8.
    """
    values = list(values)
    if len(values) == 1 and np.ndim(values[0]) == 2:
        return _quantised(np.asarray(values[0], float), bits) | {"shape": list(np.shape(values[0]))}
    if any(np.ndim(one) for one in values):
        return [_numbers(np.asarray(one, float)) for one in values]
    found = np.asarray(values, float)
    return _numbers(found) if found.size <= SHORT else _quantised(found, bits)


def _numbers(values: Any) -> list[float | None]:
    return [None if number != number else float(f"{number:.7g}") for number in values.tolist()]


def _quantised(values: Any, bits: int) -> dict[str, Any]:
    known = values[np.isfinite(values)]
    low, high = (float(known.min()), float(known.max())) if known.size else (0.0, 0.0)
    scale = LEVELS[bits] / (high - low) if high > low else 0.0
    whole = np.where(np.isfinite(values), np.rint((values - low) * scale), LEVELS[bits] + 1)
    text = b64encode(whole.astype(f"<u{bits // 8}").tobytes()).decode("ascii")
    return {"bits": bits, "low": low, "high": high, "whole": text}


def script(name: str, number: int, content: Any) -> str:
    """Return a script that hands some content to a function: a page that is opened from a disk may read no other files."""
    text = json.dumps(content, allow_nan=False, separators=(",", ":"))
    return f'{name}({number},"{b64encode(zlib.compress(text.encode(), 9)).decode("ascii")}")\n'
