"""Figure of several runs in one column of panels: slip, slip rate and traction against time, one line for each run."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from stickslip.figures.runs.curves import nearly_flat
from stickslip.figures.style import (
    BLUE,
    GREEN,
    INK,
    ORANGE,
    PURPLE,
    SKY,
    VERMILLION,
    label,
    letter,
    panels,
    quantity,
    shown,
    styled,
    time_unit,
    zero_line,
)
from stickslip.solution.evaluation import Curve, Readings

if TYPE_CHECKING:
    from stickslip.solution.solution import Solution
    from stickslip.studies.compare import Comparison

COLOURS = (BLUE, VERMILLION, GREEN, PURPLE, ORANGE, SKY, INK)
DASHES: tuple[Any, ...] = ("-", (0, (5, 2)), (0, (1, 1.5)), (0, (6, 2, 1, 2)))
"""Line styles; the next one is taken when all colours are used up."""
APART = 20.0
"""If the durations differ by more than this factor, each run is drawn against time divided by its own duration."""
WIDE = 300.0
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
    forces = {run.problem.load_unit for run in runs.values()}
    contents: dict[str, xr.Variable] = {}
    for k, name in enumerate(runs):
        contents |= _run(f"run{k}", views[name], spans[name], shares, mixed=len(forces) > 1)
    attributes = {
        "title": "Runs side by side",
        "runs": list(runs),
        "spans": [_span_text(*span) for span in spans.values()],
        "shares": int(shares),
        "local": int(event is not None),
    }
    return xr.Dataset(contents, attrs=attributes)


def _run(key: str, view: Readings, span: tuple[float, float], shares: bool, mixed: bool) -> dict[str, xr.Variable]:
    problem = view.problem
    slip: Curve = "event_slip" if "event_slip" in view.curves else "slip"
    origin = 0.0 if slip == "event_slip" else problem.initial_slip
    force = "traction" if problem.load_unit == "Pa" else "friction force"
    stress = ("friction", r"\tau/S", "1") if mixed else (force, r"\tau", problem.load_unit)
    contents = {}
    for row, curve in zip(ROWS, (slip, "slip_rate", "traction"), strict=True):
        time, values = view.curve(curve, *span)
        along = ("share of the time drawn", "t", "1") if shares else ("time", "t", "s")
        contents[f"{key}_{row}_time"] = quantity(
            f"{key}_{row}_time", (time - span[0]) / (span[1] - span[0]) if shares else time, *along
        )
        scaled = {"slip": values - origin, "slip_rate": values, "traction": values / (problem.normal if mixed else 1.0)}[row]
        meaning = {"slip": ("slip", "u-u_0", "m"), "slip_rate": ("slip rate", "v", "m/s"), "traction": stress}[row]
        contents[f"{key}_{row}"] = quantity(f"{key}_{row}_time", scaled, *meaning)
    return contents


def _span(run: Solution) -> tuple[float, float]:
    """Return start and end (s) of what is drawn: up to shortly after the last event.

    A run without events, or with one that is not over, is drawn up to its end.
    """
    end = float(run.history.span[1])
    events = run.events
    if events.empty or events.end.isna().any():
        return 0.0, end
    return 0.0, min(end, MARGIN * float(events.end.iloc[-1]))


def _span_text(start: float, end: float) -> str:
    unit, size = time_unit(end - start)
    return f"{(end - start) / size:.4g} {unit}"


@styled
def draw(dataset: xr.Dataset) -> Figure:
    """Draw three panels with a line for each run; if the durations differ much, the legend gives them."""
    figure, grid = panels(len(ROWS), 1, (6.4, 6.4), sharex=True)
    names = [str(name) for name in np.atleast_1d(dataset.attrs["runs"])]
    for axes, row in zip(grid[:, 0], ROWS, strict=True):
        _draw_row(axes, dataset, row, len(names))
    spans = np.atleast_1d(dataset.attrs["spans"])
    texts = [f"{name} ({span})" if dataset.attrs["shares"] else name for name, span in zip(names, spans, strict=True)]
    handles = grid[0, 0].get_lines()[: len(names)]
    figure.legend(handles, texts, loc="outside lower center", ncols=2 if len(texts) > 1 else 1)
    letter(grid[0, 0], dataset.attrs["title"])
    grid[-1, 0].set_xlabel(_time_label(dataset))
    figure.align_ylabels()
    return figure


def _draw_row(axes: Axes, dataset: xr.Dataset, row: str, count: int) -> None:
    _, size = _time_unit(dataset)
    drawn = [dataset[f"run{k}_{row}"] for k in range(count)]
    flat = row == "traction" and nearly_flat(*(values.values for values in drawn))
    for k, values in enumerate(drawn):
        line = {"color": COLOURS[k % len(COLOURS)], "linestyle": DASHES[k // len(COLOURS) % len(DASHES)]}
        heights = values.values - values.values[0] if flat else shown(values)
        # Later lines are thinner, so that runs with the same curve all stay visible.
        axes.plot(dataset[f"run{k}_{row}_time"].values / size, heights, linewidth=max(2.0 - 0.3 * k, 1.0), **line)
    text, symbol = label(drawn[0]), drawn[0].attrs["symbol"]
    if row != "traction" and _far_apart([float(np.abs(values).max()) for values in drawn]):
        _make_logarithmic(axes)
        text = text.replace(f"${symbol}$", f"$|{symbol}|$")
    else:
        zero_line(axes)
    unit = f" ({drawn[0].attrs['units']})" if drawn[0].attrs["units"] != "1" else ""
    axes.set_ylabel(f"change of {drawn[0].attrs['long_name']}\n${symbol}$ from its start{unit}" if flat else text)


def _far_apart(sizes: list[float]) -> bool:
    moving = [size for size in sizes if size > 0.0]
    return len(moving) > 1 and max(moving) > WIDE * min(moving)


def _make_logarithmic(axes: Axes) -> None:
    """Replace the lines by magnitudes on a logarithmic axis.

    It begins two decades below the smallest of the runs' largest values; zeros (rest) are not drawn.
    """
    tops = []
    for line in axes.get_lines():
        values: NDArray[Any] = np.abs(np.asarray(line.get_ydata(), float))
        tops.append(values.max())
        line.set_ydata(np.where(values > 0.0, values, np.nan))
    axes.set_yscale("log")
    axes.set_ylim(1e-2 * min(top for top in tops if top > 0.0), 3.0 * max(tops))


def _time_unit(dataset: xr.Dataset) -> tuple[str, float]:
    if dataset.attrs["shares"]:
        return "1", 1.0
    times = [dataset[name].values for name in dataset.variables if str(name).endswith("_slip_time")]
    return time_unit(max(float(np.ptp(time)) for time in times))


def _time_label(dataset: xr.Dataset) -> str:
    since = " since each event began" if dataset.attrs["local"] else ""
    if dataset.attrs["shares"]:
        return f"time{since}, as a share of each run's own (see legend)"
    return f"time{since} $t$ ({_time_unit(dataset)[0]})"
