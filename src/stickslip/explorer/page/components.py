"""The parts of the page that are scripts in the browser: the time bar and the controls."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from importlib.resources import files
from typing import Any

import param
from panel.custom import JSComponent
from panel.pane import HTML

from stickslip.explorer.page.look import DARK, LIGHT, palettes


@cache
def asset(name: str) -> str:
    """Return the text of a file in the folder `assets`."""
    return (files("stickslip.explorer.page") / "assets" / name).read_text(encoding="utf-8")


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
        seconds = data.get("cursor") if isinstance(data, dict) else None
        if isinstance(seconds, int | float):
            self._moved(float(seconds))


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
