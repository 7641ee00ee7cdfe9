"""The panel of energy: its parts stacked against time, and the total."""

from __future__ import annotations

from typing import Any

import numpy as np

from stickslip.extensions.explorer.model.answer import Answer
from stickslip.extensions.explorer.page.components import paint
from stickslip.extensions.explorer.page.stage import NARROW, Stage
from stickslip.extensions.explorer.page.view import Columns, LegendKey, Units, View, axis_label, limits
from stickslip.foundation.names import name_of, readable_unit

TEXT_OF_ENERGY = "Energy against time: elastic, kinetic, radiated, damped, and friction heat, stacked"
STACKED_ENERGIES = ("elastic", "kinetic", "radiated", "damped", "heat")
"""The parts that are stacked, from below, as in the figures of the package; each name is also the role of its colour."""


def data_of(answer: Answer, units: Units) -> View:
    """Return the upper edge of each part of the stack, without parts that are zero throughout, and the total."""
    energy = answer.energy
    drawn = [name for name in STACKED_ENERGIES if name in energy.parts and np.any(energy.parts[name])]
    top = np.zeros(energy.time.size)
    edges: Columns = {"time": units.nearby(energy.time), "base": top}
    for name in STACKED_ENERGIES:
        top = top + energy.parts[name] if name in drawn else top
        edges[name] = top
    total = energy.parts.get("total", top)
    unit, size = readable_unit(energy.unit, total, top)
    columns = {name: values if name == "time" else values / size for name, values in edges.items()} | {"total": total / size}
    keys = tuple(LegendKey(name_of(name) if name == "heat" else name, name, "area") for name in reversed(drawn))
    if units.whole:
        span = answer.motions[0].time[[0, -1]] / units.time[1]
        ends, clock = (float(span[0]), float(span[1])), "time"
    else:
        ends = (float(edges["time"][0]), float(edges["time"][-1]))
        clock = f"time since t = {units.begin / units.time[1]:.6g} {units.time[0]}"
    return View(
        columns={"energy": columns},
        limits={"near": ends, "energy": limits(columns["total"], columns[STACKED_ENERGIES[-1]], floor=0.0)},
        labels={"axis:near@energy": axis_label(clock, "t" if units.whole else "", units.near[0])},
        titles={"energy": axis_label("Energy", "", unit)},
        facts={"near": {"size": units.near[1], "begin": units.begin, "whole": units.whole, "from": ends[0], "to": ends[1]}},
        keys={"energy": (*keys, LegendKey("total", "ink", "dash"))},
    )


def plot(stage: Stage) -> Any:
    """Return the plot of the stacked energies."""
    drawn = stage.plot("energy", "near", "energy", TEXT_OF_ENERGY, left=NARROW)
    source = stage.source("energy", "time", "base", *STACKED_ENERGIES, "total")
    for below, name in zip(("base", *STACKED_ENERGIES), STACKED_ENERGIES, strict=False):
        paint(drawn.varea("time", below, name, source=source, fill_alpha=0.75).glyph, fill_color=name)
    paint(drawn.line("time", "total", source=source, line_width=1.4, line_dash="dashed").glyph, line_color="ink")
    stage.cursor("energy")
    return drawn
