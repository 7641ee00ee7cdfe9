"""Figure of a catalogue of slip events: their times, one of them from years down to milliseconds, and their distributions."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator
from numpy.typing import NDArray

from stickslip.figures.style import BLUE, GREEN, GREY, INK, VERMILLION, letter, quantity, styled, time_unit, zero_line
from stickslip.foundation.errors import InputError
from stickslip.observables.predictability import is_followed, predictability
from stickslip.solution.solution import Solution

Floats = NDArray[np.float64]

CLOSE = 1e-3
"""The last zoom shows this share of the event's duration after its start, and a quarter of that before it."""
WIDE = 100.0
"""Positive values that span more than this factor, and counts above this number, are drawn on a logarithmic axis."""


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
    slips = table.slip.to_numpy(float)
    chosen = int(np.flatnonzero(slips >= 0.99 * slips.max())[-1]) if event is None else event
    window = solution.window(chosen)
    lasting = window.shown[1] / 1.1
    near = solution.window(chosen, before=0.25 * CLOSE * lasting, after=CLOSE * lasting)
    contents: dict[str, Any] = {}
    for name, text, units in (
        ("start", "start of the event", "s"),
        ("slip", "slip", "m"),
        ("recurrence", "recurrence time", "s"),
    ):
        contents[name] = quantity("event", table[name].to_numpy(float), text, "", units)
    for name, (time, slip) in (
        ("run", solution.curve("slip")),
        ("window", window.curve("event_slip")),
        ("close", near.curve("event_slip")),
    ):
        contents[f"{name}_time"] = quantity(f"{name}_point", time, "time", "t", "s")
        contents[f"{name}_slip"] = quantity(f"{name}_point", slip, "slip", "u", "m")
    contents["horizon"] = quantity((), _horizon(solution), "predictability horizon", "", "s")
    contents["chosen"] = xr.Variable((), chosen % len(table))
    title = f"{type(solution.problem.body).kind.replace('-', ' ')}, {type(solution.problem.friction).kind} friction"
    return xr.Dataset(contents, attrs={"title": f"{title}: {len(table)} slip event{'s' if len(table) > 1 else ''}"})


def _horizon(solution: Solution) -> float:
    """Return the predictability horizon (s), after which only statistics mean anything; inf if there is none or it is not known."""
    return predictability(solution).horizon if is_followed(solution.problem) else math.inf


@styled
def draw(dataset: xr.Dataset) -> Figure:
    """Draw the time line, slip against time in three zooms, the distributions of slip and recurrence time, and the return map.

    Parameters
    ----------
    dataset : xarray.Dataset
        What `data` returned.

    Returns
    -------
    matplotlib.figure.Figure
        The figure; pyplot does not know it, save it with its `savefig`.
    """
    figure = Figure(figsize=(7.6, 7.2), layout="constrained")
    axes = figure.subplot_mosaic("AAA;BCD;EFG")
    _draw_time_line(axes["A"], dataset)
    _draw_zooms([axes[name] for name in "BCD"], dataset)
    _draw_distribution(axes["E"], dataset["slip"].values)
    recurrence = dataset["recurrence"].values
    recurrence = recurrence[np.isfinite(recurrence)]
    _draw_recurrence(axes["F"], recurrence)
    _draw_return_map(axes["G"], recurrence)
    return figure


def _draw_time_line(axes: Axes, dataset: xr.Dataset) -> None:
    start, slip = dataset["start"].values, dataset["slip"].values
    end = float(dataset["run_time"].values[-1])
    unit, size = time_unit(end)
    low = 0.5 * slip.min() if _wide(slip) else 0.0
    axes.vlines(start / size, low, slip, color=BLUE, linewidth=0.9)
    axes.plot(start / size, slip, "o", color=BLUE, markersize=3)
    chosen = int(dataset["chosen"])
    axes.plot(start[chosen] / size, slip[chosen], "o", color=VERMILLION, markersize=6, markerfacecolor="none")
    horizon = float(dataset["horizon"])
    if horizon < end:
        axes.axvspan(horizon / size, 1.02 * end / size, color=GREY, alpha=0.15, linewidth=0.0)
        text, side = " shaded: beyond the predictability horizon ", "right" if horizon > 0.5 * end else "left"
        axes.annotate(text, (horizon / size, 0.02), xycoords=("data", "axes fraction"), ha=side, color=INK)
    axes.set_yscale("log" if _wide(slip) else "linear")
    axes.set_ylim(bottom=low)
    axes.set_xlim(-0.02 * end / size, 1.02 * end / size)
    axes.set_xlabel(f"time $t$ ({unit})")
    axes.set_ylabel("slip (m)")
    letter(axes, f"A  {dataset.attrs['title']}")


