"""Start the explorer for `stickslip explore`: say where it is, open the browser, and answer until Ctrl-C."""

from __future__ import annotations

import os
import sys
import webbrowser
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import partial
from html import escape
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING

from stickslip.explorer.model.setting import Setting
from stickslip.explorer.page.explorer import Explorer
from stickslip.explorer.server.desk import ThreadDesk
from stickslip.explorer.server.serve import Endpoint, ExplorerServer

if TYPE_CHECKING:
    from stickslip.explorer.model.measured import Backdrop

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
    setting: Setting, endpoint: Endpoint, *, browser: bool, say: Callable[[str], object], behind: Backdrop | None = None
) -> None:
    """Serve the explorer until Ctrl-C, with a setting that is shown first; `say` shows a line to the user.

    Raises InputError if the port is taken.
    """
    from stickslip.explorer.page.page import build

    server = ExplorerServer(endpoint, partial(explorer_of, setting, behind=behind), build)
    if not endpoint.is_loopback:
        say(WARNING.format(address=endpoint.address))
    say(f"explorer: {server.url}")
    with private_page(server.url) as page:
        if not browser or not open_browser(page):
            say("open this address in a browser; it holds the token without which nothing is shown")
        say("Ctrl-C ends the explorer, and closes its pages")
        server.run()


def explorer_of(setting: Setting, desk: ThreadDesk, files: ThreadDesk, behind: Backdrop | None = None) -> Explorer:
    """Return the explorer of a new page."""
    from stickslip.explorer.model.solve import solve  # imports the compiler, which takes a second

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
