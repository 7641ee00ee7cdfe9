"""The page: all its parts in their places. `build` is what the server shows to each browser."""

from __future__ import annotations

from typing import Any

import panel as pn

from stickslip.explorer.page.components import Markup, PlayerBar, asset
from stickslip.explorer.page.controls import Controls
from stickslip.explorer.page.explorer import Explorer
from stickslip.explorer.page.heading import heading
from stickslip.explorer.page.look import style_sheet
from stickslip.explorer.page.panels import plots, view_of
from stickslip.explorer.page.pin import PinnedRun
from stickslip.explorer.page.stage import Stage
from stickslip.explorer.page.strip import StripView
from stickslip.explorer.page.tools import Tools
from stickslip.explorer.page.tour import Tour
from stickslip.explorer.page.words import Words

TITLES = {
    "law": "Friction law", "contact": "Contact g(v)", "shape": "Body now", "slip": "Slip", "rate": "Slip rate",
    "traction": "Traction", "field": "Velocity in the slab", "energy": "Energy",
}  # fmt: skip
"""Titles of the panels before the first answer, and of those whose axes have texts of their own."""
SLOTS = ("bar", "aside", "below", "above")
"""Places for further parts: in the bar at the top, below the controls, below and above the panels."""


class Panels:
    """The linked panels and the time bar of one page: `plots` and `headings` by name, and `player`."""

    def __init__(self, explorer: Explorer) -> None:
        self._explorer, self.stage, self._hears = explorer, Stage(), False
        self.plots = {name: pn.pane.Bokeh(plot, sizing_mode="stretch_both") for name, plot in plots(self.stage).items()}
        self.headings = {
            name: Markup(heading(TITLES[name], ()), sizing_mode="stretch_width", stylesheets=[asset("heading.css")])
            for name in self.plots
        }
        self.player = PlayerBar(self._moved, sizing_mode="stretch_width")
        for news in ("answer", "pin"):
            explorer.listen(news, self.show)
        explorer.listen("cursor", self._move)
        self.show()

    def show(self) -> None:
        """Show the answer of the explorer, if it has one."""
        answer, pinned = self._explorer.answer, self._explorer.pinned
        if answer is None:
            return
        view = view_of(answer, pinned[1] if pinned else None)
        with pn.io.hold():
            self.stage.show(view)
            for name, pane in self.headings.items():
                pane.object = heading(view.titles.get(name, TITLES[name]), view.keys.get(name, ()))
            pn.io.push_notebook(*self.plots.values())  # nothing happens where there is a server
            self.player.facts = view.facts  # last: the time bar reads from the plots what is true at its time

    def _move(self) -> None:
        if not self._hears:  # else it is the browser itself that has moved it, and perhaps further meanwhile
            self.player.cursor = {"seconds": self._explorer.cursor, "number": self.player.cursor.get("number", 0) + 1}

    def _moved(self, seconds: float) -> None:
        self._explorer.cursor, self._hears = seconds, True
        try:
            self._explorer.tell("cursor")
        finally:
            self._hears = False


def build(explorer: Explorer, **parts: Any) -> Any:
    """Return the page of an explorer, for a server.

    Parameters
    ----------
    explorer : Explorer
        The centre of the page.
    **parts
        Further parts by the name of their place, one of `SLOTS`.
    """
    panels, words, controls = Panels(explorer), Words(explorer), Controls(explorer)
    parts = {"bar": Tools(explorer).view, "above": PinnedRun(explorer).view} | parts
    tour, strip = Tour(explorer), StripView(explorer)
    page = pn.Template(asset("page.html"))
    page.add_variable("page_style", style_sheet() + asset("page.css"))
    page.add_variable("app_title", "stickslip explorer")
    page.add_variable("parts", sorted(parts))
    for name, pane in panels.plots.items():
        page.add_panel(name, pane)
        page.add_panel(f"{name}_heading", panels.headings[name])
    own = {"player": panels.player, "words": words.view, "controls": controls.view}
    own |= {"tour": tour.card, "tour_button": tour.button, "strip": strip.view}
    for name, part in {**own, **parts}.items():
        page.add_panel(name, part)
    return page
