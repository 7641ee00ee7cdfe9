"""A desk for tests of a page: it does its work at once, in the thread that asks."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from stickslip.foundation.errors import InputError


class DeskAtOnce:
    """A desk that does at once what it is asked, and counts."""

    def __init__(self) -> None:
        self.asked = 0

    def ask(self, work: Callable[..., Any], done: Callable[[Any], None], failed: Callable[[Exception], None]) -> None:
        self.asked += 1
        try:
            result = work(lambda text: None)
        except InputError as error:
            failed(error)
        else:
            done(result)

    def stop(self) -> None:
        pass
