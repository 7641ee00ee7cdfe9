"""The panel of the contact equation: g(v) with the set K, its folds and jumps, the load line, and the run's path on it."""

from __future__ import annotations

from typing import Any

import numpy as np
from bokeh.models import Arrow, NormalHead

from stickslip.extensions.explorer.model.answer import Answer, ContactPicture
from stickslip.extensions.explorer.page.components import paint
from stickslip.extensions.explorer.page.stage import Stage
from stickslip.extensions.explorer.page.view import Columns, LegendKey, Units, View, axis_label, limits
from stickslip.foundation.names import name_of, plain_symbol

TEXT_OF_CONTACT = "Contact equation: load against slip rate, with stick, stable and unstable slip, folds, and the path of the run"
KINDS_OF_SOLUTION = {1: "stable", -1: "unstable", 0: "continuum"}
KEYS = {
    "stable": LegendKey("stable", "stable"),
    "unstable": LegendKey("unstable", "unstable", "dash"),
    "continuum": LegendKey("continuum", "continuum"),
}


def data_of(answer: Answer, units: Units) -> View:
    """Return the parts of the curve, folds, jumps and the path, in the units of slip rate and load."""
    contact = answer.contact
    empty: Columns = {"rate": [], "load": []}
    sources = ("stick", *KINDS_OF_SOLUTION.values(), "folds", "path")
    if contact is None:
        hidden = {name: dict(empty) for name in sources} | {"jumps": {"x0": [], "y0": [], "x1": [], "y1": []}}
        return View(columns=hidden, hidden={"contact"}, facts={"contact": None})
    metre, pascal = units.on_curve[1], units.load[1]
    columns: dict[str, Columns] = {kind: _part(contact, number, metre, pascal) for number, kind in KINDS_OF_SOLUTION.items()}
    columns["stick"] = {"rate": [0.0, 0.0], "load": [0.0, contact.strength / pascal]}
    folds, jumps = np.reshape(contact.folds, (-1, 2)), np.reshape(contact.jumps, (-1, 4))
    columns["folds"] = {"rate": folds[:, 0] / metre, "load": folds[:, 1] / pascal}
    ends = dict(zip(("x0", "y0", "x1", "y1"), (jumps / [metre, pascal, metre, pascal]).T, strict=True))
    columns["jumps"] = ends
    path = {"time": contact.path_time / units.time[1], "rate": contact.path_rate / metre, "load": contact.path_load / pascal}
    columns["path"] = path
    found = [kind for kind in KINDS_OF_SOLUTION.values() if np.isfinite(columns[kind]["load"]).any()]
    keys = [LegendKey("stick", "stick"), *(KEYS[kind] for kind in found), LegendKey("path", "path")]
    keys += [LegendKey("fold", "ink", "ring")] if len(folds) else []
    keys += [LegendKey("jump", "muted", "dot")] if len(jumps) else []
    load, rate = (name_of(name, answer.motions[0].load_unit) for name in ("load", "slip_rate"))
    return View(
        columns=columns,
        limits={
            "contact_rate": limits(contact.rate / metre, path["rate"], 0.0),
            "contact_load": limits(contact.load / pascal, path["load"], columns["stick"]["load"][1]),
        },
        labels={
            "axis:contact_rate@contact": axis_label(rate, plain_symbol("slip_rate"), units.on_curve[0]),
            "axis:contact_load@contact": axis_label(load, plain_symbol("load"), units.load[0]),
        },
        titles={"contact": "Contact g(v) at the slip of the start"} if answer.scenario.problem.friction.depends_on_slip else {},
        keys={"contact": tuple(keys)},
        facts={"contact": {}},
    )


def _part(contact: ContactPicture, number: int, metre: float, pascal: float) -> Columns:
    """Return the points of one kind, with NaN elsewhere; unstable parts and continua reach to their neighbours."""
    chosen = contact.stability == number
    if number != 1 and chosen.any():
        chosen = chosen | np.append(chosen[1:], False) | np.append(False, chosen[:-1])
    return {"rate": contact.rate / metre, "load": np.where(chosen, contact.load / pascal, np.nan)}


def plot(stage: Stage) -> Any:
    """Return the plot of the contact equation."""
    drawn = stage.plot("contact", "contact_rate", "contact_load", TEXT_OF_CONTACT)
    paint(drawn.line("rate", "load", source=stage.source("stick", "rate", "load"), line_width=4.5).glyph, line_color="stick")
    for kind in KINDS_OF_SOLUTION.values():
        dash = "dashed" if kind == "unstable" else "solid"
        line = drawn.line("rate", "load", source=stage.source(kind, "rate", "load"), line_width=3, line_dash=dash)
        paint(line.glyph, line_color=kind)
    pinned = drawn.line("rate", "load", source=stage.source("pinned_contact", "rate", "load"), line_width=2, line_alpha=0.8)
    paint(pinned.glyph, line_color="pin")
    path = stage.source("path", "time", "rate", "load")
    paint(drawn.line("rate", "load", source=path, line_width=2.2).glyph, line_color="path")
    head = paint(NormalHead(size=7, line_alpha=0.0), fill_color="muted")
    jumps = stage.source("jumps", "x0", "y0", "x1", "y1")
    ends = {"x_start": "x0", "y_start": "y0", "x_end": "x1", "y_end": "y1"}
    drawn.add_layout(paint(Arrow(end=head, source=jumps, line_dash="dotted", line_width=1.5, **ends), line_color="muted"))
    folds = drawn.scatter("rate", "load", source=stage.source("folds", "rate", "load"), size=7)
    paint(folds.glyph, fill_color="card", line_color="ink")
    stage.cursor("contact", "width")
    dot = drawn.scatter("rate", "load", source=stage.source("now_contact", "rate", "load"), size=9, level="overlay")
    paint(dot.glyph, fill_color="cursor", line_color="card")
    return drawn
