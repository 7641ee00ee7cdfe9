"""The panels of the page, one a file: `data_of(answer, units)` says what is shown, `plot(stage)` makes what shows it."""

from __future__ import annotations

from typing import Any

from stickslip.extensions.explorer.model.answer import Answer
from stickslip.extensions.explorer.model.fault import FaultAnswer
from stickslip.extensions.explorer.page.panels import contact, energy, fault, field, law, loading, motion, shape
from stickslip.extensions.explorer.page.panels.law import place, unit_along
from stickslip.extensions.explorer.page.panels.motion import COLUMNS_OF_MOTION, CURVE_OF, DRAWN, columns_of
from stickslip.extensions.explorer.page.panels.units import share_axis, units_of
from stickslip.extensions.explorer.page.stage import Stage
from stickslip.extensions.explorer.page.view import Columns, LegendKey, Units, View, limits
from stickslip.foundation.given import shown_in
from stickslip.problem import units_given

NO_PINNED_RUN: dict[str, Columns] = {
    "pinned": {name: [] for name in COLUMNS_OF_MOTION},
    "pinned_law": {"x": [], "y": []},
    "pinned_contact": {"rate": [], "load": []},
}
"""The sources without a pinned run."""
KEY = LegendKey("pinned", "pin")


def add_pinned(view: View, kept: Answer | None, answer: Answer, units: Units) -> None:
    """Add a kept run to the view of another one, in the units of that one; its axes are widened to hold both."""
    view.columns |= {name: dict(columns) for name, columns in NO_PINNED_RUN.items()}
    if kept is None:
        return
    curves = columns_of(kept.motions[0], units)
    shown = {name for name, curve in CURVE_OF.items() if share_axis(answer.motions[0], kept.motions[0], curve)}
    known = {"time", "rate", *(DRAWN[name] for name in shown)}
    view.columns["pinned"] = {name: curves[name] if name in known else [float("nan")] * len(curves["time"]) for name in curves}
    for name in shown:
        _widen(view, name, curves[DRAWN[name]])
    if (kept.law.along, kept.law.log) == (answer.law.along, answer.law.log):
        x = place(kept.law, kept.law.x, unit_along(answer.law, units))
        view.columns["pinned_law"] = {"x": x, "y": kept.law.coefficient}
        _widen(view, "law_y", kept.law.coefficient)
        shown |= {"law"}
    if kept.contact is not None and answer.contact is not None and "traction" in shown:
        curve = {"rate": kept.contact.rate / units.on_curve[1], "load": kept.contact.load / units.load[1]}
        view.columns["pinned_contact"] = curve
        _widen(view, "contact_load", curve["load"])
        shown |= {"contact"}
    for name in shown:
        view.keys[name] = (*view.keys.get(name, ()), KEY)


def _widen(view: View, axis: str, values: object) -> None:
    (low, high), (least, most) = view.limits[axis], limits(values)
    view.limits[axis] = min(low, least), max(high, most)


__all__ = ["plots", "view_of"]

MODULES_OF_PANELS = (law, contact, motion, loading, field, energy, shape)


def view_of(answer: Answer | FaultAnswer, kept: Any = None) -> View:
    """Return all that the panels show of an answer, with the run that is kept beside it, which is of the same kind."""
    with shown_in(units_given(answer.scenario.problem)):
        return fault.view_of_fault(answer, kept) if isinstance(answer, FaultAnswer) else _view_of(answer, kept)


def _view_of(answer: Answer, kept: Answer | None) -> View:
    """Return the view of a contact that is a single place."""
    units, view = units_of(answer, kept), View()
    for panel in MODULES_OF_PANELS:
        view.add(panel.data_of(answer, units))
    add_pinned(view, kept, answer, units)
    view.facts["hidden"] = sorted(view.hidden)
    return view


def plots(stage: Stage) -> dict[str, Any]:
    """Return all plots by name, without data."""
    found = {"law": law.plot(stage), "contact": contact.plot(stage)} | motion.plots(stage) | motion.further_plots(stage)
    found |= loading.plots(stage)
    return found | {"field": field.plot(stage), "energy": energy.plot(stage), "shape": shape.plot(stage)}
