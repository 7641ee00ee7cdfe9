"""Figure of a sweep as curves: a quantity over one varied key, and a curve for each value of a second."""

from __future__ import annotations

from typing import Any, Unpack

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.lines import Line2D
from numpy.typing import NDArray

from stickslip.extensions.sweeps.figures.varied import ScaledNumbers, ShownQuantity, names_of, scaled, shown
from stickslip.figures.panels import add_legend, count_ticks, finish, set_log_ticks
from stickslip.figures.sheet import one_panel
from stickslip.figures.style import BLUE, GREY, LINE_COLOURS, folded
from stickslip.foundation.arrays import Floats
from stickslip.foundation.place import Place

MOST_CURVES = 4
"""A second key of up to this number of values gives a family of curves, one of more a map: each curve has its own colour."""
MISSING = {1: ("|", "undefined for this run"), 2: ("x", "failed"), 3: ("_", "not run")}
"""Mark and explanation of members without a number, by their state."""
SEPARATE = 40
"""Members of a curve are marked by dots up to this number; more would run together, and only those beside jumps are marked."""
MARKERS = ("o", "s", "^", "D")
WIDTHS = (2.8, 2.0, 1.3, 0.8)
"""Marks of the members of each curve, and the widths of the lines between them."""
ALL, BESIDE = "members; no line where the result jumps", "members beside a jump, across which no line is drawn"
"""Explanations of dots and gaps of one curve: of few members, and of many."""
ENDS = "; lines end where the result jumps"
"""The explanation of the gaps of several curves, in the heading of their key."""
STEPS_BESIDE = 3
"""Number of steps on each side with which a step is compared."""
STEEP = 6.0
"""A jump is larger than this multiple of the median of the steps near it ..."""
SHARE_OF_RANGE = 0.05
"""... and larger than this share of the whole range, so that small steps of a nearly constant quantity are no jumps."""


def draw_curves(dataset: xr.Dataset, **place: Unpack[Place]) -> Any:
    """Draw the quantity over the longer axis, with a curve for each value of the other, if there is one.

    The line of a curve is interrupted where the quantity jumps between neighbours: a line would show values that no member has.
    """
    quantity = shown(dataset)
    along = str(quantity.values.dims[int(np.argmax(quantity.values.shape))])
    others = [str(name) for name in quantity.values.dims if name != along]
    names = names_of(dataset[others[0]]) if others else None
    across = scaled(dataset[along])
    rows, states = (np.atleast_2d(part.transpose(*others, along).values) for part in (quantity.values, quantity.state))
    axes = one_panel((5.4, 3.8), **place)
    marks: list[Line2D] = []
    broken = False
    for k, (row, state) in enumerate(zip(rows, states, strict=True)):
        # Later lines are thinner, so that curves that coincide all stay visible.
        width = 1.5 if names is None else WIDTHS[k]
        look: dict[str, Any] = {"color": LINE_COLOURS[k], "marker": MARKERS[k], "markersize": 3.5, "linewidth": width}
        broken |= _draw_curve(axes, across, row, quantity, look)
        if names is not None:
            marks.append(Line2D([], [], label=names.values[k], linestyle="none" if across.words else "-", **look))
        mark_missing(axes, across.values, state, LINE_COLOURS[k] if others else GREY, k)
    across.show(axes, "x")
    show_ordinate(axes, quantity)
    if quantity.line is not None and quantity.known.size:
        at, text = quantity.line
        marks.append(axes.axhline(at, color=GREY, linewidth=1.0, linestyle="--", zorder=0, label=text))
    if broken and names is None:
        text = ALL if rows.shape[1] <= SEPARATE else BESIDE
        marks.append(Line2D([], [], linestyle="none", marker="o", markersize=3.5, color=BLUE, label=text))
    marks += missing_marks(axes)
    heading = "" if names is None else names.full + (ENDS if broken else "")
    add_legend(axes, marks, heading, own=place.get("ax") is not None)
    return finish(axes, str(dataset.attrs.get("title", "")), **place)


