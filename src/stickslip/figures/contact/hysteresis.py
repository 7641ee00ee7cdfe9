"""Figure 4 of the paper: the rule of perfect delay, as followed by an actual run whose load rises and then falls."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Unpack

import numpy as np
import xarray as xr
from matplotlib.axes import Axes

from stickslip.figures.contact import resistance
from stickslip.figures.contact.resistance import load_unit
from stickslip.figures.panels import letter_panels, zero_line
from stickslip.figures.sheet import sheet
from stickslip.figures.style import BLUE, GREY, INK, VERMILLION, Floats, curve_quantity, label, shown, styled, unit_shown
from stickslip.solution.place import Place

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from stickslip.solution.solution import Solution

CASE = "loop"
"""Prefix of the variables that `resistance.data` adds for the set K."""


def data(solution: Solution) -> xr.Dataset:
    """Return slip rate (m/s) and load (Pa) of a run, whose load must rise and then fall, and the set K that it follows."""
    time, (rate, load) = solution.curves_together(("slip_rate", "load"))
    turn = int(np.argmax(load))
    background = resistance.data({CASE: solution.problem}, float(rate.max()))
    run = {
        "run_time": curve_quantity("run_time", time, "time"),
        "run_slip_rate": curve_quantity("run_time", rate, "slip_rate"),
        "run_load": curve_quantity("run_time", load, "load"),
        "run_turn": xr.Variable((), turn, {"long_name": "index at which the load turns from rising to falling"}),
    }
    return background.assign(run).assign_attrs(title="The rule of perfect delay")


@styled
def draw(dataset: xr.Dataset, **place: Unpack[Place]) -> Figure:
    """Draw the loop in the plane of slip rate and load on the left, and the same run against time on the right."""
    figure = sheet((7.2, 3.8), **place)
    axes: Any = figure.subplot_mosaic([["loop", "load"], ["loop", "rate"]], width_ratios=(1.25, 1))
    _draw_loop(axes["loop"], dataset)
    _draw_time(axes["load"], axes["rate"], dataset)
    figure.align_ylabels([axes["load"], axes["rate"]])
    letter_panels((axes["loop"], axes["load"], axes["rate"]), ("Set K and the path of a run", "Load", "Slip rate"))
    return figure


def _parts(dataset: xr.Dataset) -> tuple[tuple[slice, str, str], ...]:
    turn = int(dataset["run_turn"])
    return (slice(None, turn + 1), VERMILLION, "load rises: ODABE"), (slice(turn, None), BLUE, "load falls: EBCDO")


def _draw_loop(axes: Axes, dataset: xr.Dataset) -> None:
    resistance.draw_set(axes, dataset, CASE, quiet=True)
    rate = shown(dataset["run_slip_rate"], unit_shown(dataset["slip_rate"]))
    load = shown(dataset["run_load"], load_unit(dataset))
    shift = 0.012 * rate.max()  # both paths follow the same branches: draw them side by side, not on top of each other
    for (part, colour, text), side in zip(_parts(dataset), (-1, 1), strict=True):
        x, y = rate[part] + side * shift, load[part] - side * 0.35
        axes.plot(x, y, color=colour, linewidth=1.8, label=text)
        _arrows(axes, x, y, colour)
    axes.set(ylim=(50, 90), xlim=(-0.04 * rate.max(), 1.04 * rate.max()))
    resistance.draw_points(axes, dataset, CASE, D=(8, 3))
    axes.annotate("to O", (0, 50), (6, 4), textcoords="offset points", fontsize=9, fontweight="bold")
    axes.set_ylabel(label(dataset["run_load"], load_unit(dataset)))
    axes.legend(loc="lower right")


def _arrows(axes: Axes, x: Floats, y: Floats, colour: str) -> None:
    """Draw arrow heads in the middle of the jump, and halfway along the slipping and the sticking part of the path."""
    jump = int(np.argmax(np.abs(np.diff(x))))
    halves = [(low, high) for low, high in ((0, jump), (jump + 1, x.size - 1)) if high - low > 10]
    middles = [(low + 2 * (high - low) // 5, low + 3 * (high - low) // 5) for low, high in halves]
    for first, last in ((jump, jump + 1), *middles):
        tail, head = ((x[first] + share * (x[last] - x[first]), y[first] + share * (y[last] - y[first])) for share in (0.4, 0.6))
        axes.annotate("", head, tail, arrowprops={"arrowstyle": "-|>", "color": colour})


def _draw_time(top: Axes, bottom: Axes, dataset: xr.Dataset) -> None:
    time = shown(dataset["run_time"])
    for axes, name, unit in ((top, "run_load", load_unit(dataset)), (bottom, "run_slip_rate", unit_shown(dataset["slip_rate"]))):
        for part, colour, _ in _parts(dataset):
            axes.plot(time[part], shown(dataset[name], unit)[part], color=colour)
        axes.set(ylabel=label(dataset[name], unit), xlim=(0, time[-1]))
    for point, left in (("A", 0.0), ("C", 0.25 * time[-1])):
        stress, size = load_unit(dataset)
        level = dataset[f"{CASE}_point_{point}"].values[1] / size
        top.axhline(level, color=GREY, linewidth=0.8, linestyle=":", zorder=0)
        text = f"fold {point}, {level:.2f} {stress}"
        top.annotate(text, (left, level), (3, 2), textcoords="offset points", fontsize=7.5, color=INK)
    zero_line(bottom)
    top.tick_params(labelbottom=False)
    bottom.set_xlabel(label(dataset["run_time"]))
    bottom.sharex(top)
