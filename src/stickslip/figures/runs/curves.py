"""Curves of a run against time: the interval, units, scales and limits of their axes, and marks of shocks."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, Literal, Unpack

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes

from stickslip.engine import SlipEvents, shock_columns
from stickslip.figures.panels import add_legend, finish, set_log_ticks, zero_line
from stickslip.figures.runs.asked import DRAWN_KINDS
from stickslip.figures.runs.packed import draw_line
from stickslip.figures.sheet import one_panel
from stickslip.figures.style import (
    BLUE,
    GREEN,
    GREY,
    INK,
    PURPLE,
    VERMILLION,
    axis_text,
    clock,
    curve_label,
    nearly_flat,
    styled,
    time_unit,
    title_of,
)
from stickslip.foundation.arguments import shown
from stickslip.foundation.arrays import Floats
from stickslip.foundation.errors import InputError, nearest
from stickslip.foundation.names import TURNS, name_of, readable_unit
from stickslip.foundation.place import Place
from stickslip.friction.contract import STATE_NAMES
from stickslip.problem import default_event_rate
from stickslip.solution import Curve, Readings, times_of
from stickslip.solution.observables import event_columns

if TYPE_CHECKING:
    from matplotlib.figure import Figure

COLOURS: dict[str, str] = {
    "slip": BLUE,
    "event_slip": BLUE,
    "slip_rate": GREEN,
    "traction": VERMILLION,
    "load": INK,
    "state": PURPLE,
    "second_state": PURPLE,
    "friction": VERMILLION,
    "drive_rate": PURPLE,
    "drive_traction": PURPLE,
    "surface_torque": PURPLE,
}
"""Colour of each curve, the same in all figures."""
DASHES: dict[str, Any] = {"color": INK, "linewidth": 1.0, "linestyle": "--", "zorder": 2.1}
"""Look of the load: above the line of friction, which it coincides with at rest, so that both are seen."""
MOST_EVENTS, IN_EVENT = 1000, 33
"""Against slip, each of up to so many slip events has so many points of its own."""
MOST_SHOCKS = 60
"""If there are more shocks than this, they are not marked: the marks would hide the curves."""
BRIEF = 0.01
"""The start from rest is left out if it takes less than this share of the time that is shown."""
Span = tuple[float, float]
"""First and last time that are drawn, s."""


def interval(readings: Readings, start: float | None, end: float | None) -> Span:
    """Return the interval (s) that is asked for; the default is what the run or the window shows."""
    first, last = (limit if one is None else float(times_of(one)) for one, limit in zip((start, end), readings.shown, strict=True))
    return first, last


def set_time(axes: Axes, readings: Readings, span: Span) -> None:
    """Set the label of the time axis."""
    axes.set_xlabel(f"{clock(readings)} ({time_unit(span[1] - span[0])[0]})")


def draw_curve(axes: Axes, readings: Readings, name: Curve, span: Span) -> None:
    """Draw one curve against time, with its label; the slip rate on a logarithmic axis if the contact creeps at rest."""
    time, values = readings.curve(name, *span)
    settled = after_start(readings, time, span)
    change = name == "slip" and nearly_flat(values) and np.ptp(values) > 0.0
    if change:
        values = values - values[0]
    log = name == "slip_rate" and readings.problem.friction.creeps
    if log:
        values = np.where((values != 0.0) & settled, np.abs(values), np.nan)
    elif name == "traction":
        values = np.where(settled, values, np.nan)
    if name in STATE_NAMES:
        state = readings.problem.friction.states[STATE_NAMES.index(name)]
        size, text = 1.0, axis_text(name_of(name), "", state.unit)
    else:
        unit, size = readable_unit(readings.problem.unit_of(name), values, log=log)
        text = curve_label(name, unit, readings.problem.load_unit)
    draw_line(axes, time / time_unit(span[1] - span[0])[1], values / size, log=log, color=COLOURS[name])
    axes.set_ylabel(f"change of {text}" if change else text)
    if log:
        axes.set_yscale("log")
        fit_height(axes, [values / size])
        set_log_ticks(axes, "y")
    elif name in ("slip", "event_slip", "slip_rate"):
        zero_line(axes)


def draw_drive_rate(axes: Axes, readings: Readings, span: Span) -> None:
    """Draw the rate of the drive beside that of the contact, in the unit of the latter, with an entry for a key."""
    _, values = readings.curve("slip_rate", *span)
    time, drive = readings.curve("drive_rate", *span)
    size = readable_unit(readings.problem.unit_of("slip_rate"), values, log=readings.problem.friction.creeps)[1]
    look: dict[str, Any] = {"color": PURPLE, "linewidth": 1.0, "linestyle": "--", "label": name_of("drive_rate", TURNS)}
    draw_line(axes, time / time_unit(span[1] - span[0])[1], drive / size, **look)


def after_start(readings: Readings, time: Floats, span: Span) -> Floats:
    """Return True for the times after the start from rest, which is not drawn where it would set the limits of an axis.

    A contact whose law never sticks starts at a slip rate of 0, far below all that follow, and a block accelerates from there
    within one period. If no more is shown than that, all times count.
    """
    if not readings.problem.friction.creeps or span[0] > 0.0 or "event_slip" in readings.curves:
        return np.ones(time.shape, bool)
    body = readings.problem.body
    lasts = DRAWN_KINDS[body.structure].accelerates_for(body)
    if lasts > BRIEF * (span[1] - span[0]):
        lasts = 0.0
    # Of the two limits at the start of a slab, the first is the state at rest.
    return np.asarray((time > lasts) | ((time == 0.0) & (np.arange(len(time)) > 0) & (lasts == 0.0)))


def fit_height(axes: Axes, values: Sequence[Floats]) -> None:
    """Set the limits of the vertical axis to those of the given values, with a margin."""
    known = np.concatenate(values)
    known = known[np.isfinite(known)]
    if not known.size:
        return
    low, high = float(known.min()), float(known.max())
    if axes.get_yscale() == "log":
        room = max((high / low) ** 0.08, 1.3)
        axes.set_ylim(low / room, high * room)
    else:
        room = 0.08 * (high - low) or 0.05 * abs(high) or 1.0
        axes.set_ylim(low - room, high + room)


def marks_in(*panels: Axes) -> list[Artist]:
    """Return the entries of a key for panels, each text once."""
    found = [pair for panel in panels for pair in zip(*panel.get_legend_handles_labels(), strict=True)]
    return list({text: mark for mark, text in reversed(found)}.values())[::-1]


def draw_stress(axes: Axes, readings: Readings, span: Span) -> None:
    """Draw traction and load against time, as changes from the problem's initial load if they hardly change."""
    units = readings.problem.load_unit
    names = [name_of(name, units) for name in ("traction", "load")]
    time, (load, traction) = readings.curves_together(("load", "traction"), *span)
    change = nearly_flat(load, traction)
    offset = readings.problem.load if change else 0.0
    unit, size = readable_unit(units, load - offset, traction - offset)
    seconds = time_unit(span[1] - span[0])[1]
    draw_line(axes, time / seconds, (load - offset) / size, label=rf"{names[1]} $\beta$", **DASHES)
    draw_line(axes, time / seconds, (traction - offset) / size, label=rf"{names[0]} $\tau$", color=VERMILLION)
    shared = " " + names[1].rpartition(" ")[2]
    text = f"{names[0].removesuffix(shared)} and\n{names[1]}" if names[0].endswith(shared) else ", ".join(names)
    before = "change of" + ("\n" if "," in text else " ")
    axes.set_ylabel(f"{before if change else ''}{text} ({unit})")
    if change or min(load.min(), traction.min()) < 0.5 * max(load.max(), traction.max()):
        zero_line(axes)
    else:
        fit_height(axes, [load / size, traction / size])


