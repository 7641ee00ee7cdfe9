"""Figure of the first slip event of a slab and its equivalent block: ratios of slip, peak rate, duration, and where they agree."""

from __future__ import annotations

from typing import Any, Unpack

import numpy as np
import xarray as xr
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.colors import ListedColormap, LogNorm
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.ticker import FixedFormatter, FixedLocator, NullFormatter

from stickslip.extensions.studies.analogy import QUANTITIES_COMPARED, Analogy
from stickslip.figures.panels import cell_edges, draw_map, draw_parameters, letter_panels, panels, parameter_numbers, set_title
from stickslip.figures.style import INK, PALE, TWO, shown, styled
from stickslip.foundation.arrays import Floats
from stickslip.foundation.place import Place

LARGEST_RATIO = 10.0
"""The scale of colours ends at this ratio and at its inverse."""
TICKS = (0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0)
"""Ratios that are marked on the scale of colours."""
NUMBER_LINES: dict[str, tuple[Any, str]] = {
    "weakening_slip": ("-", r"weakening with slip = stiffness: $-S\,\partial\mu/\partial u = G/h$"),
    "weakening_rate": ("--", r"weakening with slip rate = impedance: $-S\,\partial\mu/\partial v = Z$"),
}
"""Line style and legend of the two weakening numbers, by column of the study; a line is drawn where a number is 1."""
NOT, STANDS = TWO
"""Colours of points at which the block does not stand for the slab, and at which it does."""


def analogy_data(found: Analogy) -> xr.Dataset:
    """Return the results of a study over its two axes, shape (y, x), in SI.

    They are the three ratios slab / block, the numbers of pulses of slab and block, the two weakening numbers, and `stands` (1 if
    block and slab agree within the study's tolerance and have as many pulses).
    """
    dims, noun = ("y", "x"), found.problem.body.noun
    contents = {
        name: xr.Variable(dims, found.grid(name), {"units": "1"})
        for name in (*NUMBER_LINES, "pulses_slab", "pulses_block", "stands")
    }
    for one in QUANTITIES_COMPARED:
        about = {"long_name": f"{one.replace('_', ' ')}, {noun} / block", "units": "1"}
        contents[f"{one}_ratio"] = xr.Variable(dims, found.ratio(one), about)
    axes = parameter_numbers(found.problem, x=found.x, y=found.y)
    coordinates = {name: xr.Variable(name, one.values, one.attrs) for name, one in axes.items()}
    attributes = {"title": f"First slip event: {noun} against equivalent block", "within": found.within, "body": noun}
    return xr.Dataset(contents, coords=coordinates, attrs=attributes)


@styled
def draw_analogy(dataset: xr.Dataset, **place: Unpack[Place]) -> Figure:
    """Draw three maps of ratios in one scale of colours, and a map of the points at which the block can stand for the slab."""
    figure, axes = panels(2, 2, (7.2, 6.8), place, sharex=True, sharey=True)
    noun = dataset.attrs["body"]
    ratios = {"cmap": "RdBu_r", "norm": LogNorm(1.0 / LARGEST_RATIO, LARGEST_RATIO)}
    for panel, one in zip(axes.flat, QUANTITIES_COMPARED, strict=False):
        image = draw_map(panel, dataset, dataset[f"{one}_ratio"].values, **ratios)
    marks = _draw_stands(axes[1, 1], dataset)
    for panel in axes.flat:
        _draw_numbers(panel, dataset)
        draw_parameters(panel, dataset)
        panel.label_outer()
    letter_panels(axes.flat, [*(f"ratio of {one.replace('_', ' ')}s" for one in QUANTITIES_COMPARED), f"block stands for {noun}"])
    bar = figure.colorbar(image, ax=axes, location="right", shrink=0.7, extend="both", label=f"ratio {noun} / block, (a) to (c)")
    bar.ax.yaxis.set_major_locator(FixedLocator(TICKS))
    bar.ax.yaxis.set_major_formatter(FixedFormatter([f"{tick:g}" for tick in TICKS]))
    bar.ax.yaxis.set_minor_formatter(NullFormatter())
    lines = [
        Line2D([], [], color=INK, linewidth=1.2, linestyle=dashes, label=text)
        for column, (dashes, text) in NUMBER_LINES.items()
        if _crosses(dataset, column)
    ]
    if any(np.isnan(dataset[f"{one}_ratio"].values).any() for one in QUANTITIES_COMPARED):
        marks.append(Patch(color=PALE, label="no ratio: an event is missing or does not end"))
    figure.legend(handles=[*marks, *lines], loc="outside lower center", ncols=1 + (len(marks) + len(lines) > 2))
    set_title(figure, dataset.attrs["title"])
    return figure


def _draw_stands(axes: Axes, dataset: xr.Dataset) -> list[Artist]:
    """Draw the points at which all answers agree; those with different numbers of pulses are labelled "slab:block".

    Return the entries of the key.
    """
    known = np.isfinite(sum(dataset[f"{one}_ratio"].values for one in QUANTITIES_COMPARED))
    stands = np.where(known, dataset["stands"].values, np.nan)
    draw_map(axes, dataset, stands, cmap=ListedColormap([NOT, STANDS]), vmin=0, vmax=1)
    slab, block = dataset["pulses_slab"].values, dataset["pulses_block"].values
    x, y = (_middles(dataset[name]) for name in ("x", "y"))
    differ = list(zip(*np.nonzero(known & (slab != block)), strict=True))
    for i, j in differ:
        axes.text(x[j], y[i], f"{slab[i, j]:g}:{block[i, j]:g}", ha="center", va="center", fontsize=7)
    within = f"{100 * float(dataset.attrs['within']):g} %"
    marks: list[Artist] = [Patch(color=STANDS, label=f"(d) all three ratios within {within}, same pulses")]
    marks.append(Patch(color=NOT, label="(d) not so"))
    if differ:
        text = r"$\mathrm{n:m}$"
        pulses = f"(d) n pulses of the {dataset.attrs['body']}, m of the block"
        marks.append(Line2D([], [], linestyle="none", marker=text, markersize=14, color=INK, label=pulses))
    return marks


def _middles(parameter: xr.DataArray) -> Floats:
    """Return the middles of the cells of a map along a parameter; those of the first and the last cell lie beside its value."""
    log = bool(parameter.attrs["log"])
    edges = cell_edges(shown(parameter), log=log)
    return np.asarray(np.sqrt(edges[1:] * edges[:-1]) if log else 0.5 * (edges[1:] + edges[:-1]))


def _draw_numbers(axes: Axes, dataset: xr.Dataset) -> None:
    """Draw the lines on which each of the two weakening numbers is 1."""
    for column, (dashes, _) in NUMBER_LINES.items():
        if _crosses(dataset, column):
            look = {"colors": INK, "linewidths": 1.2, "linestyles": dashes}
            axes.contour(shown(dataset["x"]), shown(dataset["y"]), dataset[column].values, levels=[1.0], **look)


def _crosses(dataset: xr.Dataset, column: str) -> bool:
    """Return True if the weakening number is 1 somewhere on the map."""
    values = dataset[column].values
    return bool(np.nanmin(values) < 1.0 < np.nanmax(values))
