"""Figure of a branch of cycles: amplitude and period against the parameter, with its edges."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING, Unpack

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from stickslip.figures.names import parameter_name
from stickslip.figures.panels import add_legend, letter_panels, panels
from stickslip.figures.style import BLUE, GREY, INK, VERMILLION, curve_quantity, folded, label, quantity, shown, styled, unit_shown
from stickslip.foundation.place import Place

if TYPE_CHECKING:
    from stickslip.extensions.cycles.branch import BranchOfCycles
    from stickslip.foundation.arrays import Floats

LOOKS = {True: (BLUE, "-", "stable"), False: (VERMILLION, "--", "unstable"), None: (GREY, ":", "neither")}
"""Colours, lines and words of cycles, by whether they are stable."""
MARKS = ("o", "s", "D", "^", "v", "P")
"""Marks of edges, in the order of their names along the branch."""


@styled
def draw_branch(found: BranchOfCycles, **place: Unpack[Place]) -> Figure:
    """Draw amplitude and period of the cycles: solid where they are stable, dashed where not, with marks at the edges."""
    figure, grid = panels(2, 1, (6.4, 5.2), place, sharex=True)
    parameter, load_unit = found.parameter, found.problem.load_unit
    words = parameter_name(parameter.name, parameter.declared.meaning)
    sizes = {name: [getattr(one.measures, name) for one in found.points] for name in ("amplitude", "period")}
    rates = curve_quantity("cycle", sizes["amplitude"], "slip_rate", load_unit)
    rates.attrs["long_name"] = "amplitude of the slip rate"
    along = quantity("cycle", [one.value for one in found.points], words, "", parameter.unit or "1")
    periods = quantity("cycle", sizes["period"], "period", "T", "s")
    drawn = xr.Dataset({"along": along, "amplitude": rates, "period": periods})
    unit = unit_shown(drawn["along"])
    values = shown(drawn["along"], unit)
    for axes, name in zip(grid[:, 0], sizes, strict=True):
        own = unit_shown(drawn[name])
        _draw_cycles(axes, found, values, shown(drawn[name], own))
        axes.set_ylabel(folded(label(drawn[name], own)))
    grid[1, 0].set_xlabel(folded(label(drawn["along"], unit)))
    letter_panels(grid[:, 0], ["amplitude", "period"])
    add_legend(grid[0, 0], grid[0, 0].get_legend_handles_labels()[0])
    return figure


def _draw_cycles(axes: Axes, found: BranchOfCycles, values: Floats, sizes: Floats) -> None:
    """Draw one number of the cycles against the parameter."""
    kinds: list[bool | None] = []
    for one in found.points:  # an edge belongs to the cycles before it
        kinds.append(kinds[-1] if one.edge and kinds else one.stable)
    parts = [one.part for one in found.points]
    ends = [0, *(n for n in range(1, len(kinds)) if kinds[n] != kinds[n - 1] or parts[n] != parts[n - 1]), len(kinds)]
    named = set()
    for first, past in pairwise(ends):
        colour, line, word = LOOKS[kinds[first]]
        joins = first > 0 and parts[first] == parts[first - 1]
        drawn = slice(first - 1 if joins else first, past)  # from the cycle before: a part of the branch is one line
        axes.plot(values[drawn], sizes[drawn], line, color=colour, label="" if word in named else word, marker=".", markersize=3)
        named.add(word)
    names = list(dict.fromkeys(one.edge for one in found.points if one.edge))
    for name, mark in zip(names, MARKS, strict=False):
        here = np.array([one.edge == name for one in found.points])
        axes.plot(values[here], sizes[here], mark, color=INK, markerfacecolor="none", linestyle="none", label=name, zorder=4)
