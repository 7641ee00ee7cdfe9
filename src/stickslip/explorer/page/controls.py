"""The controls of the page: what is entered changes the setting, and faults are shown at the field that is wrong."""

from __future__ import annotations

import re
from contextlib import suppress
from typing import Any

from stickslip.explorer.model.setting import Setting
from stickslip.explorer.page.components import ControlRows
from stickslip.explorer.page.explorer import Explorer

FAULT = re.compile(r"\[(?P<table>[\w.]+)\] (?P<key>\w+)")
"""Where a message says which entry is wrong, as in "[friction] alpha must be at least 0"."""


class Controls:
    """All controls of one page. `view` is what is placed on it."""

    def __init__(self, explorer: Explorer) -> None:
        self._explorer = explorer
        self.view = ControlRows(self._enter, sizing_mode="stretch_width")
        explorer.listen("setting", self._show)
        explorer.listen("fault", self._blame)
        self._show()

    def _show(self) -> None:
        self.view.groups = groups_of(self._explorer.setting)

    def _blame(self) -> None:
        fault = self._explorer.fault
        found = FAULT.search(fault)
        self.view.faults = {f"{found['table']}.{found['key']}": fault} if found else {}

    def _enter(self, entered: dict[str, Any]) -> None:
        setting, path = self._explorer.setting, str(entered.get("path"))
        value = entered.get("value", entered.get("text"))
        if isinstance(value, str):
            with suppress(ValueError):
                value = float(value)
        self._explorer.change(setting.with_value(path, value))


def groups_of(setting: Setting) -> list[dict[str, Any]]:
    """Return groups of rows for the entries of a setting."""
    groups = []
    for table in ("body", "friction", "loading", "initial", "run"):
        rows = []
        for key, value in (setting.value(table) or {}).items():
            row = {
                "path": f"{table}.{key}",
                "label": key,
                "kind": "text",
                "text": str(value),
                "value": 0.0,
                "unit": "",
                "range": None,
            }
            if isinstance(value, int | float) and value:
                row |= {
                    "kind": "number",
                    "value": value,
                    "range": {"low": min(0.0, 3 * value), "high": max(0.0, 3 * value), "log": False},
                }
            rows.append(row)
        groups.append({"title": table, "rows": rows})
    return groups
