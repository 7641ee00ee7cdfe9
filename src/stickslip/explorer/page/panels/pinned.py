"""The run that is kept, in grey behind the one that is shown: its motion, its law, and its curve of the contact."""

from __future__ import annotations

from stickslip.explorer.model.answer import Answer
from stickslip.explorer.page.panels.law import place, unit_along
from stickslip.explorer.page.panels.motion import COLUMNS, DRAWN, columns_of
from stickslip.explorer.page.panels.units import share_loads
from stickslip.explorer.page.view import Columns, Key, Units, View, limits

NOTHING: dict[str, Columns] = {
    "pinned": {name: [] for name in COLUMNS},
    "pinned_law": {"x": [], "y": []},
    "pinned_contact": {"rate": [], "load": []},
}
"""The sources without a pinned run."""
KEY = Key("pinned", "pin")


def add_pinned(view: View, kept: Answer | None, answer: Answer, units: Units) -> None:
    """Add a kept run to the view of another one, in the units of that one; its axes are widened to hold both."""
    view.columns |= {name: dict(columns) for name, columns in NOTHING.items()}
    if kept is None:
        return
    curves = columns_of(kept.motions[0], units)
    shown = {"slip", "rate"} | ({"traction"} if share_loads(answer.motions[0], kept.motions[0]) else set())
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
    """Let an axis hold further values."""
    (low, high), (least, most) = view.limits[axis], limits(values)
    view.limits[axis] = min(low, least), max(high, most)
