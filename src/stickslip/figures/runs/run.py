"""The default plot of a run: panels with slip, slip rate, traction and load, and the loading below if it varies."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib import pyplot
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from stickslip.figures.panels import letter, zero_line
from stickslip.figures.runs.loading import draw_loading
from stickslip.figures.style import (
    BLUE,
    GREEN,
    GREY,
    INK,
    VERMILLION,
    Floats,
    clock,
    curve_label,
    nearly_flat,
    readable,
    styled,
    system_title,
    time_unit,
)
from stickslip.solution.evaluation import Readings

MANY = 60
"""If there are more shocks than this, they are not marked: the marks would hide the curves."""


@styled
def plot_run(solution: Readings, start: float | None = None, end: float | None = None, *, title: str = "") -> Figure:
    """Draw a run, or a window on it, from `start` to `end` (s) in a new pyplot figure.

    A notebook or `pyplot.show()` displays it. Shocks (jumps of the slip rate) are marked by dotted lines. The unit of time, from µs
    to years, suits the interval. If the friction law never sticks, the slip rate has a logarithmic axis.
    """
    start, end = solution.shown[0] if start is None else start, solution.shown[1] if end is None else end
    unit, size = time_unit(end - start)
    varies = solution.problem.varies
    heights = [3, 3, 3, 2] if varies else [1, 1, 1]
    figure = pyplot.figure(figsize=(6.4, 6.8 if varies else 5.6), layout="constrained")
    axes: Any = figure.subplots(len(heights), 1, sharex=True, height_ratios=heights)
    for panel, name, colour in ((axes[0], solution.curves[0], BLUE), (axes[1], "slip_rate", GREEN)):
        time, values = solution.curve(name, start, end)
        if name == "slip_rate" and not solution.problem.friction.sticks:
            # A contact that never sticks slips at widely different rates.
            panel.set_yscale("log")
            values = np.where(values != 0.0, np.abs(values), np.nan)
        panel.plot(time / size, values, color=colour)
        panel.set_ylabel(curve_label(name))
    _draw_stress(axes[2], solution, start, end, size)
    if varies:
        draw_loading(axes[3], solution, start, end, size)
    for panel in axes[:3]:
        if panel.get_yscale() == "linear":
            zero_line(panel)
        for at in _shock_times(solution, start, end):
            panel.axvline(at / size, color=GREY, linewidth=0.7, linestyle=":", zorder=0)
    axes[-1].set_xlabel(f"{clock(solution)} ({unit})")
    letter(axes[0], title or system_title(solution.problem))
    figure.align_ylabels()
    return figure


def _draw_stress(panel: Axes, solution: Readings, start: float, end: float, size: float) -> None:
    """Draw traction and load, as changes from the problem's initial load if they hardly change."""
    units = solution.problem.load_unit
    (time, load), (_, traction) = solution.curve("load", start, end), solution.curve("traction", start, end)
    unit, scale = readable(float(np.abs(load).max()), units)
    offset, text = 0.0, f"traction, load ({unit})"
    if nearly_flat(load, traction):
        scale, offset, text = 1.0, solution.problem.load, f"change of\ntraction, load ({units})"
    panel.plot(time / size, (load - offset) / scale, color=INK, linewidth=1.0, linestyle="--", label=r"load $\beta$")
    panel.plot(time / size, (traction - offset) / scale, color=VERMILLION, label=r"traction $\tau$")
    panel.set_ylabel(text)
    panel.legend(loc="best")


def _shock_times(solution: Readings, start: float, end: float) -> Floats:
    times = np.asarray(solution.shocks["time"], dtype=float)
    times = times[(times >= start) & (times <= end)]
    return times if times.size <= MANY else times[:0]
