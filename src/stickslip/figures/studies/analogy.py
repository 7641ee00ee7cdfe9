"""Figure of the first slip event of a slab and its equivalent block: ratios of slip, peak rate, duration, and where they agree."""

from __future__ import annotations

from typing import Any, Unpack

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.colors import ListedColormap, LogNorm
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import FixedFormatter, FixedLocator, NullFormatter

from stickslip.figures.panels import draw_map, draw_parameters, letter, panels, parameter_variables
from stickslip.figures.sheet import Place
from stickslip.figures.style import GREEN, INK, LIGHT_ORANGE, shown, styled
from stickslip.studies.analogy import QUANTITIES, Analogy

LARGEST = 10.0
"""The scale of colours ends at this ratio and at its inverse."""
TICKS = (0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0)
"""Ratios that are marked on the scale of colours."""
NUMBERS: dict[str, tuple[Any, str]] = {
    "weakening_slip": ("-", r"$-S\,\partial\mu/\partial u = G/h$"),
    "weakening_rate": ("--", r"$-S\,\partial\mu/\partial v = Z$ (critical)"),
}
"""Line style and legend of the two weakening numbers, by column of the study; a line is drawn where a number is 1."""


def data(found: Analogy) -> xr.Dataset:
    """Return the results of a study over its two axes, shape (y, x), in SI.

    They are the three ratios slab / block, the numbers of pulses of slab and block, the two weakening numbers, and `stands` (1 if
    block and slab agree within the study's tolerance and have as many pulses).
    """
    dims = ("y", "x")
    contents = {
        name: xr.Variable(dims, found.grid(name), {"units": "1"}) for name in (*NUMBERS, "pulses_slab", "pulses_block", "stands")
    }
    for one in QUANTITIES:
        about = {"long_name": f"{one.replace('_', ' ')}, slab / block", "units": "1"}
        contents[f"{one}_ratio"] = xr.Variable(dims, found.ratio(one), about)
    coordinates = parameter_variables(found.problem, x=found.x, y=found.y)
    return xr.Dataset(
        contents, coords=coordinates, attrs={"title": "Slab and equivalent block, first slip event", "within": found.within}
    )


@styled
def draw(dataset: xr.Dataset, **place: Unpack[Place]) -> Figure:
    """Draw three maps of ratios in one scale of colours, and a map of the points at which the block can stand for the slab."""
    figure, axes = panels(2, 2, (7.6, 6.4), place, sharex=True, sharey=True)
    ratios = {"cmap": "RdBu_r", "norm": LogNorm(1.0 / LARGEST, LARGEST)}
    for k, (panel, one) in enumerate(zip(axes.flat, QUANTITIES, strict=False)):
        ratio = dataset[f"{one}_ratio"]
        image = draw_map(panel, dataset, ratio.values, **ratios)
        letter(panel, f"{'abc'[k]}   {ratio.attrs['long_name']}")
    _draw_stands(axes[1, 1], dataset)
    for panel in axes.flat:
        _draw_numbers(panel, dataset)
        draw_parameters(panel, dataset)
        panel.label_outer()
    bar = figure.colorbar(image, ax=axes, location="right", shrink=0.6, extend="both", label="slab / block")
    bar.ax.yaxis.set_major_locator(FixedLocator(TICKS))
    bar.ax.yaxis.set_major_formatter(FixedFormatter([f"{tick:g}" for tick in TICKS]))
    bar.ax.yaxis.set_minor_formatter(NullFormatter())
    lines = [Line2D([], [], color=INK, linewidth=1.2, linestyle=style, label=text) for style, text in NUMBERS.values()]
    figure.legend(handles=lines, loc="outside lower center", ncols=2)
    return figure


def _draw_stands(axes: Axes, dataset: xr.Dataset) -> None:
    """Draw the points at which all answers agree; those with different numbers of pulses are labelled "slab:block"."""
    known = np.isfinite(sum(dataset[f"{one}_ratio"].values for one in QUANTITIES))
    stands = np.where(known, dataset["stands"].values, np.nan)
    draw_map(axes, dataset, stands, cmap=ListedColormap([LIGHT_ORANGE, GREEN]), vmin=0, vmax=1)
    slab, block = dataset["pulses_slab"].values, dataset["pulses_block"].values
    x, y = shown(dataset["x"]), shown(dataset["y"])
    for i, j in zip(*np.nonzero(known & (slab != block)), strict=True):
        axes.text(x[j], y[i], f"{slab[i, j]:g}:{block[i, j]:g}", ha="center", va="center", fontsize=6)
    letter(axes, f"d   all within {100 * float(dataset.attrs['within']):g} % (green)")


def _draw_numbers(axes: Axes, dataset: xr.Dataset) -> None:
    """Draw the lines on which each of the two weakening numbers is 1."""
    for column, (style, _) in NUMBERS.items():
        values, look = dataset[column].values, {"colors": INK, "linewidths": 1.2, "linestyles": style}
        if np.nanmin(values) < 1.0 < np.nanmax(values):
            axes.contour(shown(dataset["x"]), shown(dataset["y"]), values, levels=[1.0], **look)
