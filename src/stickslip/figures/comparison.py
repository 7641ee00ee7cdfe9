"""Figures 5 to 7: runs side by side, slip, slip rate and traction against time."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from stickslip.bodies import ElasticSlab
from stickslip.figures.style import BLUE, GREY, INK, VERMILLION, label, letter, panels, quantity, shown, styled, zero_line

if TYPE_CHECKING:
    from stickslip.evolution import Solution

COLOURS = (BLUE, VERMILLION)
ROWS = ("slip", "slip_rate", "traction", "load")


def data(solutions: Mapping[str, Solution], ends: Mapping[str, float], titles: Mapping[str, str] | None = None) -> xr.Dataset:
    """The runs from t = 0 to their `ends`, under their names; each has its own times, with both limits at every shock."""
    contents: dict[str, xr.Variable] = {}
    for name, solution in solutions.items():
        unit = solution.problem.load_unit
        force = "traction" if unit == "Pa" else "friction force"
        meaning = {
            "slip": ("slip", "u", "m"),
            "slip_rate": ("slip rate", "v", "m/s"),
            "traction": (force, r"\tau", unit),
            "load": ("load", r"\beta", unit),
        }
        for row in ROWS:
            time, values = solution.curve(row, 0.0, ends[name])
            contents[f"{name}_{row}"] = quantity(f"{name}_time", values, *meaning[row])
        contents[f"{name}_time"] = quantity(f"{name}_time", time, "time", "t", "s")
        body = solution.problem.body
        if isinstance(body, ElasticSlab):
            contents[f"{name}_two_way_time"] = quantity((), body.two_way_time, "two-way travel time 2h/c", "R", "s")
    shown_as = [(titles or {}).get(name, name) for name in solutions]
    attributes = {"title": "Runs side by side", "systems": list(solutions), "system_titles": shown_as}
    return xr.Dataset(contents, attrs=attributes)


@styled
def draw(dataset: xr.Dataset) -> Figure:
    """A column for each system; friction solid, the load behind it dashed."""
    names, titles = ([str(name) for name in np.atleast_1d(dataset.attrs[key])] for key in ("systems", "system_titles"))
    figure, axes = panels(3, len(names), (3.6 * len(names), 5.4), sharex="col")
    for column, (name, title) in enumerate(zip(names, titles, strict=True)):
        _draw_column(axes[:, column], dataset, name, COLOURS[column % 2])
        letter(axes[0, column], f"{'abcdef'[column]}   {title}")
    figure.align_ylabels()
    return figure


def _draw_column(column: list[Axes], dataset: xr.Dataset, name: str, colour: str) -> None:
    time = dataset[f"{name}_time"]
    for panel, row in zip(column, ROWS, strict=False):
        values = dataset[f"{name}_{row}"]
        if row == "traction":
            panel.plot(
                shown(time), shown(dataset[f"{name}_load"]), color=INK, linewidth=0.9, linestyle=(0, (4, 2)), label=r"load $\beta$"
            )
        panel.plot(shown(time), shown(values), color=colour, label=rf"{values.attrs['long_name']} ${values.attrs['symbol']}$")
        panel.set_ylabel(label(values))
        zero_line(panel)
        _mark_echo(panel, dataset, name, named=row == "slip")
    span = float(time[-1] - time[0])
    column[-1].set(xlabel=label(time), xlim=(float(time[0]) - 0.03 * span, float(time[-1])))
    column[-1].legend(loc="best")


def _mark_echo(panel: Axes, dataset: xr.Dataset, name: str, named: bool) -> None:
    if f"{name}_two_way_time" not in dataset:
        return
    at = float(dataset[f"{name}_two_way_time"])
    panel.axvline(at, color=GREY, linewidth=0.8, linestyle=":", zorder=0)
    if named:
        panel.annotate(
            "2h/c",
            (at, 1.0),
            (3, -2),
            xycoords=("data", "axes fraction"),
            textcoords="offset points",
            va="top",
            fontsize=8,
            color=GREY,
        )
