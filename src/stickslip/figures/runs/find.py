"""Figure of the search for an edge: what each exact run gave along the parameter, and the last bracket."""

from __future__ import annotations

from typing import TYPE_CHECKING, Unpack

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.ticker import FixedFormatter, FixedLocator, MaxNLocator

from stickslip.figures.names import parameter_name
from stickslip.figures.panels import add_legend, finish, set_log_ticks
from stickslip.figures.sheet import one_panel
from stickslip.figures.style import BLUE, ORANGE, folded, label, quantity, shown, styled, unit_shown
from stickslip.foundation.place import Place
from stickslip.run import Edge

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def edge_data(found: Edge) -> xr.Dataset:
    """Return the runs in the order in which they were made (parameter in SI, and what they gave) and the last bracket."""
    values = found.table.iloc[:, 0].to_numpy(float)
    words = parameter_name(found.parameter, found.meaning)
    given = quantity("run", found.table.iloc[:, 1].to_numpy().astype(float), found.what, "", "1")
    given.attrs["yes_no"] = int(isinstance(found.at_low, bool))
    contents = {
        "parameter": quantity("run", values, words, "", found.unit or "1"),
        "given": given,
        "bracket": quantity("end", [found.low, found.high], words, "", found.unit or "1"),
    }
    return xr.Dataset(contents)


@styled
def draw_edge(dataset: xr.Dataset, **place: Unpack[Place]) -> Figure | Axes:
    """Draw what each run gave against the parameter, and the bracket in which it changes."""
    axes = one_panel((5.6, 3.0), **place)
    unit = unit_shown(dataset["parameter"])
    values, low_high = shown(dataset["parameter"], unit), shown(dataset["bracket"], unit)
    axes.axvspan(*low_high, color=ORANGE, zorder=0, label="last bracket")
    axes.plot(values, dataset["given"].values, "o", color=BLUE, label=f"{len(values)} exact runs")
    axes.set(xlabel=folded(label(dataset["parameter"], unit)), ylabel=dataset["given"].attrs["long_name"])
    if dataset["given"].attrs["yes_no"]:
        axes.yaxis.set_major_locator(FixedLocator([0.0, 1.0]))
        axes.yaxis.set_major_formatter(FixedFormatter(["no", "yes"]))
        axes.set_ylim(-0.25, 1.25)
    else:
        axes.yaxis.set_major_locator(MaxNLocator(integer=True))
    if np.min(values) > 0.0 and np.max(values) > 3.0 * np.min(values):
        axes.set_xscale("log")
        set_log_ticks(axes, "x")
    add_legend(axes, axes.get_legend_handles_labels()[0], own=place.get("ax") is not None)
    return finish(axes, "", **place)
