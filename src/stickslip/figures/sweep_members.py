"""Members of a sweep that are no grid: points, or the cells of a refined map."""

from __future__ import annotations

import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from stickslip.figures.colours import Colours, colours_of, explain
from stickslip.figures.style import BLUE, GREY, PALE, letter, panels
from stickslip.figures.sweep_curves import mark_failed, show_ordinate
from stickslip.figures.varied import Shown, scaled, shown
from stickslip.sweeps.design import MEMBER

SIZE = 12.0
"""Area of a point (square points)."""


def draw_members(dataset: xr.Dataset) -> Figure:
    """Coloured points over two varied keys; for any other number of them the quantity over each key, whatever the others are."""
    quantity, names = shown(dataset), varied(dataset)
    if len(names) == 2:
        colours = colours_of(quantity)
        figure, grid = panels(1, 1, (5.4, 4.4))
        _draw_points(grid[0, 0], dataset, quantity, colours, names)
        crosses = Line2D([], [], color=GREY, marker="x", linestyle="none", label="failed", markersize=4.0)
        explain(figure, list(grid.flat), colours, quantity, *([crosses] if quantity.has(2) else []))
    else:
        columns = min(len(names), 3)
        rows = -(-len(names) // columns)
        figure, grid = panels(rows, columns, (2.6 * columns + 1.0, 2.6 * rows + 0.4), sharey=True)
        for axes, name in zip(grid.flat, names, strict=False):
            _draw_over(axes, dataset, quantity, name)
        for axes in list(grid.flat)[len(names) :]:
            axes.set_axis_off()
        for axes in grid[:, 0]:
            show_ordinate(axes, quantity)
    letter(grid[0, 0], str(dataset.attrs.get("title", "")))
    return figure


def varied(dataset: xr.Dataset) -> list[str]:
    """The keys that members differ in."""
    return [str(name) for name in dataset.coords if dataset[name].dims == (MEMBER,) and name not in (MEMBER, "level")]


def _draw_points(axes: Axes, dataset: xr.Dataset, quantity: Shown, colours: Colours, names: list[str]) -> None:
    x, y = (scaled(dataset[name]) for name in names)
    values, state = quantity.values.values, quantity.state.values
    for which, colour, marker in ((1, PALE, "o"), (2, GREY, "x")):
        axes.scatter(x.values[state == which], y.values[state == which], s=SIZE, color=colour, marker=marker, rasterized=True)
    there = state == 0
    axes.scatter(x.values[there], y.values[there], c=values[there], s=SIZE, linewidths=0.0, rasterized=True, **colours.options)
    x.show(axes, "x")
    y.show(axes, "y")


def _draw_over(axes: Axes, dataset: xr.Dataset, quantity: Shown, name: str) -> None:
    across, state = scaled(dataset[name]), quantity.state.values
    axes.plot(across.values, quantity.values.values, ".", color=BLUE, markersize=3.0, rasterized=True)
    mark_failed(axes, across.values[state == 2])
    across.show(axes, "x")
