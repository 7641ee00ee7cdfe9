"""Figure of the first slip event of a slab and its equivalent block: ratios of slip, peak rate, duration, and where they agree."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.colors import ListedColormap, LogNorm
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import FixedFormatter, FixedLocator, NullFormatter

from stickslip.figures.style import GREEN, INK, PALE, SHOWN, letter, panels, styled
from stickslip.problem.parameters import parameter
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
    coordinates = {}
    for name, axis in (("x", found.x), ("y", found.y)):
        one = parameter(found.problem, axis.parameter)
        attributes = {"long_name": one.name.rpartition(".")[2], "units": one.unit or "1", "log": int(axis.log)}
        coordinates[name] = xr.Variable(name, axis.values, attributes)
    contents = {
        f"{one}_ratio": xr.Variable(
            ("y", "x"), found.ratio(one), {"long_name": f"{one.replace('_', ' ')}, slab / block", "units": "1"}
        )
        for one in QUANTITIES
    }
    for column in (*NUMBERS, "pulses_slab", "pulses_block", "stands"):
        contents[column] = xr.Variable(("y", "x"), found.grid(column), {"units": "1"})
    attributes = {"title": "Slab and equivalent block, first slip event", "within": found.within}
    return xr.Dataset(contents, coords=coordinates, attrs=attributes)


@styled
def draw(dataset: xr.Dataset) -> Figure:
    """Draw three maps of ratios in one scale of colours, and a map of the points at which the block can stand for the slab."""
    figure, axes = panels(2, 2, (7.6, 6.4), sharex=True, sharey=True)
    drawn = None
    for k, (panel, one) in enumerate(zip(axes.flat, QUANTITIES, strict=False)):
        drawn = _draw_ratio(panel, dataset, one)
        letter(panel, f"{'abc'[k]}   {dataset[f'{one}_ratio'].attrs['long_name']}")
    _draw_stands(axes[1, 1], dataset)
    for panel in axes.flat:
        _draw_numbers(panel, dataset)
        _set_axes(panel, dataset)
    for panel in axes[0]:
        panel.set_xlabel("")
    for panel in axes[:, 1]:
        panel.set_ylabel("")
    bar = figure.colorbar(drawn, ax=axes, location="right", shrink=0.6, extend="both", label="slab / block")  # type: ignore[arg-type]
    bar.ax.yaxis.set_major_locator(FixedLocator(TICKS))
    bar.ax.yaxis.set_major_formatter(FixedFormatter([f"{tick:g}" for tick in TICKS]))
    bar.ax.yaxis.set_minor_formatter(NullFormatter())
    lines = [Line2D([], [], color=INK, linewidth=1.2, linestyle=style, label=text) for style, text in NUMBERS.values()]
    figure.legend(handles=lines, loc="outside lower center", ncols=2)
    return figure


def _scales(dataset: xr.Dataset) -> list[float]:
    return [SHOWN.get(dataset[name].attrs["units"], ("", 1.0))[1] for name in ("x", "y")]


def _places(dataset: xr.Dataset) -> tuple[Any, Any]:
    x, y = (dataset[name].values / scale for name, scale in zip(("x", "y"), _scales(dataset), strict=True))
    return x, y


def _draw_ratio(axes: Axes, dataset: xr.Dataset, one: str) -> Any:
    axes.set_facecolor(PALE)
    ratio = np.ma.masked_invalid(dataset[f"{one}_ratio"].values)
    scale = LogNorm(1.0 / LARGEST, LARGEST)
    return axes.pcolormesh(*_places(dataset), ratio, cmap="RdBu_r", norm=scale, shading="nearest", rasterized=True)


def _draw_stands(axes: Axes, dataset: xr.Dataset) -> None:
    """Draw the points at which all answers agree; those with different numbers of pulses are labelled "slab:block"."""
    axes.set_facecolor(PALE)
    known = np.isfinite(sum(dataset[f"{one}_ratio"].values for one in QUANTITIES))
    stands = np.ma.masked_where(~known, dataset["stands"].values)
    axes.pcolormesh(
        *_places(dataset), stands, cmap=ListedColormap(["#F8D9C4", GREEN]), vmin=0, vmax=1, shading="nearest", rasterized=True
    )
    slab, block = dataset["pulses_slab"].values, dataset["pulses_block"].values
    x, y = _places(dataset)
    for i, j in zip(*np.nonzero(known & (slab != block)), strict=True):
        axes.text(x[j], y[i], f"{slab[i, j]:g}:{block[i, j]:g}", ha="center", va="center", fontsize=6)
    letter(axes, f"d   all within {100 * float(dataset.attrs['within']):g} % (green)")


def _draw_numbers(axes: Axes, dataset: xr.Dataset) -> None:
    """Draw the lines on which each of the two weakening numbers is 1."""
    for column, (style, _) in NUMBERS.items():
        values = dataset[column].values
        if np.nanmin(values) < 1.0 < np.nanmax(values):
            axes.contour(*_places(dataset), values, levels=[1.0], colors=INK, linewidths=1.2, linestyles=style)


def _set_axes(axes: Axes, dataset: xr.Dataset) -> None:
    for name, axis in (("x", axes.xaxis), ("y", axes.yaxis)):
        attributes = dataset[name].attrs
        unit = SHOWN.get(attributes["units"], (attributes["units"],))[0]
        text = unit.replace("m^-1 s", "s/m")
        axis.set_label_text(attributes["long_name"].replace("_", " ") + ("" if unit == "1" else f" ({text})"))
        getattr(axes, f"set_{name}scale")("log" if attributes["log"] else "linear")
