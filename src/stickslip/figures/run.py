"""The default plot of a run: slip, slip rate, traction and load, one above the other."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib import pyplot
from matplotlib.figure import Figure
from numpy.typing import NDArray

from stickslip.figures.style import BLUE, GREEN, GREY, INK, SHOWN, VERMILLION, YEAR, letter, styled, zero_line

if TYPE_CHECKING:
    from stickslip.evolution import Solution

MANY = 60  # shocks beyond this are drawn by the curves alone: marks would hide them


@styled
def plot_run(solution: Solution, start: float = 0.0, end: float | None = None, *, title: str = "") -> Figure:
    """Draw the run from `start` to `end` (s) in a new pyplot figure, so that a notebook or `pyplot.show()` shows it.

    Shocks (jumps of the slip rate) are dotted lines; time is in years where seconds would be unreadable.
    """
    end = solution.duration if end is None else end
    unit, size = ("year", YEAR) if end - start > 0.5 * YEAR else ("s", 1.0)
    figure = pyplot.figure(figsize=(6.4, 5.6), layout="constrained")
    axes: Any = figure.subplots(3, 1, sharex=True)
    force, scale = SHOWN[solution.problem.load_unit]
    for panel, name, divide, colour in _curves(axes, scale):
        time, values = solution.curve(name, start, end)
        panel.plot(
            time / size,
            values / divide,
            color=colour,
            label=name,
            linestyle="--" if name == "load" else "-",
            linewidth=1.0 if name == "load" else 1.5,
        )
        zero_line(panel)
    for panel in axes:
        for at in _shock_times(solution, start, end):
            panel.axvline(at / size, color=GREY, linewidth=0.7, linestyle=":", zorder=0)
    axes[0].set_ylabel("slip $u$ (m)")
    axes[1].set_ylabel("slip rate $v$ (m/s)")
    axes[2].set(ylabel=f"traction, load ({force})", xlabel=f"time $t$ ({unit})")
    axes[2].legend(loc="best")
    letter(axes[0], title or _title(solution))
    figure.align_ylabels()
    return figure


def _curves(axes: Any, scale: float) -> tuple[tuple[Any, str, float, str], ...]:
    return (
        (axes[0], "slip", 1.0, BLUE),
        (axes[1], "slip_rate", 1.0, GREEN),
        (axes[2], "load", scale, INK),
        (axes[2], "traction", scale, VERMILLION),
    )


def _shock_times(solution: Solution, start: float, end: float) -> NDArray[np.float64]:
    times = np.asarray(solution.shocks["time"], dtype=float)
    times = times[(times >= start) & (times <= end)]
    return times if times.size <= MANY else times[:0]


def _title(solution: Solution) -> str:
    problem = solution.problem
    body = type(problem.body).kind.replace("-", " ").capitalize()
    return f"{body}, {type(problem.friction).kind} friction"
