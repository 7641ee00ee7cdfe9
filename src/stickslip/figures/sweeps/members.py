"""Figure of a sweep whose members are not a grid: samples, lists, or the members of a refined map, as points."""

from __future__ import annotations

import json
from dataclasses import replace
from typing import Unpack

import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from stickslip.figures.panels import letter, panels
from stickslip.figures.sheet import Place
from stickslip.figures.style import BLUE, GREY, PALE
from stickslip.figures.sweeps.colours import colours_of, explain
from stickslip.figures.sweeps.curves import mark_failed, show_ordinate
from stickslip.figures.sweeps.varied import Scaled, Shown, scaled, shown
from stickslip.sweeps.results.refinement_spec import ATTRIBUTE, RefinementSpec

SIZE = 12.0
"""Area of a point (in square points, as `scatter` takes it)."""


def draw_members(dataset: xr.Dataset, **place: Unpack[Place]) -> Figure:
    """Draw coloured points over two varied keys; for any other number of keys, draw the quantity against each key in turn."""
    quantity, places = shown(dataset), list(axes_of(dataset).values())
    if len(places) == 2:
        figure, grid = panels(1, 1, (5.4, 4.4), place)
        _draw_points(grid[0, 0], quantity, *places)
    else:
        columns = min(len(places), 3)
        rows = -(-len(places) // columns)
        figure, grid = panels(rows, columns, (max(2.6 * columns + 1.0, 5.4), max(2.6 * rows + 0.4, 3.8)), place, sharey=True)
        for axes, across in zip(grid.flat, places, strict=False):
            axes.plot(across.values, quantity.values.values, ".", color=BLUE, markersize=3.0, rasterized=True)
            mark_failed(axes, across.values[quantity.state.values == 2])
            across.show(axes, "x")
        for axes in list(grid.flat)[len(places) :]:
            axes.set_axis_off()
        for axes in grid[:, 0]:
            show_ordinate(axes, quantity)
    letter(grid[0, 0], str(dataset.attrs.get("title", "")))
    return figure


def axes_of(dataset: xr.Dataset) -> dict[str, Scaled]:
    """Return the varied keys, scaled for drawing; of a refined map, an axis is logarithmic if the search was."""
    names = [str(name) for name in json.loads(dataset.attrs["design"])["keys"]]
    found = {name: scaled(dataset[name]) for name in names}
    if ATTRIBUTE not in dataset.attrs:
        return found
    # The values themselves do not tell: members crowd where the answer changes.
    logarithmic = dict(zip(names, RefinementSpec.read(dataset).logarithmic, strict=True))
    return {name: replace(one, log=logarithmic[name]) for name, one in found.items()}


def _draw_points(axes: Axes, quantity: Shown, x: Scaled, y: Scaled) -> None:
    """Draw a point for each member in the colour of its number, and explain the colours."""
    colours, values, state = colours_of(quantity), quantity.values.values, quantity.state.values
    for which, colour, marker in ((1, PALE, "o"), (2, GREY, "x")):
        axes.scatter(x.values[state == which], y.values[state == which], s=SIZE, color=colour, marker=marker, rasterized=True)
    there = state == 0
    axes.scatter(x.values[there], y.values[there], c=values[there], s=SIZE, linewidths=0.0, rasterized=True, **colours.options)
    x.show(axes, "x")
    y.show(axes, "y")
    crosses = Line2D([], [], color=GREY, marker="x", linestyle="none", label="failed", markersize=4.0)
    figure = axes.figure
    assert isinstance(figure, Figure)
    explain(figure, [axes], colours, quantity, *([crosses] if quantity.has(2) else []))
