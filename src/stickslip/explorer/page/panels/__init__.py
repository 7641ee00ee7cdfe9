"""The panels of the page, one a file: `data_of(answer, units)` says what is shown, `plot(stage)` makes what shows it."""

from __future__ import annotations

from typing import Any

from stickslip.explorer.model.answer import Answer
from stickslip.explorer.page.panels import contact, energy, field, law, motion, shape
from stickslip.explorer.page.panels.pinned import add_pinned
from stickslip.explorer.page.panels.units import units_of
from stickslip.explorer.page.stage import Stage
from stickslip.explorer.page.view import View

__all__ = ["plots", "view_of"]

PANELS = (law, contact, motion, field, energy, shape)


def view_of(answer: Answer, kept: Answer | None = None) -> View:
    """Return all that the panels show of an answer, with the run that is kept beside it."""
    units, view = units_of(answer, kept), View()
    for panel in PANELS:
        view.add(panel.data_of(answer, units))
    add_pinned(view, kept, answer, units)
    view.facts["hidden"] = sorted(view.hidden)
    return view


def plots(stage: Stage) -> dict[str, Any]:
    """Return all plots by name, without data."""
    found = {"law": law.plot(stage), "contact": contact.plot(stage)} | motion.plots(stage)
    return found | {"field": field.plot(stage), "energy": energy.plot(stage), "shape": shape.plot(stage)}
