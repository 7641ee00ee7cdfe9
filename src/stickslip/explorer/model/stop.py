"""How a run is stopped from outside: the function that is told of its progress raises `Stopped`."""

from __future__ import annotations

from collections.abc import Callable

Told = Callable[[str], None]
"""A function that is told in one line how far a run is, some ten times a second. It raises `Stopped` to end the run there."""


class Stopped(KeyboardInterrupt):
    """Raised where a run reports its progress: the run ends with a valid solution up to there, as after Ctrl-C."""


def silent(_: str) -> None:
    """Ignore a report of progress."""
