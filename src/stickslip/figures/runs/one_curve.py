"""One quantity of a run against time, in a figure of one panel."""

from __future__ import annotations

from typing import TYPE_CHECKING, Unpack

from stickslip.figures.panels import set_title
from stickslip.figures.runs.curves import draw_curve, interval, set_time
from stickslip.figures.sheet import one_panel, result
from stickslip.figures.style import styled, title_of
from stickslip.solution.evaluation import Curve, Readings
from stickslip.solution.place import Place

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


@styled
def draw(
    readings: Readings, name: Curve, start: float | None = None, end: float | None = None, **place: Unpack[Place]
) -> Figure | Axes:
    """Draw one of `readings.curves` from `start` to `end` (s)."""
    start, end = interval(readings, start, end)
    axes = one_panel((6.4, 3.0), **place)
    draw_curve(axes, readings, name, (start, end))
    set_time(axes, readings, (start, end))
    if place.get("ax") is None:
        set_title(axes, title_of(readings))
    return result(axes, **place)
