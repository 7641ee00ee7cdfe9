"""Curves of a sweep: a quantity over one varied key, or a family of them."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator
from numpy.typing import NDArray

from stickslip.figures.style import BLUE, GREEN, GREY, PURPLE, VERMILLION, letter, panels
from stickslip.figures.sweeps.varied import Shown, scaled, shown, value_text

Floats = NDArray[np.float64]

_COLOURS = (BLUE, VERMILLION, GREEN, PURPLE)
MOST_CURVES = len(_COLOURS)
"""An axis of at most so many values gives the curves of a family; one of more makes a map."""
SEPARATE = 40
"""At most so many members of a curve are marked each."""


def draw_curves(dataset: xr.Dataset) -> Figure:
    """The quantity over the longer axis, one curve for each value of the other."""
    quantity = shown(dataset)
    along = str(quantity.values.dims[int(np.argmax(quantity.values.shape))])
    others = [str(name) for name in quantity.values.dims if name != along]
    across = scaled(dataset[along])
    order = np.argsort(across.values)
    marker = "o" if len(order) <= SEPARATE else ""
    rows, states = (np.atleast_2d(part.transpose(*others, along).values) for part in (quantity.values, quantity.state))
    figure, grid = panels(1, 1, (5.4, 3.8))
    axes = grid[0, 0]
    for k, row in enumerate(rows):
        text = value_text(dataset[others[0]][k]) if others else ""
        look: dict[str, Any] = {"marker": marker, "markersize": 3.0, "linestyle": "none" if across.words else "-"}
        if quantity.is_whole:
            look["drawstyle"] = "steps-mid"
        axes.plot(across.values[order], row[order], color=_COLOURS[k], label=text, **look)
    for k, state in enumerate(states):
        mark_failed(axes, across.values[state == 2], _COLOURS[k] if others else GREY)
    across.show(axes, "x")
    show_ordinate(axes, quantity)
    handles, texts = axes.get_legend_handles_labels()
    if any(texts):
        figure.legend(handles, texts, loc="outside lower center", ncols=min(len(texts), 4))
    letter(axes, str(dataset.attrs.get("title", "")))
    return figure


def mark_failed(axes: Axes, places: Floats, colour: str = GREY) -> None:
    """Crosses at the foot of the panel."""
    if places.size:
        text = "" if "failed" in axes.get_legend_handles_labels()[1] else "failed"
        at: dict[str, Any] = {"transform": axes.get_xaxis_transform(), "clip_on": False}
        axes.plot(places, np.full(len(places), 0.02), "x", color=colour, markersize=4.0, label=text, **at)


def show_ordinate(axes: Axes, quantity: Shown) -> None:
    """Label and scale of the quantity's axis."""
    if not quantity.known.size:
        axes.set_yticks([])
    elif quantity.is_flag:
        axes.set_yticks([0.0, 1.0], ["no", "yes"])
    elif quantity.is_wide:
        axes.set_yscale("log")
    elif quantity.is_whole:
        axes.yaxis.set_major_locator(MaxNLocator(6, integer=True))
    axes.set_ylabel(quantity.title)
