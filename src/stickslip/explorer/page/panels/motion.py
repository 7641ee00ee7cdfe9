"""The panels of slip, slip rate and traction against time, the body and its companion overlaid."""

from __future__ import annotations

from typing import Any

import numpy as np

from stickslip.explorer.model.answer import Answer, Motion
from stickslip.explorer.page.look import paint
from stickslip.explorer.page.panels.units import share_loads
from stickslip.explorer.page.stage import NARROW, Stage
from stickslip.explorer.page.view import Columns, Key, Units, View, axis_label, limits
from stickslip.figures.style import CURVES, FORCES

TEXTS = {"slip": "Slip against time", "rate": "Slip rate against time", "traction": "Traction and load against time"}
MANY = 30
"""More marks than this are not drawn as lines in the panels."""
SYMBOLS = {"slip": "u", "rate": "v", "traction": "τ"}


def data_of(answer: Answer, units: Units) -> View:
    """Return the curves of both bodies, and the times of the marks."""
    main = answer.motions[0]
    others = answer.motions[1:2]
    drawn = [columns_of(motion, units) for motion in (main, *others)]
    columns = {"motion": drawn[0], "companion": drawn[1] if others else {name: [] for name in drawn[0]}}
    if others and not share_loads(main, others[0]):
        columns["companion"] |= {name: np.full(others[0].time.size, np.nan) for name in ("traction", "load")}
    columns["marks"] = {"time": [mark.time / units.time[1] for mark in answer.marks] if len(answer.marks) <= MANY else []}
    if main.body == "block":
        # The end of the spring that is pulled, from the law of the spring.
        stiffness = answer.scenario.problem.body.stiffness
        columns["motion"]["drive"] = (main.slip + (main.load - main.load[0]) / stiffness) / units.slip[1]
    force = main.load_unit == "N"
    name = FORCES["traction"] if force else CURVES["traction"][0]
    name = f"change of {name}" if units.offset else name
    bodies = [motion.name for motion in (main, *others)]
    styles = ("line", "dash")
    keys: dict[str, tuple[Key, ...]] = {
        role: tuple(Key(body, role, style) for body, style in zip(bodies, styles, strict=False))  # type: ignore[arg-type]
        for role in TEXTS
    }
    beside = bool(others) and share_loads(main, others[0])
    keys["traction"] = (*keys["traction"][: 1 + beside], Key("spring force" if force else "load", "load", "dot"))
    time = [body["time"] for body in drawn]
    return View(
        columns=columns,
        limits={
            "time": (float(time[0][0]), float(time[0][-1])),
            "slip": limits(*(body["slip"] for body in drawn)),
            "rate": limits(*(body["rate"] for body in drawn)),
            "traction": limits(*(body[name] for body in drawn for name in ("traction", "load"))),
        },
        labels={
            "axis:time@traction": axis_label("time", "t", units.time[0]),
        },
        titles={
            "slip": axis_label("Slip", "u", units.slip[0]),
            "rate": axis_label("Slip rate", "v", units.rate[0]),
            "traction": axis_label(name.capitalize(), "τ", units.stress[0]),
        },
        keys=keys,
        facts={
            "time": {"unit": units.time[0], "size": units.time[1], "from": float(time[0][0]), "to": float(time[0][-1])},
            "read": [
                {"column": column, "symbol": SYMBOLS[column], "unit": unit, "offset": bool(units.offset and column == "traction")}
                for column, unit in (("slip", units.slip[0]), ("rate", units.rate[0]), ("traction", units.stress[0]))
            ],
            "marks": [{"time": mark.time / units.time[1], "kind": mark.kind, "text": mark.text} for mark in answer.marks],
        },
    )


def columns_of(motion: Motion, units: Units) -> Columns:
    """Return the curves of one body in the units shown."""
    return {
        "time": motion.time / units.time[1],
        "slip": motion.slip / units.slip[1],
        "rate": motion.slip_rate / units.rate[1],
        "traction": (motion.traction - units.offset) / units.stress[1],
        "load": (motion.load - units.offset) / units.stress[1],
    }


def plots(stage: Stage) -> dict[str, Any]:
    """Return the three plots, which share the axis of time; the last one has its texts."""
    return {name: _plot(stage, name, bare=name != "traction") for name in TEXTS}


def _plot(stage: Stage, name: str, *, bare: bool) -> Any:
    drawn = stage.plot(name, "time", name, TEXTS[name], left=NARROW, bare=bare)
    columns = ("time", "slip", "rate", "traction", "load")
    main, other = stage.source("motion", *columns), stage.source("companion", *columns)
    pinned = drawn.line("time", name, source=stage.source("pinned", *columns), line_width=2, line_alpha=0.8)
    paint(pinned.glyph, line_color="pin")
    marks = drawn.vspan(x="time", source=stage.source("marks", "time"), line_width=1, line_dash="dotted")
    paint(marks.glyph, line_color="faint")
    if name == "traction":
        paint(drawn.line("time", "load", source=main, line_width=1.2, line_dash="dotted").glyph, line_color="load")
    paint(drawn.line("time", name, source=other, line_width=1.5, line_dash="dashed", line_alpha=0.8).glyph, line_color=name)
    paint(drawn.line("time", name, source=main, line_width=2).glyph, line_color=name)
    stage.cursor(name)
    dot = drawn.scatter("time", name, source=stage.source("now", "time", "slip", "rate", "traction"), size=8, level="overlay")
    paint(dot.glyph, fill_color=name, line_color="card")
    return drawn
