"""A view as one block of bytes, because a browser takes one message much faster than one for each of some fifty columns."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any

import numpy as np

from stickslip.explorer.page.view import View

STEP = 8
"""Numbers begin at multiples of so many bytes, as arrays in a browser must."""


def view_bytes(view: View, headings: Mapping[str, str]) -> bytes:
    """Return a view, with the heading of each panel as HTML, as `readView` in assets/view.js takes it.

    The block begins with the length of a text (8 bytes), and the text, which is JSON. After it follow the numbers: the columns in
    double precision, and images in single precision.
    """
    arrays: list[bytes] = []
    columns = {
        source: {name: _placed(values, arrays) for name, values in columns.items()} for source, columns in view.columns.items()
    }
    content = {
        "columns": columns,
        "limits": view.limits,
        "labels": view.labels,
        "headings": dict(headings),
        "hidden": sorted(view.hidden),
        "fastest": view.fastest or 1.0,
        "facts": view.facts,
    }
    text = _padded(json.dumps(content, allow_nan=False, separators=(",", ":")).encode("ascii"), b" ")
    return b"".join((len(text).to_bytes(STEP, "little"), text, *arrays))


def _placed(values: Any, arrays: list[bytes]) -> Any:
    """Add the numbers of a column to the block, and return where they are: `at` (bytes) and `length`, for an image its `shape`."""
    if isinstance(values, list) and any(np.ndim(one) for one in values):
        return [_placed(one, arrays) for one in values]
    found = np.asarray(values)
    at = sum(map(len, arrays))
    is_image = found.ndim == 2
    arrays.append(_padded(found.astype("<f4" if is_image else "<f8").tobytes(), b"\0"))
    return {"at": at, "shape": list(found.shape)} if is_image else {"at": at, "length": found.size}


def _padded(content: bytes, filling: bytes) -> bytes:
    return content + filling * (-len(content) % STEP)
