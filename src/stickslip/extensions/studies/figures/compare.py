"""Figure of several runs in one column of panels: slip, slip rate and traction against time, one line for each run."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple, Unpack, cast

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from stickslip.figures.panels import add_legend, letter_panels, panels, set_log_ticks, set_title, zero_line
from stickslip.figures.style import LINE_COLOURS, axis_text, nearly_flat, styled, time_unit
from stickslip.foundation.arrays import Floats
from stickslip.foundation.names import QUANTITIES, name_of, readable_unit, si_unit
from stickslip.foundation.place import Place
from stickslip.solution import Curve, Readings

if TYPE_CHECKING:
    from stickslip.extensions.studies.compare import Comparison
    from stickslip.solution import Solution

DASHES: tuple[Any, ...] = ("-", (0, (5, 2)), (0, (1, 1.5)), (0, (6, 2, 1, 2)))
"""Line styles; the next one is taken when all colours are used up."""
MARKERS = "osD^v<>P"
"""Marks on the lines, one kind for each run, at places of its own: where lines lie on one another each is still told."""
EACH = 6
"""Number of marks on a line."""
WIDEST, THINNEST = 2.6, 1.1
"""Widths (points) of the first line and of the last, which lies on it: the edges of the wider one are seen."""
APART_DURATIONS = 20.0
"""If the durations differ by more than this factor, each run is drawn against time divided by its own duration."""
FAR_APART = 300.0
"""If the largest slips or slip rates of the runs differ by more than this factor, the axis is logarithmic."""
MARGIN_OF_REST = 1.25
"""A run is drawn up to this multiple of the end of its last event, so that the rest after it is seen."""
COMPARED_PANELS = ("slip", "slip_rate", "traction")
"""Panels, from above."""


class RunLines(NamedTuple):
    """What is drawn of several runs: `span` (s) of each, and a line of each run in the panel of each row.

    `shares` is True if times are divided by the time drawn, `mixed` if tractions are divided by the normal stress or force.
    """

    spans: dict[str, tuple[float, float]]
    shares: bool
    mixed: bool
    lines: dict[str, list[tuple[Floats, Floats]]]


def drawn(study: Comparison) -> RunLines:
    """Return the runs from their start to shortly after the last slip event of all, or one event of each in local time, in SI.

    All runs cover the same time, except those that end earlier. The comparison says which event is drawn, if any. Slip counts from
    the start of the run or of the event. If slabs (Pa) and blocks (N) are drawn together, tractions are divided by the normal
    stress or force. If the durations differ by more than the factor `APART_DURATIONS`, times are divided by the duration drawn.
    """
    runs, event = study.runs, study.event
    views, spans = _whole(runs) if event is None else _windows(runs, event)
    lengths = [end - start for start, end in spans.values()]
    shares = max(lengths) > APART_DURATIONS * min(lengths)
    mixed = len({run.problem.load_unit for run in runs.values()}) > 1
    lines = {row: [_line(views[name], row, spans[name], shares=shares, mixed=mixed) for name in runs] for row in COMPARED_PANELS}
    return RunLines(spans, shares, mixed, lines)


def _whole(runs: dict[str, Solution]) -> tuple[dict[str, Readings], dict[str, tuple[float, float]]]:
    """Return the runs, and start and end (s) of what is drawn of each.

    That is the same for all, unless the runs last so differently that each is drawn against its own duration.
    """
    ends = {name: float(run.history.span[1]) for name, run in runs.items()}
    over = {name: _last_end(run) for name, run in runs.items()}
    needed = {name: min(ends[name], MARGIN_OF_REST * over[name]) for name in runs}
    longest = max(needed.values())
    if longest <= APART_DURATIONS * min(needed.values()):
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
    if longest.after <= APART_DURATIONS * shortest.after:
        views = {name: run.window(event, longest.before, longest.after) for name, run in runs.items()}
    return dict(views), {name: view.shown for name, view in views.items()}


def _line(view: Readings, row: str, span: tuple[float, float], *, shares: bool, mixed: bool) -> tuple[Floats, Floats]:
    """Return times and values of a run's line in the panel of a row."""
    problem = view.problem
    curve: Curve = "event_slip" if row == "slip" and "event_slip" in view.curves else cast("Curve", row)
    time, (values, normal) = view.curves_together((curve, "normal_load"), *span)
    if curve == "slip":
        values = values - problem.initial_slip
    if row == "traction" and not problem.friction.sticks:
        # Such a law has no friction at rest, where a run may start: that zero would set the scale.
        values = np.where(values != 0.0, values, np.nan)
    if row == "traction" and mixed:
        values = values / normal
    return ((time - span[0]) / (span[1] - span[0]) if shares else time), values