def draw_friction(axes: Axes, readings: Readings, span: Span, against: Literal["time", "slip", "slip_rate"] = "time") -> None:
    """Draw the friction coefficient, against time beside the load over the normal load, or against slip or slip rate."""
    slip = readings.curves[0]
    names: tuple[Curve, ...] = ("load", "traction", "normal_load")
    time, values = readings.curves_together(names, *span)
    if against != "time" and readings.problem.friction.sticks:
        time, values = _with_events(readings, span, time, dict(zip(names, values, strict=True)))
    load, traction, normal = values
    across, settled = time / time_unit(span[1] - span[0])[1], after_start(readings, time, span)
    traction, load = (np.where(settled, values, np.nan) for values in (traction, load))
    if against != "time":
        moving: Curve = slip if against == "slip" else "slip_rate"
        moved = getattr(readings, moving)(time)
        unit, size = readable_unit(readings.problem.unit_of(moving), moved)
        across = moved / size
        axes.set_xlabel(curve_label(moving, unit, readings.problem.load_unit))
    look: dict[str, Any] = {"color": VERMILLION, "label": r"friction coefficient $\mu=\tau/S$"}
    if against == "time":
        name = name_of("load", readings.problem.load_unit)
        draw_line(axes, across, load / normal, label=rf"{name} over normal load, $\beta/S$", **DASHES)
        draw_line(axes, across, traction / normal, **look)
    else:
        axes.plot(across, traction / normal, **look)
    axes.set_ylabel(curve_label("friction"))
    fit_height(axes, [traction / normal] if against != "time" else [traction / normal, load / normal])


