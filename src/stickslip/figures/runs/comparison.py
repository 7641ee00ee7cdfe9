"""Figures 5 to 7 of the paper: runs side by side, with slip, slip rate and traction against time."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from stickslip.figures.runs.curves import Name, nearly_flat
from stickslip.figures.style import BLUE, GREY, INK, VERMILLION, label, letter, panels, quantity, shown, styled, zero_line

if TYPE_CHECKING:
    from stickslip.solution.solution import Solution

DASHED: dict[str, Any] = {"linewidth": 0.9, "linestyle": (0, (4, 2))}
"""Look of the load's line."""
COLOURS = (BLUE, VERMILLION)
ROWS: tuple[Name, ...] = ("slip", "slip_rate", "traction", "load")
"""Curves of each run, in SI; the panel of traction shows the load too."""


def data(solutions: Mapping[str, Solution], ends: Mapping[str, float], titles: Mapping[str, str] | None = None) -> xr.Dataset:
    """Return the curves of each run from t = 0 to its entry in `ends` (s), in SI, with the run's name as prefix of the variables.

    Each run has its own times, with both limits at every shock. `titles` names the columns.
    """
    contents: dict[str, xr.Variable] = {}
    for name, solution in solutions.items():
        unit = solution.problem.load_unit
        force, load = ("traction", "load") if unit == "Pa" else ("friction force", "spring force")
        meaning = {
            "slip": ("slip", "u", "m"),
            "slip_rate": ("slip rate", "v", "m/s"),
            "traction": (force, r"\tau", unit),
            "load": (load, r"\beta", unit),
        }
        for row in ROWS:
            time, values = solution.curve(row, 0.0, ends[name])
            contents[f"{name}_{row}"] = quantity(f"{name}_time", values, *meaning[row])
        contents[f"{name}_time"] = quantity(f"{name}_time", time, "time", "t", "s")
        body = solution.problem.body
        if body.has_waves:
            contents[f"{name}_two_way_time"] = quantity((), body.round_trip_time, "two-way travel time 2h/c", "R", "s")
    shown_as = [(titles or {}).get(name, name) for name in solutions]
    attributes = {"title": "Runs side by side", "systems": list(solutions), "system_titles": shown_as}
    return xr.Dataset(contents, attrs=attributes)


@styled
def draw(dataset: xr.Dataset) -> Figure:
    """Draw a column for each system, with friction as a solid line and the load as a dashed line behind it."""
    names, titles = ([str(name) for name in np.atleast_1d(dataset.attrs[key])] for key in ("systems", "system_titles"))
    figure, axes = panels(3, len(names), (3.6 * len(names), 5.4), sharex="col")
    for column, (name, title) in enumerate(zip(names, titles, strict=True)):
        _draw_column(axes[:, column], dataset, name, COLOURS[column % 2])
        letter(axes[0, column], f"{'abcdef'[column]}   {title}")
    figure.align_ylabels()
    return figure


def _draw_column(column: NDArray[Any], dataset: xr.Dataset, name: str, colour: str) -> None:
    time = dataset[f"{name}_time"]
    for panel, row in zip(column[:2], ROWS, strict=False):
        values = dataset[f"{name}_{row}"]
        panel.plot(shown(time), shown(values), color=colour)
        panel.set_ylabel(label(values))
        zero_line(panel)
    _draw_stress(column[2], dataset, name, colour)
    span = float(time[-1] - time[0])
    column[2].set(xlabel=label(time), xlim=(float(time[0]) - 0.03 * span, float(time[-1])))
    for panel in column:
        _mark_echo(panel, dataset, name, named=panel is column[0])


def _draw_stress(panel: Axes, dataset: xr.Dataset, name: str, colour: str) -> None:
    """Draw friction and load, as changes from the initial load if they hardly change."""
    time, friction, load = (dataset[f"{name}_{row}"] for row in ("time", "traction", "load"))
    text, symbol = friction.attrs["long_name"], friction.attrs["symbol"]
    if nearly_flat(friction.values, load.values):
        start = float(load[0])
        panel.plot(shown(time), load.values - start, color=INK, **DASHED, label=load.attrs["long_name"])
        panel.plot(shown(time), friction.values - start, color=colour, label=text)
        panel.set_ylabel(f"{text} change\n${symbol}-\\beta(0)$ ({friction.attrs['units']})")
    else:
        panel.plot(shown(time), shown(load), color=INK, **DASHED, label=load.attrs["long_name"])
        panel.plot(shown(time), shown(friction), color=colour, label=text)
        panel.set_ylabel(label(friction))
    zero_line(panel)
    panel.legend(loc="lower right", bbox_to_anchor=(1.0, 0.97), ncols=2, borderaxespad=0.0)


def _mark_echo(panel: Axes, dataset: xr.Dataset, name: str, named: bool) -> None:
    if f"{name}_two_way_time" not in dataset:
        return
    at = float(dataset[f"{name}_two_way_time"])
    panel.axvline(at, color=GREY, linewidth=0.8, linestyle=":", zorder=0)
    if named:
        where: dict[str, Any] = {"xycoords": ("data", "axes fraction"), "textcoords": "offset points"}
        panel.annotate("2h/c", (at, 1.0), (0, 2), ha="center", fontsize=8, color=GREY, **where)
