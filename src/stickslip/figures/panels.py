"""Parts of figures that many of them share: sheets with panels, titles, marks, scales, and panels of one kind."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator
from numpy.typing import NDArray

from stickslip.contact.regime_map import Axis
from stickslip.figures.style import GREY, PALE, label, shown
from stickslip.problem.problem import Problem


def panels(rows: int, columns: int, size: tuple[float, float], **options: Any) -> tuple[Figure, NDArray[Any]]:
    """Return a new figure (size in inches) and its grid of axes, always as a 2-D array."""
    figure = Figure(figsize=size, layout="constrained")
    axes: NDArray[Any] = figure.subplots(rows, columns, squeeze=False, **options)
    return figure, axes


def sheet(figure: Figure | None, size: tuple[float, float]) -> Figure:
    """Return a figure of this size (inches) to draw on: the given one, or a new one that pyplot does not know."""
    figure = Figure() if figure is None else figure
    figure.set_size_inches(*size)
    figure.set_layout_engine("constrained")
    return figure


def letter(axes: Axes, text: str) -> None:
    """Set the title of a panel: its letter and what it shows."""
    axes.set_title(text, pad=6)


def zero_line(axes: Axes) -> None:
    """Draw a faint horizontal line at zero, for quantities whose zero has a meaning."""
    axes.axhline(0.0, color=PALE, linewidth=0.8, zorder=0)


def leave_empty(axes: Axes, text: str = "") -> None:
    """Replace a panel by a note that says why there is nothing to draw."""
    axes.set_axis_off()
    axes.text(0.5, 0.5, text, transform=axes.transAxes, ha="center", color=GREY)


def set_scale(axes: Axes, which: str, log: bool) -> None:
    """Make the axes "x", "y" or both ("xy") logarithmic, or linear."""
    for name in which:
        getattr(axes, f"set_{name}scale")("log" if log else "linear")


def count_ticks(axes: Axes, count: int = 4) -> None:
    """Give the vertical axis at most `count` intervals between ticks at whole numbers."""
    axes.yaxis.set_major_locator(MaxNLocator(count, integer=True))


def parameter_variables(problem: Problem, *, short: bool = False, **axes: Axis) -> dict[str, xr.Variable]:
    """Return the coordinates `x` and `y` of a map over two parameters of a problem; `short` names leave out the table."""
    found = {}
    for name, axis in axes.items():
        one = problem.parameters[axis.parameter]
        text = one.name.rpartition(".")[2].replace("_", " ") if short else one.name
        found[name] = xr.Variable(name, axis.values, {"long_name": text, "units": one.unit or "1", "log": int(axis.log)})
    return found


def draw_parameters(axes: Axes, dataset: xr.Dataset) -> None:
    """Set labels and scales of a map over the two parameters `x` and `y`."""
    axes.set(xlabel=label(dataset["x"]), ylabel=label(dataset["y"]))
    for name in ("x", "y"):
        set_scale(axes, name, bool(dataset[name].attrs["log"]))


def draw_map(axes: Axes, dataset: xr.Dataset, values: Any, **colours: Any) -> Any:
    """Draw values over the two parameters `x` and `y` as an image, pale where they are not finite, and return the image."""
    axes.set_facecolor(PALE)
    masked = np.ma.masked_invalid(values)
    return axes.pcolormesh(shown(dataset["x"]), shown(dataset["y"]), masked, shading="nearest", rasterized=True, **colours)
