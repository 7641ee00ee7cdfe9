"""The same parts as those of the page, in a layout for a cell of a notebook: no template, no address, one light ground."""

from __future__ import annotations

from typing import Any

import panel as pn

from stickslip.explorer.page.controls import Controls
from stickslip.explorer.page.explorer import Explorer
from stickslip.explorer.page.look import style_sheet
from stickslip.explorer.page.page import Panels
from stickslip.explorer.page.pin import PinnedRun
from stickslip.explorer.page.tools import Tools
from stickslip.explorer.page.words import Words

ROWS = ((("law", "contact", "shape"), 260), (("slip", "rate", "traction"), 190), (("field", "energy"), 240))
"""The panels of each row, and its height (px)."""
LOOK = """
:host { color: var(--ink); background: var(--card); --edge: #dfe3e8; --focus: #0072b2; --field: #ffffff; --paper: #f3f5f7; }
"""
"""What the style of a page says beside the colours, which the parts inherit."""
CONTROLS = 290
"""Width (px) of the controls."""


def build_for_notebook(explorer: Explorer) -> Any:
    """Return the parts of an explorer as a layout for a notebook."""
    panels, words, controls = Panels(explorer), Words(explorer), Controls(explorer)
    rows = [pn.Row(*(_panel(panels, name) for name in names), height=height, **_WIDE) for names, height in ROWS]
    beside = pn.Column(controls.view, width=CONTROLS, height=sum(height for _, height in ROWS), scroll=True)
    colours = style_sheet().partition("\n")[0].replace(":root", ":host")
    return pn.Column(
        Tools(explorer, linked=False).view,
        words.view,
        PinnedRun(explorer).view,
        pn.Row(beside, pn.Column(*rows, **_WIDE), **_WIDE),
        panels.player,
        stylesheets=[colours, LOOK],
        **_WIDE,
    )


_WIDE: dict[str, Any] = {"sizing_mode": "stretch_width"}


def _panel(panels: Panels, name: str) -> Any:
    return pn.Column(panels.headings[name], panels.plots[name], sizing_mode="stretch_both")
