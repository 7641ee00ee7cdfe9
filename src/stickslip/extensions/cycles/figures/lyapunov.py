"""Figure of the growth of a disturbance along a run, with the mean rate and its error."""

from __future__ import annotations

from typing import TYPE_CHECKING, Unpack

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from stickslip.figures.panels import add_legend, panels
from stickslip.figures.style import BLUE, GREY, INK, label, quantity, shown, styled, unit_shown
from stickslip.foundation.place import Place

if TYPE_CHECKING:
    from stickslip.extensions.cycles.exponent import LyapunovExponent


@styled
def draw_growth(found: LyapunovExponent, **place: Unpack[Place]) -> Figure:
    """Draw the logarithm of the size of a disturbance against time, and the line and the wedge of the exponent and its error."""
    figure, grid = panels(1, 1, (6.4, 3.6), place)
    axes, time, growth = grid[0, 0], found.found.time, found.found.growth
    drawn = xr.Dataset(
        {
            "time": quantity("along", time, "time", "t", "s"),
            "growth": quantity("along", growth, "growth of a disturbance, natural logarithm", "", "1"),
        }
    )
    unit = unit_shown(drawn["time"])
    over = shown(drawn["time"], unit)
    axes.plot(over, growth, color=BLUE, label="disturbance")
    if np.isfinite(found.exponent):
        from_start = time - time[0]
        axes.plot(over, growth[0] + found.exponent * from_start, color=INK, linestyle="--", label="mean rate")
        low, high = (growth[0] + (found.exponent + sign * found.error) * from_start for sign in (-1.0, 1.0))
        axes.fill_between(over, low, high, color=GREY, alpha=0.3, label="standard error")
    axes.set(xlabel=label(drawn["time"], unit), ylabel=label(drawn["growth"], unit_shown(drawn["growth"])))
    add_legend(axes, axes.get_legend_handles_labels()[0])
    return figure
