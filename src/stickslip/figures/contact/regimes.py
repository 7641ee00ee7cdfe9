"""Figure of the regime over two parameters of a problem: where the contact equation has one solution, and where several."""

from __future__ import annotations

import numpy as np
import xarray as xr
from matplotlib.collections import LineCollection
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from stickslip.contact.regime_map import RegimeMap
from stickslip.figures.panels import draw_map, draw_parameters, letter, panels, parameter_variables
from stickslip.figures.style import INK, LIGHT_BLUE, LIGHT_ORANGE, PALE, shown, styled, unit_shown
from stickslip.problem.problem import Problem

REGULAR, IRREGULAR = LIGHT_BLUE, LIGHT_ORANGE
"""Colours of the two regimes."""


def data(problem: Problem, found: RegimeMap) -> xr.Dataset:
    """Return a map of regimes as a dataset in SI, with the units of its axes."""
    contents = {
        "margin": xr.Variable(("y", "x"), found.margin, {"long_name": "smallest g'(v)/Z over slip rates", "units": "1"}),
        "boundary": xr.Variable(("piece", "end", "coordinate"), found.boundary, {"long_name": "critical curve: x, y"}),
        "present": xr.Variable("coordinate", list(found.present), {"long_name": "the problem's own x, y"}),
    }
    title = f"Regimes: {type(problem.friction).kind} friction"
    return xr.Dataset(contents, coords=parameter_variables(problem, x=found.x, y=found.y), attrs={"title": title})


@styled
def draw(dataset: xr.Dataset) -> Figure:
    """Draw the two regimes as areas, the critical curve between them, and the point of the problem itself."""
    figure, grid = panels(1, 1, (5.4, 4.2))
    axes, margin = grid[0, 0], dataset["margin"].values
    regime = np.where(np.isnan(margin), np.nan, margin < 0.0)
    draw_map(axes, dataset, regime, cmap=ListedColormap([REGULAR, IRREGULAR]), vmin=0, vmax=1)
    scales = np.array([unit_shown(dataset[name])[1] for name in ("x", "y")])
    axes.add_collection(LineCollection(dataset["boundary"].values / scales, colors=INK, linewidths=1.6))
    own = {"markersize": 11, "markeredgecolor": "white", "label": "the scenario"}
    star = axes.plot(*(dataset["present"].values / scales), "*", color=INK, **own)
    draw_parameters(axes, dataset)
    axes.set(xlim=shown(dataset["x"])[[0, -1]], ylim=shown(dataset["y"])[[0, -1]])
    marks = [Patch(color=REGULAR, label="regular: one slip rate"), Patch(color=IRREGULAR, label="irregular: several")]
    marks += [Patch(color=PALE, label="problem not valid")] if np.isnan(margin).any() else []
    figure.legend(handles=[*marks, *star], loc="outside lower center", ncols=4)
    letter(axes, dataset.attrs["title"])
    return figure