def _draw_zooms(panels: list[Axes], dataset: xr.Dataset) -> None:
    chosen, local = int(dataset["chosen"]), "since its start"
    shown = (("run", "B  the run", "time $t$"), ("window", "C  the event", local), ("close", "D  its start", local))
    for axes, (name, title, what) in zip(panels, shown, strict=True):
        time, slip = dataset[f"{name}_time"].values, dataset[f"{name}_slip"].values
        unit, size = time_unit(float(np.ptp(time)))
        power = _power(float(np.ptp(slip)))
        axes.plot(time / size, slip / power, color=GREEN)
        axes.set_xlabel(f"{what} ({unit})")
        kind = "slip $u$" if name == "run" else "slip in the event"
        axes.set_ylabel(f"{kind} ({_metres(power)})")
        axes.xaxis.set_major_locator(MaxNLocator(4))
        zero_line(axes)
        letter(axes, title)
    unit, size = time_unit(float(np.ptp(dataset["run_time"].values)))
    panels[0].axvline(float(dataset["start"].values[chosen]) / size, color=VERMILLION, linewidth=0.8, zorder=0)


def _draw_distribution(axes: Axes, slip: Floats) -> None:
    """Draw the number of events whose slip is at least x, against x."""
    ordered = np.sort(slip)
    many = len(slip) > WIDE
    smallest = ordered[0] if _wide(slip) else 0.0
    axes.step([smallest, *ordered, ordered[-1]], [len(slip), *range(len(slip), 0, -1), 1 if many else 0], where="pre", color=BLUE)
    axes.set_xscale("log" if _wide(slip) else "linear")
    axes.set_yscale("log" if many else "linear")
    if not many:
        axes.set_ylim(bottom=0.0)
        axes.yaxis.set_major_locator(MaxNLocator(4, integer=True))
    if not _wide(slip):
        axes.set_xlim(0.0, 1.15 * ordered[-1])
    axes.set_xlabel("slip (m)")
    axes.set_ylabel("number of events with slip ≥ $x$")
    letter(axes, "E  slip")


def _draw_recurrence(axes: Axes, recurrence: Floats) -> None:
    letter(axes, "F  recurrence times")
    if _too_few(axes, recurrence, 1):
        return
    unit, size = time_unit(float(recurrence.max()))
    times = recurrence / size
    bins = min(max(int(np.sqrt(4 * len(times))), 5), 60)
    edges = np.geomspace(times.min(), times.max(), bins + 1) if _wide(times) else np.linspace(0.0, 1.15 * times.max(), bins + 1)
    counts, _ = np.histogram(times, edges)
    axes.stairs(counts, edges, fill=True, color=BLUE)
    if counts.max() > WIDE:
        axes.set_yscale("log")
        axes.set_ylim(0.5, 4.0 * counts.max())
    else:
        axes.set_ylim(0.0, 1.25 * counts.max())
        axes.yaxis.set_major_locator(MaxNLocator(4, integer=True))
    axes.axvline(float(times.mean()), color=VERMILLION, linewidth=1.0)
    axes.set_xscale("log" if _wide(times) else "linear")
    axes.set_xlabel(f"recurrence time ({unit})")
    axes.set_ylabel("events")
    if len(times) > 1:
        variation = times.std(ddof=1) / times.mean()
        text = axes.text(
            0.03, 0.97, f"coefficient of variation {variation:.2g}", transform=axes.transAxes, va="top", color=VERMILLION
        )
        text.set_bbox({"facecolor": "white", "edgecolor": "none", "pad": 1.0})


def _draw_return_map(axes: Axes, recurrence: Floats) -> None:
    letter(axes, "G  return map")
    if _too_few(axes, recurrence, 2):
        return
    unit, size = time_unit(float(recurrence.max()))
    times = recurrence / size
    axes.plot(times[:-1], times[1:], "o", color=INK, markersize=2.5, alpha=0.7)
    low, high = (0.5 * times.min(), 2.0 * times.max()) if _wide(times) else (0.0, 1.15 * times.max())
    for scale, limits in ((axes.set_xscale, axes.set_xlim), (axes.set_yscale, axes.set_ylim)):
        scale("log" if _wide(times) else "linear")
        limits(low, high)
    axes.plot([low, high], [low, high], color=GREY, linewidth=0.8, zorder=0)
    axes.set_aspect("equal")
    axes.set_xlabel(f"recurrence time ({unit})")
    axes.set_ylabel(f"next recurrence time ({unit})")


def _too_few(axes: Axes, recurrence: Floats, needed: int) -> bool:
    """Return True, and say so in the panel, if there are fewer recurrence times than needed."""
    if len(recurrence) >= needed:
        return False
    axes.set_axis_off()
    axes.text(0.5, 0.5, f"needs {needed + 1} events", transform=axes.transAxes, ha="center", color=GREY)
    return True


def _wide(values: Floats) -> bool:
    return bool(values.min() > 0.0 and values.max() > WIDE * values.min())


def _power(length: float) -> float:
    """Return the size (m) of the unit in which a length is readable: m, mm, µm or nm."""
    return next((size for size in (1.0, 1e-3, 1e-6) if length > 0.5 * size), 1e-9)


def _metres(size: float) -> str:
    return {1.0: "m", 1e-3: "mm", 1e-6: "µm", 1e-9: "nm"}[size]
