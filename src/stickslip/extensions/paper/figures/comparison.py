"""Figures 5 to 7 of the paper: runs side by side, with slip, slip rate and traction against time."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, Unpack

import numpy as np
import xarray as xr
from matplotlib.axes import Axes

from stickslip.figures.panels import letter_panels, panels, zero_line
from stickslip.figures.runs.asked import DRAWN_KINDS
from stickslip.figures.style import GREY, INK, LINE_COLOURS, curve_quantity, label, nearly_flat, quantity, shown, styled, unit_shown
from stickslip.foundation.names import readable_unit
from stickslip.foundation.place import Place

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from stickslip.solution import Curve, Solution

Unit = tuple[str, float]
"""Name of a unit, and its size in SI units."""
APART_SYSTEMS = 100.0
"""Systems whose largest values differ by more than this factor have units of their own."""
RUN_CURVES: tuple[Curve, ...] = ("slip", "slip_rate", "traction", "load")
"""Curves of each run, in SI; the panel of traction shows the load too."""


def comparison_data(solutions: Mapping[str, Solution], end: float, titles: Mapping[str, str] | None = None) -> xr.Dataset:
    """Return the curves of each run from t = 0 to `end` (s), in SI, with the run's name as prefix of the variables.

    Each run has its own times, with both limits at every shock. `titles` names the columns.
    """
    contents: dict[str, xr.Variable] = {}
    for name, solution in solutions.items():
        body, along = solution.problem.body, f"{name}_time"
        for row in RUN_CURVES:
            time, values = solution.curve(row, 0.0, end)
            contents[f"{name}_{row}"] = curve_quantity(along, values, row, solution.problem.load_unit)
        contents[along] = curve_quantity(along, time, "time")
        for echo in DRAWN_KINDS[body.structure].echoes_after(body):
            contents[f"{name}_two_way_time"] = quantity((), echo, "two-way travel time 2h/c", "R", "s")
    shown_as = [(titles or {}).get(name, name) for name in solutions]
    return xr.Dataset(contents, attrs={"title": "Runs side by side", "systems": list(solutions), "system_titles": shown_as})


@styled
def draw_comparison(dataset: xr.Dataset, **place: Unpack[Place]) -> Figure:
    """Draw a column for each system, with friction as a solid line and the load as a dashed line behind it."""
    names, titles = ([str(name) for name in np.atleast_1d(dataset.attrs[key])] for key in ("systems", "system_titles"))
    figure, axes = panels(3, len(names), (3.6 * len(names), 5.4), place, sharex=True)
    units = {row: _units(dataset, names, row) for row in ("slip", "slip_rate")}
    clock = unit_shown(*(dataset[f"{name}_time"] for name in names))
    for k, name in enumerate(names):
        own = {row: units[row][k] for row in units} | {"time": clock}
        _draw_column(axes[:, k], dataset, name, LINE_COLOURS[k % 2], own)
    letter_panels(axes.T.flat, [text for title in titles for text in (title, "", "")])
    figure.align_ylabels()
    return figure


def _units(dataset: xr.Dataset, names: list[str], row: str) -> list[Unit]:
    """Return the unit of one row of panels for each system: the same for all, unless they are too far apart for that."""
    values = [dataset[f"{name}_{row}"] for name in names]
    tops = [top for one in values if (top := float(np.abs(one).max())) > 0.0]
    if tops and max(tops) <= APART_SYSTEMS * min(tops):
        return [unit_shown(*values)] * len(names)
    return [unit_shown(one) for one in values]


def _draw_column(column: Any, dataset: xr.Dataset, name: str, colour: str, units: Mapping[str, Unit]) -> None:
    time = dataset[f"{name}_time"]
    for panel, row in zip(column[:2], RUN_CURVES, strict=False):
        values = dataset[f"{name}_{row}"]
        panel.plot(shown(time, units["time"]), shown(values, units[row]), color=colour)
        panel.set_ylabel(label(values, units[row]))
        zero_line(panel)
    _draw_stress(column[2], dataset, name, colour, units["time"])
    first, last = (float(at) / units["time"][1] for at in time[[0, -1]])
    column[2].set(xlabel=label(time, units["time"]), xlim=(first - 0.03 * (last - first), last))
    if f"{name}_two_way_time" in dataset:
        _mark_echo(column, float(dataset[f"{name}_two_way_time"]) / units["time"][1])


def _draw_stress(panel: Axes, dataset: xr.Dataset, name: str, colour: str, clock: Unit) -> None:
    """Draw friction and load, as changes from the initial load if they hardly change."""
    time, friction, load = (dataset[f"{name}_{row}"] for row in ("time", "traction", "load"))
    about, change = friction.attrs, nearly_flat(friction.values, load.values)
    start = float(load[0]) if change else 0.0
    unit, size = readable_unit(about["units"], friction.values - start, load.values - start)
    dashed: dict[str, Any] = {"color": INK, "linewidth": 0.9, "linestyle": (0, (4, 2))}
    for variable, look in ((load, dashed), (friction, {"color": colour})):
        panel.plot(shown(time, clock), (variable.values - start) / size, label=variable.attrs["long_name"], **look)
    what = f"{about['long_name']} change\n${about['symbol']}-\\beta(0)$ ({unit})"
    panel.set_ylabel(what if change else label(friction, (unit, size)))
    zero_line(panel)
    panel.legend(loc="lower right", bbox_to_anchor=(1.0, 0.97), ncols=2, borderaxespad=0.0)


def _mark_echo(column: Any, at: float) -> None:
    """Mark the return of the first echo, at 2h/c, in every panel."""
    for panel in column:
        panel.axvline(at, color=GREY, linewidth=0.8, linestyle=":", zorder=0)
    where: dict[str, Any] = {"xycoords": ("data", "axes fraction"), "textcoords": "offset points"}
    column[0].annotate("2h/c", (at, 1.0), (0, 2), ha="center", fontsize=8, color=GREY, **where)
