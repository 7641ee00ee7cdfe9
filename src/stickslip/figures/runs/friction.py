"""The friction coefficient of a run against slip, in a figure of one panel."""

from __future__ import annotations

from typing import TYPE_CHECKING, Unpack

from stickslip.figures.panels import set_title
from stickslip.figures.runs.curves import draw_friction, interval
from stickslip.figures.sheet import one_panel, result
from stickslip.figures.style import styled, title_of
from stickslip.solution.evaluation import Readings
from stickslip.solution.place import Place

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


@styled
def draw(readings: Readings, start: float | None = None, end: float | None = None, **place: Unpack[Place]) -> Figure | Axes:
    """Draw the friction coefficient against slip from `start` to `end` (s), as papers on laboratory friction do."""
    axes = one_panel((6.4, 3.2), **place)
    draw_friction(axes, readings, interval(readings, start, end), against_slip=True)
    if place.get("ax") is None:
        set_title(axes, title_of(readings))
    return result(axes, **place)
