"""The look of the page, one colour for each role on a light and on a dark ground, and its parts that are scripts.

Every model of Bokeh that has a colour or a size is tagged with its role (`paint`). The browser reads the tags when the ground
changes (assets/theme.js).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import cache
from importlib.resources import files
from typing import Any

import numpy as np
import param
from panel.custom import JSComponent
from panel.pane import HTML

from stickslip.figures.style import BLUE, GREEN, GREY, INK, ORANGE, PALE, PURPLE, SKY, VERMILLION

LIGHT = {
    "slip": BLUE, "rate": GREEN, "traction": VERMILLION, "load": INK,
    "stick": INK, "stable": BLUE, "unstable": VERMILLION,
    "continuum": PURPLE, "path": ORANGE, "law": PURPLE,
    "elastic": BLUE, "kinetic": GREEN, "radiated": SKY, "damped": PURPLE, "heat": VERMILLION,
    "ink": INK, "muted": "#5A626C", "faint": "#C9CED5", "grid": "#E9ECF0", "card": "#FFFFFF",
    "ground": PALE, "grey": GREY, "cursor": INK, "front": "#00000050", "pin": GREY,
}  # fmt: skip
"""Colours by role on a light ground: those of `stickslip.figures.style`."""
DARK = LIGHT | {
    "slip": "#4BA3E3", "rate": "#2FC79B", "traction": "#FF8640", "load": "#E8EAED",
    "stick": "#E8EAED", "stable": "#4BA3E3", "unstable": "#FF8640", "continuum": "#E39BC6", "path": "#F2B53A", "law": "#E39BC6",
    "elastic": "#4BA3E3", "kinetic": "#2FC79B", "radiated": "#9AD5F5", "damped": "#E39BC6", "heat": "#FF8640",
    "ink": "#E8EAED", "muted": "#A3ACB8", "faint": "#454D58", "grid": "#272D36", "card": "#171B21",
    "ground": "#39414B", "grey": "#8B95A1", "cursor": "#FFFFFF", "front": "#FFFFFF60", "pin": "#8B95A1",
}  # fmt: skip
"""The same on a dark ground: lighter, so that lines keep a contrast of at least 4.5."""
FONT = "system-ui, -apple-system, 'Segoe UI', Roboto, 'DejaVu Sans', sans-serif"
"""Type of the page and of its plots: that of the reader's own system, because nothing is fetched from elsewhere."""
COLOURS = 129
"""Number of steps of a colour scale."""


def blend(*colours: str) -> list[str]:
    """Return a colour scale that passes evenly through the given colours (as #rrggbb)."""
    corners = np.array([[int(colour[place : place + 2], 16) for place in (1, 3, 5)] for colour in colours])
    at = np.linspace(0.0, len(colours) - 1.0, COLOURS)
    channels = [np.interp(at, np.arange(len(colours)), channel) for channel in corners.T]
    return ["#" + "".join(f"{round(part):02x}" for part in colour) for colour in zip(*channels, strict=True)]


def palettes() -> dict[str, dict[str, list[str]]]:
    """Return the colour scale of signed values on each ground; its middle is the colour of the ground."""
    # ColorBrewer's red and blue, as in the package's figures of space and time.
    blue, red = ("#2166AC", "#4393C3", "#92C5DE", "#D1E5F0"), ("#FDDBC7", "#F4A582", "#D6604D", "#B2182B")
    dark = blend("#A8DCFF", "#2F8FD8", DARK["card"], "#E0602A", "#FFC49A")
    return {"light": {"signed": blend(*blue, "#F7F7F7", *red)}, "dark": {"signed": dark}}


def paint(model: Any, *, sizes: dict[str, float] | None = None, **roles: str) -> Any:
    """Give a model the light colours of its roles, and note roles and sizes (px) in its tags; return the model."""
    for key, role in roles.items():
        setattr(model, key, LIGHT[role])
    for key, size in (sizes or {}).items():
        setattr(model, key, f"{size:g}px" if key.endswith("font_size") else round(size))
    model.tags = [*model.tags, {"paint": roles, "sizes": sizes or {}}]
    return model


def style_sheet(root: str = ":root") -> str:
    """Return the colours as variables of CSS, for both grounds; `root` selects the element that has them."""

    def block(selector: str, colours: dict[str, str]) -> str:
        return selector + " {" + "".join(f"--{role}: {colour};" for role, colour in colours.items()) + "}\n"

    scales = {ground: f"linear-gradient(90deg, {', '.join(found['signed'][::16])})" for ground, found in palettes().items()}
    light, dark = LIGHT | {"signed": scales["light"]}, DARK | {"signed": scales["dark"]}
    return block(root, light) + block(f'{root}[data-ground="dark"]', dark)


@cache
def asset(name: str) -> str:
    """Return the text of a file in the folder `assets`."""
    return (files("stickslip.extensions.explorer.page") / "assets" / name).read_text(encoding="utf-8")


def player_script() -> str:
    """Return the script of the time bar: a module of JavaScript that exports `Player` and, for Panel, `render`."""
    return "\n".join(asset(name) for name in ("theme.js", "moment.js", "view.js", "player.js"))


def look() -> dict[str, Any]:
    """Return colours and colour scales for both grounds, for scripts."""
    return {"colours": {"light": LIGHT, "dark": DARK}, "palettes": palettes()}


class Markup(HTML):  # type: ignore[misc] # panel has no types
    """A text with markup that changes.

    Only the text is sent again. Panel would send the style sheets too, as new ones, which a notebook cannot place.
    """

    def _update(self, ref: str, model: Any) -> None:
        model.update(text=self._transform_object(self.object)["object"])


def finite(value: Any) -> float | None:
    """Return a number from a browser as a float; None for what is no number or not finite, and for one beyond all floats."""
    try:
        return float(value) if isinstance(value, int | float) and math.isfinite(value) else None
    except OverflowError:
        return None


class PlayerBar(JSComponent):  # type: ignore[misc] # panel has no types
    """The time bar: it brings answers to the panels, moves the cursor of all of them, and tells Python where the cursor rests."""

    shown = param.Bytes(default=b"", doc="What the panels show: `view_bytes`; empty before the first answer.")
    look = param.Dict(default={}, doc="Colours and colour scales.")
    cursor = param.Dict(
        default={"seconds": 0.0}, doc="Time (s) to which Python moves the cursor, and a number that differs each time."
    )

    _esm = player_script()

    def __init__(self, moved: Callable[[float], None], **params: Any) -> None:
        self._moved = moved
        super().__init__(look=look(), stylesheets=[asset("player.css")], **params)

    def _handle_msg(self, data: Any) -> None:
        seconds = finite(data.get("cursor")) if isinstance(data, dict) else None
        if seconds is not None:
            self._moved(seconds)


class ControlRows(JSComponent):  # type: ignore[misc] # panel has no types
    """Rows of controls, with faults beside those that are wrong; what is entered is handed to a function."""

    groups = param.List(default=[], doc="Groups of rows: title, rows, and for each row path, label, kind and unit.")
    values = param.Dict(default={}, doc="What the rows hold, by their paths: text, and for a slider its value and its range.")
    faults = param.Dict(default={}, doc="What is wrong, by the path of the row.")

    _esm = asset("controls.js")

    def __init__(self, entered: Callable[[dict[str, Any]], None], **params: Any) -> None:
        self._entered = entered
        super().__init__(stylesheets=[asset("controls.css")], **params)

    def _handle_msg(self, data: Any) -> None:
        if isinstance(data, dict):
            self._entered(data)
