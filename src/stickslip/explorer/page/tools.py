"""The tools in the bar of the page: pin a run, open and save files, copy a link; and the address, which follows what is shown."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import param
from panel.custom import JSComponent

from stickslip.explorer.page.components import asset
from stickslip.explorer.page.explorer import Explorer
from stickslip.explorer.page.files import FORMATS, content_of, export, opened
from stickslip.explorer.page.link_in_url import query_of
from stickslip.foundation.errors import InputError

KINDS = [{"kind": kind, "label": one.label} for kind, one in FORMATS.items()]
"""The entries of the menu of files."""


class ToolBar(JSComponent):  # type: ignore[misc] # panel has no types
    """The buttons and the menu of files; what is pressed is handed to a function."""

    kinds = param.List(default=KINDS, doc="Kind and label of each file that can be saved.")
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
        self.view = ToolBar(self._press, linked=linked, margin=0)
        for news in ("answer", "pin", "cursor", "tour", "strip"):
            explorer.listen(news, self.update)
        self.update()

    def update(self) -> None:
        """Bring the buttons, and the address, to what is shown now."""
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
                self._explorer.change(opened(str(data.get("name")), content_of(str(data.get("content"))), self._explorer.setting))
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
