"""Figure of a sweep as maps: a quantity over two varied keys, side by side for some values of a third."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure
from numpy.typing import NDArray

from stickslip.figures.style import PALE, letter, panels
from stickslip.figures.sweeps.colours import Colours, colours_of, explain, failed_area, prepare
from stickslip.figures.sweeps.varied import Shown, scaled, shown, value_text

PANELS = 9
"""Largest number of maps side by side; more would be too small to read."""


def draw_maps(dataset: xr.Dataset) -> Figure:
    """Draw the first key along x and the second along y; of three keys, the one with the fewest values gives the separate maps."""
    quantity = shown(dataset)
    colours, title = colours_of(quantity), str(dataset.attrs.get("title", ""))
    lengths = {str(name): length for name, length in quantity.values.sizes.items()}
    if len(lengths) == 2:
        figure, grid = panels(1, 1, (5.4, 4.4))
        draw_map(grid[0, 0], dataset, quantity, colours)
        letter(grid[0, 0], title)
    else:
        third = dataset[min(lengths, key=lambda name: lengths[name])]

        def draw_one(axes: Axes, k: int) -> None:
            one = quantity.values.isel({third.name: k}), quantity.state.isel({third.name: k})
            draw_map(axes, dataset, replace(quantity, values=one[0], state=one[1]), colours)

        figure, grid = side_by_side(third, draw_one)
        figure.suptitle(title, fontsize=9.5, fontweight="bold")
    explain(figure, list(grid.flat), colours, quantity, *failed_area(quantity))
    return figure


def side_by_side(third: xr.DataArray, draw_one: Callable[[Axes, int], None]) -> tuple[Figure, NDArray[Any]]:
    """Return a figure with a panel for each value of a key, or for `PANELS` of them evenly chosen, and its axes.

    `draw_one` draws a panel; it receives its axes and the index of the value.
    """
    chosen = np.unique(np.linspace(0, third.size - 1, min(third.size, PANELS)).round().astype(int))
    columns = min(len(chosen), 3)
    rows = -(-len(chosen) // columns)
    figure, grid = panels(rows, columns, (2.4 * columns + 1.2, 2.1 * rows + 1.0), sharex=True, sharey=True)
    for place, axes in enumerate(grid.flat):
        if place >= len(chosen):
            axes.set_axis_off()
            continue
        draw_one(axes, int(chosen[place]))
        letter(axes, value_text(third[chosen[place]]))
        lowest = place + columns >= len(chosen)
        axes.yaxis.label.set_visible(place % columns == 0)
        axes.xaxis.label.set_visible(lowest)
        axes.xaxis.set_tick_params(labelbottom=lowest)
    return figure, grid


def draw_map(axes: Axes, dataset: xr.Dataset, quantity: Shown, colours: Colours) -> None:
    """Draw one map, with members that have no such number in pale grey and those not run in white."""
    names = [str(name) for name in quantity.values.dims]
    x, y = (scaled(dataset[name]) for name in names)
    columns, rows = np.argsort(x.values), np.argsort(y.values)
    values, state = (part.values[columns][:, rows].T for part in (quantity.values, quantity.state))
    prepare(axes, quantity)
    edges = replace(x, values=x.values[columns]).edges, replace(y, values=y.values[rows]).edges
    blank = np.ma.masked_where((state == 0) | (state == 2), state)
    axes.pcolormesh(*edges, blank, cmap=ListedColormap([PALE, "white"]), vmin=1, vmax=3, rasterized=True)
    axes.pcolormesh(*edges, np.ma.masked_invalid(values), rasterized=True, **colours.options)
    x.show(axes, "x")
    y.show(axes, "y")
