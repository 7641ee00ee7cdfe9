"""The tools in the bar of the page: pin a run, open and save files, copy a link; and the address, which follows what is shown."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from contextlib import suppress
from typing import Any
from urllib.parse import parse_qsl, quote, urlencode

import param
from panel.custom import JSComponent

from stickslip.extensions.explorer.model.setting import Setting, parameters_of, setting_of
from stickslip.extensions.explorer.model.strip import strip_range
from stickslip.extensions.explorer.model.tour import tour_of
from stickslip.extensions.explorer.page.components import asset
from stickslip.extensions.explorer.page.explorer import Explorer
from stickslip.extensions.explorer.page.files import content_of, export, formats_of, opened
from stickslip.foundation.axis import Axis
from stickslip.foundation.errors import InputError

MOST_FIELDS = 500
"""Largest number of parameters of a pinned setting inside a link."""


def query_of(explorer: Explorer) -> str:
    """Return the parameters of the page's address, encoded: setting, pinned setting, cursor, step of the tour, and strip.

    Raises InputError if the scenario is too large for an address.
    """
    found = parameters_of(explorer.setting)
    if explorer.pinned is not None:
        found["pin"] = _encoded(parameters_of(explorer.pinned[0]))
    if explorer.cursor:
        found["t"] = repr(float(f"{explorer.cursor:.9g}"))
    if explorer.tour:
        found["tour"] = str(explorer.tour)
    strip = explorer.strip
    if strip is not None:
        found["strip"] = f"{strip.parameter}:{strip.low!r}:{strip.high!r}{':log' if strip.log else ''}"
    return _encoded(found)


def _encoded(parameters: Mapping[str, str]) -> str:
    return urlencode(parameters, quote_via=quote, safe=":")


def begin(explorer: Explorer, parameters: Mapping[str, str]) -> None:
    """Ask for the first answer of a page: that of the link that opened it, or of the explorer's setting.

    A part of the link that cannot be used is left out, and the page says why.
    """
    cursor = _number(parameters.get("t", ""))
    tour, strip = _step(parameters.get("tour", ""), len(tour_of(explorer.setting))), _strip(parameters.get("strip", ""))
    if tour:
        explorer.show_step(tour, None, None, 0.0)
    if strip is not None:
        explorer.show_strip(strip)
    if not {"scenario", "document", "pin"} & set(parameters):
        _ask(explorer, None, explorer.setting, cursor)
        return

    def follow(found: tuple[Setting, Setting | None, str]) -> None:
        setting, pinned, fault = found
        if fault:
            explorer.once_answered(lambda: explorer.refuse(fault))
        _ask(explorer, pinned, setting, cursor)

    # a stranger's document may take a while to read: not on the page's own thread, which other pages share
    explorer.read(lambda: _of_link(parameters, explorer.setting), follow)


def _of_link(parameters: Mapping[str, str], present: Setting) -> tuple[Setting, Setting | None, str]:
    """Return the setting and the pinned one of a link, as far as they can be read, and what is wrong with it, or ""."""
    setting, pinned = present, None
    try:
        setting = setting_of(parameters) if {"scenario", "document"} & set(parameters) else setting
        if "pin" in parameters:
            pinned = setting_of(dict(parse_qsl(parameters["pin"], keep_blank_values=True, max_num_fields=MOST_FIELDS)))
    except (InputError, ValueError) as error:
        return setting, pinned, str(error)
    return setting, pinned, ""


def _ask(explorer: Explorer, pinned: Setting | None, setting: Setting, cursor: float | None) -> None:
    if pinned is None:
        explorer.change(setting, cursor)
        return

    def then() -> None:
        explorer.pin()
        explorer.change(setting, cursor)

    explorer.once_answered(then)
    explorer.change(pinned)


def _number(text: str) -> float | None:
    try:
        value = float(text)
    except ValueError:
        return None
    return value if math.isfinite(value) else None


def _step(text: str, count: int) -> int:
    return int(text) if text.isdecimal() and text.isascii() and len(text) < 3 and 1 <= int(text) <= count else 0


def _strip(text: str) -> Axis | None:
    parameter, *ends = text.split(":")
    low, high = (_number(one) for one in [*ends, "", ""][:2])
    if low is None or high is None or not parameter.replace(".", "").replace("_", "").isalnum():
        return None
    with suppress(InputError):
        return strip_range(parameter, low, high, log=ends[2:] == ["log"])
    return None


class ToolBar(JSComponent):  # type: ignore[misc] # panel has no types
    """The buttons and the menu of files; what is pressed is handed to a function."""

    kinds = param.List(default=[], doc="Kind and label of each file that can be saved.")
    pinned = param.Boolean(default=False, doc="True if a run is kept.")
    ready = param.Boolean(default=False, doc="True if there is a run to keep and to save.")
    busy = param.Boolean(default=False, doc="True while a file is written.")
    query = param.String(default="", doc="The parameters of the page's address.")
    linked = param.Boolean(default=True, doc="False in a notebook, whose address is not that of the page.")

    _esm = asset("tools.js")

    def __init__(self, pressed: Callable[[dict[str, Any]], None], **params: Any) -> None:
        self._pressed = pressed
        super().__init__(stylesheets=[asset("tools.css")], **params)

    def _handle_msg(self, data: Any) -> None:
        if isinstance(data, dict):
            self._pressed(data)


class Tools:
    """The tools of one page. `view` is what is placed in the bar."""

    def __init__(self, explorer: Explorer, *, linked: bool = True) -> None:
        self._explorer = explorer
        kinds = [{"kind": kind, "label": one.label} for kind, one in formats_of(explorer.setting).items()]
        self.view = ToolBar(self._press, kinds=kinds, linked=linked, margin=0)
        for news in ("answer", "pin", "cursor", "tour", "strip"):
            explorer.listen(news, self.update)
        self.update()

    def update(self) -> None:
        """Make the buttons and the address match the answer that is shown now."""
        self.view.param.update(
            pinned=self._explorer.pinned is not None, ready=self._explorer.shown is not None, query=self._query() or self.view.query
        )

    def _query(self) -> str:
        if not self.view.linked or self._explorer.shown is None:
            return ""  # the address stays as it was opened until its link has been followed
        try:
            return query_of(self._explorer)
        except InputError:
            return "too-large"

    def _press(self, data: dict[str, Any]) -> None:
        do = data.get("do")
        try:
            if do == "pin":
                self._explorer.pin()
            elif do == "save":
                self._save(str(data.get("kind")))
            elif do == "open":
                name, content, present = str(data.get("name")), str(data.get("content")), self._explorer.setting
                self._explorer.read(lambda: _read(opened(name, content_of(content), present)), self._explorer.change)
            elif do == "refuse":
                raise InputError(str(data.get("fault"))[:200])
        except InputError as error:
            self._explorer.refuse(str(error))

    def _save(self, kind: str) -> None:
        shown = self._explorer.shown
        if shown is None or self.view.busy:
            return
        self.view.busy = True
        self._explorer.files.ask(lambda told: export(kind, *shown), self._saved, self._not_saved)

    def _saved(self, file: tuple[str, str, bytes]) -> None:
        name, media, content = file
        self.view.busy = False
        self.view._send_msg({"save": name, "media": media, "content": content})

    def _not_saved(self, error: Exception) -> None:
        self.view.busy = False
        self._explorer.refuse(str(error))


def _read(setting: Setting) -> Setting:
    """Return a setting that has been read, which it remembers. Raises InputError."""
    setting.scenario()
    return setting
