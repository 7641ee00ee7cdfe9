"""Start the explorer: for `stickslip explore` in the browser, until Ctrl-C, or in a notebook."""

from __future__ import annotations

import asyncio
import os
import sys
import webbrowser
from collections import deque
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import partial
from html import escape
from pathlib import Path
from queue import SimpleQueue
from tempfile import TemporaryDirectory
from typing import Any

import panel as pn

from stickslip.extensions.explorer.model.answer import RecordBehind
from stickslip.extensions.explorer.model.setting import Setting
from stickslip.extensions.explorer.page.explorer import Explorer
from stickslip.extensions.explorer.server.desk import ThreadDesk
from stickslip.extensions.explorer.server.serve import Endpoint, ExplorerServer
from stickslip.foundation.errors import InputError
from stickslip.problem.scenarios import Scenario

WARNING = (
    "warning: listening on {address}: whoever reaches this computer over a network, and has the address with the token, can use "
    "the explorer; nothing is encrypted"
)
LEADS_ON = """<!DOCTYPE html>
<meta charset="utf-8">
<meta name="referrer" content="no-referrer">
<meta http-equiv="refresh" content="0; url={url}">
<title>stickslip explorer</title>
<p><a href="{url}">Open the explorer</a></p>
"""
"""A page that leads to an address at once, or by its link."""


def start(
    setting: Setting,
    endpoint: Endpoint,
    *,
    browser: bool,
    say: Callable[[str], object],
    behind: RecordBehind | None = None,
) -> None:
    """Serve the explorer until Ctrl-C, with a setting that is shown first; `say` shows a line to the user.

    Raises InputError if the port is taken.
    """
    from stickslip.extensions.explorer.page.page import build

    make = partial(explorer_of, setting, behind=behind)
    server = ExplorerServer(endpoint, make, build, warms=not setting.is_fault)
    if not endpoint.is_loopback:
        say(WARNING.format(address=endpoint.address))
    say(f"explorer: {server.url}")
    with private_page(server.url) as page:
        if not browser or not open_browser(page):
            say("open this address in a browser; it holds the token without which nothing is shown")
        say("Ctrl-C ends the explorer, and closes its pages")
        server.run()


def explorer_of(setting: Setting, desk: ThreadDesk, files: ThreadDesk, behind: RecordBehind | None = None) -> Explorer:
    """Return the explorer of a new page."""
    if setting.is_fault:
        from stickslip.extensions.explorer.model.fault import solve_fault

        return Explorer(setting, desk, solve_fault, files)
    from stickslip.extensions.explorer.model.solve import solve  # imports the compiler, which takes a second

    return Explorer(setting, desk, partial(solve, behind=behind), files)


@contextmanager
def private_page(url: str) -> Iterator[Path]:
    """Give a file that leads to an address and that only this user can read, as Jupyter does; it is removed at the end."""
    with TemporaryDirectory(prefix="stickslip-") as folder:  # only this user can enter it
        path = Path(folder) / "explorer.html"
        with os.fdopen(os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600), "w", encoding="utf-8") as file:
            file.write(LEADS_ON.format(url=escape(url)))
        yield path


def open_browser(page: Path) -> bool:
    """Open a file in the user's browser. Returns False if there is none that has a window."""
    windows = sys.platform in ("win32", "darwin") or any(name in os.environ for name in ("DISPLAY", "WAYLAND_DISPLAY", "BROWSER"))
    return windows and webbrowser.open(page.as_uri())


MOST_EXPLORERS = 8
"""At most this many explorers are at work in one notebook."""
ENDED = (
    f"This explorer has ended, because {MOST_EXPLORERS} newer ones are open in this notebook: run its cell again to go on with it."
)


def shown_in_notebook(scenario: Scenario, behind: RecordBehind | None = None) -> Any:
    """Return the explorer of a scenario, with a record behind its runs, as an object that a notebook shows.

    Raises InputError where there is no notebook.
    """
    from stickslip.extensions.explorer.page.page import build_for_notebook

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
