"""The open pages of a server: how many there may be, and what is let go of when one is closed."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Any

LINGER_MS = 5_000.0
"""How long (ms) a page that has lost its connection is kept: it may come back after a gap in the network."""
NEVER_SEEN_MS = 60_000
"""How long (ms) a page that has never connected is kept: a browser on a slow line loads its scripts first."""
LOOK_EVERY_MS = 1_000
"""Time (ms) between two looks for pages that have been closed."""


class Sessions:
    """Counts the open pages of a server, of which there may be `most`, and has those that were closed removed."""

    def __init__(self, most: int) -> None:
        self.most = most
        self.contexts: Iterable[Any] = ()
        """The application contexts of the Bokeh server, which hold its sessions."""
        self._seen: set[str] = set()

    def refusal(self) -> str:
        """Return a sentence if no further page can be opened, and otherwise an empty text."""
        if sum(not self._is_closed(session) for session in self._all()) < self.most:
            return ""
        pages = "1 page is" if self.most == 1 else f"{self.most} pages are"
        return f"{pages} open here, which is the limit (--sessions of `stickslip explore`): close one, and load this page again."

    def look(self) -> None:
        """Ask for the removal of pages whose browser has gone: Bokeh itself knows one waiting time for these and for new pages."""
        everything = list(self._all())
        self._seen &= {session.id for session in everything}
        self._seen |= {session.id for session in everything if session.connection_count > 0}
        for session in everything:
            if self._is_closed(session) and session.milliseconds_since_last_unsubscribe > LINGER_MS:
                session.request_expiration()

    def _all(self) -> Iterator[Any]:
        for context in self.contexts:
            yield from list(context.sessions)

    def _is_closed(self, session: Any) -> bool:
        return session.connection_count == 0 and session.id in self._seen
