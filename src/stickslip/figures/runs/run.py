"""The default figure of a run: slip, slip rate, traction and load against time, and the loading below if it varies."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Unpack

from stickslip.figures.legends import add_legend
from stickslip.figures.panels import letter_panels, set_title
from stickslip.figures.runs.curves import draw_curve, draw_friction, draw_stress, interval, mark_shocks, set_time
from stickslip.figures.runs.loading import draw_loading
from stickslip.figures.sheet import sheet
from stickslip.figures.style import styled, title_of
from stickslip.solution.evaluation import Readings
from stickslip.solution.place import Place

if TYPE_CHECKING:
    from matplotlib.figure import Figure

WIDTH = 6.4
"""Usual width of the figure, inches."""
HEIGHTS = {"curve": 1.75, "loading": 1.25, "slip": 2.0}
"""Usual heights (inches) of a panel with a curve, of that of the loading, and of that with friction against slip."""


@styled
def draw(readings: Readings, start: float | None = None, end: float | None = None, **place: Unpack[Place]) -> Figure:
    """Draw a run, or a window on it, from `start` to `end` (s).

    Shocks (jumps of the slip rate) are marked by dotted lines. The unit of time, from µs to years, suits the interval. If the
    friction law never sticks, the slip rate has a logarithmic axis, friction is drawn as a coefficient in place of traction and
    load, and a further panel shows it against slip, as papers on laboratory friction do. The start from rest of such a contact is
    left out of these panels: its scale is far from all that follows.
    """
    span = interval(readings, start, end)
    figure, panels = _panels(readings, place)
    *curves, stress = panels["curves"]
    for panel, name in zip(curves, (readings.curves[0], "slip_rate"), strict=True):
        draw_curve(panel, readings, name, span)
    if readings.problem.friction.sticks:
        draw_stress(stress, readings, span)
    else:
        draw_friction(stress, readings, span)
    mark_shocks([*curves, stress], readings, span)
    last = stress
    for last in panels["loading"]:
        draw_loading(last, readings, *span)
    set_time(last, readings, span)
    for panel in panels["slip"]:
        draw_friction(panel, readings, span, "slip")
    add_legend(stress, [mark for panel in (stress, *panels["loading"]) for mark in panel.get_legend_handles_labels()[0]])
    letter_panels([panel for group in panels.values() for panel in group])
    set_title(figure, title_of(readings))
    figure.align_ylabels()
    return figure


def _panels(readings: Readings, place: Place) -> tuple[Figure, dict[str, list[Any]]]:
    """Return the figure and its panels in one column: three curves, the loading if it varies, and friction against slip."""
    groups = {"curves": 3, "loading": int(readings.problem.varies), "slip": int(not readings.problem.friction.sticks)}
    heights = [HEIGHTS["curve"]] * 3 + [HEIGHTS["loading"]] * groups["loading"] + [HEIGHTS["slip"]] * groups["slip"]
    figure = sheet((WIDTH, 0.35 + sum(heights)), **place)
    grid = figure.add_gridspec(len(heights), 1, height_ratios=heights)
    found: dict[str, list[Any]] = {name: [] for name in groups}
    first = None
    for k, name in enumerate([name for name, count in groups.items() for _ in range(count)]):
        panel = figure.add_subplot(grid[k], sharex=first if name != "slip" else None)
        first = first or panel
        found[name].append(panel)
    timed = [*found["curves"], *found["loading"]]
    for panel in timed[:-1]:
        panel.tick_params(labelbottom=False)
    return figure, found
