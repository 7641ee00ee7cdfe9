"""The friction coefficient of a run against slip or slip rate, in a figure of one panel."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal, Unpack

from stickslip.figures.panels import set_title
from stickslip.figures.runs.curves import draw_friction, interval
from stickslip.figures.sheet import one_panel, result
from stickslip.figures.style import styled, title_of
from stickslip.foundation.arguments import shown
from stickslip.foundation.errors import InputError, nearest
from stickslip.solution.evaluation import Readings
from stickslip.solution.place import Place

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


@styled
def draw(
    readings: Readings,
    start: float | None = None,
    end: float | None = None,
    against: Literal["slip", "slip_rate"] = "slip",
    **place: Unpack[Place],
) -> Figure | Axes:
    """Draw the friction coefficient against slip, as papers on laboratory friction do, or slip rate, from `start` to `end` (s)."""
    if against not in ("slip", "slip_rate"):
        raise InputError(f"friction: against {shown(against)} is unknown; {nearest(str(against), ('slip', 'slip_rate'))}")
    axes = one_panel((6.4, 3.2), **place)
    draw_friction(axes, readings, interval(readings, start, end), against)
    if place.get("ax") is None:
        set_title(axes, title_of(readings))
    return result(axes, **place)
