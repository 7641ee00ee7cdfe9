"""The explorer beside a kernel: its desk delivers on the kernel's own thread, between two cells."""

from __future__ import annotations

import asyncio
from typing import Any

import panel as pn

from stickslip.explorer.model.setting import Setting
from stickslip.explorer.server.desk import ThreadDesk
from stickslip.explorer.server.start import explorer_of
from stickslip.scenarios.scenario import Scenario


def shown_in_notebook(scenario: Scenario) -> Any:
    """Return the explorer of a scenario as an object that a notebook shows."""
    from stickslip.explorer.page.cell import build_cell

    pn.extension()
    deliver = asyncio.get_event_loop().call_soon_threadsafe
    desk = ThreadDesk(deliver)
    explorer = explorer_of(Setting.of(scenario), desk, ThreadDesk(deliver))
    desk.report = explorer.told
    page = build_cell(explorer)
    page.explorer = explorer
    explorer.change(explorer.setting)
    return page
