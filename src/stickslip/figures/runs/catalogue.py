"""Figure of a catalogue of slip events: their times, one of them from years down to milliseconds, and their distributions."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Unpack

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.ticker import MaxNLocator

from stickslip.figures.panels import count_ticks, leave_empty, letter, set_scale, zero_line
from stickslip.figures.runs.slab_panels import last_large_event
from stickslip.figures.sheet import Place, sheet
from stickslip.figures.style import (
    BLUE,
    GREEN,
    GREY,
    INK,
    VERMILLION,
    WIDE,
    Floats,
    curve_label,
    curve_quantity,
    length_unit,
    quantity,
    spans_decades,
    styled,
    time_unit,
    title_of,
)
from stickslip.foundation.errors import InputError
from stickslip.observables.predictability import is_followed, predictability
from stickslip.solution.solution import Solution

if TYPE_CHECKING:
    from matplotlib.figure import Figure

CLOSE = 1e-3
"""The last zoom shows this share of the event's duration after its start, and a quarter of that before it."""
ZOOMS = {
    "run": ("B  the run", "slip", "time $t$"),
    "window": ("C  the event", "event_slip", "since its start"),
    "close": ("D  its start", "event_slip", "since its start"),
}
"""Title, curve and name of the time axis of the three zooms, by the prefix of their variables."""


def data(solution: Solution, event: int | None = None) -> xr.Dataset:
    """Return the catalogue of a run, its slip, and one event in local time.

    Parameters
    ----------
    solution : Solution
        The run.
    event : int, optional
        Row number in `solution.events`; negative ones count from the last. By default the last event whose slip is at least 99 %
        of the largest.

    Returns
    -------
    xarray.Dataset
        In SI: start (s), slip (m) and recurrence time (s) of all events; slip (m) against time (s) over the whole run, over the
        event, and at the start of the event, the last two in s since the event began; the predictability `horizon` (s; inf if
        there is none or it is not known); and `chosen`, the row number of the event.

    Raises
    ------
    InputError
        If the run has no slip event, or not the one asked for.
    """
    table = solution.events
    if table.empty:
        raise InputError("catalogue figure: the run has no slip event")
    chosen = last_large_event(table.slip.to_numpy(float)) if event is None else event
    window = solution.window(chosen)
    lasting = window.shown[1] / 1.1
    near = solution.window(chosen, before=0.25 * CLOSE * lasting, after=CLOSE * lasting)
    about = {"start": ("start of the event", "s"), "slip": ("slip", "m"), "recurrence": ("recurrence time", "s")}
    contents = {name: quantity("event", table[name].to_numpy(float), text, "", unit) for name, (text, unit) in about.items()}
    for name, readings in (("run", solution), ("window", window), ("close", near)):
        time, slip = readings.curve("slip" if name == "run" else "event_slip")
        contents[f"{name}_time"] = curve_quantity(f"{name}_point", time, "time")
        contents[f"{name}_slip"] = curve_quantity(f"{name}_point", slip, "slip")
    # After the horizon only statistics mean anything.
    horizon = predictability(solution).horizon if is_followed(solution.problem) else math.inf
    contents["horizon"] = quantity((), horizon, "predictability horizon", "", "s")
    contents["chosen"] = xr.Variable((), chosen % len(table))
    count = f"{len(table)} slip event{'s' if len(table) > 1 else ''}"
    return xr.Dataset(contents, attrs={"title": f"{title_of(solution)}: {count}".removeprefix(": ")})


@styled
def draw(dataset: xr.Dataset, **place: Unpack[Place]) -> Figure:
    """Draw the time line, slip against time in three zooms, the distributions of slip and recurrence time, and the return map."""
    figure = sheet((7.6, 7.2), **place)
    axes = figure.subplot_mosaic("AAA;BCD;EFG")
    _draw_time_line(axes["A"], dataset)
    _draw_zooms([axes[name] for name in "BCD"], dataset)
    _draw_distribution(axes["E"], dataset["slip"].values)
    recurrence = dataset["recurrence"].values
    recurrence = recurrence[np.isfinite(recurrence)]
    for name, title, needed, draw_times in (
        ("F", "F  recurrence times", 1, _draw_recurrence),
        ("G", "G  return map", 2, _draw_return_map),
    ):
        letter(axes[name], title)
        if len(recurrence) < needed:
            leave_empty(axes[name], f"needs {needed + 1} events")
        else:
            unit, size = time_unit(float(recurrence.max()))
            draw_times(axes[name], recurrence / size, unit)
    return figure


