"""The explorer beside a kernel: its desk delivers on the kernel's own thread, at first within the cell, then between two cells."""

from __future__ import annotations

import asyncio
from collections import deque
from collections.abc import Callable
from queue import SimpleQueue
from typing import Any

import panel as pn

from stickslip.explorer.model.measured import Backdrop
from stickslip.explorer.model.setting import Setting
from stickslip.explorer.page.explorer import Explorer
from stickslip.explorer.server.desk import ThreadDesk
from stickslip.explorer.server.start import explorer_of
from stickslip.foundation.errors import InputError
from stickslip.scenarios.scenario import Scenario

MOST_EXPLORERS = 8
"""Largest number of explorers that are at work in one notebook."""
ENDED = (
    f"This explorer has ended, because {MOST_EXPLORERS} newer ones are open in this notebook: run its cell again to go on with it."
)


def shown_in_notebook(scenario: Scenario, behind: Backdrop | None = None) -> Any:
    """Return the explorer of a scenario, with a record behind its runs, as an object that a notebook shows.

    Raises InputError where there is no notebook.
    """
    from stickslip.explorer.page.page import build_for_notebook

    try:
        deliver = DeliveryToCell(asyncio.get_running_loop().call_soon_threadsafe)
    except RuntimeError:
        raise InputError("explore: there is no notebook here; `stickslip explore` opens the explorer in a browser") from None
    _bring_scripts()
    desk, files = ThreadDesk(deliver), ThreadDesk(deliver)
    explorer = explorer_of(Setting.of(scenario), desk, files, behind)
    desk.report = explorer.told
    page = build_for_notebook(explorer)
    page.explorer = explorer
    _keep(explorer, desk, files)
    explorer.change(explorer.setting)
    deliver.serve_cell(lambda: explorer.answer is not None or bool(explorer.fault))
    return page


class DeliveryToCell:
    """What a desk delivers is called within the cell that asks for the first answer, and after that between two cells.

    What is told to a browser while it still loads its scripts is lost. Therefore a page is shown with its first answer in it. Any
    thread may call `between_cells`, which has a function called by the kernel when no cell runs.
    """

    def __init__(self, between_cells: Callable[[Callable[[], None]], object]) -> None:
        self._calls: SimpleQueue[Callable[[], None]] = SimpleQueue()
        self._deliver: Callable[[Callable[[], None]], object] = self._calls.put
        self._between_cells = between_cells

    def __call__(self, call: Callable[[], None]) -> None:
        """Have a function called on the kernel's own thread."""
        self._deliver(call)

    def serve_cell(self, is_enough: Callable[[], bool]) -> None:
        """Call what is delivered until `is_enough` returns True; what comes later is called between two cells."""
        try:
            while not is_enough():
                self._calls.get()()
        finally:
            self._deliver = self._between_cells


_AT_WORK: deque[tuple[Explorer, tuple[ThreadDesk, ...]]] = deque()
"""The explorers that are at work in this kernel, with their desks, the oldest first."""


def _keep(explorer: Explorer, *desks: ThreadDesk) -> None:
    """Keep an explorer at work, and end the oldest if there are more than `MOST_EXPLORERS`.

    A kernel does not tell when a cell is run again or deleted, and each explorer has a thread.
    """
    _AT_WORK.append((explorer, desks))
    while len(_AT_WORK) > MOST_EXPLORERS:
        oldest, ended = _AT_WORK.popleft()
        for desk in ended:
            desk.close()
        oldest.told("")
        oldest.refuse(ENDED)


def _bring_scripts() -> None:
    """Bring the scripts of Panel and Bokeh into the notebook, out of the installed packages and not from the internet.

    They come with every explorer: a page of the notebook that is loaded again has lost those of a cell that ran before.
    """
    pn.extension(inline=True)
