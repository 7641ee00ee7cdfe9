"""What a command printed, as the fixture `command` returns it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass


@dataclass(frozen=True)
class Outcome:
    """The exit code of a command, and what it wrote."""

    code: int
    out: str
    err: str

    @property
    def refusal(self) -> str:
        """The one line with which a command was refused, without its beginning; a command that was not refused fails the test."""
        assert (self.code, self.out, self.err.count("\n")) == (2, "", 1), self
        assert self.err.startswith("stickslip: ")
        return self.err.removeprefix("stickslip: ")


Command = Callable[..., Outcome]
