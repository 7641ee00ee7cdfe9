"""Maps of a sweep: a quantity over two varied keys, side by side for some values of a third."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure

from stickslip.figures.colours import Colours, colours_of, explain, failed_area, prepare
from stickslip.figures.style import PALE, letter, panels
from stickslip.figures.varied import Shown, scaled, shown, value_text

PANELS = 9
"""At most so many maps side by side."""


def draw_maps(dataset: xr.Dataset) -> Figure:
    """The first key across, the second up; of three, the one with the fewest values goes from map to map."""
    quantity = shown(dataset)
    colours, title = colours_of(quantity), str(dataset.attrs.get("title", ""))
    lengths = {str(name): length for name, length in quantity.values.sizes.items()}
    if len(lengths) == 2:
        figure, grid = panels(1, 1, (5.4, 4.4))
        draw_map(grid[0, 0], dataset, quantity, colours)
        letter(grid[0, 0], title)
    else:
        figure, grid = _side_by_side(dataset, quantity, colours, min(lengths, key=lambda name: lengths[name]))
        figure.suptitle(title, fontsize=9.5, fontweight="bold")
    explain(figure, list(grid.flat), colours, quantity, *failed_area(quantity))
    return figure


def _side_by_side(dataset: xr.Dataset, quantity: Shown, colours: Colours, third: str) -> tuple[Figure, np.ndarray]:
    """A map for each value of the third key, or for some of them, evenly chosen."""
    values = dataset[third]
    chosen = np.unique(np.linspace(0, values.size - 1, min(values.size, PANELS)).round().astype(int))
    columns = min(len(chosen), 3)
    rows = -(-len(chosen) // columns)
    figure, grid = panels(rows, columns, (2.4 * columns + 1.2, 2.1 * rows + 1.0), sharex=True, sharey=True)
    for place, k in enumerate(chosen):
        axes = grid.flat[place]
        one = replace(quantity, values=quantity.values.isel({third: k}), state=quantity.state.isel({third: k}))
        draw_map(axes, dataset, one, colours)
        letter(axes, value_text(values[k]))
        axes.yaxis.label.set_visible(place % columns == 0)
        lowest = place + columns >= len(chosen)
        axes.xaxis.label.set_visible(lowest)
        axes.xaxis.set_tick_params(labelbottom=lowest)
    for axes in list(grid.flat)[len(chosen) :]:
        axes.set_axis_off()
    return figure, grid


def draw_map(axes: Axes, dataset: xr.Dataset, quantity: Shown, colours: Colours) -> None:
    """One map."""
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
