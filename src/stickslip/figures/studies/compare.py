"""Figure of several runs in one column of panels: slip, slip rate and traction against time, one line for each run."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Unpack

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from stickslip.figures.panels import letter, panels, zero_line
from stickslip.figures.sheet import Place
from stickslip.figures.style import LINE_COLOURS, axis_text, curve_quantity, label, nearly_flat, quantity, shown, styled, time_unit
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
    """Return the runs from their start to shortly after their last slip event, or one event of each in local time, in SI.

    The comparison says which event, if any. Slip counts from the start of the run or of the event. If slabs (Pa) and blocks (N) are
    drawn together, tractions are divided by the normal stress or force. If the durations differ by more than the factor `APART`,
    times are divided by the duration drawn.
    """
    runs, event = study.runs, study.event
    views: dict[str, Readings] = {name: run if event is None else run.window(event) for name, run in runs.items()}
    spans = {name: _span(run) if event is None else views[name].shown for name, run in runs.items()}
    lengths = [end - start for start, end in spans.values()]
    shares = max(lengths) > APART * min(lengths)
    mixed = len({run.problem.load_unit for run in runs.values()}) > 1
    contents: dict[str, xr.Variable] = {}
    for k, name in enumerate(runs):
        contents |= _run(f"run{k}", views[name], spans[name], shares=shares, mixed=mixed)
    units = [(length, *time_unit(length)) for length in lengths]
    attributes = {
        "title": "Runs side by side",
        "runs": list(runs),
        "spans": [f"{length / size:.4g} {unit}" for length, unit, size in units],
        "shares": int(shares),
        "local": int(event is not None),
    }
    return xr.Dataset(contents, attrs=attributes)


def _span(run: Solution) -> tuple[float, float]:
    """Return start and end (s) of what is drawn: up to shortly after the last event.

    A run without events, or with one that is not over, is drawn up to its end.
    """
    end = float(run.history.span[1])
    events = run.events
    if events.empty or events.end.isna().any():
        return 0.0, end
    return 0.0, min(end, MARGIN * float(events.end.iloc[-1]))


def _run(key: str, view: Readings, span: tuple[float, float], *, shares: bool, mixed: bool) -> dict[str, xr.Variable]:
    """Return the curves of one run and their times, with `key` as prefix of the variables."""
    problem, contents = view.problem, {}
    slip: Curve = "event_slip" if "event_slip" in view.curves else "slip"
    for row, curve in zip(ROWS, (slip, "slip_rate", "traction"), strict=True):
        along = f"{key}_{row}_time"
        time, values = view.curve(curve, *span)
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
    figure, grid = panels(len(ROWS), 1, (6.4, 6.4), place, sharex=True)
    names, spans = (np.atleast_1d(dataset.attrs[key]).astype(str).tolist() for key in ("runs", "spans"))
    shares = dataset.attrs["shares"]
    times = [dataset[f"run{k}_slip_time"].values for k in range(len(names))]
    unit, size = ("1", 1.0) if shares else time_unit(max(float(np.ptp(time)) for time in times))
    for axes, row in zip(grid[:, 0], ROWS, strict=True):
        _draw_row(axes, dataset, row, size)
    texts = [f"{name} ({span})" for name, span in zip(names, spans, strict=True)] if shares else names
    figure.legend(grid[0, 0].get_lines()[: len(names)], texts, loc="outside lower center", ncols=2 if len(texts) > 1 else 1)
    letter(grid[0, 0], dataset.attrs["title"])
    since = " since each event began" if dataset.attrs["local"] else ""
    grid[-1, 0].set_xlabel(f"time{since}" + (", as a share of each run's own (see legend)" if shares else f" $t$ ({unit})"))
    figure.align_ylabels()
    return figure


def _draw_row(axes: Axes, dataset: xr.Dataset, row: str, size: float) -> None:
    """Draw one curve of every run, against time in units of `size` (s)."""
    drawn = [dataset[f"run{k}_{row}"] for k in range(np.size(dataset.attrs["runs"]))]
    flat = row == "traction" and nearly_flat(*(values.values for values in drawn))
    for k, values in enumerate(drawn):
        look = {"color": LINE_COLOURS[k % len(LINE_COLOURS)], "linestyle": DASHES[k // len(LINE_COLOURS) % len(DASHES)]}
        heights = values.values - values.values[0] if flat else shown(values)
        # Later lines are thinner, so that runs with the same curve all stay visible.
        axes.plot(dataset[f"run{k}_{row}_time"].values / size, heights, linewidth=max(2.0 - 0.3 * k, 1.0), **look)
    about, text = drawn[0].attrs, label(drawn[0])
    tops = [top for values in drawn if (top := float(np.abs(values).max())) > 0.0]
    if row != "traction" and len(tops) > 1 and max(tops) > FAR_APART * min(tops):
        _make_logarithmic(axes, min(tops), max(tops))
        text = text.replace(f"${about['symbol']}$", f"$|{about['symbol']}|$")
    else:
        zero_line(axes)
    if flat:
        text = f"change of {about['long_name']}\n" + axis_text(f"${about['symbol']}$ from its start", "", about["units"])
    axes.set_ylabel(text)


def _make_logarithmic(axes: Axes, least: float, most: float) -> None:
    """Replace the lines by magnitudes on a logarithmic axis; zeros (rest) are not drawn.

    `least` and `most` are the smallest and the largest of the runs' largest values. The axis begins two decades below the first.
    """
    for line in axes.get_lines():
        values = np.abs(np.asarray(line.get_ydata(), float))
        line.set_ydata(np.where(values > 0.0, values, np.nan))
    axes.set_yscale("log")
    axes.set_ylim(1e-2 * least, 3.0 * most)
