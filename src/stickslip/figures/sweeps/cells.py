"""Figure of a refined map: its cells, each coloured by the answer around it, and the cells in which the answer changes."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from stickslip.figures.style import INK, PALE, letter, panels
from stickslip.figures.sweeps.colours import Colours, colours_of, explain, failed_area, prepare
from stickslip.figures.sweeps.maps import side_by_side
from stickslip.figures.sweeps.members import axes_of, draw_members
from stickslip.figures.sweeps.varied import Scaled, Shown, shown
from stickslip.sweeps.results.refinement_spec import RefinedMap, RefinementSpec, cells_of


def draw_cells(dataset: xr.Dataset) -> Figure:
    """Draw the cells over two varied keys, or cuts through them at some coarse values of a third.

    For any other number of keys, or a quantity other than the refined one, draw the members as points instead.
    """
    spec, title = RefinementSpec.read(dataset), str(dataset.attrs.get("title", ""))
    names = list(spec.columns)
    if dataset.attrs["quantity"] != spec.quantity or len(names) not in (2, 3):
        return draw_members(dataset)
    quantity, cells = shown(dataset), cells_of(dataset)
    colours, places = colours_of(quantity, cells.answer), axes_of(dataset)
    if len(names) == 2:
        figure, grid = panels(1, 1, (5.4, 4.4))
        _draw(grid[0, 0], quantity, colours, cells, places)
        letter(grid[0, 0], title)
    else:
        values = spec.columns[names[2]]
        third = xr.DataArray(values, name=names[2], attrs=dataset[names[2]].attrs)
        figure, grid = side_by_side(third, lambda axes, k: _draw(axes, quantity, colours, cells.at(names[2], values[k]), places))
        figure.suptitle(title, fontsize=9.5, fontweight="bold")
    change = [Patch(facecolor=INK, label="boundary")] if cells.changes.any() else []
    explain(figure, list(grid.flat), colours, quantity, *failed_area(quantity), *change)
    return figure


def _draw(axes: Axes, quantity: Shown, colours: Colours, cells: RefinedMap, places: dict[str, Scaled]) -> None:
    """Draw cells as rectangles; those in which the answer changes come last and have a line, so that the smallest can be seen."""
    prepare(axes, quantity)
    if not quantity.has(2):
        axes.set_facecolor(PALE)
    x, y = ((cells.low[name] / one.size, cells.high[name] / one.size) for name, one in list(places.items())[:2])
    corners = np.stack([np.stack([x[i], y[j]], axis=1) for i, j in ((0, 0), (1, 0), (1, 1), (0, 1))], axis=1)
    there = np.isfinite(cells.answer)
    _fill(axes, corners[there], colours.cmap(colours.norm(cells.answer[there])), 0.2)
    _fill(axes, corners[cells.changes], INK, 0.8)
    for which, one in zip("xy", places.values(), strict=False):
        getattr(axes, f"set_{which}lim")(one.values.min(), one.values.max())
        one.show(axes, which)


def _fill(axes: Axes, corners: Any, colour: Any, width: float) -> None:
    axes.add_collection(PolyCollection(corners, facecolors=colour, edgecolors="face", linewidths=width, rasterized=True))
