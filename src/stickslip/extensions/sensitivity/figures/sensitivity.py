"""Figure of sensitivities: what each number makes of an output, over time, or as bars for a number of a slip event."""

from __future__ import annotations

from typing import TYPE_CHECKING, Unpack

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from stickslip.figures.panels import add_legend, panels, zero_line
from stickslip.figures.style import BLUE, GREY, VERMILLION, folded, label, quantity, shown, styled, unit_shown
from stickslip.foundation.place import Place

if TYPE_CHECKING:
    from stickslip.extensions.sensitivity.result import Sensitivity
    from stickslip.foundation.arrays import Floats

MOST_CURVES = 7
"""Only so many numbers have a curve, those that matter most: there are no more colours."""
FEW_TIMES = 20
"""Fewer times than this are marked by points."""


@styled
def draw_sensitivity(found: Sensitivity, **place: Unpack[Place]) -> Figure:
    """Draw the scaled derivatives: the number times the derivative, for the numbers that matter most."""
    figure, grid = panels(1, 1, (6.4, 4.0), place)
    axes, timed = grid[0, 0], bool(len(found.times))
    order = [n for n in found.order if found.found[n].parameter.value != 0.0 and np.isfinite(found.scaled[n]).any()]
    words = f"number times derivative of {found.output.words}"
    drawn = xr.Dataset({"scaled": quantity(("number", "along"), found.scaled[order], words, "", found.unit)})["scaled"]
    unit = unit_shown(drawn)
    names, values = [found.numbers[n] for n in order], shown(drawn, unit)
    if timed:
        _draw_curves(axes, found, names, values)
    else:
        _draw_bars(axes, names, values[:, 0])
    (axes.set_ylabel if timed else axes.set_xlabel)(folded(label(drawn, unit)))
    return figure


def _draw_curves(axes: Axes, found: Sensitivity, names: list[str], values: Floats) -> None:
    """Draw a curve over time for each number, with gaps where there is no derivative."""
    time = xr.Dataset({"time": quantity("along", found.times, "time", "t", "s")})["time"]
    unit = unit_shown(time)
    zero_line(axes)
    for name, one in list(zip(names, values, strict=True))[:MOST_CURVES]:
        axes.plot(shown(time, unit), one, label=name, marker="." if len(found.times) < FEW_TIMES else "")
    axes.set_xlabel(label(time, unit))
    if names:
        add_legend(axes, axes.get_legend_handles_labels()[0])


def _draw_bars(axes: Axes, names: list[str], sizes: Floats) -> None:
    """Draw a bar for each number, the largest at the top."""
    axes.barh(np.arange(len(names)), sizes, color=[BLUE if one >= 0.0 else VERMILLION for one in sizes])
    axes.set_yticks(np.arange(len(names)), names)
    axes.invert_yaxis()
    axes.axvline(0.0, color=GREY, linewidth=0.8)
