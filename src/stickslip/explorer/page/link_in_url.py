"""The state of a page in its address: a link reproduces the view."""

from __future__ import annotations

import math
from collections.abc import Mapping
from urllib.parse import parse_qsl, quote, urlencode

from stickslip.explorer.model.link import parameters_of, setting_of
from stickslip.explorer.model.setting import Setting
from stickslip.explorer.model.strip import StripRange
from stickslip.explorer.model.tour import TOUR
from stickslip.explorer.page.explorer import Explorer
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
    """Ask for the first answer of a page: that of the link by which it was opened, or of the explorer's setting.

    A part of the link that cannot be used is left out, and the page says why.
    """
    faults: list[str] = []
    setting, pinned = explorer.setting, None
    try:
        setting = setting_of(parameters) if {"scenario", "document"} & set(parameters) else setting
        if "pin" in parameters:
            pinned = setting_of(dict(parse_qsl(parameters["pin"], keep_blank_values=True, max_num_fields=MOST_FIELDS)))
    except (InputError, ValueError) as error:
        faults.append(str(error))
    cursor = _number(parameters.get("t", ""))
    tour, strip = _step(parameters.get("tour", "")), _strip(parameters.get("strip", ""))
    if tour:
        explorer.show_step(tour, None, None, 0.0)
    if strip is not None:
        explorer.show_strip(strip)
    if faults:
        explorer.once_answered(lambda: explorer.refuse(faults[0]))
    _ask(explorer, pinned, setting, cursor)


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


def _step(text: str) -> int:
    return int(text) if text.isdecimal() and text.isascii() and len(text) < 3 and 1 <= int(text) <= len(TOUR) else 0


def _strip(text: str) -> StripRange | None:
    parameter, *ends = text.split(":")
    low, high = (_number(one) for one in [*ends, "", ""][:2])
    if low is None or high is None or not parameter.replace(".", "").replace("_", "").isalnum():
        return None
    return StripRange(parameter, low, high, log=ends[2:] == ["log"])
