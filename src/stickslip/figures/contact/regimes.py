"""Figure of the regime over two parameters of a problem: where the contact equation has one solution, and where several."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Unpack

import numpy as np
import xarray as xr
from matplotlib.artist import Artist
from matplotlib.collections import LineCollection
from matplotlib.colors import ListedColormap
from matplotlib.patches import Patch

from stickslip.contact.regime_map import RegimeMap
from stickslip.figures.legends import add_legend
from stickslip.figures.panels import draw_map, draw_parameters, parameter_variables, set_title
from stickslip.figures.sheet import one_panel, result
from stickslip.figures.style import INK, PALE, TWO, shown, styled, unit_shown
from stickslip.problem.problem import Problem
from stickslip.solution.place import Place

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

REGULAR, IRREGULAR = TWO
"""Colours of the two regimes, which are those of no and yes in maps of sweeps."""


def data(problem: Problem, found: RegimeMap, title: str = "") -> xr.Dataset:
    """Return a map of regimes as a dataset in SI, with the units of its axes; `title` is that of the scenario."""
    contents = {
        "margin": xr.Variable(("y", "x"), found.margin, {"long_name": "smallest g'(v)/Z over slip rates", "units": "1"}),
        "boundary": xr.Variable(("piece", "end", "coordinate"), found.boundary, {"long_name": "critical curve: x, y"}),
        "present": xr.Variable("coordinate", list(found.present), {"long_name": "the problem's own x, y"}),
    }
    return xr.Dataset(contents, coords=parameter_variables(problem, x=found.x, y=found.y), attrs={"title": title})


@styled
def draw(dataset: xr.Dataset, **place: Unpack[Place]) -> Figure | Axes:
    """Draw the two regimes as areas, the critical curve between them, and the point of the problem itself."""
    axes, margin = one_panel((5.4, 4.4), **place), dataset["margin"].values
    regime = np.where(np.isnan(margin), np.nan, margin < 0.0)
    draw_map(axes, dataset, regime, cmap=ListedColormap([REGULAR, IRREGULAR]), vmin=0, vmax=1)
    scales = np.array([unit_shown(dataset[name])[1] for name in ("x", "y")])
    curve = LineCollection(dataset["boundary"].values / scales, colors=INK, linewidths=1.6, label="critical: boundary of the two")
    axes.add_collection(curve)
    own: dict[str, Any] = {"markersize": 11, "markeredgecolor": "white", "label": "the scenario"}
    star = axes.plot(*(dataset["present"].values / scales), "*", color=INK, **own)
    draw_parameters(axes, dataset)
    axes.set(xlim=shown(dataset["x"])[[0, -1]], ylim=shown(dataset["y"])[[0, -1]])
    marks: list[Artist] = [Patch(color=REGULAR, label="regular: one slip rate at every load")]
    marks.append(Patch(color=IRREGULAR, label="irregular: several at some loads"))
    marks += [curve] if len(dataset["boundary"]) else []
    marks += [Patch(color=PALE, label="problem not valid")] if np.isnan(margin).any() else []
    add_legend(axes, [*marks, *star], own=place.get("ax") is not None)
    if place.get("ax") is None:
        set_title(axes, dataset.attrs["title"])
    return result(axes, **place)
