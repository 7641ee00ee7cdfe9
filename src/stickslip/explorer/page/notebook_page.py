"""The explorer in a notebook's cell: the same parts as on the page, placed by Panel, because a cell takes no page of its own."""

from __future__ import annotations

from typing import Any

import panel as pn

from stickslip.explorer.page.components import Markup, asset
from stickslip.explorer.page.controls import Controls
from stickslip.explorer.page.explorer import Explorer
from stickslip.explorer.page.look import style_sheet
from stickslip.explorer.page.page import Panels
from stickslip.explorer.page.pin import PinnedRun
from stickslip.explorer.page.strip import StripView
from stickslip.explorer.page.tools import Tools
from stickslip.explorer.page.tour import Tour
from stickslip.explorer.page.words import Words

HEIGHTS = {"slip": 110, "rate": 110, "traction": 150, "field": 180, "energy": 190, "law": 240, "contact": 240, "shape": 240}
"""Heights (px) of the panels, with their headings."""
ROWS = (("law", "contact", "shape"), (("slip", "rate", "traction"), ("field", "energy")))
"""The rows of panels: names side by side, and within the second row names below each other."""


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
    first = pn.Row(*(cards[name] for name in ROWS[0]), sizing_mode="stretch_width")
    stacks = [pn.Column(*(cards[name] for name in stack), sizing_mode="stretch_width") for stack in ROWS[1]]
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
        StripView(explorer).view,
        stylesheets=[style_sheet(":host") + asset("notebook_page.css")],
        min_width=900,
        **wide,
    )


def _card(heading: Any, plot: Any, height: int) -> Any:
    """Return a panel with its heading."""
    return pn.Column(heading, plot, height=height, sizing_mode="stretch_width", margin=2)
