"""The space-time panel: the velocity in the slab as an image, with the wave fronts that leave the contact."""

from __future__ import annotations

from typing import Any

import numpy as np

from stickslip.explorer.model.answer import Answer
from stickslip.explorer.page.look import paint
from stickslip.explorer.page.stage import NARROW, Stage
from stickslip.explorer.page.view import Columns, Key, Units, View, axis_label, single
from stickslip.figures.style import unit_of

TEXT = "Velocity in the slab: distance from the contact against time, with wave fronts"
EMPTY: Columns = {"velocity": [], "displacement": [], "x": [], "y": [], "dw": [], "dh": []}


def data_of(answer: Answer, units: Units) -> View:
    """Return velocity and displacement as images (rows are places, columns are times), and the fronts as lines."""
    slab = answer.slab
    if slab is None:
        return View(
            columns={"field": dict(EMPTY), "fronts": {"time": [], "place": []}}, hidden={"field"}, facts={"field": None}
        )  # fmt: skip
    time, place = units.nearby(slab.time), slab.place / units.place[1]
    step, height = (float(np.mean(np.diff(one))) if one.size > 1 else 1.0 for one in (time, place))
    name, size = unit_of("m/s", slab.velocity)
    velocity = single(slab.velocity.T / size)
    largest = float(np.abs(velocity).max()) or 1.0
    thickness = float(place[-1] + 0.5 * height)
    shape = {"x": [float(time[0]) - 0.5 * step], "y": [0.0], "dw": [step * time.size], "dh": [thickness]}
    image = {"velocity": [velocity], "displacement": [single(slab.displacement.T / units.slip[1])]}
    return View(
        columns={
            "field": image | shape,
            "fronts": {
                "time": [units.nearby(front[:, 0]) for front in slab.fronts],
                "place": [front[:, 1] / units.place[1] for front in slab.fronts],
            },
        },
        limits={"place": (0.0, thickness)},
        fastest=largest,
        titles={"field": axis_label("Slab: distance", "x", units.place[0])},
        keys={"field": (Key(f"velocity ±{largest:.3g} {name}", "signed", "scale"), Key("wave front", "front"))},
        facts={"field": {"thickness": thickness}},
    )


def plot(stage: Stage) -> Any:
    """Return the plot of velocity over time and place."""
    drawn = stage.plot("field", "near", "place", TEXT, left=NARROW, bare=True)
    drawn.image("velocity", "x", "y", "dw", "dh", source=stage.source("field", *EMPTY), color_mapper=stage.signed, level="image")
    fronts = drawn.multi_line("time", "place", source=stage.source("fronts", "time", "place"), line_width=1)
    paint(fronts.glyph, line_color="front")
    drawn.grid.visible = False
    stage.cursor("field")
    return drawn
