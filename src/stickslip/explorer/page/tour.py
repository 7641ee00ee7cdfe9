"""The tour on the page: a card with the text of a step above the panels, and the button in the bar that opens it."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import panel as pn
import param
from panel.custom import JSComponent

from stickslip.explorer.model.tour import TOUR
from stickslip.explorer.page.components import asset
from stickslip.explorer.page.explorer import Explorer


def told_steps() -> list[dict[str, str]]:
    """Return what the card shows of each step, as plain texts."""
    return [{name: getattr(step, name) for name in ("title", "text", "look", "question", "panel")} for step in TOUR]


class TourCard(JSComponent):  # type: ignore[misc] # panel has no types
    """The card of the tour: it shows one step, and asks for others."""

    steps = param.List(default=[], doc="Title, text, look, question and panel of each step.")
    step = param.Integer(default=0, doc="The step that is shown, from 1; 0 if the card is closed.")

    _esm = asset("tour.js")

    def __init__(self, asked: Callable[[int], None], **params: Any) -> None:
        self._asked = asked
        super().__init__(steps=told_steps(), stylesheets=[asset("tour.css")], **params)

    def _handle_msg(self, data: Any) -> None:
        step = data.get("step") if isinstance(data, dict) else None
        if isinstance(step, int) and 0 <= step <= len(TOUR):
            self._asked(step)


class Tour:
    """The tour of one page: `card` is placed above the panels, and `button` in the bar."""

    def __init__(self, explorer: Explorer) -> None:
        self._explorer = explorer
        self.card = TourCard(self.show, step=explorer.tour, sizing_mode="stretch_width", margin=0)
        self.button = pn.widgets.Button(label="Tour", margin=0, stylesheets=[asset("button.css")])
        self.button.on_click(lambda _: self.show(0 if explorer.tour else 1))
        explorer.listen("tour", self._update)

    def show(self, step: int) -> None:
        """Show a step of the tour, from 1; 0 closes the tour."""
        found = TOUR[step - 1] if step else None
        if found is None:
            self._explorer.show_step(0, None, None, 0.0)
        else:
            self._explorer.show_step(step, found.setting, found.strip, found.cursor)

    def _update(self) -> None:
        self.card.step = self._explorer.tour
