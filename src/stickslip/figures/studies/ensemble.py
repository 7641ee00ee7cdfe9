"""Figure of an ensemble: the events of every member, the growth of the disturbance, and the distribution of slips."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, Unpack

import numpy as np
import xarray as xr
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.ticker import MaxNLocator

from stickslip.figures.panels import add_legend, count_ticks, letter_panels, set_log_ticks, set_scale
from stickslip.figures.sheet import sheet
from stickslip.figures.style import BLUE, GREY, INK, SKY, VERMILLION, WIDE, curve_quantity, quantity, styled, time_unit, unit_of
from stickslip.foundation.place import Place

if TYPE_CHECKING:
    from stickslip.studies.ensemble import Ensemble

CLOSE = 3.0
"""Spreads of starts that span more than this factor are drawn on a logarithmic axis."""
GROWTH = {"growth": "median of the members", "least": "least", "most": "most", "predicted": "running maximum of the prediction"}
"""Curves of the growth of the disturbance, by column of the study."""
SHARED = {"members": "1", "start_spread": "s", "slip_spread": "m", "recurrence_spread": "s", "amplification": "1"}
"""Units of what is known of the events that members share, by column of the study."""


def data(study: Ensemble) -> xr.Dataset:
    """Return the results of a study in SI.

    They are the events of every run (member 0 is the undisturbed one), the growth of the disturbance, the events that members share
    with the undisturbed run, and the statistics.
    """
    load = study.problem.load_unit
    contents = _events(study) | _growth(study) | _shared(study) | _statistics(study)
    contents["push"] = quantity("member", study.pushes, "added to the initial load", "", load)
    predicted = study.prediction
    attributes = {
        "until": study.until,
        "size": study.size,
        "horizon": study.horizon,
        "predicted_horizon": math.nan if predicted is None else predicted.horizon,
        "exponent": study.exponent,
        "predicted_exponent": study.predicted_exponent,
        "saturation": study.separation.saturation,
        "found": study.text,
        "growth_found": study.growth_text,
        "note": study.note,
        "stopped": study.stopped,
    }
    return xr.Dataset(contents, attrs=attributes)


def _events(study: Ensemble) -> dict[str, xr.Variable]:
    tables = study.catalogues
    member = np.repeat(np.arange(len(tables)), [len(table) for table in tables])
    start, slip = (np.concatenate([table[name].to_numpy(float) for table in tables]) for name in ("start", "slip"))
    shared = [len(study.table), *study.has.sum(axis=1)]
    same = np.concatenate([np.arange(len(table)) < first for table, first in zip(tables, shared, strict=True)])
    return {
        "start": quantity("event", start, "start of the event", "", "s"),
        "slip": quantity("event", slip, "slip", "", "m"),
        "of_member": xr.Variable("event", member, {"long_name": "member, 0 the undisturbed run"}),
        "same": xr.Variable("event", same.astype(np.int8), {"long_name": "whether it is the event of the undisturbed run"}),
    }


def _growth(study: Ensemble) -> dict[str, xr.Variable]:
    table = study.growth
    contents = {name: quantity("time", table[name].to_numpy(float), f"growth, {text}", "", "1") for name, text in GROWTH.items()}
    contents["small"] = xr.Variable("time", table.small.to_numpy(np.int8), {"long_name": "whether the separation is small"})
    return contents | {"time": curve_quantity("time", table.time.to_numpy(float), "time")}


def _shared(study: Ensemble) -> dict[str, xr.Variable]:
    return {
        f"shared_{name}": quantity("shared", study.table[name].to_numpy(float), name.replace("_", " "), "", unit)
        for name, unit in SHARED.items()
    }


def _statistics(study: Ensemble) -> dict[str, xr.Variable]:
    table = study.statistics
    contents = {f"statistics_{name}": xr.Variable("quantity", table[name].to_numpy(float)) for name in table.columns}
    return contents | {"quantity": xr.Variable("quantity", table.index.to_numpy(str))}


@styled
def draw(dataset: xr.Dataset, **place: Unpack[Place]) -> Figure:
    """Draw the members' time lines and below them the growth of the disturbance; beside them slips, and the spread of starts.

    Panels without data are left out: slips if there are no events, starts if no difference is above rounding.
    """
    beside = {"C": bool(dataset.sizes["event"]), "D": bool((dataset["shared_start_spread"].values > 0.0).any())}
    figure = sheet((7.2, 5.8), **place)
    axes: Any = figure.subplot_mosaic(_layout(**beside))
    unit, size = time_unit(float(dataset.attrs["until"]))
    titles = {"A": "slip events", "B": "growth of the disturbance", "C": "sizes of events", "D": "spread of their starts"}
    _draw_time_lines(axes["A"], dataset, size)
    _draw_growth(axes["B"], dataset, size)
    for panel in (axes["A"], axes["B"]):
        panel.set_xlim(-0.02 * dataset.attrs["until"] / size, 1.02 * dataset.attrs["until"] / size)
        panel.set_xlabel(f"time $t$ ({unit})")
    if beside["C"]:
        _draw_slips(axes["C"], dataset)
    if beside["D"]:
        _draw_starts(axes["D"], dataset)
    drawn = sorted(axes)
    letter_panels([axes[name] for name in drawn], [titles[name] for name in drawn])
    add_legend(axes["A"], _marks(dataset, **beside))
    return figure


def _layout(*, C: bool, D: bool) -> Any:
    """Return the places of the panels: two wide ones, and beside them those that have data."""
    if not C and not D:
        return [["A"], ["B"]]
    upper, lower = ("C", "D") if C and D else ("C", "C") if C else ("D", "D")
    return [["A", "A", upper], ["B", "B", lower]]


def _marks(dataset: xr.Dataset, *, C: bool, D: bool) -> list[Artist]:
    panels = [name for name, there in (("a", C), ("d" if C else "c", D)) if there]
    where = f"({panels[-1]})" if D else ""
    shared = "events of all members" if (dataset["same"] == 1).all() else "events shared with member 0"
    marks: list[Artist] = [Line2D([], [], color=BLUE, linestyle="none", marker="|", label=shared)] if C else []
    if (dataset["same"] == 0).any():
        marks.append(Line2D([], [], color=VERMILLION, linestyle="none", marker="|", label="events not shared"))
    marks.append(Line2D([], [], color=BLUE, label="(b) measured, median"))
    marks.append(Patch(color=SKY, alpha=0.4, linewidth=0.0, label="(b) measured, least to most"))
    if np.isfinite(dataset["predicted"].values).any():
        marks.append(Line2D([], [], color=VERMILLION, linestyle="--", label="(b) predicted"))
    until, horizon, predicted = (float(dataset.attrs[name]) for name in ("until", "horizon", "predicted_horizon"))
    if horizon < until:
        marks.append(Patch(color=GREY, alpha=0.15, linewidth=0.0, label="after the first event not shared"))
    if predicted < until:
        marks.append(Line2D([], [], color=VERMILLION, linewidth=1.0, linestyle=":", label="predicted horizon"))
    if C:
        marks += [Line2D([], [], color=INK, label="(c) member 0"), Line2D([], [], color=SKY, linewidth=0.8, label="(c) others")]
    complete = dataset["shared_members"].values == dataset.sizes["member"]
    there = dataset["shared_start_spread"].values > 0.0
    for of, colour, text in ((complete, BLUE, "in all members"), (~complete, VERMILLION, "in some members")):
        if (there & of).any():
            marks.append(Line2D([], [], color=colour, linestyle="none", marker="o", markersize=3, label=f"{where} event {text}"))
    return marks


def _draw_time_lines(axes: Axes, dataset: xr.Dataset, size: float) -> None:
    start, member, same = (dataset[name].values for name in ("start", "of_member", "same"))
    style: Any = {"linestyle": "none", "marker": "|", "markersize": 7, "markeredgewidth": 0.8, "rasterized": True}
    for of, colour in ((same == 1, BLUE), (same == 0, VERMILLION)):
        axes.plot(start[of] / size, member[of], color=colour, **style)
    _draw_horizons(axes, dataset, size)
    axes.set_ylim(dataset.sizes["member"] + 0.6, -0.6)
    count_ticks(axes, 6)
    axes.set_ylabel("member (0: undisturbed)")
    if not len(start):
        axes.text(0.5, 0.5, "no slip event", transform=axes.transAxes, ha="center", color=GREY)


def _draw_growth(axes: Axes, dataset: xr.Dataset, size: float) -> None:
    time = np.append(0.0, dataset["time"].values) / size
    growth, least, most, predicted = (np.append(1.0, dataset[name].values) for name in GROWTH)
    floor = np.finfo(float).tiny
    axes.fill_between(time, np.maximum(least, floor), np.maximum(most, floor), color=SKY, alpha=0.4, linewidth=0.0)
    axes.plot(time, np.where(growth > 0.0, growth, np.nan), color=BLUE, label="measured")
    lost = float(dataset.attrs["saturation"]) / float(np.abs(dataset["push"].values).max())
    if np.isfinite(predicted[1:]).any():
        axes.plot(time, np.where(predicted < 10.0 * lost, predicted, np.nan), "--", color=VERMILLION, label="predicted")
    if lost > 0.0:
        at: Any = ("axes fraction", "data")
        axes.axhline(lost, color=GREY, linewidth=0.8, linestyle=":")
        axes.annotate("a tenth of the load's range", (0.0, lost), (4, 2), at, "offset points", color=INK)
    _draw_horizons(axes, dataset, size)
    positive = np.concatenate([values[values > 0.0] for values in (growth, least[1:])])
    axes.set(yscale="log", ylim=(0.3 * float(positive.min()), 10.0 * max(lost, float(growth.max()))))
    axes.set_ylabel("separation of loads\n(times the disturbance)")


def _draw_horizons(axes: Axes, dataset: xr.Dataset, size: float) -> None:
    """Shade the time from the first event that not all members share; mark its predicted time by a dotted line."""
    until, horizon, predicted = (float(dataset.attrs[name]) for name in ("until", "horizon", "predicted_horizon"))
    if horizon < until:
        axes.axvspan(horizon / size, 1.02 * until / size, color=GREY, alpha=0.15, linewidth=0.0, zorder=0)
    if predicted < until:
        axes.axvline(predicted / size, color=VERMILLION, linewidth=1.0, linestyle=":")


def _draw_slips(axes: Axes, dataset: xr.Dataset) -> None:
    slip, member = dataset["slip"].values, dataset["of_member"].values
    wide = slip.max() > WIDE * slip[slip > 0.0].min(initial=slip.max())
    unit, size = unit_of("m", slip, log=bool(wide))
    for i in range(dataset.sizes["member"], -1, -1):
        ordered = np.sort(slip[member == i]) / size
        # The first step begins at the axis: all events are at least that large.
        first = [ordered[0] if wide else 0.0] if len(ordered) else []
        colour, width = (SKY, 0.8) if i else (INK, 1.2)
        heights = [*([len(ordered)] if first else []), *range(len(ordered), 0, -1)]
        axes.step([*first, *ordered], heights, where="pre", color=colour, linewidth=width)
    set_scale(axes, "x", wide)
    if not wide:
        axes.set_xlim(0.0, 1.1 * slip.max() / size)
    many = (member == 0).sum() > WIDE
    set_scale(axes, "y", many)
    if not many:
        axes.set_ylim(bottom=0.0)
        count_ticks(axes)
    axes.set(xlabel=f"slip $x$ ({unit})", ylabel="events with slip ≥ $x$")


def _draw_starts(axes: Axes, dataset: xr.Dataset) -> None:
    """Draw the root mean square differences between the starts of each event, blue while all members have it."""
    spread = dataset["shared_start_spread"].values
    number, there = np.arange(1, len(spread) + 1), spread > 0.0
    complete = dataset["shared_members"].values == dataset.sizes["member"]
    log = bool(spread[there].max() > CLOSE * spread[there].min())
    unit, size = unit_of("s", spread[there], log=log)
    for of, colour in ((there & complete, BLUE), (there & ~complete, VERMILLION)):
        axes.plot(number[of], spread[of] / size, "o", color=colour, markersize=2.5, rasterized=True)
    if log:
        axes.set_yscale("log")
        set_log_ticks(axes, "y")
    else:
        axes.set_ylim(0.0, 1.5 * spread[there].max() / size)
    axes.xaxis.set_major_locator(MaxNLocator(4, integer=True))
    axes.set(xlabel="number of the event", ylabel=f"root mean square ({unit})")