def _draw_time_line(axes: Axes, dataset: xr.Dataset) -> None:
    slip, wide = dataset["slip"].values, spans_decades(dataset["slip"].values)
    unit, size = time_unit(float(dataset["run_time"].values[-1]))
    start, end = dataset["start"].values / size, float(dataset["run_time"].values[-1]) / size
    low = 0.5 * slip.min() if wide else 0.0
    axes.vlines(start, low, slip, color=BLUE, linewidth=0.9)
    axes.plot(start, slip, "o", color=BLUE, markersize=3)
    chosen, horizon = int(dataset["chosen"]), float(dataset["horizon"]) / size
    axes.plot(start[chosen], slip[chosen], "o", color=VERMILLION, markersize=6, markerfacecolor="none")
    if horizon < end:
        axes.axvspan(horizon, 1.02 * end, color=GREY, alpha=0.15, linewidth=0.0)
        text, side = " shaded: beyond the predictability horizon ", "right" if horizon > 0.5 * end else "left"
        axes.annotate(text, (horizon, 0.02), xycoords=("data", "axes fraction"), ha=side, color=INK)
    set_scale(axes, "y", wide)
    axes.set_ylim(bottom=low)
    axes.set(xlim=(-0.02 * end, 1.02 * end), xlabel=curve_label("time", unit), ylabel="slip (m)")
    letter(axes, f"A  {dataset.attrs['title']}")


def _draw_zooms(panels: list[Axes], dataset: xr.Dataset) -> None:
    for axes, (name, (title, curve, clock)) in zip(panels, ZOOMS.items(), strict=True):
        time, slip = dataset[f"{name}_time"].values, dataset[f"{name}_slip"].values
        (unit, size), (length, metres) = time_unit(float(np.ptp(time))), length_unit(float(np.ptp(slip)))
        axes.plot(time / size, slip / metres, color=GREEN)
        if name == "run":
            axes.axvline(float(dataset["start"][int(dataset["chosen"])]) / size, color=VERMILLION, linewidth=0.8, zorder=0)
        axes.set(xlabel=f"{clock} ({unit})", ylabel=curve_label(curve, length))
        axes.xaxis.set_major_locator(MaxNLocator(4))
        zero_line(axes)
        letter(axes, title)


def _draw_distribution(axes: Axes, slip: Floats) -> None:
    """Draw the number of events whose slip is at least x, against x."""
    ordered, many, wide = np.sort(slip), len(slip) > WIDE, spans_decades(slip)
    smallest = ordered[0] if wide else 0.0
    axes.step([smallest, *ordered, ordered[-1]], [len(slip), *range(len(slip), 0, -1), 1 if many else 0], where="pre", color=BLUE)
    set_scale(axes, "x", wide)
    set_scale(axes, "y", many)
    if not many:
        axes.set_ylim(bottom=0.0)
        count_ticks(axes)
    if not wide:
        axes.set_xlim(0.0, 1.15 * ordered[-1])
    axes.set(xlabel="slip $x$ (m)", ylabel="number of events with slip ≥ $x$")
    letter(axes, "E  slip")


def _draw_recurrence(axes: Axes, times: Floats, unit: str) -> None:
    """Draw a histogram of recurrence times, given in `unit`, with their mean and their coefficient of variation."""
    bins = min(max(int(np.sqrt(4 * len(times))), 5), 60)
    wide = spans_decades(times)
    edges = np.geomspace(times.min(), times.max(), bins + 1) if wide else np.linspace(0.0, 1.15 * times.max(), bins + 1)
    counts, _ = np.histogram(times, edges)
    axes.stairs(counts, edges, fill=True, color=BLUE)
    if counts.max() > WIDE:
        axes.set(yscale="log", ylim=(0.5, 4.0 * counts.max()))
    else:
        axes.set_ylim(0.0, 1.25 * counts.max())
        count_ticks(axes)
    axes.axvline(float(times.mean()), color=VERMILLION, linewidth=1.0)
    set_scale(axes, "x", wide)
    axes.set(xlabel=f"recurrence time ({unit})", ylabel="events")
    if len(times) > 1:
        text = f"coefficient of variation {times.std(ddof=1) / times.mean():.2g}"
        behind = {"facecolor": "white", "edgecolor": "none", "pad": 1.0}
        axes.text(0.03, 0.97, text, transform=axes.transAxes, va="top", color=VERMILLION, bbox=behind)


def _draw_return_map(axes: Axes, times: Floats, unit: str) -> None:
    """Draw each recurrence time, given in `unit`, against the one before it."""
    axes.plot(times[:-1], times[1:], "o", color=INK, markersize=2.5, alpha=0.7)
    wide = spans_decades(times)
    limits = (0.5 * times.min(), 2.0 * times.max()) if wide else (0.0, 1.15 * times.max())
    set_scale(axes, "xy", wide)
    axes.plot(limits, limits, color=GREY, linewidth=0.8, zorder=0)
    axes.set(xlim=limits, ylim=limits, aspect="equal")
    axes.set(xlabel=f"recurrence time ({unit})", ylabel=f"next recurrence time ({unit})")
