"""Figure of several runs in one column of panels: slip, slip rate and traction against time, one line for each run."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Unpack

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from stickslip.figures.panels import add_legend, letter_panels, panels, set_log_ticks, zero_line
from stickslip.figures.style import LINE_COLOURS, axis_text, curve_quantity, nearly_flat, quantity, styled, time_unit, unit_of
from stickslip.foundation.place import Place
from stickslip.solution.evaluation import Curve, Readings

if TYPE_CHECKING:
    from stickslip.solution.solution import Solution
    from stickslip.studies.compare import Comparison

DASHES: tuple[Any, ...] = ("-", (0, (5, 2)), (0, (1, 1.5)), (0, (6, 2, 1, 2)))
"""Line styles; the next one is taken when all colours are used up."""
APART = 20.0
"""If the durations differ by more than this factor, each run is drawn against time divided by its own duration."""
FAR_APART = 300.0
"""If the largest slips or slip rates of the runs differ by more than this factor, the axis is logarithmic."""
MARGIN = 1.25
"""A run is drawn up to this multiple of the end of its last event, so that the rest after it is seen."""
ROWS = ("slip", "slip_rate", "traction")
"""Panels, from above."""


def data(study: Comparison) -> xr.Dataset:
    """Return the runs from their start to shortly after the last slip event of all, or one event of each in local time, in SI.

    All runs cover the same time, except those that end earlier. The comparison says which event is drawn, if any. Slip counts from
    the start of the run or of the event. If slabs (Pa) and blocks (N) are drawn together, tractions are divided by the normal
    stress or force. If the durations differ by more than the factor `APART`, times are divided by the duration drawn.
    """
    runs, event = study.runs, study.event
    views, spans = _whole(runs) if event is None else _windows(runs, event)
    lengths = [end - start for start, end in spans.values()]
    shares = max(lengths) > APART * min(lengths)
    mixed = len({run.problem.load_unit for run in runs.values()}) > 1
    contents: dict[str, xr.Variable] = {}
    for k, name in enumerate(runs):
        contents |= _run(f"run{k}", views[name], spans[name], shares=shares, mixed=mixed)
    units = [(length, *time_unit(length)) for length in lengths]
    attributes = {
        "runs": list(runs),
        "spans": [f"{length / size:.4g} {unit}{'s' if unit in ('year', 'day') else ''}" for length, unit, size in units],
        "shares": int(shares),
        "local": int(event is not None),
        "sticks": int(any(run.problem.friction.sticks for run in runs.values())),
    }
    return xr.Dataset(contents, attrs=attributes)


def _whole(runs: dict[str, Solution]) -> tuple[dict[str, Readings], dict[str, tuple[float, float]]]:
    """Return the runs, and start and end (s) of what is drawn of each.

    That is the same for all, unless the runs last so differently that each is drawn against its own duration.
    """
    ends = {name: float(run.history.span[1]) for name, run in runs.items()}
    over = {name: _last_end(run) for name, run in runs.items()}
    needed = {name: min(ends[name], MARGIN * over[name]) for name in runs}
    longest = max(needed.values())
    if longest <= APART * min(needed.values()):
        # Up to the earliest end of a run, if that leaves out no event.
        common = min(longest, max(min(ends.values()), *over.values()))
        needed = {name: min(common, end) for name, end in ends.items()}
    return dict(runs), {name: (0.0, end) for name, end in needed.items()}


def _last_end(run: Solution) -> float:
    """Return the end (s) of the last event of a run, or of the run if there is none, or one that is not over."""
    ends = run.events.end
    return float(run.history.span[1] if ends.empty or ends.isna().any() else ends.iloc[-1])


def _windows(runs: dict[str, Solution], event: int) -> tuple[dict[str, Readings], dict[str, tuple[float, float]]]:
    """Return a window on the event of each run, and its local start and end (s), as far as the run goes.

    They are the same for all, unless the events last so differently that each is drawn against its own duration.
    """
    views = {name: run.window(event) for name, run in runs.items()}
    longest, shortest = (of(views.values(), key=lambda view: view.after) for of in (max, min))
    if longest.after <= APART * shortest.after:
        views = {name: run.window(event, longest.before, longest.after) for name, run in runs.items()}
    return dict(views), {name: view.shown for name, view in views.items()}


def _run(key: str, view: Readings, span: tuple[float, float], *, shares: bool, mixed: bool) -> dict[str, xr.Variable]:
    """Return the curves of one run and their times, with `key` as prefix of the variables."""
    problem, contents = view.problem, {}
    slip: Curve = "event_slip" if "event_slip" in view.curves else "slip"
    for row, curve in zip(ROWS, (slip, "slip_rate", "traction"), strict=True):
        along = f"{key}_{row}_time"
        time, values = view.curve(curve, *span)
        if row == "traction" and not problem.friction.sticks:
            # Such a law has no friction at rest, where a run may start: that zero would set the scale.
            values = np.where(values != 0.0, values, np.nan)
        if row == "slip":
            slipped = values if slip == "event_slip" else values - problem.initial_slip
            contents[f"{key}_{row}"] = quantity(along, slipped, "slip", "u-u_0", "m")
        elif row == "traction" and mixed:
            contents[f"{key}_{row}"] = quantity(along, values / problem.normal, "friction", r"\tau/S", "1")
        else:
            contents[f"{key}_{row}"] = curve_quantity(along, values, row, problem.load_unit)
        part = (time - span[0]) / (span[1] - span[0])
        contents[along] = (
            quantity(along, part, "share of the time drawn", "t", "1") if shares else curve_quantity(along, time, "time")
        )
    return contents


@styled
def draw(dataset: xr.Dataset, **place: Unpack[Place]) -> Figure:
    """Draw three panels with a line for each run; if the durations differ much, the legend gives them."""
    figure, grid = panels(len(ROWS), 1, (6.4, 6.2), place, sharex=True)
    names, spans = (np.atleast_1d(dataset.attrs[key]).astype(str).tolist() for key in ("runs", "spans"))
    shares = dataset.attrs["shares"]
    times = [dataset[f"run{k}_slip_time"].values for k in range(len(names))]
    unit, size = ("1", 1.0) if shares else time_unit(max(float(np.ptp(time)) for time in times))
    for axes, row in zip(grid[:, 0], ROWS, strict=True):
        _draw_row(axes, dataset, row, size)
    texts = [f"{name} ({span})" for name, span in zip(names, spans, strict=True)] if shares else names
    marks = grid[0, 0].get_lines()[: len(names)]
    for mark, text in zip(marks, texts, strict=True):
        mark.set_label(text)
    add_legend(grid[0, 0], marks)
    letter_panels(grid[:, 0])
    since = " since each event began" if dataset.attrs["local"] else ""
    grid[-1, 0].set_xlabel(f"time{since}" + (", as a share of each run's own (see legend)" if shares else f" $t$ ({unit})"))
    figure.align_ylabels()
    return figure


def _draw_row(axes: Axes, dataset: xr.Dataset, row: str, size: float) -> None:
    drawn = [dataset[f"run{k}_{row}"] for k in range(np.size(dataset.attrs["runs"]))]
    about = drawn[0].attrs
    flat = row == "traction" and nearly_flat(*(values.values[np.isfinite(values.values)] for values in drawn))
    heights = [values.values - values.values[np.isfinite(values.values)][0] if flat else values.values for values in drawn]
    tops = [top for values in heights if (top := float(np.nanmax(np.abs(values)))) > 0.0]
    log = row != "traction" and len(tops) > 1 and max(tops) > FAR_APART * min(tops)
    unit, scale = (about["units"], 1.0) if log else unit_of(about["units"], *heights)
    for k, values in enumerate(heights):
        look = {"color": LINE_COLOURS[k % len(LINE_COLOURS)], "linestyle": DASHES[k // len(LINE_COLOURS) % len(DASHES)]}
        magnitudes = np.where(values != 0.0, np.abs(values), np.nan) if log else values / scale
        # Later lines are thinner, so that runs with the same curve all stay visible.
        axes.plot(dataset[f"run{k}_{row}_time"].values / size, magnitudes, linewidth=max(2.0 - 0.3 * k, 1.0), **look)
    symbol = f"|{about['symbol']}|" if log else about["symbol"]
    if log:
        # Two decades below the smaller run; rest has no place on the axis.
        axes.set(yscale="log", ylim=(1e-2 * min(tops), 3.0 * max(tops)))
        set_log_ticks(axes, "y")
    elif row != "traction" or dataset.attrs["sticks"]:
        zero_line(axes)
    if flat:
        axes.set_ylabel(f"change of {about['long_name']}\n" + axis_text(f"${symbol}$ from its start", "", unit))
    else:
        axes.set_ylabel(axis_text(about["long_name"], symbol, unit))
