"""The page: all its parts in their places, for a server (`build`) and for the cell of a notebook (`build_for_notebook`)."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

import panel as pn

from stickslip.extensions.explorer.model.strip import has_strips
from stickslip.extensions.explorer.page.components import Markup, PlayerBar, asset, style_sheet
from stickslip.extensions.explorer.page.controls import Controls
from stickslip.extensions.explorer.page.explorer import Explorer
from stickslip.extensions.explorer.page.panels import fault, plots, view_of
from stickslip.extensions.explorer.page.stage import Stage
from stickslip.extensions.explorer.page.strip import StripView
from stickslip.extensions.explorer.page.tools import Tools
from stickslip.extensions.explorer.page.view import View, headings_of, view_bytes
from stickslip.extensions.explorer.page.words import PinnedRun, Tour, Words

TITLES_OF_PANELS = {
    "law": "Friction law", "contact": "Contact g(v)", "shape": "Body now", "slip": "Slip", "rate": "Slip rate",
    "state": "State of friction", "given": "Loading", "also_given": "Loading",
    "residual": "Measured minus run", "traction": "Traction", "field": "Slab in space and time", "energy": "Energy",
}  # fmt: skip
"""Titles of the panels before the first answer, and of those whose axes have texts of their own."""
FIELDS = (("velocity", "velocity"), ("displacement", "displacement"), ("stress", "stress change"))
"""What can be shown of the slab in space and time, and its name."""
FIRST_WORDS = "All pictures show one run, in which a slab or a block slips against friction. First move a slider: they all follow."


class PageLayout(NamedTuple):
    """The panels of a page: titles by name, rows, and plots; what the map can show; and the first words in the bar."""

    titles: Mapping[str, str]
    rows: tuple[tuple[str, ...], tuple[tuple[str, ...], ...]]
    plots: Callable[[Stage], dict[str, Any]]
    fields: tuple[tuple[str, str], ...]
    first_words: str
    may_have_strip: bool = True

    @property
    def has_strip(self) -> bool:
        """True if a strip is shown below the panels."""
        return self.may_have_strip and has_strips()


SLOTS = ("bar", "aside", "below", "above")
"""Places for further parts: in the bar at the top, below the controls, below and above the panels."""


class Panels:
    """The linked panels and the time bar of one page: `plots` by name, and the `player`, which shows each `view` in the browser."""

    def __init__(self, explorer: Explorer) -> None:
        self._explorer, self._hears, self._moves, self.view = explorer, False, 0, View()
        self.layout = layout_of(explorer)
        self.plots = {name: pn.pane.Bokeh(plot, sizing_mode="stretch_both") for name, plot in self.layout.plots(Stage()).items()}
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
        self.view = view_of(answer, pinned[1] if pinned else None)
        self.player.shown = view_bytes(self.view, self.headings)

    @property
    def headings(self) -> dict[str, str]:
        """The heading of each panel, as HTML."""
        return headings_of(self.view, self.layout.titles)

    def _move(self) -> None:
        if not self._hears:  # else it is the browser itself that has moved it, and perhaps further meanwhile
            self._moves += 1  # counted here: a browser may send another number
            self.player.cursor = {"seconds": self._explorer.cursor, "number": self._moves}

    def _moved(self, seconds: float) -> None:
        self._explorer.cursor, self._hears = seconds, True
        try:
            self._explorer.tell("cursor")
        finally:
            self._hears = False


def build(explorer: Explorer, **parts: Any) -> Any:
    """Return the page of an explorer, for a server; `parts` are further parts by the name of their place, one of `SLOTS`."""
    panels, words, controls = Panels(explorer), Words(explorer), Controls(explorer)
    parts = {"bar": Tools(explorer).view, "above": PinnedRun(explorer).view} | parts
    if panels.layout.has_strip:
        parts["strip"] = StripView(explorer).view
    tour, layout = Tour(explorer), panels.layout
    page = pn.Template(asset("page.html"))
    page.add_variable("page_style", style_sheet() + asset("page.css") + asset("heading.css"))
    page.add_variable("app_title", "stickslip explorer")
    page.add_variable("parts", sorted(parts))
    page.add_variable("headings", panels.headings)
    for name in ("titles", "rows", "fields", "first_words"):
        page.add_variable(name, getattr(layout, name))
    for name, pane in panels.plots.items():
        page.add_panel(name, pane)
    own = {"player": panels.player, "words": words.view, "controls": controls.view}
    own |= {"tour": tour.card, "tour_button": tour.button}
    for name, part in {**own, **parts}.items():
        page.add_panel(name, part)
    return page


HEIGHTS = {
    "profile_rate": 240,
    "state": 110,
    "residual": 110,
    "given": 110,
    "also_given": 110,
    "profile_slip": 240,
    "slip": 110,
    "rate": 110,
    "traction": 150,
    "field": 180,
    "energy": 190,
    "law": 240,
    "contact": 240,
    "shape": 240,
}
"""Heights (px) of the panels, with their headings."""
ROWS_OF_PANELS = (
    ("law", "contact", "shape"),
    (("slip", "rate", "state", "residual", "given", "also_given", "traction"), ("field", "energy")),
)
"""The rows of panels: names side by side, and within the second row names below each other."""
OF_ONE_PLACE = PageLayout(TITLES_OF_PANELS, ROWS_OF_PANELS, plots, FIELDS, FIRST_WORDS)
OF_A_FAULT = PageLayout(
    fault.TITLES_OF_FAULT,
    (("profile_rate", "profile_slip"), (("slip", "rate", "traction"), ROWS_OF_PANELS[1][1])),
    fault.plots,
    (("velocity", "slip rate"), ("displacement", "slip"), ("stress", "change of traction")),
    "All pictures show one run of a fault in 2D: a slab whose slip varies along its contact. First move a slider: they all follow.",
    may_have_strip=False,
)


def layout_of(explorer: Explorer) -> PageLayout:
    """Return the panels of the page of an explorer: those of a fault, or of a contact that is a single place."""
    return OF_A_FAULT if explorer.setting.is_fault else OF_ONE_PLACE


def build_for_notebook(explorer: Explorer) -> Any:
    """Return the explorer as an object that a notebook shows below a cell."""
    panels = Panels(explorer)
    headings = {name: Markup(sizing_mode="stretch_width", stylesheets=[asset("heading.css")]) for name in panels.plots}
    cards = {name: _card(headings[name], panels.plots[name], HEIGHTS[name]) for name in panels.plots}

    def show() -> None:
        for name, html in panels.headings.items():
            headings[name].object = html
            cards[name].visible = name not in panels.view.hidden

    for news in ("answer", "pin"):
        explorer.listen(news, show)
    show()
    rows = panels.layout.rows
    first = pn.Row(*(cards[name] for name in rows[0]), sizing_mode="stretch_width")
    stacks = [pn.Column(*(cards[name] for name in stack), sizing_mode="stretch_width") for stack in rows[1]]
    tour, wide = Tour(explorer), {"sizing_mode": "stretch_width"}
    side = pn.Column(Controls(explorer).view, width=300, height=660, scroll="y-auto", margin=(0, 10, 0, 0))
    body = pn.Column(first, pn.Row(*stacks, **wide), **wide)
    return pn.Column(
        pn.Row(pn.layout.HSpacer(), tour.button, Tools(explorer, linked=False).view, **wide),
        Words(explorer).view,
        tour.card,
        PinnedRun(explorer).view,
        pn.Row(side, body, **wide),
        panels.player,
        *([StripView(explorer).view] if panels.layout.has_strip else []),
        stylesheets=[style_sheet(":host") + asset("notebook_page.css")],
        min_width=900,
        **wide,
    )


def _card(heading: Any, plot: Any, height: int) -> Any:
    return pn.Column(heading, plot, height=height, sizing_mode="stretch_width", margin=2)
