"""The explorer beside a kernel: its desk delivers on the kernel's own thread, between two cells."""

from __future__ import annotations

import asyncio
from functools import cache
from typing import Any

import panel as pn

from stickslip.explorer.model.setting import Setting
from stickslip.explorer.server.desk import ThreadDesk
from stickslip.explorer.server.start import explorer_of
from stickslip.foundation.errors import InputError
from stickslip.scenarios.scenario import Scenario


def shown_in_notebook(scenario: Scenario) -> Any:
    """Return the explorer of a scenario as an object that a notebook shows. Raises InputError where there is no notebook."""
    from stickslip.explorer.page.notebook_page import build_for_notebook

    try:
        deliver = asyncio.get_running_loop().call_soon_threadsafe
    except RuntimeError:
        raise InputError("explore: there is no notebook here; `stickslip explore` opens the explorer in a browser") from None
    _bring_scripts()
    desk = ThreadDesk(deliver)
    explorer = explorer_of(Setting.of(scenario), desk, ThreadDesk(deliver))
    desk.report = explorer.told
    page = build_for_notebook(explorer)
    page.explorer = explorer
    explorer.change(explorer.setting)
    return page


@cache
def _bring_scripts() -> None:
    """Bring the scripts of Panel and Bokeh into the notebook, once: they are some megabytes."""
    pn.extension()
