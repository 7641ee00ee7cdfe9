"""The words above the panels: the sentence, what is wrong with the last entry, and the progress of a run."""

from __future__ import annotations

from html import escape

import panel as pn

from stickslip.explorer.model.answer import Answer
from stickslip.explorer.page.components import asset
from stickslip.explorer.page.explorer import Explorer


class Words:
    """The sentence above the panels, with the fault of the last entry and the progress of a run under way."""

    def __init__(self, explorer: Explorer) -> None:
        self._explorer = explorer
        self.view = pn.pane.HTML(sizing_mode="stretch_width", stylesheets=[asset("words.css")])
        for news in ("answer", "fault", "progress"):
            explorer.listen(news, self.show)
        self.show()

    def show(self) -> None:
        """Show the words of the explorer as it is now."""
        explorer, answer = self._explorer, self._explorer.answer
        sentence = _sentence(answer) if answer else "The first answer is being calculated."
        notes = "".join(f"<li>{escape(note)}</li>" for note in answer.notes) if answer else ""
        self.view.object = (
            f'<div class="words"><p class="sentence" role="status" aria-live="polite">{sentence}</p>'
            f'<p class="progress" aria-live="polite">{escape(explorer.progress)}</p>'
            f'<p class="fault" role="alert">{escape(explorer.fault)}</p><ul class="notes">{notes}</ul></div>'
        )


def _sentence(answer: Answer) -> str:
    """Return the sentence as HTML; the word for the regime stands out if it comes first."""
    text, word = escape(answer.sentence), answer.regime
    first, rest = text[: len(word)], text[len(word) :]
    return f'<strong class="regime {escape(word)}">{first}</strong>{rest}' if first.lower() == word else text
