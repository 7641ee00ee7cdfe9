"""What the panels show of one answer, as plain numbers and texts: made in Python, shown by Python or by a page without it."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from html import escape
from typing import Any, Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

Columns = dict[str, Any]
LineStyle = Literal["line", "dash", "dot", "area", "ring", "scale"]


class LegendKey(NamedTuple):
    """One entry of a panel's legend: its text, the role of its colour, and how it is drawn."""

    text: str
    role: str
    style: LineStyle = "line"


@dataclass
class View:
    """All that changes on the page from one answer to the next, in the units shown.

    `columns` are those of each source of data, `limits` the ends of each axis that is not found from the data, `labels` the texts
    of the axes, `titles` and `keys` (legends) those of the panels. `hidden` names panels, renderers and axes that have nothing to
    show. `fastest` is the velocity at both ends of the colour scale; 0 if there is no image. `facts` are what the browser needs to
    move the cursor: units, marks, and how the body is drawn.
    """

    columns: dict[str, Columns] = field(default_factory=dict)
    limits: dict[str, tuple[float, float]] = field(default_factory=dict)
    labels: dict[str, str] = field(default_factory=dict)
    titles: dict[str, str] = field(default_factory=dict)
    keys: dict[str, tuple[LegendKey, ...]] = field(default_factory=dict)
    hidden: set[str] = field(default_factory=set)
    fastest: float = 0.0
    facts: dict[str, Any] = field(default_factory=dict)

    def add(self, other: View) -> None:
        """Take over the content of another view."""
        for name, columns in other.columns.items():
            self.columns[name] = self.columns.get(name, {}) | columns
        self.limits |= other.limits
        self.labels |= other.labels
        self.titles |= other.titles
        self.keys |= other.keys
        self.hidden |= other.hidden
        self.fastest = self.fastest or other.fastest
        self.facts |= other.facts


@dataclass(frozen=True)
class Units:
    """The units of an answer, chosen once for all panels that show the same quantity: name and size in SI."""

    time: tuple[str, float]
    near: tuple[str, float]
    """That of the time in the panels of slab and energy, which show only one event of a long run."""
    begin: float
    """Where that time begins (s); 0 if these panels show the whole run."""
    whole: bool
    slip: tuple[str, float]
    rate: tuple[str, float]
    log: bool
    """True if slip rate against time is drawn on a logarithmic axis."""
    stress: tuple[str, float]
    """That of traction and load against time."""
    offset: float
    """What is taken off traction and load against time, because they hardly change; 0 usually."""
    load: tuple[str, float]
    on_curve: tuple[str, float]
    """Those of load and slip rate on the contact's curve."""
    place: tuple[str, float]
    slip_unit: str = "m"
    """The SI unit of slip."""

    def nearby(self, seconds: Any) -> Any:
        """Return times (s) on the axis of the panels of slab and energy."""
        return (np.asarray(seconds, float) - self.begin) / self.near[1]


def axis_label(name: str, symbol: str, unit: str) -> str:
    """Return the text of an axis, such as "slip rate v (m/s)"."""
    text = f"{name} {symbol}".strip()
    return text if unit in ("", "1") else f"{text} ({unit})"


def limits(*values: Any, floor: float | None = None, share: float = 0.04) -> tuple[float, float]:
    """Return round limits around finite values, so that an axis keeps them while a number changes a little.

    `floor` is a lower limit that is kept if no value lies below it. `share` of the range is added on both sides at least.
    """
    together = np.concatenate([np.ravel(np.asarray(one, float)) for one in values]) if values else np.zeros(0)
    together = together[np.isfinite(together)]
    low, high = (float(together.min()), float(together.max())) if together.size else (0.0, 1.0)
    if floor is not None and low >= floor:
        low = floor
    if high - low <= 1e-12 * max(abs(low), abs(high)):
        middle = max(abs(high), 1e-300)
        low, high = low - 0.5 * middle, high + 0.5 * middle
    step = round_step((high - low) / 10.0)
    margin = share * (high - low)
    bottom = low if floor is not None and low == floor else step * math.floor((low - margin) / step)
    return bottom, step * math.ceil((high + margin) / step)


def round_step(size: float) -> float:
    """Return the largest of 1, 2 and 5 times a power of ten that is at most `size`."""
    power = 10.0 ** math.floor(math.log10(size))
    return next(one * power for one in (5.0, 2.0, 1.0) if one * power <= size * (1 + 1e-9))


def single(values: Any) -> NDArray[np.float32]:
    """Return values in single precision: enough for a picture, and half as much to send."""
    return np.ascontiguousarray(values, dtype=np.float32)


def plain(found: Mapping[str, Any]) -> dict[str, Any]:
    """Return columns as lists, with NaN as None, for JSON."""
    return {name: [None if x != x else x for x in np.asarray(values, float).tolist()] for name, values in found.items()}


def heading(title: str, keys: Sequence[LegendKey]) -> str:
    """Return the heading of a panel as HTML."""
    entries = "".join(
        f'<li><span class="sample {key.style}" style="--role: var(--{key.role})" aria-hidden="true"></span>{escape(key.text)}</li>'
        for key in keys
    )
    return f'<div class="heading"><h2>{escape(title)}</h2><ul role="list" aria-label="Legend">{entries}</ul></div>'


def headings_of(view: View, titles: Mapping[str, str]) -> dict[str, str]:
    """Return the heading of each panel as HTML; `titles` are used for panels without a heading in the view."""
    return {name: heading(view.titles.get(name, title), view.keys.get(name, ())) for name, title in titles.items()}


ALIGNMENT = 8
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
    return b"".join((len(text).to_bytes(ALIGNMENT, "little"), text, *arrays))


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
    return content + filling * (-len(content) % ALIGNMENT)
