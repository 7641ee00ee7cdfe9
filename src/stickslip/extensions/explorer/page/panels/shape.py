"""The panel of the body at the time of the cursor: the slab's particles and lines, sheared, or the block on its spring.

The browser calculates the points from the sources "field" and "motion" (assets/stage.js), because they move with the cursor.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from bokeh.core.properties import value

from stickslip.extensions.explorer.model.answer import Answer
from stickslip.extensions.explorer.page.components import FONT, paint
from stickslip.extensions.explorer.page.stage import Stage
from stickslip.extensions.explorer.page.view import LegendKey, Units, View, axis_label, round_step
from stickslip.foundation.names import readable_unit

TEXT_OF_SHAPE = "Shape of the body at the time of the cursor: displacements, drawn many times larger"
WIDTH_OF_PICTURE = 10.0
"""Width of the picture, in its own units."""
LARGEST_DISPLACEMENT = 0.3
"""Largest displacement, as a share of the width."""


def data_of(answer: Answer, units: Units) -> View:
    """Return how much displacements are enlarged, and the length of the bar that shows their scale."""
    slab, slip = answer.slab, answer.motions[0].slip
    largest = float(np.abs(slab.displacement if slab is not None else slip - slip[0]).max()) or 1.0
    unit, size = readable_unit(units.slip_unit, largest)
    scale, bar = LARGEST_DISPLACEMENT * WIDTH_OF_PICTURE / largest * units.slip[1], round_step(largest / size)
    keys = [LegendKey("velocity of particles", "signed", "scale")] if slab is not None else []
    low, height = (answer.slab.place[[0, -1]] / units.place[1]).tolist() if answer.slab is not None else (0.0, 1.0)
    tall = height - low
    return View(
        limits={"shape_x": (0.0, WIDTH_OF_PICTURE), "shape_y": (low - 0.16 * tall, height + 0.17 * tall)},
        labels={"axis:shape_y@shape": axis_label("distance", "x", units.place[0])},
        keys={"shape": tuple(keys)},
        hidden={"axis:shape_x@shape"} | (set() if slab is not None else {"axis:shape_y@shape"}),
        facts={
            "shape": {
                "kind": "slab" if slab is not None else "block",
                "scale": scale, "bar": bar * size / units.slip[1] * scale, "width": WIDTH_OF_PICTURE, "height": height, "low": low,
                "boundaries": [one / units.place[1] for one in slab.boundaries] if slab is not None else [],
                "text": f"{bar:g} {unit}",
            }
        },
    )  # fmt: skip


def plot(stage: Stage) -> Any:
    """Return the plot of the body's shape."""
    drawn = stage.plot("shape", "shape_x", "shape_y", TEXT_OF_SHAPE)
    drawn.grid.visible = False
    ground = stage.source("ground", "x0", "x1", "y0", "y1")
    paint(
        drawn.quad(left="x0", right="x1", bottom="y0", top="y1", source=ground, line_width=0, level="overlay").glyph,
        fill_color="ground",
    )
    body = drawn.patches("x", "y", source=stage.source("body", "x", "y"), fill_alpha=0.12, level="overlay")
    paint(body.glyph, fill_color="slip", line_color="slip")
    lines = drawn.multi_line("x", "y", source=stage.source("lines", "x", "y"), line_width=1, level="overlay")
    paint(lines.glyph, line_color="faint")
    driver = drawn.multi_line("x", "y", source=stage.source("driver", "x", "y"), line_width=3, level="overlay")
    paint(driver.glyph, line_color="ink")
    texts = drawn.text("x", "y", "text", source=stage.source("texts", "x", "y", "text"), text_align="right", level="overlay")
    texts.glyph.text_font = value(FONT)
    paint(texts.glyph, text_color="ink", sizes={"text_font_size": 11})
    dots = drawn.scatter("x", "y", source=stage.source("particles", "x", "y", "velocity"), size=5, level="overlay")
    dots.glyph.fill_color = {"field": "velocity", "transform": stage.signed}
    paint(dots.glyph, line_color="grey")
    return drawn
