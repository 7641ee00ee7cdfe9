"""The space-time panel: what happens in the slab as an image, with the wave fronts that leave the contact.

The browser has velocity, displacement and stress, and draws the one that is chosen (assets/player.js).
"""

from __future__ import annotations

from typing import Any

import numpy as np

from stickslip.extensions.explorer.model.answer import Answer
from stickslip.extensions.explorer.page.components import paint
from stickslip.extensions.explorer.page.stage import NARROW, Stage, signed_scale
from stickslip.extensions.explorer.page.view import Columns, LegendKey, Units, View, axis_label, single
from stickslip.foundation.names import readable_unit, si_unit

TEXT_OF_FIELD = "Velocity, displacement or stress in the slab: distance from the contact against time, with wave fronts"
LINES: Columns = {"time": [], "place": []}
EMPTY: Columns = {"velocity": [], "displacement": [], "stress": [], "x": [], "y": [], "dw": [], "dh": []}


def data_of(answer: Answer, units: Units) -> View:
    """Return velocity, displacement and change of stress as images (rows are places, columns are times), and fronts as lines."""
    slab = answer.slab
    if slab is None:
        return View(
            columns={"field": dict(EMPTY), "fronts": dict(LINES), "layers": dict(LINES)}, hidden={"field"}, facts={"fields": {}}
        )  # fmt: skip
    load_unit = answer.motions[0].load_unit
    time, place = units.nearby(slab.time), slab.place / units.place[1]
    step, height = (float(np.mean(np.diff(one))) if one.size > 1 else 1.0 for one in (time, place))
    name, size = readable_unit(si_unit("slip_rate", load_unit), slab.velocity)
    velocity = single(slab.velocity.T / size)
    largest = float(np.abs(velocity).max()) or 1.0
    shape = {
        "x": [float(time[0]) - 0.5 * step],
        "y": [float(place[0]) - 0.5 * height],
        "dw": [step * time.size],
        "dh": [height * place.size],
    }
    displacement, change = slab.displacement.T, (slab.stress - slab.stress[0]).T
    of_stress, pascal = readable_unit(load_unit, change)
    image = {"velocity": [velocity], "displacement": [single(displacement / units.slip[1])], "stress": [single(change / pascal)]}
    fields = {
        "velocity": ends_of(velocity, name),
        "displacement": ends_of(image["displacement"][0], units.slip[0]),
        "stress": ends_of(image["stress"][0], of_stress),
    }
    keys = [LegendKey("wave front", "front")] if slab.fronts else []
    return View(
        columns={
            "field": image | shape,
            "fronts": {
                "time": [units.nearby(front[:, 0]) for front in slab.fronts],
                "place": [front[:, 1] / units.place[1] for front in slab.fronts],
            },
            "layers": {
                "time": [[float(time[0]), float(time[-1])] for _ in slab.boundaries],
                "place": [[one / units.place[1]] * 2 for one in slab.boundaries],
            },
        },
        limits={"place": (float(place[0]), float(place[-1]))},
        fastest=largest,
        titles={"field": axis_label(f"{answer.motions[0].name.capitalize()}:", "x", units.place[0])},
        keys={"field": (LegendKey(f"velocity {fields['velocity']['text']}", "signed", "scale"), *keys)},
        facts={"fields": fields},
    )


def ends_of(values: Any, unit: str) -> dict[str, Any]:
    """Return the ends of the colour scale of an image, as a number and as the text of the legend."""
    most = float(np.abs(values).max()) or 1.0
    return {"most": most, "text": f"±{most:.3g} {unit}"}


def plot(stage: Stage, text: str = TEXT_OF_FIELD) -> Any:
    """Return the plot of the chosen quantity in the slab, over time and place."""
    drawn = stage.plot("field", "near", "place", text, left=NARROW, bare=True)
    picture, colours = stage.source("picture", "image", "x", "y", "dw", "dh"), signed_scale("colour:field")
    drawn.image("image", "x", "y", "dw", "dh", source=picture, color_mapper=colours, level="image")
    picture.tags = [stage.source("field", *EMPTY)]  # what nothing refers to, the browser does not get
    fronts = drawn.multi_line("time", "place", source=stage.source("fronts", "time", "place"), line_width=1)
    paint(fronts.glyph, line_color="front")
    layers = drawn.multi_line("time", "place", source=stage.source("layers", "time", "place"), line_width=1)
    paint(layers.glyph, line_color="ink")
    drawn.grid.visible = False
    stage.cursor("field")
    return drawn
