"""Figure of a sweep whose members are not a grid: samples, lists, or the members of a refined map, as points."""

from __future__ import annotations

from dataclasses import replace
from typing import Any, Unpack

import xarray as xr
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from stickslip.figures.legends import add_legend
from stickslip.figures.panels import letter_panels, panels, set_title
from stickslip.figures.sheet import one_panel, result
from stickslip.figures.style import BLUE, GREY, INK, PALE
from stickslip.figures.sweeps.colours import colours_of, explain
from stickslip.figures.sweeps.curves import mark_missing, missing_marks, show_ordinate
from stickslip.figures.sweeps.varied import LITTLE, ROOM, Scaled, Shown, scaled, shown
from stickslip.solution.place import Place
from stickslip.sweeps.results.layout import read_design
from stickslip.sweeps.results.refinement_spec import ATTRIBUTE, RefinementSpec

SIZE = 16.0
"""Area of a point (in square points, as `scatter` takes it)."""


def draw_members(dataset: xr.Dataset, **place: Unpack[Place]) -> Any:
    """Draw coloured points over two varied keys; for any other number of keys, draw the quantity against each key in turn."""
    quantity, places = shown(dataset), list(axes_of(dataset).values())
    title = str(dataset.attrs.get("title", ""))
    if len(places) == 2:
        axes = one_panel((5.4, 4.4), **place)
        _draw_points(axes, quantity, places[0], places[1], own=place.get("ax") is not None)
        if place.get("ax") is None:
            set_title(axes, title)
        return result(axes, **place)
    columns = min(len(places), 3)
    rows = -(-len(places) // columns)
    figure, grid = panels(rows, columns, (max(2.0 * columns + 1.2, 5.4), 2.4 * rows + 0.8), place, sharey=True)
    drawn = list(grid.flat)[: len(places)]
    for axes, across in zip(drawn, places, strict=True):
        axes.plot(across.values, quantity.values.values, ".", color=BLUE, markersize=4.0, rasterized=True)
        mark_missing(axes, across.values, quantity.state.values)
        replace(across, room=LITTLE if columns > 1 else ROOM).show(axes, "x")
    for axes in list(grid.flat)[len(places) :]:
        axes.remove()
    for axes in grid[:, 0]:
        show_ordinate(axes, quantity)
    letter_panels(drawn)
    dots = Line2D([], [], linestyle="none", marker=".", color=BLUE, label="one dot for each member")
    add_legend(drawn[0], [*([dots] if len(drawn) > 1 else []), *missing_marks(*drawn)])
    set_title(figure, title)
    return figure


def axes_of(dataset: xr.Dataset) -> dict[str, Scaled]:
    """Return the varied keys, scaled for drawing; of a refined map, an axis is logarithmic if the search was."""
    _, names, _ = read_design(dataset.attrs)
    found = {name: scaled(dataset[name]) for name in names}
    if ATTRIBUTE not in dataset.attrs:
        return found
    # The values themselves do not tell: members crowd where the answer changes.
    logarithmic = dict(zip(names, RefinementSpec.read(dataset).logarithmic, strict=True))
    return {name: replace(one, log=logarithmic[name]) for name, one in found.items()}


def _draw_points(axes: Axes, quantity: Shown, x: Scaled, y: Scaled, *, own: bool) -> None:
    """Draw a point for each member in the colour of its number, and explain the colours."""
    colours, values, state = colours_of(quantity), quantity.values.values, quantity.state.values
    for which, colour, marker in ((1, PALE, "o"), (2, GREY, "x")):
        axes.scatter(x.values[state == which], y.values[state == which], s=SIZE, color=colour, marker=marker, rasterized=True)
    there = state == 0
    look: dict[str, Any] = {"s": SIZE, "linewidths": 0.3, "edgecolors": INK, "rasterized": True, **colours.options}
    axes.scatter(x.values[there], y.values[there], c=values[there], **look)
    x.show(axes, "x")
    y.show(axes, "y")
    crosses = Line2D([], [], color=GREY, marker="x", linestyle="none", label="failed", markersize=4.0)
    explain([axes], colours, quantity, *([crosses] if quantity.has(2) else []), own=own)
