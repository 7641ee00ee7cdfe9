"""Figure of the regime over two parameters of a problem: where the contact equation has one solution, and where several."""

from __future__ import annotations

import numpy as np
import xarray as xr
from matplotlib.collections import LineCollection
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from stickslip.contact.regime_map import RegimeMap
from stickslip.figures.style import INK, PALE, SHOWN, letter, panels, styled
from stickslip.problem.parameters import parameter
from stickslip.problem.problem import Problem

REGULAR, IRREGULAR = "#D6E6F4", "#F8D9C4"
"""Colours of the two regimes."""


def data(problem: Problem, found: RegimeMap) -> xr.Dataset:
    """Return a map of regimes as a dataset in SI, with the units of its axes."""
    coordinates = {}
    for name, axis in (("x", found.x), ("y", found.y)):
        one = parameter(problem, axis.parameter)
        attributes = {"long_name": one.name, "units": one.unit, "log": int(axis.log)}
        coordinates[name] = xr.Variable(name, axis.values, attributes)
    contents = {
        "margin": xr.Variable(("y", "x"), found.margin, {"long_name": "smallest g'(v)/Z over slip rates", "units": "1"}),
        "boundary": xr.Variable(("piece", "end", "coordinate"), found.boundary, {"long_name": "critical curve: x, y"}),
        "present": xr.Variable("coordinate", list(found.present), {"long_name": "the problem's own x, y"}),
    }
    return xr.Dataset(contents, coords=coordinates, attrs={"title": f"Regimes: {type(problem.friction).kind} friction"})


@styled
def draw(dataset: xr.Dataset) -> Figure:
    """Draw the two regimes as areas, the critical curve between them, and the point of the problem itself."""
    figure, grid = panels(1, 1, (5.4, 4.2))
    axes = grid[0, 0]
    scales = [SHOWN.get(dataset[name].attrs["units"], ("", 1.0))[1] for name in ("x", "y")]
    x, y = (dataset[name].values / scale for name, scale in zip(("x", "y"), scales, strict=True))
    margin = dataset["margin"].values
    regime = np.ma.masked_invalid(np.where(np.isnan(margin), np.nan, margin < 0.0))
    axes.set_facecolor(PALE)
    axes.pcolormesh(x, y, regime, cmap=ListedColormap([REGULAR, IRREGULAR]), vmin=0, vmax=1, shading="nearest", rasterized=True)
    axes.add_collection(LineCollection(dataset["boundary"].values / np.array(scales), colors=INK, linewidths=1.6))
    marks = [Patch(color=REGULAR, label="regular: one slip rate"), Patch(color=IRREGULAR, label="irregular: several")]
    marks += [Patch(color=PALE, label="problem not valid")] if np.isnan(margin).any() else []
    own = axes.plot(
        *(dataset["present"].values / scales), "*", color=INK, markersize=11, markeredgecolor="white", label="the scenario"
    )
    for name, limits, axis in (("x", x, axes.xaxis), ("y", y, axes.yaxis)):
        attributes = dataset[name].attrs
        unit = SHOWN.get(attributes["units"], (attributes["units"],))[0]
        axis.set_label_text(attributes["long_name"] + ("" if unit == "1" else f" ({unit})"))
        getattr(axes, f"set_{name}scale")("log" if attributes["log"] else "linear")
        getattr(axes, f"set_{name}lim")(limits[0], limits[-1])
    figure.legend(handles=[*marks, *own], loc="outside lower center", ncols=4)
    letter(axes, dataset.attrs["title"])
    return figure