def _with_events(readings: Readings, span: Span, time: Floats, values: dict[Curve, Floats]) -> tuple[Floats, list[Floats]]:
    """Return times, and the values of curves, with more points in slip events: their time is short, their slip is what is drawn."""
    found = SlipEvents.of(readings.history, default_event_rate(readings.problem))
    if not 0 < len(found.pulses) <= MOST_EVENTS:
        return time, list(values.values())
    table = event_columns(readings.history, found)
    ends = [np.asarray(table[name], float) for name in ("start", "end")]
    ends = [np.clip(np.where(np.isfinite(one), one, span[1]), *span) for one in ends]
    first, last = (one[ends[1] > ends[0]] for one in ends)
    inside = np.linspace(first, last - 1e-9 * (last - first), IN_EVENT).ravel(order="F")  # an end is known to rounding
    edges = np.concatenate((first, last))
    added = np.concatenate((edges, inside))
    together = np.concatenate((time, added))
    order = np.argsort(together, kind="stable")
    curves = [getattr(readings, name) for name in values]
    left, right = [one(edges, side="left") for one in curves], [one(inside) for one in curves]
    return together[order], [np.concatenate(parts)[order] for parts in zip(values.values(), left, right, strict=True)]


def mark_shocks(panels: Sequence[Axes], readings: Readings, span: Span) -> None:
    """Mark the shocks (jumps of the slip rate) by dotted lines, with an entry in the legend of the last panel."""
    times = shock_columns(readings.history, *span)["time"]
    size = time_unit(span[1] - span[0])[1]
    for panel in panels:
        for k, at in enumerate(times if times.size <= MOST_SHOCKS else ()):
            name = "shock (jump of the slip rate)" if k == 0 and panel is panels[-1] else None
            panel.axvline(at / size, color=GREY, linewidth=0.7, linestyle=":", zorder=0, label=name)


@styled
def draw_alone(
    readings: Readings, name: Curve, start: float | None = None, end: float | None = None, **place: Unpack[Place]
) -> Figure | Axes:
    """Draw one of `readings.curves`, in a figure of one panel, from `start` to `end` (s)."""
    start, end = interval(readings, start, end)
    axes = one_panel((6.4, 3.0), **place)
    draw_curve(axes, readings, name, (start, end))
    set_time(axes, readings, (start, end))
    add_legend(axes, marks_in(axes), own=place.get("ax") is not None)
    return finish(axes, title_of(readings), **place)


@styled
def draw_friction_alone(
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
    return finish(axes, title_of(readings), **place)
