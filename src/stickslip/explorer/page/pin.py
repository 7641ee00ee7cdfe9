"""Two of everything: the run that is kept, and what differs between it and the one that is shown."""

from __future__ import annotations

from html import escape

from stickslip.explorer.model.difference import difference
from stickslip.explorer.page.components import Markup, asset
from stickslip.explorer.page.explorer import Explorer

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
