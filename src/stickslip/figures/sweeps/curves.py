"""Figure of a sweep as curves: a quantity over one varied key, and a curve for each value of a second."""

from __future__ import annotations

from typing import Any, Unpack

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from stickslip.figures.panels import count_ticks, letter, panels
from stickslip.figures.sheet import Place
from stickslip.figures.style import GREY, LINE_COLOURS, Floats
from stickslip.figures.sweeps.varied import Shown, scaled, shown, value_text

MOST_CURVES = 4
"""A second key of up to this number of values gives a family of curves, one of more a map: each curve has its own colour."""
SEPARATE = 40
"""Members of a curve are marked by dots up to this number; more would run together."""


def draw_curves(dataset: xr.Dataset, **place: Unpack[Place]) -> Figure:
    """Draw the quantity over the longer axis, with a curve for each value of the other, if there is one."""
    quantity = shown(dataset)
    along = str(quantity.values.dims[int(np.argmax(quantity.values.shape))])
    others = [str(name) for name in quantity.values.dims if name != along]
    across = scaled(dataset[along])
    order = np.argsort(across.values)
    marker = "o" if len(order) <= SEPARATE else ""
    rows, states = (np.atleast_2d(part.transpose(*others, along).values) for part in (quantity.values, quantity.state))
    figure, grid = panels(1, 1, (5.4, 3.8), place)
    axes = grid[0, 0]
    for k, row in enumerate(rows):
        text = value_text(dataset[others[0]][k]) if others else ""
        look: dict[str, Any] = {"marker": marker, "markersize": 3.0, "linestyle": "none" if across.words else "-"}
        if quantity.is_whole:
            look["drawstyle"] = "steps-mid"
        axes.plot(across.values[order], row[order], color=LINE_COLOURS[k], label=text, **look)
    for k, state in enumerate(states):
        mark_failed(axes, across.values[state == 2], LINE_COLOURS[k] if others else GREY)
    across.show(axes, "x")
    show_ordinate(axes, quantity)
    handles, texts = axes.get_legend_handles_labels()
    if any(texts):
        figure.legend(handles, texts, loc="outside lower center", ncols=min(len(texts), 4))
    letter(axes, str(dataset.attrs.get("title", "")))
    return figure


def mark_failed(axes: Axes, places: Floats, colour: str = GREY) -> None:
    """Draw crosses at the bottom of the panel at the values whose members failed."""
    if places.size:
        text = "" if "failed" in axes.get_legend_handles_labels()[1] else "failed"
        at: dict[str, Any] = {"transform": axes.get_xaxis_transform(), "clip_on": False}
        axes.plot(places, np.full(len(places), 0.02), "x", color=colour, markersize=4.0, label=text, **at)


def show_ordinate(axes: Axes, quantity: Shown) -> None:
    """Set label, scale and ticks of the axis of the quantity."""
    if not quantity.known.size:
        axes.set_yticks([])
    elif quantity.is_flag:
        axes.set_yticks([0.0, 1.0], ["no", "yes"])
    elif quantity.is_wide:
        axes.set_yscale("log")
    elif quantity.is_whole:
        count_ticks(axes, 6)
    axes.set_ylabel(quantity.title)