def _draw_curve(axes: Axes, across: ScaledNumbers, row: Floats, quantity: ShownQuantity, look: dict[str, Any]) -> bool:
    """Draw the members of one curve, and lines between neighbours that no jump divides. Return True if it jumps."""
    order = np.argsort(across.values)
    places, values = across.values[order], row[order]
    if across.words:
        axes.plot(places, values, linestyle="none", **look)
        return False
    with np.errstate(invalid="ignore"):
        divided = jumps(np.log(values) if quantity.is_wide else values, whole=quantity.is_whole)
    points = np.stack([places, values], axis=1)
    segments = np.stack([points[:-1], points[1:]], axis=1)[~divided & np.isfinite(np.diff(values))]
    axes.add_collection(LineCollection(list(segments), colors=look["color"], linewidths=look["linewidth"]))
    axes.plot(places, values, linestyle="none", markevery=_marked(values, divided), **look)
    return bool(divided.any())


def _marked(values: Floats, divided: NDArray[np.bool_]) -> list[int]:
    """Return the places of the members that are marked: all if they are few, else those without a line to both sides."""
    if len(values) <= SEPARATE:
        return list(range(len(values)))
    apart = divided | ~np.isfinite(np.diff(values))
    beside = np.append(apart, False) | np.append(False, apart)
    return np.flatnonzero(beside & np.isfinite(values)).tolist()


def mark_missing(axes: Axes, places: Floats, state: NDArray[Any], colour: str = GREY, row: int = 0) -> None:
    """Mark at the bottom of the panel, in a row for each curve, the values whose members have no number, by why they have none."""
    at: dict[str, Any] = {"transform": axes.get_xaxis_transform(), "clip_on": False, "linestyle": "none", "markersize": 4.0}
    for which, (marker, text) in MISSING.items():
        if (state == which).any():
            here = places[state == which]
            axes.plot(here, np.full(len(here), 0.02 + 0.03 * row), marker=marker, color=colour, label=text, **at)


def missing_marks(*all_axes: Axes) -> list[Line2D]:
    """Return an entry of the key for each reason why members have no number that is marked in these panels."""
    found = {str(line.get_label()): line for axes in all_axes for line in axes.get_lines()}
    return [found[text] for _, text in MISSING.values() if text in found]


def show_ordinate(axes: Axes, quantity: ShownQuantity) -> None:
    """Set label, scale and ticks of the axis of the quantity."""
    if not quantity.known.size:
        axes.set_yticks([])
        axes.text(0.5, 0.5, "no member has this number", transform=axes.transAxes, ha="center", color=GREY)
    elif quantity.is_flag:
        axes.set_yticks([0.0, 1.0], ["no", "yes"])
        axes.set_ylim(-0.1, 1.1)
    elif quantity.is_wide:
        axes.set_yscale("log")
        set_log_ticks(axes, "y")
    elif quantity.is_whole:
        count_ticks(axes, 6)
    axes.set_ylabel(folded(quantity.title))


def jumps(values: Floats, *, whole: bool = False) -> NDArray[np.bool_]:
    """Return for each step between neighbours whether the quantity, as it is drawn, jumps there; False beside a missing value.

    Counts (`whole`) jump wherever they change.
    """
    steps = np.abs(np.diff(values))
    known = np.isfinite(steps)
    if whole or not known.any():
        return known & (steps > 0.0)
    least = SHARE_OF_RANGE * np.ptp(values[np.isfinite(values)])
    found = np.zeros(steps.shape, bool)
    for place in np.flatnonzero(known & (steps > least)):
        near = np.concatenate([steps[max(place - STEPS_BESIDE, 0) : place], steps[place + 1 : place + 1 + STEPS_BESIDE]])
        near = near[np.isfinite(near)]
        # Without neighbours nothing says that the quantity is smooth, and nothing says that it is not.
        found[place] = near.size > 0 and steps[place] > STEEP * np.median(near)
    return found
