"""The words above the panels: the sentence, what is wrong with the last entry, and the progress of a run, with its stop."""

from __future__ import annotations

from typing import Any

import param
from panel.custom import JSComponent

from stickslip.explorer.model.answer import Answer
from stickslip.explorer.page.components import asset
from stickslip.explorer.page.explorer import Explorer

FIRST = "The first answer is being calculated."


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
        told = words_of(answer) if answer else {"sentence": FIRST, "regime": "", "notes": []}
        self.view.texts = told | {"fault": explorer.fault, "progress": explorer.progress}


def words_of(answer: Answer) -> dict[str, Any]:
    """Return what is said of an answer: the sentence, the word for the regime, and the notes."""
    return {"sentence": answer.sentence, "regime": answer.regime, "notes": list(answer.notes)}
