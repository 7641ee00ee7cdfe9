"""Open the page in the user's browser, without its token on a command line, where other users of the computer could read it."""

from __future__ import annotations

import os
import sys
import webbrowser
from collections.abc import Iterator
from contextlib import contextmanager
from html import escape
from pathlib import Path
from tempfile import TemporaryDirectory

LEADS_ON = """<!DOCTYPE html>
<meta charset="utf-8">
<meta name="referrer" content="no-referrer">
<meta http-equiv="refresh" content="0; url={url}">
<title>stickslip explorer</title>
<p><a href="{url}">Open the explorer</a></p>
"""
"""A page that leads to an address at once, or by its link."""


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
