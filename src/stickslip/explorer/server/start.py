"""Start the explorer for `stickslip explore`: say where it is, open the browser, and answer until Ctrl-C."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from stickslip.explorer.model.setting import Setting
from stickslip.explorer.page.explorer import Explorer
from stickslip.explorer.server.browser import open_browser, private_page
from stickslip.explorer.server.desk import ThreadDesk
from stickslip.explorer.server.serve import ExplorerServer, Place

WARNING = (
    "warning: listening on {address}: whoever reaches this computer over a network, and has the address with the token, can use "
    "the explorer; nothing is encrypted"
)


def start(setting: Setting, place: Place, *, browser: bool, say: Callable[[str], object]) -> None:
    """Serve the explorer until Ctrl-C.

    Parameters
    ----------
    setting : Setting
        What a new page shows first.
    place : Place
        Where the server listens.
    browser : bool
        True to open the page in the user's browser.
    say : callable
        Function that shows a line to the user.

    Raises
    ------
    InputError
        If the port is taken.
    """
    from stickslip.explorer.page.page import build

    server = ExplorerServer(place, partial(explorer_of, setting), build)
    if not place.is_loopback:
        say(WARNING.format(address=place.address))
    say(f"explorer: {server.url}")
    with private_page(server.url) as page:
        if not browser or not open_browser(page):
            say("open this address in a browser; it holds the token without which nothing is shown")
        say("Ctrl-C ends the explorer, and closes its pages")
        server.run()


def explorer_of(setting: Setting, desk: ThreadDesk, files: ThreadDesk) -> Explorer:
    """Return the explorer of a new page."""
    from stickslip.explorer.model.solve import solve  # imports the compiler, which takes a second

    return Explorer(setting, desk, solve, files)
