"""The panels of what is given over time: the motion of the ground, the pull rate, a stress or a load that varies."""

from __future__ import annotations

from typing import Any

import numpy as np

from stickslip.extensions.explorer.model.answer import Answer
from stickslip.extensions.explorer.page.components import paint
from stickslip.extensions.explorer.page.stage import NARROW, Stage
from stickslip.extensions.explorer.page.view import LegendKey, Units, View, axis_label, limits
from stickslip.figures.runs.given import curve_of, varying
from stickslip.foundation.arrays import Floats
from stickslip.foundation.names import for_readers, readable_unit

TEXTS_OF_LOADING = {"given": "Loading against time", "also_given": "Further loading against time"}
"""The panels, each with what it shows: most problems have one such history, few two."""
SHAKING_PANELS = ("ground_acceleration", "ground_velocity")
"""What shakes comes first."""
BINS = 1000
"""A curve of more points than twice this number is drawn by its lowest and highest value in each of so many intervals."""


def data_of(answer: Answer, units: Units) -> View:
    """Return the loading histories of a problem over the time of its run, each in a panel."""
    view, problem, time = View(), answer.solution.problem, answer.motions[0].time
    found = varying(problem)
    names = sorted(found, key=lambda name: name not in SHAKING_PANELS)[: len(TEXTS_OF_LOADING)]
    for panel, name in zip(TEXTS_OF_LOADING, [*names, None, None], strict=False):
        if name is None:
            view.add(View(columns={panel: {"time": [], panel: [], "low": [], "high": []}}, hidden={panel}))
            continue
        at, values, swing = curve_of(found[name], float(time[0]), float(time[-1]))
        at, values = thinned(at, values)
        unit, size = readable_unit(problem.unit_of(name), np.abs(values) + swing)
        low, high = (values - swing) / size, (values + swing) / size
        what = name.replace("_", " ")
        texts = ("range of its tone", "area") if swing else (what, "line")
        view.add(
            View(
                columns={panel: {"time": at / units.time[1], panel: values / size, "low": low, "high": high}},
                limits={panel: limits(low, high)},
                titles={panel: axis_label(what.capitalize(), "", for_readers(unit))},
                keys={panel: (LegendKey(texts[0], "load", "area" if swing else "line"),)},
            )
        )
    return view


def thinned(time: Floats, values: Floats) -> tuple[Floats, Floats]:
    """Return a curve as it is, or the extremes of each of `BINS` intervals in the order in which they are passed."""
    if len(time) <= 2 * BINS:
        return time, values
    edges = np.searchsorted(time, np.linspace(time[0], time[-1], BINS + 1)[1:-1])
    parts = [part for part in np.split(np.arange(len(time)), edges) if part.size]
    kept = np.unique([end for part in parts for end in (part[np.argmin(values[part])], part[np.argmax(values[part])])])
    kept = np.union1d(kept, [0, len(time) - 1])
    return time[kept], values[kept]


def plots(stage: Stage) -> dict[str, Any]:
    """Return the plots, over the same axis of time as the motion."""
    found = {name: stage.plot(name, "time", name, text, left=NARROW, bare=True) for name, text in TEXTS_OF_LOADING.items()}
    for name, drawn in found.items():
        source = stage.source(name, "time", name, "low", "high")
        drawn.yaxis[0].ticker.desired_num_ticks = 3  # what shakes goes to and fro: of two ticks, zero would be one
        band = drawn.varea(x="time", y1="low", y2="high", source=source, fill_alpha=0.3)
        paint(band.glyph, fill_color="load")
        paint(drawn.line("time", name, source=source, line_width=1.6).glyph, line_color="load")
        stage.cursor(name)
    return found
