"""Figure of a cycle: slip rate and traction over one period, and the way of load and slip rate around it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Unpack

import xarray as xr
from matplotlib.figure import Figure

from stickslip.figures.panels import letter_panels, panels, zero_line
from stickslip.figures.style import BLUE, INK, VERMILLION, curve_quantity, label, shown, spans_decades, styled, unit_shown
from stickslip.foundation.place import Place

if TYPE_CHECKING:
    from stickslip.extensions.cycles.limit_cycle import LimitCycle
    from stickslip.solution import Curve

CURVES: tuple[Curve, ...] = ("slip_rate", "traction", "load")
"""Curves of one period."""


@styled
def draw_cycle(found: LimitCycle, **place: Unpack[Place]) -> Figure:
    """Draw slip rate and traction over one period on the left, and load against slip rate on the right."""
    figure, grid = panels(2, 2, (7.6, 4.6), place)
    unit_of_loads = found.problem.load_unit
    time, (rate, traction, load) = found.run.curves_together(CURVES, found.begin, found.begin + found.period)
    time = time - found.begin
    values: Any = {"slip_rate": rate, "traction": traction, "load": load, "time": time}
    drawn = xr.Dataset({name: curve_quantity("along", one, name, unit_of_loads) for name, one in values.items()})
    units = {name: unit_shown(drawn[name]) for name in values}
    units["load"] = units["traction"]
    over = shown(drawn["time"], units["time"])
    for axes, name, colour in zip(grid[:, 0], CURVES, (BLUE, VERMILLION), strict=False):
        axes.plot(over, shown(drawn[name], units[name]), color=colour)
        axes.set(ylabel=label(drawn[name], units[name]), xlim=(over[0], over[-1]))
    zero_line(grid[1, 0])
    grid[1, 0].plot(over, shown(drawn["load"], units["load"]), color=INK, linewidth=0.9, linestyle=(0, (4, 2)), zorder=0)
    grid[1, 0].set_xlabel(label(drawn["time"], units["time"]))
    for axes in grid[:, 1]:
        axes.remove()
    plane = figure.add_subplot(grid[0, 1].get_gridspec()[:, 1])
    plane.plot(shown(drawn["slip_rate"], units["slip_rate"]), shown(drawn["load"], units["load"]), color=BLUE)
    if rate.min() > 0.0 and spans_decades(rate):
        plane.set_xscale("log")
        grid[0, 0].set_yscale("log")
    plane.set(xlabel=label(drawn["slip_rate"], units["slip_rate"]), ylabel=label(drawn["load"], units["load"]))
    letter_panels([*grid[:, 0], plane], ["one period", "traction, and load (dashed)", "phase plane"])
    return figure
