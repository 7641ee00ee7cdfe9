"""The default figure of a run: slip, slip rate, traction and load against time, and the loading below if it varies."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Unpack

import numpy as np
from matplotlib.axes import Axes

from stickslip.figures.panels import add_legend, letter_panels, set_scale, set_title, zero_line
from stickslip.figures.runs.curves import (
    draw_curve,
    draw_drive_rate,
    draw_friction,
    draw_stress,
    fit_height,
    interval,
    mark_shocks,
    marks_in,
    set_time,
)
from stickslip.figures.runs.given import curve_of, varying
from stickslip.figures.sheet import sheet
from stickslip.figures.style import GREY, INK, PALE, styled, time_unit, title_of
from stickslip.foundation.names import for_readers, readable_unit
from stickslip.foundation.place import Place
from stickslip.solution import Readings

if TYPE_CHECKING:
    from matplotlib.figure import Figure


WIDTH_OF_FIGURE = 6.4
"""Usual width of the figure, inches."""
HEIGHTS = {"curves": 1.75, "drive": 1.5, "loading": 1.25, "slip": 2.0}
"""Usual heights (inches) of a panel with a curve, with what a drive measures, with the loading, and with friction against slip."""


@styled
def draw_run(readings: Readings, start: float | None = None, end: float | None = None, **place: Unpack[Place]) -> Figure:
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
    for last in panels["drive"]:
        draw_curve(last, readings, "surface_torque", span)
        draw_drive_rate(curves[1], readings, span)
    for field, last in zip(varying(readings.problem), panels["loading"], strict=True):
        _draw_loading(last, readings, field, *span)
    set_time(last, readings, span)
    for panel in panels["slip"]:
        draw_friction(panel, readings, span, "slip")
    add_legend(stress, marks_in(stress, *panels["loading"], *curves))
    letter_panels([panel for group in panels.values() for panel in group])
    set_title(figure, title_of(readings))
    figure.align_ylabels()
    return figure


def _panels(readings: Readings, place: Place) -> tuple[Figure, dict[str, list[Any]]]:
    """Return the figure and its panels in one column.

    They are three curves, what the drive of a string measures, the loading if it varies, and friction against slip.
    """
    groups = {"curves": 3, "drive": int(bool(readings.at_drive)), "loading": len(varying(readings.problem))}
    groups |= {"slip": int(not readings.problem.friction.sticks)}
    heights = [HEIGHTS[name] for name, count in groups.items() for _ in range(count)]
    figure = sheet((WIDTH_OF_FIGURE, 0.35 + sum(heights)), **place)
    grid = figure.add_gridspec(len(heights), 1, height_ratios=heights)
    found: dict[str, list[Any]] = {name: [] for name in groups}
    first = None
    for k, name in enumerate([name for name, count in groups.items() for _ in range(count)]):
        panel = figure.add_subplot(grid[k], sharex=first if name != "slip" else None)
        first = first or panel
        found[name].append(panel)
    timed = [*found["curves"], *found["drive"], *found["loading"]]
    for panel in timed[:-1]:
        panel.tick_params(labelbottom=False)
    return figure, found


def _draw_loading(panel: Axes, readings: Readings, name: str, start: float, end: float) -> None:
    """Draw the varying field of a name from `start` to `end` (s since the epoch of the readings).

    The axis is logarithmic if the field is positive and spans a factor of ten or more, as steps of the pull rate do.
    """
    size = time_unit(end - start)[1]
    history = varying(readings.problem)[name]
    row, offset = readings.history.epoch
    begun = row * readings.history.round_trip_time + offset
    time, values, swing = curve_of(history, start + begun, end + begun)
    spread, what, is_band = swing, name.replace("_", " "), swing > 0.0
    unit, scale = readable_unit(readings.problem.unit_of(name), np.abs(values) + spread)
    time = (time - begun) / size
    if is_band:
        panel.fill_between(
            time, (values - swing) / scale, (values + swing) / scale, facecolor=PALE, edgecolor=GREY, label="range of the tone"
        )
    panel.plot(time, values / scale, color=INK, label=f"{what} without its tone" if is_band else None)
    low, high = float((values - spread).min()), float((values + spread).max())
    if low > 0.0 and high >= 10.0 * low:
        set_scale(panel, "y", log=True)
        fit_height(panel, [values / scale])
    elif low < 0.0 < high:
        zero_line(panel)
    panel.set_ylabel(f"{what}\n({for_readers(unit)})")
