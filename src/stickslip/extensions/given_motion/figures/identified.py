"""Figure of an identified law: friction measured and of the model, against time and slip rate, and what is left."""

from __future__ import annotations

from typing import TYPE_CHECKING, Unpack

from matplotlib.figure import Figure

from stickslip.figures.panels import add_legend, letter_panels, panels
from stickslip.figures.style import BLUE, GREY, Numbers, axis_text, label, shown, styled, time_unit, unit_shown
from stickslip.foundation.names import name_of
from stickslip.foundation.place import Place

if TYPE_CHECKING:
    from stickslip.extensions.given_motion.identification import Identification

MOST_POINTS = 20_000
"""Draw at most so many samples."""


@styled
def draw_identified(found: Identification, **place: Unpack[Place]) -> Figure:
    """Draw friction against time, what is left of it, and friction against the slip rate."""
    record, unit = found.model.record, found.model.record.unit
    thin = slice(None, None, max(1, -(-len(record.time) // MOST_POINTS)))
    name = name_of("traction", unit) if unit else "friction coefficient"
    about = {"units": unit or "1", "long_name": name, "symbol": r"\tau" if unit else r"\mu"}
    measured, model = (Numbers(one[thin], about) for one in (record.friction, found.friction))
    rate = Numbers(found.model.rate[thin], {"units": "rad/s" if record.turns else "m/s", "long_name": "slip rate", "symbol": "v"})
    size = unit_shown(measured)
    clock, second = time_unit(float(record.time[-1]))
    figure, axes = panels(3, 1, (6.5, 7.0), place)
    time = record.time[thin] / second
    axes[0, 0].plot(time, shown(measured, size), color=GREY, linewidth=0.8, label="measured")
    axes[0, 0].plot(time, shown(model, size), color=BLUE, label=type(found.model.law).__name__)
    left = shown(measured, size) - shown(model, size)
    axes[1, 0].plot(time, left, color=GREY, linewidth=0.8)
    axes[2, 0].plot(shown(rate), shown(measured, size), ".", color=GREY, markersize=2.0)
    axes[2, 0].plot(shown(rate), shown(model, size), color=BLUE, linewidth=0.8)
    for panel in (axes[0, 0], axes[2, 0]):
        panel.set_ylabel(label(measured, size))
    axes[1, 0].set_ylabel(axis_text("left", "", size[0]))
    axes[1, 0].set_xlabel(axis_text("time", "t", clock))
    axes[2, 0].set_xlabel(label(rate))
    add_legend(axes[0, 0], axes[0, 0].get_legend_handles_labels()[0])
    letter_panels(axes.flat)
    return figure
