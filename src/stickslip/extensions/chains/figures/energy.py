"""Figure of the energies of a chain: in springs, gone as heat, gone in dashpots, and what the driver has put in."""

from __future__ import annotations

from typing import TYPE_CHECKING, Unpack

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from stickslip.figures.panels import add_legend, finish
from stickslip.figures.sheet import one_panel
from stickslip.figures.style import (
    BLUE,
    GREEN,
    INK,
    VERMILLION,
    Numbers,
    axis_text,
    readable,
    styled,
    time_unit,
)
from stickslip.foundation.arrays import Floats
from stickslip.foundation.place import Place

if TYPE_CHECKING:
    from stickslip.extensions.chains.run import ChainRun


def energies_at_events(run: ChainRun) -> dict[str, Floats]:
    """Return time (s) and energies (J) at the start, before and after each event, and at the end.

    Keys: time; springs; heat of friction; dashpots; driver, its work since the start. Between events the driver loads springs.
    """
    events, found = run.events, run.energy()
    time = np.stack([events["time"], events["time"] + events["duration"]], axis=1).ravel()
    springs = np.stack([events["springs_before"], events["springs_after"]], axis=1).ravel()
    before = {name: np.repeat(np.append(0.0, np.cumsum(events[name])), 2)[1:-1] for name in ("heat", "dashpot")}
    driver = springs + before["heat"] + before["dashpot"] - found.springs_at_start
    ends = {"time": (0.0, run.duration), "springs": (found.springs_at_start, found.springs), "heat": (0.0, found.heat)}
    ends |= {"dashpots": (0.0, found.dashpots), "driver": (0.0, found.driver)}
    inner = {"time": time, "springs": springs, "heat": before["heat"], "dashpots": before["dashpot"], "driver": driver}
    return {name: np.concatenate([[first], inner[name], [last]]) for name, (first, last) in ends.items()}


@styled
def draw_chain_energy(run: ChainRun, **place: Unpack[Place]) -> Figure | Axes:
    """Draw energies against time, at rest before and after each event; the work of the driver is the sum of the others."""
    axes = one_panel((6.4, 4.0), **place)
    found = energies_at_events(run)
    clock, second = time_unit(run.duration)
    unit, size = readable(Numbers(found["driver"], {"units": "J"}), *(found[name] for name in ("springs", "heat", "driver")))
    time = found["time"] / second
    axes.plot(time, found["springs"] / size, color=BLUE, label="springs")
    axes.plot(time, found["heat"] / size, color=VERMILLION, label="heat of friction")
    if found["dashpots"][-1] > 0.0:
        axes.plot(time, found["dashpots"] / size, color=GREEN, label="heat in dashpots")
    work = (found["driver"] + found["springs"][0]) / size
    axes.plot(time, work, color=INK, linewidth=1.0, linestyle="--", label="springs at the start and work of the driver")
    axes.set_xlabel(axis_text("time", "t", clock))
    axes.set_ylabel(axis_text("energy", "E", unit))
    add_legend(axes, axes.get_legend_handles_labels()[0], own=place.get("ax") is not None)
    return finish(axes, run.title, **place)
