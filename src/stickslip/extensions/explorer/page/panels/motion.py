"""The panels of slip, slip rate and traction against time, the body and its companion overlaid."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from bokeh.models import Span

from stickslip.extensions.explorer.model.answer import Answer, BodyCurves, short
from stickslip.extensions.explorer.page.components import paint
from stickslip.extensions.explorer.page.panels.units import Curve, held, share_axis
from stickslip.extensions.explorer.page.stage import NARROW, Stage
from stickslip.extensions.explorer.page.view import Columns, LegendKey, LineStyle, Units, View, axis_label, limits
from stickslip.figures.runs.curves import after_start
from stickslip.foundation.names import QUANTITIES, name_of, plain_symbol, readable_unit, si_unit

TEXTS_OF_MOTION = {"slip": "Slip against time", "rate": "Slip rate against time", "traction": "Traction and load against time"}
FURTHER = {
    "state": "States of friction against time",
    "residual": "What was measured minus the run, against time",
}
"""Panels that only some answers have something to show in."""
SEVERAL = 100.0
"""States that change by more than this factor are drawn on a logarithmic axis."""
MOST_LINES = 30
"""More marks than this are not drawn as lines in the panels."""
DRAWN = {"slip": "slip", "rate": "rate_at", "traction": "traction"}
"""The column that each panel draws: `rate_at` is the place of the slip rate on an axis that may be logarithmic."""
CURVE_OF: dict[str, Curve] = {"slip": "slip", "rate": "slip_rate", "traction": "traction"}
"""The curve of a motion by the name of its panel."""
COLUMNS_OF_MOTION = ("time", "slip", "rate", "rate_at", "traction", "load")
"""What is known of a body at each time."""
LOADS = ("traction", "load")


def data_of(answer: Answer, units: Units) -> View:
    """Return the curves of both bodies, and the times of the marks."""
    main, other = answer.motions[0], answer.motions[1:2]
    columns = {"motion": columns_of(main, units), "companion": _beside(main, other, units)}
    behind = columns["measured"] = _measured(answer, units)
    columns["marks"] = {"time": [mark.time / units.time[1] for mark in answer.marks] if len(answer.marks) <= MOST_LINES else []}
    if main.body == "block":
        # The end of the spring that is pulled, from the law of the spring.
        stiffness = answer.scenario.problem.body.stiffness
        columns["motion"]["drive"] = (main.slip + (main.load - main.load[0]) / stiffness) / units.slip[1]
    spoken = {panel: name_of(curve, main.load_unit) for panel, curve in CURVE_OF.items()}
    spoken["traction"] = "change of " * bool(units.offset) + spoken["traction"]
    keys = {name: (LegendKey(main.name, name), *_key(answer, name)) for name in CURVE_OF}
    for panel, key in _misfits(answer).items():
        keys[panel] = (*keys[panel], key)
    keys["traction"] = (*keys["traction"], LegendKey(name_of("load", main.load_unit), "load", "dot"))
    time = columns["motion"]["time"]
    view = View(
        columns=columns,
        limits={
            "time": (float(time[0]), float(time[-1])),
            "slip": limits(behind["slip"], *(columns_of(body, units)["slip"] for body in held(answer, "slip"))),
            "rate": _rate_limits(answer, units),
            "traction": limits(
                behind["traction"], *(columns_of(body, units)[name] for body in held(answer, "traction") for name in LOADS)
            ),
        },
        labels={
            "axis:time@traction": axis_label("time", "t", units.time[0]),
        },
        titles=titles(spoken, units),
        keys=keys,
        hidden={"axis:rate@rate" if units.log else "axis:rate_powers"},
        facts={
            "time": {"unit": units.time[0], "size": units.time[1], "from": float(time[0]), "to": float(time[-1])},
            "read": read(units),
            "marks": [{"time": mark.time / units.time[1], "kind": mark.kind, "text": mark.text} for mark in answer.marks],
        },
    )
    view.add(_states(main, units))
    view.add(_residual(answer, units))
    return view


def titles(spoken: Mapping[str, str], units: Units) -> dict[str, str]:
    """Return the title of each panel, from the name of what it shows."""
    shown = zip(CURVE_OF.items(), (units.slip, units.rate, units.stress), strict=True)
    return {panel: axis_label(spoken[panel].capitalize(), plain_symbol(curve), unit) for (panel, curve), (unit, _) in shown}


def read(units: Units) -> list[dict[str, Any]]:
    """Return symbol and unit of what is read off at the cursor in each panel."""
    shown = zip(CURVE_OF.items(), (units.slip, units.rate, units.stress), strict=True)
    return [
        {"column": panel, "symbol": plain_symbol(curve), "unit": unit, "offset": bool(units.offset and panel == "traction")}
        for (panel, curve), (unit, _) in shown
    ]


def _states(main: BodyCurves, units: Units) -> View:
    """Return the states of friction, on a logarithmic axis if they change by orders of magnitude."""
    both = ("state", "second")
    if not main.states:
        return View(columns={"states": {name: [] for name in ("time", *both)}}, hidden={"state"})
    values = [one.values for one in main.states]
    log = all((one > 0.0).all() and one.max() > SEVERAL * one.min() for one in values)
    unit, size = (main.states[0].unit, 1.0) if log else readable_unit(main.states[0].unit, *values)
    shown = [np.log10(one) if log else one / size for one in values]
    nothing = np.full(main.time.size, np.nan)
    columns = {"time": main.time / units.time[1]} | dict(zip(both, [*shown, nothing], strict=False))
    styles: tuple[LineStyle, ...] = ("line", "dash")
    return View(
        columns={"states": columns},
        limits={"state": limits(*shown)},
        titles={"state": axis_label("State of friction", "", unit)},
        keys={"state": tuple(LegendKey(one.meaning, "law", style) for one, style in zip(main.states, styles, strict=False))},
        hidden={"axis:state@state" if log else "axis:state_powers"},
    )


def _residual(answer: Answer, units: Units) -> View:
    """Return what was measured minus the run, of the traction if that was measured, and otherwise of slip or slip rate."""
    found = answer.measured
    curve = next((one for one in ("traction", "slip", "slip_rate") if found is not None and one in found.residuals), "")
    if found is None or not curve:
        return View(columns={"residual": {"time": [], "residual": []}}, hidden={"residual"})
    unit, size = readable_unit(si_unit(curve, answer.motions[0].load_unit), found.residuals[curve])
    away = found.residuals[curve] / size
    return View(
        columns={"residual": {"time": found.time / units.time[1], "residual": away}},
        limits={"residual": limits(away, 0.0)},
        titles={"residual": axis_label(f"Measured minus run: {QUANTITIES[curve].name}", "", unit)},
    )


def _measured(answer: Answer, units: Units) -> Columns:
    """Return the samples of a record behind the run, NaN for quantities that were not measured; empty columns without a record."""
    found = answer.measured
    if found is None:
        return {name: [] for name in ("time", *DRAWN.values())}
    nothing = np.full(found.time.size, np.nan)
    slip, rate, traction = (found.curves.get(CURVE_OF[name], nothing) for name in DRAWN)
    rate = rate / units.rate[1]
    return {
        "time": found.time / units.time[1],
        "slip": slip / units.slip[1],
        "rate_at": np.log10(np.where(rate > 0.0, rate, np.nan)) if units.log else rate,
        "traction": (traction - units.offset) / units.stress[1],
    }


def _misfits(answer: Answer) -> dict[str, LegendKey]:
    """Return the entry of a record in the legend of each panel that shows it, with the misfit of the run."""
    found = answer.measured
    if found is None:
        return {}
    panels: dict[str, str] = {curve: name for name, curve in CURVE_OF.items()}
    return {
        panels[curve]: LegendKey(f"measured, misfit {short(one.value, one.unit)}", "path", "ring")
        for curve, one in zip(found.curves, found.misfits, strict=True)
    }


def _beside(main: BodyCurves, other: Sequence[BodyCurves], units: Units) -> Columns:
    """Return the curves of the companion, if there is one; without loads that cannot share an axis with those of the body."""
    if not other:
        return {name: [] for name in COLUMNS_OF_MOTION}
    found = columns_of(other[0], units)
    return (
        found if share_axis(main, other[0], "traction") else found | {name: np.full(other[0].time.size, np.nan) for name in LOADS}
    )


def _rate_limits(answer: Answer, units: Units) -> tuple[float, float]:
    """Return the ends of the axis of slip rate; the start from rest does not count where it is logarithmic."""
    main, *others = held(answer, "slip_rate")
    rate = columns_of(main, units)["rate_at"]
    settled = after_start(answer.solution, main.time, (float(main.time[0]), float(main.time[-1])))
    return limits(rate[settled], *(columns_of(body, units)["rate_at"] for body in others if not units.log))


def _key(answer: Answer, name: str) -> tuple[LegendKey, ...]:
    """Return how the legend of a panel names the companion; one that leaves the axis is named with the end of its curve."""
    main, curve = answer.motions[0], CURVE_OF[name]
    others = [one for one in answer.motions[1:2] if share_axis(main, one, curve)]
    if not others or others[0] in held(answer, curve):
        return tuple(LegendKey(one.name, name, "dash") for one in others)
    reach = getattr(others[0], curve)
    reach = reach[np.argmax(np.abs(reach))]
    unit, size = readable_unit(si_unit(curve, main.load_unit), reach)
    return (LegendKey(f"{others[0].name}, to {reach / size:.3g} {unit}", name, "dash"),)


def columns_of(motion: BodyCurves, units: Units) -> Columns:
    """Return the curves of one body in the units shown."""
    rate = motion.slip_rate / units.rate[1]
    return {
        "time": motion.time / units.time[1],
        "slip": motion.slip / units.slip[1],
        "rate": rate,
        "rate_at": np.log10(np.where(rate == 0.0, np.nan, np.abs(rate))) if units.log else rate,
        "traction": (motion.traction - units.offset) / units.stress[1],
        "load": (motion.load - units.offset) / units.stress[1],
    }


def plots(stage: Stage) -> dict[str, Any]:
    """Return the three plots, which share the axis of time; the last one has its texts."""
    return {name: _plot(stage, name, bare=name != "traction") for name in TEXTS_OF_MOTION}


def further_plots(stage: Stage) -> dict[str, Any]:
    """Return the plots of the states and of the record minus the run, over the same axis of time."""
    found = {name: stage.plot(name, "time", name, text, left=NARROW, bare=True) for name, text in FURTHER.items()}
    stage.powers(found["state"], "state_powers", "left")
    states = stage.source("states", "time", "state", "second")
    paint(found["state"].line("time", "state", source=states, line_width=2).glyph, line_color="law")
    paint(found["state"].line("time", "second", source=states, line_width=1.6, line_dash="dashed").glyph, line_color="law")
    source = stage.source("residual", "time", "residual")
    paint(found["residual"].scatter("time", "residual", source=source, size=3, line_color=None).glyph, fill_color="path")
    found["residual"].add_layout(paint(Span(location=0.0, dimension="width", line_width=1), line_color="faint"))
    for name in found:
        stage.cursor(name)
    return found


def _plot(stage: Stage, name: str, *, bare: bool) -> Any:
    drawn = stage.plot(name, "time", name, TEXTS_OF_MOTION[name], left=NARROW, bare=bare)
    if name == "rate":
        stage.powers(drawn, "rate_powers", "left")
    column, main, other = DRAWN[name], stage.source("motion", *COLUMNS_OF_MOTION), stage.source("companion", *COLUMNS_OF_MOTION)
    pinned = drawn.line("time", column, source=stage.source("pinned", *COLUMNS_OF_MOTION), line_width=2, line_alpha=0.8)
    paint(pinned.glyph, line_color="pin")
    marks = drawn.vspan(x="time", source=stage.source("marks", "time"), line_width=1, line_dash="dotted")
    paint(marks.glyph, line_color="faint")
    if name == "traction":
        drawn.yaxis[0].ticker.desired_num_ticks = 3  # it often lies within a part of 10, where two would come down to one
        paint(drawn.line("time", "load", source=main, line_width=1.2, line_dash="dotted").glyph, line_color="load")
    samples = drawn.scatter("time", column, source=stage.source("measured", "time", *DRAWN.values()), size=4, fill_color=None)
    paint(samples.glyph, line_color="path")
    paint(drawn.line("time", column, source=other, line_width=1.3, line_dash="dashed", line_alpha=0.65).glyph, line_color=name)
    paint(drawn.line("time", column, source=main, line_width=2).glyph, line_color=name)
    stage.cursor(name)
    dot = drawn.scatter("time", column, source=stage.source("now", "time", *DRAWN.values()), size=8, level="overlay")
    paint(dot.glyph, fill_color=name, line_color="card")
    return drawn
