"""Figure of the regime over two parameters of a problem: where the contact equation has one solution, and where several."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Unpack

import numpy as np
from matplotlib.artist import Artist
from matplotlib.collections import LineCollection
from matplotlib.colors import ListedColormap
from matplotlib.patches import Patch

from stickslip.contact import RegimeMap
from stickslip.figures.panels import add_legend, draw_map, draw_parameters, finish, parameter_numbers
from stickslip.figures.sheet import one_panel
from stickslip.figures.style import INK, PALE, TWO, shown, styled, unit_shown
from stickslip.foundation.place import Place
from stickslip.problem import Problem

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

REGULAR, IRREGULAR = TWO
"""Colours of the two regimes, which are those of no and yes in maps of sweeps."""


@styled
def draw_regimes(problem: Problem, found: RegimeMap, title: str = "", **place: Unpack[Place]) -> Figure | Axes:
    """Draw the two regimes as areas, the critical curve between them, and the point of the problem itself.

    `title` is that of the scenario.
    """
    axes, margin = one_panel((5.4, 4.4), **place), found.margin
    numbers = parameter_numbers(problem, x=found.x, y=found.y)
    regime = np.where(np.isnan(margin), np.nan, margin < 0.0)
    draw_map(axes, numbers, regime, cmap=ListedColormap([REGULAR, IRREGULAR]), vmin=0, vmax=1)
    scales = np.array([unit_shown(one)[1] for one in numbers.values()])
    curve = LineCollection(found.boundary / scales, colors=INK, linewidths=1.6, label="critical: boundary of the two")
    axes.add_collection(curve)
    own: dict[str, Any] = {"markersize": 11, "markeredgecolor": "white", "label": "the scenario"}
    star = axes.plot(*(np.array(found.present) / scales), "*", color=INK, **own)
    draw_parameters(axes, numbers)
    axes.set(xlim=shown(numbers["x"])[[0, -1]], ylim=shown(numbers["y"])[[0, -1]])
    marks: list[Artist] = [Patch(color=REGULAR, label="regular: one slip rate at every load")]
    marks.append(Patch(color=IRREGULAR, label="irregular: several at some loads"))
    marks += [curve] if len(found.boundary) else []
    marks += [Patch(color=PALE, label="problem not valid")] if np.isnan(margin).any() else []
    add_legend(axes, [*marks, *star], own=place.get("ax") is not None)
    return finish(axes, title, **place)