@styled
def draw_compared(study: Comparison, **place: Unpack[Place]) -> Figure:
    """Draw three panels with a line for each run; if the durations differ much, the legend gives them."""
    figure, grid = panels(len(COMPARED_PANELS), 1, (6.4, 6.2), place, sharex=True)
    found = drawn(study)
    unit, size = ("1", 1.0) if found.shares else time_unit(max(float(np.ptp(time)) for time, _ in found.lines["slip"]))
    for axes, row in zip(grid[:, 0], COMPARED_PANELS, strict=True):
        _draw_row(axes, study, found, row, size)
    marks = grid[0, 0].get_lines()[: len(study.runs)]
    for mark, name in zip(marks, found.spans, strict=True):
        mark.set_label(_label(study, found, name))
    add_legend(grid[0, 0], marks)
    letter_panels(grid[:, 0])
    since = "" if study.event is None else " since each event began"
    grid[-1, 0].set_xlabel(f"time{since}" + (", as a share of each run's own (see legend)" if found.shares else f" $t$ ({unit})"))
    figure.align_ylabels()
    set_title(figure, study.scenario)
    return figure


def _look(k: int, count: int) -> dict[str, Any]:
    """Return the look of line k of `count`: colour, dashes, marks and a width, each of which tells it from the others."""
    width = WIDEST - (WIDEST - THINNEST) * k / max(count - 1, 1)
    marks = {"marker": MARKERS[k % len(MARKERS)], "markersize": 4.5, "markeredgecolor": "white", "markeredgewidth": 0.5}
    return marks | {"color": LINE_COLOURS[k % len(LINE_COLOURS)], "linestyle": DASHES[k % len(DASHES)], "linewidth": width}


def _places(time: Floats, values: Floats, k: int, count: int) -> list[int]:
    """Return the points of line k of `count` that are marked: evenly spaced in time, between the marks of the other lines."""
    shares = (np.arange(EACH) + (k + 0.5) / count) / EACH
    known = np.flatnonzero(np.isfinite(values))
    if not len(known):
        return []
    found = np.searchsorted(time[known], time[0] + shares * (time[-1] - time[0]))
    return [int(place) for place in np.unique(known[np.minimum(found, len(known) - 1)])]


def _label(study: Comparison, found: RunLines, name: str) -> str:
    """Return what the legend says of a run: how long it lasts where that differs, and the wait that its selection rule makes."""
    start, end = found.spans[name]
    if found.shares:
        return f"{name} ({_lasting(end - start)})"
    waits = study.table.set_index("name").wait
    return f"{name} (waits {_lasting(waits[name])})" if study.scenario and waits[name] > 0.0 else name


def _lasting(length: float) -> str:
    unit, size = time_unit(length)
    return f"{length / size:.4g} {unit}{'s' if unit in ('year', 'day') else ''}"


def _meaning(study: Comparison, row: str, *, mixed: bool) -> tuple[str, str, str]:
    """Return the name, the symbol and the SI unit of what the panel of a row shows."""
    loads = [run.problem.load_unit for run in study.runs.values()]
    if row == "slip":
        return name_of(row, loads[0]), "u-u_0", si_unit(row, *loads)
    if row == "traction" and mixed:
        return "friction", r"\tau/S", "1"
    return name_of(row, loads[0]), QUANTITIES[row].symbol, si_unit(row, *loads)


def _draw_row(axes: Axes, study: Comparison, found: RunLines, row: str, size: float) -> None:
    lines, (name, symbol, units) = found.lines[row], _meaning(study, row, mixed=found.mixed)
    flat = row == "traction" and nearly_flat(*(values[np.isfinite(values)] for _, values in lines))
    heights = [values - values[np.isfinite(values)][0] if flat else values for _, values in lines]
    tops = [top for values in heights if (top := float(np.nanmax(np.abs(values)))) > 0.0]
    log = row != "traction" and len(tops) > 1 and max(tops) > FAR_APART * min(tops)
    unit, scale = (units, 1.0) if log else readable_unit(units, *heights)
    for k, ((time, _), values) in enumerate(zip(lines, heights, strict=True)):
        magnitudes = np.where(values != 0.0, np.abs(values), np.nan) if log else values / scale
        axes.plot(time / size, magnitudes, **_look(k, len(lines)), markevery=_places(time, magnitudes, k, len(lines)))
    symbol = f"|{symbol}|" if log else symbol
    if log:
        # Two decades below the smaller run; rest has no place on the axis.
        axes.set(yscale="log", ylim=(1e-2 * min(tops), 3.0 * max(tops)))
        set_log_ticks(axes, "y")
    elif row != "traction" or any(run.problem.friction.sticks for run in study.runs.values()):
        zero_line(axes)
    if flat:
        axes.set_ylabel(f"change of {name}\n" + axis_text(f"${symbol}$ from its start", "", unit))
    else:
        axes.set_ylabel(axis_text(name, symbol, unit))
