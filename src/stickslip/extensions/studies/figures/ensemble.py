"""Figure of an ensemble: the events of every member, and below them the growth of the disturbance."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, Unpack

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from stickslip.figures.panels import add_legend, count_ticks, letter_panels, panels
from stickslip.figures.style import BLUE, GREY, INK, SKY, VERMILLION, styled, time_unit
from stickslip.foundation.place import Place

if TYPE_CHECKING:
    from stickslip.extensions.studies.ensemble import Ensemble


@styled
def draw_ensemble(study: Ensemble, **place: Unpack[Place]) -> Figure:
    """Draw the members' time lines, and below them the growth of the disturbance."""
    figure, grid = panels(2, 1, (6.4, 5.8), place, sharex=True)
    lines, growth = grid[:, 0]
    unit, size = time_unit(study.until)
    _draw_time_lines(lines, study, size)
    _draw_growth(growth, study, size)
    growth.set_xlim(-0.02 * study.until / size, 1.02 * study.until / size)
    growth.set_xlabel(f"time $t$ ({unit})")
    letter_panels([lines, growth], ["slip events", "growth of the disturbance"])
    add_legend(lines, _marks(study))
    return figure


def _predicted_horizon(study: Ensemble) -> float:
    return math.inf if study.prediction is None else study.prediction.horizon


def _shared(study: Ensemble) -> tuple[int, ...]:
    """Return the number of shared events of the undisturbed run, then of each member; they are its first ones."""
    return len(study.table), *study.has.sum(axis=1).tolist()


def _marks(study: Ensemble) -> list[Artist]:
    marks: list[Artist] = []
    if not study.table.empty:
        marks.append(Line2D([], [], color=BLUE, linestyle="none", marker="|", label="events of the undisturbed run"))
    if any(len(table) > count for table, count in zip(study.catalogues, _shared(study), strict=True)):
        marks.append(Line2D([], [], color=VERMILLION, linestyle="none", marker="|", label="events not shared"))
    marks.append(Line2D([], [], color=BLUE, label="(b) measured, median"))
    marks.append(Patch(color=SKY, alpha=0.4, linewidth=0.0, label="(b) measured, least to most"))
    if study.prediction is not None:
        marks.append(Line2D([], [], color=VERMILLION, linestyle="--", label="(b) running maximum of the prediction"))
    if study.horizon < study.until:
        marks.append(Patch(color=GREY, alpha=0.15, linewidth=0.0, label="after the first event not shared"))
    if _predicted_horizon(study) < study.until:
        marks.append(Line2D([], [], color=VERMILLION, linewidth=1.0, linestyle=":", label="predicted horizon"))
    return marks


def _draw_time_lines(axes: Axes, study: Ensemble, size: float) -> None:
    look: Any = {"linestyle": "none", "marker": "|", "markersize": 7, "markeredgewidth": 0.8, "rasterized": True}
    for member, (table, count) in enumerate(zip(study.catalogues, _shared(study), strict=True)):
        start = table.start.to_numpy(float) / size
        for starts, colour in ((start[:count], BLUE), (start[count:], VERMILLION)):
            axes.plot(starts, np.full(len(starts), member), color=colour, **look)
    _draw_horizons(axes, study, size)
    axes.set_ylim(len(study.runs) + 0.6, -0.6)
    count_ticks(axes, 6)
    axes.set_ylabel("member (0: undisturbed)")
    if all(table.empty for table in study.catalogues):
        axes.text(0.5, 0.5, "no slip event", transform=axes.transAxes, ha="center", color=GREY)


def _draw_growth(axes: Axes, study: Ensemble, size: float) -> None:
    table = study.growth
    time = np.append(0.0, table.time) / size
    growth, least, most, predicted = (np.append(1.0, table[name]) for name in ("growth", "least", "most", "predicted"))
    floor = np.finfo(float).tiny
    axes.fill_between(time, np.maximum(least, floor), np.maximum(most, floor), color=SKY, alpha=0.4, linewidth=0.0)
    axes.plot(time, np.where(growth > 0.0, growth, np.nan), color=BLUE, label="measured")
    lost = study.separation.saturation / float(np.abs(study.pushes).max())
    if np.isfinite(predicted[1:]).any():
        axes.plot(time, np.where(predicted < 10.0 * lost, predicted, np.nan), "--", color=VERMILLION, label="predicted")
    if lost > 0.0:
        at: Any = ("axes fraction", "data")
        axes.axhline(lost, color=GREY, linewidth=0.8, linestyle=":")
        axes.annotate("a tenth of the load's range", (0.0, lost), (4, 2), at, "offset points", color=INK)
    _draw_horizons(axes, study, size)
    positive = np.concatenate([values[values > 0.0] for values in (growth, least[1:])])
    axes.set(yscale="log", ylim=(0.3 * float(positive.min()), 10.0 * max(lost, float(growth.max()))))
    axes.set_ylabel("separation of loads\n(times the disturbance)")


def _draw_horizons(axes: Axes, study: Ensemble, size: float) -> None:
    """Shade the time from the first event that not all members share; mark its predicted time by a dotted line."""
    if study.horizon < study.until:
        axes.axvspan(study.horizon / size, 1.02 * study.until / size, color=GREY, alpha=0.15, linewidth=0.0, zorder=0)
    if _predicted_horizon(study) < study.until:
        axes.axvline(_predicted_horizon(study) / size, color=VERMILLION, linewidth=1.0, linestyle=":")
