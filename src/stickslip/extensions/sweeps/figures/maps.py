"""Figures of a sweep as maps over two keys, side by side for some values of a third, and as points.

Maps are of a grid. Points show members that are no grid: samples or lists.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any, Unpack

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.colors import ListedColormap
from matplotlib.lines import Line2D

from stickslip.extensions.sweeps.figures.colours import Colours, colours_of, explain, failed_area, prepare
from stickslip.extensions.sweeps.figures.curves import mark_missing, missing_marks, show_ordinate
from stickslip.extensions.sweeps.figures.varied import LITTLE, Names, ScaledNumbers, ShownQuantity, names_of, scaled, shown
from stickslip.extensions.sweeps.results.layout import read_design
from stickslip.figures.panels import add_legend, finish, letter_panels, panels, set_title
from stickslip.figures.sheet import one_panel
from stickslip.figures.style import BLUE, GREY, INK, PALE, ROOM, VERMILLION
from stickslip.foundation.place import Place

MAPS_SIDE_BY_SIDE = 9
"""Largest number of maps side by side; more would be too small to read."""
Draw = Callable[[Axes, int], None]
"""A function that draws a map; it receives its axes and the index of the value of the third key."""
STYLE_OF_LINE: dict[str, Any] = {"colors": VERMILLION, "linewidths": 1.6}
"""The line at a number of a quantity."""
SIZE = 16.0
"""Area of a point (in square points, as `scatter` takes it)."""


def draw_maps(dataset: xr.Dataset, **place: Unpack[Place]) -> Any:
    """Draw the first key along x and the second along y; of three keys, the one with the fewest values gives the separate maps."""
    quantity = shown(dataset)
    colours, lengths = colours_of(quantity), quantity.values.sizes
    third = dataset[min(lengths, key=lambda name: lengths[name])] if len(lengths) == 3 else None

    def draw_one(axes: Axes, k: int) -> None:
        cut = quantity if third is None else quantity.at(**{str(third.name): k})
        _draw_map(axes, dataset, cut, colours, ROOM if third is None else LITTLE)

    return _draw_all(dataset, quantity, colours, third, draw_one, place=place)


def _draw_all(
    dataset: xr.Dataset, quantity: ShownQuantity, colours: Colours, third: xr.DataArray | None, draw_one: Draw, *, place: Place
) -> Any:
    """Draw one map, or one for each of some values of a third key, and explain the colours."""
    title, marks = str(dataset.attrs.get("title", "")), failed_area(quantity)
    inner = [str(name) for name in quantity.values.dims if third is None or name != third.name]
    if quantity.line is not None and _has_line(quantity, *(scaled(dataset[name]) for name in inner)):
        marks.append(Line2D([], [], color=STYLE_OF_LINE["colors"], linewidth=STYLE_OF_LINE["linewidths"], label=quantity.line[1]))
    if third is not None:
        names = names_of(third)
        grid = _side_by_side(names, draw_one, place)
        set_title(grid[0].figure, f"{title}. Panels: {names.plain}".removeprefix(". "))
        # One row of panels is too low for a long name.
        low = grid[0].get_gridspec().nrows == 1  # type: ignore[union-attr]
        explain(grid, colours, quantity, *marks, room=LITTLE if low else ROOM)
        return grid[0].figure
    axes = one_panel((5.4, 4.4), **place)
    draw_one(axes, 0)
    explain([axes], colours, quantity, *marks, own=place.get("ax") is not None)
    return finish(axes, title, **place)


def _side_by_side(names: Names, draw_one: Draw, place: Place) -> list[Axes]:
    """Draw a panel for each value of a key, or for `MAPS_SIDE_BY_SIDE` of them evenly chosen, and return the panels."""
    count = len(names.values)
    chosen = np.unique(np.linspace(0, count - 1, min(count, MAPS_SIDE_BY_SIDE)).round().astype(int))
    columns = len(chosen) if len(chosen) <= 3 else 2 if len(chosen) == 4 else 3
    rows = -(-len(chosen) // columns)
    _, grid = panels(rows, columns, (2.0 * columns + 1.4, 2.1 * rows + 1.0), place, sharex=True, sharey=True)
    drawn = list(grid.flat)[: len(chosen)]
    for number, axes in enumerate(drawn):
        draw_one(axes, int(chosen[number]))
        lowest = number + columns >= len(chosen)
        axes.yaxis.label.set_visible(number % columns == 0)
        axes.xaxis.label.set_visible(lowest)
        axes.xaxis.set_tick_params(labelbottom=lowest)
    for axes in list(grid.flat)[len(chosen) :]:
        axes.remove()
    letter_panels(drawn, (names.equations[k] for k in chosen))
    return drawn


def _draw_map(axes: Axes, dataset: xr.Dataset, quantity: ShownQuantity, colours: Colours, room: int) -> None:
    """Draw one map of a grid, with members that have no such number in pale grey and those not run in white."""
    x, y = (replace(scaled(dataset[str(name)]), room=room) for name in quantity.values.dims)
    columns, rows = np.argsort(x.values), np.argsort(y.values)
    values, state = (part.values[columns][:, rows].T for part in (quantity.values, quantity.state))
    prepare(axes, quantity)
    edges = replace(x, values=x.values[columns]).edges, replace(y, values=y.values[rows]).edges
    blank = np.ma.masked_where((state == 0) | (state == 2), state)
    axes.pcolormesh(*edges, blank, cmap=ListedColormap([PALE, "white"]), vmin=1, vmax=3, rasterized=True)
    axes.pcolormesh(*edges, np.ma.masked_invalid(values), rasterized=True, **colours.options)
    if quantity.line is not None and _has_line(quantity, x, y):
        at = [quantity.line[0]]
        axes.contour(x.values[columns], y.values[rows], np.ma.masked_invalid(values), levels=at, **STYLE_OF_LINE)
    x.show(axes, "x")
    y.show(axes, "y")


def _has_line(quantity: ShownQuantity, *across: ScaledNumbers) -> bool:
    """Return True if a map of a quantity has its line: between numbers to both sides of it, on axes without words."""
    if quantity.line is None or any(one.words or len(one.values) < 2 for one in across):
        return False
    known = quantity.known
    return bool(known.size and known.min() < quantity.line[0] < known.max())


def draw_members(dataset: xr.Dataset, **place: Unpack[Place]) -> Any:
    """Draw coloured points over two varied keys; for any other number of keys, draw the quantity against each key in turn."""
    quantity, places = shown(dataset), [scaled(dataset[name]) for name in read_design(dataset.attrs)[1]]
    title = str(dataset.attrs.get("title", ""))
    if len(places) == 2:
        axes = one_panel((5.4, 4.4), **place)
        _draw_points(axes, quantity, places[0], places[1], own=place.get("ax") is not None)
        return finish(axes, title, **place)
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


def _draw_points(axes: Axes, quantity: ShownQuantity, x: ScaledNumbers, y: ScaledNumbers, *, own: bool) -> None:
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
