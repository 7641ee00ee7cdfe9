"""Words above the panels: sentence, faults, progress and stop, the card of the tour, and what differs from the pinned run."""

from __future__ import annotations

from collections.abc import Callable
from html import escape
from typing import Any

import panel as pn
import param
from panel.custom import JSComponent

from stickslip.extensions.explorer.model.answer import Answer
from stickslip.extensions.explorer.model.difference import difference
from stickslip.extensions.explorer.model.fault import FaultAnswer
from stickslip.extensions.explorer.model.tour import TOUR, TourStep, tour_of
from stickslip.extensions.explorer.page.components import Markup, asset
from stickslip.extensions.explorer.page.explorer import Explorer
from stickslip.problem import in_given_units


def told_steps(steps: tuple[TourStep, ...] = TOUR) -> list[dict[str, str]]:
    """Return what the card shows of each step, as plain texts."""
    return [{name: getattr(step, name) for name in ("title", "text", "look", "question", "panel")} for step in steps]


class TourCard(JSComponent):  # type: ignore[misc] # panel has no types
    """The card of the tour: it shows one step, and asks for others."""

    steps = param.List(default=[], doc="Title, text, look, question and panel of each step.")
    step = param.Integer(default=0, doc="The step that is shown, from 1; 0 if the card is closed.")

    _esm = asset("tour.js")

    def __init__(self, asked: Callable[[int], None], **params: Any) -> None:
        self._asked = asked
        super().__init__(stylesheets=[asset("tour.css")], **params)

    def _handle_msg(self, data: Any) -> None:
        step = data.get("step") if isinstance(data, dict) else None
        if isinstance(step, int) and 0 <= step <= len(self.steps):
            self._asked(step)


class Tour:
    """The tour of one page: `card` is placed above the panels, and `button` in the bar."""

    def __init__(self, explorer: Explorer) -> None:
        self._explorer = explorer
        self._steps = tour_of(explorer.setting)
        self.card = TourCard(self.show, steps=told_steps(self._steps), step=explorer.tour, sizing_mode="stretch_width", margin=0)
        self.button = pn.widgets.Button(label="Tour", margin=0, stylesheets=[asset("button.css")])
        self.button.on_click(lambda _: self.show(0 if explorer.tour else 1))
        explorer.listen("tour", self._update)

    def show(self, step: int) -> None:
        """Show a step of the tour, from 1; 0 closes the tour."""
        found = self._steps[step - 1] if step else None
        if found is None:
            self._explorer.show_step(0, None, None, 0.0)
        else:
            self._explorer.show_step(step, found.setting, found.strip, found.cursor)

    def _update(self) -> None:
        self.card.step = self._explorer.tour


MOST_NAMED = 8
"""Largest number of changes, and of numbers, that the page names."""


class PinnedRun:
    """What differs between the kept run and the one that is shown. `view` is what is placed on the page."""

    def __init__(self, explorer: Explorer) -> None:
        self._explorer = explorer
        self.view = Markup("", sizing_mode="stretch_width", stylesheets=[asset("pin.css")], visible=False, margin=0)
        for news in ("pin", "answer"):
            explorer.listen(news, self.show)
        self.show()

    def show(self) -> None:
        """Show the difference, or nothing if no run is kept."""
        pinned, shown = self._explorer.pinned, self._explorer.shown
        self.view.visible = pinned is not None
        if pinned is None or shown is None:
            self.view.object = ""
            return
        found = difference(pinned, shown)
        self.view.object = (
            f'<section class="pinned" aria-live="polite" aria-label="Comparison with the pinned run"><p class="name">'
            f"Pinned: {escape(pinned[0].title or pinned[0].name)}</p>{_list('Changed', [str(one) for one in found.changes])}"
            f"{_list('Moved', [str(one) for one in found.moved])}{_nothing(bool(found.changes))}</section>"
        )


def _list(heading: str, lines: list[str]) -> str:
    more = [f"and {len(lines) - MOST_NAMED} more"] * (len(lines) > MOST_NAMED)
    items = "".join(f"<li>{escape(line)}</li>" for line in [*lines[:MOST_NAMED], *more])
    return f'<p class="kind">{heading}</p><ul>{items}</ul>' if lines else ""


def _nothing(changed: bool) -> str:
    return "" if changed else '<p class="kind">Nothing is changed yet: move a control, and what moves is named here.</p>'


FIRST_ANSWER_COMING = "The first answer is being calculated."


class WordsBox(JSComponent):  # type: ignore[misc] # panel has no types
    """The words in the browser, where readers of the screen are told when they change."""

    texts = param.Dict(default={}, doc="sentence, regime, fault, progress and notes.")

    _esm = asset("words.js")

    def __init__(self, explorer: Explorer, **params: Any) -> None:
        self._explorer = explorer
        super().__init__(stylesheets=[asset("words.css")], **params)

    def _handle_msg(self, data: Any) -> None:
        if data == "stop":
            self._explorer.stop()


class Words:
    """The words of one page. `view` is what is placed on it."""

    def __init__(self, explorer: Explorer) -> None:
        self._explorer = explorer
        self.view = WordsBox(explorer, sizing_mode="stretch_width")
        for news in ("answer", "fault", "progress"):
            explorer.listen(news, self.show)
        self.show()

    def show(self) -> None:
        """Show the words of the explorer as it is now."""
        explorer, answer = self._explorer, self._explorer.answer
        told = words_of(answer) if answer else {"sentence": FIRST_ANSWER_COMING, "regime": "", "notes": []}
        self.view.texts = told | {"fault": explorer.fault, "progress": explorer.progress}


@in_given_units
def words_of(answer: Answer | FaultAnswer) -> dict[str, Any]:
    """Return what is said of an answer: the sentence, the word for the regime, and the notes."""
    return {"sentence": answer.sentence, "regime": answer.regime, "notes": list(answer.notes)}
