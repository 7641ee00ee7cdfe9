"""A page of words only, which stands in for the page of panels until that is there."""

from __future__ import annotations

from typing import Any

import panel as pn

from stickslip.explorer.page.explorer import Explorer


def build(explorer: Explorer) -> Any:
    """Return a page that shows the sentence, the fault and the progress of an explorer."""
    words: Any = pn.pane.HTML("The first answer is being calculated.")  # type: ignore[no-untyped-call]

    def show() -> None:
        sentence = explorer.answer.sentence if explorer.answer else ""
        words.object = "\n".join(line for line in (sentence, explorer.fault, explorer.progress) if line)

    for news in ("answer", "fault", "progress"):
        explorer.listen(news, show)
    return pn.Column(words)
