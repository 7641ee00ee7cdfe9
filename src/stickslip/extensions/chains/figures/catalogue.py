"""Figure of the catalogue of a chain: the moment and the size of each event against time."""

from __future__ import annotations

from typing import TYPE_CHECKING, Unpack

import numpy as np
from matplotlib.figure import Figure

from stickslip.figures.panels import letter_panels, panels, set_title
from stickslip.figures.style import BLUE, VERMILLION, Numbers, axis_text, label, shown, spans_decades, styled, time_unit
from stickslip.foundation.errors import InputError
from stickslip.foundation.place import Place

if TYPE_CHECKING:
    from stickslip.extensions.chains.run import ChainRun


@styled
def draw_catalogue(run: ChainRun, **place: Unpack[Place]) -> Figure:
    """Draw moment, and number of blocks that slipped, of each event against the time of its first onset."""
    events = run.events
    if not len(events):
        raise InputError(f"plot.catalogue: no event ended in {run.duration:g} s")
    figure, grid = panels(2, 1, (7.0, 4.6), place, sharex=True)
    moments, sizes = grid[:, 0]
    clock, second = time_unit(run.duration)
    time = events["time"] / second
    moment = Numbers(np.abs(events["moment"]), {"units": "m", "long_name": "moment", "symbol": "M"})
    values = shown(moment)
    positive = values[values > 0.0]
    floor = 0.5 * float(positive.min()) if len(positive) and spans_decades(positive) else 0.0
    moments.vlines(time, floor, values, color=BLUE, linewidth=0.8)
    if floor:
        moments.set(yscale="log", ylim=(floor, 2.0 * float(positive.max())))
    moments.set_ylabel(label(moment))
    sizes.plot(time, events["size"], ".", color=VERMILLION, markersize=3.0)
    if spans_decades(events["size"]):
        sizes.set_yscale("log")
    sizes.set(ylabel="blocks that slipped", xlim=(0.0, run.duration / second))
    sizes.set_xlabel(axis_text("time", "t", clock))
    letter_panels(grid[:, 0], ["moment of events", "size of events"])
    set_title(figure, run.title)
    return figure
