"""Figure of numerical schemes beside the exact solution: errors against the mesh; slip and slip rate of the finest meshes."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Unpack

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from stickslip.figures.panels import add_legend, letter_panels, set_log_ticks, set_title, zero_line
from stickslip.figures.sheet import sheet
from stickslip.figures.style import GREY, INK, LINE_COLOURS, curve_quantity, label, quantity, shown, styled, unit_shown
from stickslip.foundation.place import Place

if TYPE_CHECKING:
    from stickslip.studies.schemes import Schemes

MOST_CURVES = 4
"""Largest number of schemes whose curves are drawn."""
POINTS = 2000
"""Number of times at which each exact curve is evaluated."""
STYLES = ("-", "--", ":", "-.")
"""Styles of the lines of schemes, and of the exact solutions of rules other than the problem's own."""


def data(study: Schemes) -> xr.Dataset:
    """Return errors (m) against the step (s) of each scheme, and the slip (m) and slip rate (m/s) on each scheme's finest mesh."""
    table, contents = study.table, {}
    names = list(dict.fromkeys(table.scheme))
    for i, name in enumerate(names):
        own = table[table.scheme == name]
        dim = f"scheme{i}_step"
        contents[dim] = quantity(dim, own.step, "step of time", r"\Delta t", "s")
        contents[f"scheme{i}_error"] = quantity(dim, own.slip_error, "mean slip difference", r"\langle|\Delta u|\rangle", "m")
    drawn = names[:MOST_CURVES]
    finest = [min((one for one in study.series if one.name == name), key=lambda one: one.step) for name in drawn]
    for i, one in enumerate(finest):
        kept = one.time <= study.until
        contents |= _curves(f"run{i}", one.time[kept], one.slip[kept], one.rate[kept])
    own_group = next(group for group in study.paths.groups() if study.problem.rule in group)
    ordered = [own_group, *(group for group in study.paths.groups() if group != own_group)]
    for i, group in enumerate(ordered):
        run = study.exact[group[0]]
        time = np.unique(np.concatenate([np.linspace(0.0, study.until, POINTS), run.breaks[run.breaks <= study.until]]))
        contents |= _curves(f"exact{i}", time, run.slip(time) - study.problem.initial_slip, run.slip_rate(time))
    attributes = {
        "schemes": names,
        "runs": [f"{one.name}, {one.cells} cells" if one.cells else one.name for one in finest],
        "rules": ["exact" if len(ordered) == 1 else f"exact, {', '.join(group)}" for group in ordered],
        "title": "Numerical schemes beside the exact solution",
    }
    return xr.Dataset(contents, attrs=attributes)


def _curves(name: str, time: Any, slip: Any, rate: Any) -> dict[str, xr.Variable]:
    dim = f"{name}_time"
    return {
        dim: quantity(dim, time, "time", "t", "s"),
        f"{name}_slip": curve_quantity(dim, slip, "slip"),
        f"{name}_rate": curve_quantity(dim, rate, "slip_rate"),
    }


@styled
def draw(dataset: xr.Dataset, **place: Unpack[Place]) -> Figure:
    """Draw the errors on the left; on the right the slip, and below it the slip rate."""
    figure = sheet((7.4, 5.4), **place)
    axes: Any = figure.subplot_mosaic([["errors", "slip"], ["errors", "rate"]], width_ratios=(1, 1.25))
    marks = _draw_errors(axes["errors"], dataset)
    for name in ("slip", "rate"):
        _draw_curves(axes[name], dataset, name)
    letter_panels(axes.values(), ["errors", "slip", "slip rate"])
    figure.align_ylabels([axes["slip"], axes["rate"]])
    add_legend(axes["errors"], [*marks, *_run_marks(dataset)])
    set_title(figure, dataset.attrs["title"])
    return figure


def _draw_errors(axes: Axes, dataset: xr.Dataset) -> list[Line2D]:
    names = np.atleast_1d(dataset.attrs["schemes"]).tolist()
    steps = [dataset[f"scheme{i}_step"] for i in range(len(names))]
    errors = [dataset[f"scheme{i}_error"] for i in range(len(names))]
    clock, length = unit_shown(*steps), unit_shown(*errors)
    for i, name in enumerate(names):
        values = shown(errors[i], length)
        style = STYLES[i // len(LINE_COLOURS) % len(STYLES)]
        colour = LINE_COLOURS[i % len(LINE_COLOURS)]
        axes.plot(
            shown(steps[i], clock), np.where(values > 0.0, values, np.nan), style, color=colour, marker="o", label=f"(a) {name}"
        )
    for line in axes.lines:
        line.set_markersize(3.5)
    axes.set(xscale="log", yscale="log", xlabel=label(steps[0], clock), ylabel=label(errors[0], length))
    set_log_ticks(axes, "x")
    return [
        Line2D([], [], color=line.get_color(), linestyle=line.get_linestyle(), label=str(line.get_label())) for line in axes.lines
    ]


def _draw_curves(axes: Axes, dataset: xr.Dataset, name: str) -> None:
    runs = _styles(dataset)
    times = [dataset[f"{run}_time"] for run, *_ in runs]
    values = [dataset[f"{run}_{name}"] for run, *_ in runs]
    clock, unit = unit_shown(*times), unit_shown(*values)
    for (_, colour, style, width), time, value in zip(runs, times, values, strict=True):
        axes.plot(shown(time, clock), shown(value, unit), style, color=colour, linewidth=width)
    zero_line(axes)
    axes.set(xlabel=label(times[-1], clock), ylabel=label(values[-1], unit))


def _styles(dataset: xr.Dataset) -> list[tuple[str, str, Any, float]]:
    """Return the name, colour, line style and width of each curve; the exact ones come last and are drawn on top."""
    runs = [(f"run{i}", LINE_COLOURS[i], "-", 1.2) for i in range(len(np.atleast_1d(dataset.attrs["runs"])))]
    rules = len(np.atleast_1d(dataset.attrs["rules"]))
    exact = [(f"exact{i}", GREY if i else INK, STYLES[i % len(STYLES)], 1.0) for i in range(rules)]
    return [*runs, *exact[::-1]]


def _run_marks(dataset: xr.Dataset) -> list[Line2D]:
    runs, rules = (np.atleast_1d(dataset.attrs[name]).tolist() for name in ("runs", "rules"))
    return [
        Line2D([], [], color=colour, linestyle=style, linewidth=width, label=f"(b, c) {text}")
        for (_, colour, style, width), text in zip(_styles(dataset), [*runs, *rules[::-1]], strict=True)
    ]
