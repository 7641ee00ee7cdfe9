"""The panel of energy: its parts stacked against time, and the total."""

from __future__ import annotations

from typing import Any

import numpy as np

from stickslip.explorer.model.answer import Answer
from stickslip.explorer.page.look import paint
from stickslip.explorer.page.stage import NARROW, Stage
from stickslip.explorer.page.view import Columns, Key, Units, View, axis_label, limits
from stickslip.figures.style import unit_of

TEXT = "Energy against time: elastic, kinetic, radiated, damped, and friction heat, stacked"
PARTS = ("elastic", "kinetic", "radiated", "damped", "heat")
"""The parts that are stacked, from below, as in the figures of the package; each name is also the role of its colour."""
NAMES = {"heat": "friction heat"}


def data_of(answer: Answer, units: Units) -> View:
    """Return the upper edge of each part of the stack, without parts that are zero throughout, and the total."""
    energy = answer.energy
    drawn = [name for name in PARTS if name in energy.parts and np.any(energy.parts[name])]
    top = np.zeros(energy.time.size)
    edges: Columns = {"time": energy.time / units.time[1], "base": top}
    for name in PARTS:
        top = top + energy.parts[name] if name in drawn else top
        edges[name] = top
    total = energy.parts.get("total", top)
    unit, size = unit_of(energy.unit, total, top)
    columns = {name: values if name == "time" else values / size for name, values in edges.items()} | {"total": total / size}
    keys = tuple(Key(NAMES.get(name, name), name, "area") for name in reversed(drawn))
    return View(
        columns={"energy": columns},
        limits={"energy": limits(columns["total"], columns[PARTS[-1]], floor=0.0)},
        labels={"axis:time@energy": axis_label("time", "t", units.time[0])},
        titles={"energy": axis_label("Energy", "", unit)},
        keys={"energy": (*keys, Key("total", "ink", "dash"))},
    )


def plot(stage: Stage) -> Any:
    """Return the plot of the stacked energies."""
    drawn = stage.plot("energy", "time", "energy", TEXT, left=NARROW)
    source = stage.source("energy", "time", "base", *PARTS, "total")
    for below, name in zip(("base", *PARTS), PARTS, strict=False):
        paint(drawn.varea("time", below, name, source=source, fill_alpha=0.75).glyph, fill_color=name)
    paint(drawn.line("time", "total", source=source, line_width=1.4, line_dash="dashed").glyph, line_color="ink")
    stage.cursor("energy")
    return drawn
