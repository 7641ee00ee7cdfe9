"""Figure of numerical schemes beside the exact solution: errors against the mesh; slip and slip rate of the finest meshes."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple, Unpack

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from stickslip.extensions.schemes.measures import units_for
from stickslip.figures.panels import add_legend, letter_panels, set_log_ticks, set_title, zero_line
from stickslip.figures.sheet import sheet
from stickslip.figures.style import GREY, INK, LINE_COLOURS, axis_text, curve_label, styled
from stickslip.foundation.arrays import Floats
from stickslip.foundation.names import readable_unit, si_unit
from stickslip.foundation.place import Place

if TYPE_CHECKING:
    from stickslip.extensions.schemes.converged import SeriesWithinBand
    from stickslip.extensions.schemes.schemes import Schemes

MOST_CURVES = 4
"""Largest number of schemes whose curves are drawn."""
EXACT_TIMES = 2000
"""Evaluate each exact curve at this many times."""
STYLES = ("-", "--", ":", "-.")
"""Styles of the lines of schemes, and of the exact solutions of rules other than the problem's own."""


class SchemeCurve(NamedTuple):
    """A curve of slip and of slip rate against time, and how it looks."""

    text: str
    time: Floats
    values: dict[str, Floats]
    colour: str
    linestyle: str
    width: float


def curves(study: Schemes) -> list[SchemeCurve]:
    """Return slip (m) and slip rate (m/s) on the finest mesh of each scheme, then the exact ones, which are drawn on top."""
    drawn = []
    for colour, name in zip(LINE_COLOURS, study.table.scheme.unique()[:MOST_CURVES], strict=False):
        one = min((one for one in study.series if one.name == name), key=lambda one: one.step)
        kept = one.time <= study.until
        values = {"slip": one.slip[kept], "slip_rate": one.rate[kept]}
        drawn.append(SchemeCurve(f"{name}, {one.cells} cells" if one.cells else name, one.time[kept], values, colour, "-", 1.2))
    groups = study.paths.groups()
    own = next(group for group in groups if study.problem.rule in group)
    exact = []
    for i, group in enumerate([own, *(group for group in groups if group != own)]):
        run = study.exact[group[0]]
        time = np.unique(np.concatenate([np.linspace(0.0, study.until, EXACT_TIMES), run.breaks[run.breaks <= study.until]]))
        values = {"slip": run.slip(time) - study.problem.initial_slip, "slip_rate": run.slip_rate(time)}
        text = "exact" if len(groups) == 1 else f"exact, {', '.join(group)}"
        exact.append(SchemeCurve(text, time, values, GREY if i else INK, STYLES[i % len(STYLES)], 1.0))
    return [*drawn, *exact[::-1]]


@styled
def draw_schemes(study: Schemes, **place: Unpack[Place]) -> Figure:
    """Draw the errors on the left; on the right the slip, and below it the slip rate."""
    figure = sheet((7.4, 5.4), **place)
    axes: Any = figure.subplot_mosaic([["errors", "slip"], ["errors", "slip_rate"]], width_ratios=(1, 1.25))
    marks, drawn = _draw_errors(axes["errors"], study), curves(study)
    for name in ("slip", "slip_rate"):
        _draw_curves(axes[name], drawn, name, study.problem.body.load_unit)
    letter_panels(axes.values(), ["errors", "slip", "slip rate"])
    figure.align_ylabels([axes["slip"], axes["slip_rate"]])
    for one in drawn:
        look: Any = {"color": one.colour, "linestyle": one.linestyle, "linewidth": one.width}
        marks.append(Line2D([], [], label=f"(b, c) {one.text}", **look))
    add_legend(axes["errors"], marks)
    set_title(figure, "Numerical schemes beside the exact solution")
    return figure


def _draw_errors(axes: Axes, study: Schemes) -> list[Line2D]:
    table = study.table
    clock, length = readable_unit("s", table.step), readable_unit(units_for(study.problem.body.load_unit)["m"], table.slip_error)
    for i, (name, own) in enumerate(table.groupby("scheme", sort=False)):
        errors = np.where(own.slip_error > 0.0, own.slip_error / length[1], np.nan)
        look: Any = {"color": LINE_COLOURS[i % len(LINE_COLOURS)], "linestyle": STYLES[i // len(LINE_COLOURS) % len(STYLES)]}
        axes.plot(own.step / clock[1], errors, marker="o", markersize=3.5, label=f"(a) {name}", **look)
    axes.set(xscale="log", yscale="log", xlabel=axis_text("step of time", r"\Delta t", clock[0]))
    axes.set_ylabel(axis_text("mean slip difference", r"\langle|\Delta u|\rangle", length[0]))
    set_log_ticks(axes, "x")
    return [
        Line2D([], [], color=line.get_color(), linestyle=line.get_linestyle(), label=str(line.get_label())) for line in axes.lines
    ]


def _draw_curves(axes: Axes, drawn: list[SchemeCurve], name: str, load_unit: str) -> None:
    clock = readable_unit("s", *(one.time for one in drawn))
    unit = readable_unit(si_unit(name, load_unit), *(one.values[name] for one in drawn))
    for one in drawn:
        heights = one.values[name] / unit[1]
        axes.plot(one.time / clock[1], heights, one.linestyle, color=one.colour, linewidth=one.width)
    zero_line(axes)
    axes.set(xlabel=curve_label("time", clock[0]), ylabel=curve_label(name, unit[0]))


@styled
def draw_within_band(study: SeriesWithinBand, **place: Unpack[Place]) -> Figure:
    """Draw slip, slip rate and traction of series, below one another, over the converged ones and their error bands."""
    figure = sheet((6.2, 6.4), **place)
    axes: Any = figure.subplots(3, sharex=True)
    time = study.right.time.to_numpy()
    for one, name in zip(axes, ("slip", "slip_rate", "traction"), strict=True):
        right, band = (study.right[column].to_numpy() for column in (name, f"{name}_band"))
        own = [(series.name, series.time, getattr(series, name.removeprefix("slip_"))) for series in study.series]
        unit = readable_unit(si_unit(name, "Pa"), right)
        one.fill_between(time, (right - band) / unit[1], (right + band) / unit[1], color=GREY, alpha=0.4, linewidth=0.0)
        one.plot(time, right / unit[1], color=INK, linewidth=1.0, label="converged")
        for colour, (text, times, values) in zip(LINE_COLOURS, own, strict=False):
            one.plot(times, values / unit[1], color=colour, linewidth=1.2, label=text)
        one.set_ylabel(curve_label(name, unit[0]))
    axes[-1].set(xlabel=curve_label("time", "s"), xlim=(time[0], time[-1]))
    letter_panels(axes, ["slip", "slip rate", "traction"])
    add_legend(axes[0], axes[0].lines)
    set_title(figure, "Series beside the converged one")
    return figure
