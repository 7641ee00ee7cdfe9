"""What a command printed, as the fixture `command` returns it, and what holds for all refusals."""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from stickslip.run.templates import template
from tests.messages import places_twice


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


def check_refusal(command: Command, arguments: list[str], message: str) -> None:
    """Fail unless a command refuses its arguments in one printable line that begins as is said, and writes nothing.

    In its folder are a scenario with a misspelt key, a file in place of a store, and folders and a pipe with names of figures.
    """
    here = Path()
    (here / "bad.toml").write_text(template("slab").replace("thickness =", "thicknes ="))
    (here / "bad.zarr").touch()
    for name in ("folder.png", "folder.csv", "folder.txt"):
        (here / name).mkdir()
    os.mkfifo(here / "pipe.png")
    before = sorted(here.iterdir())
    said = command(*arguments).refusal
    assert said.startswith(message)
    assert said.strip().isprintable()
    assert not places_twice(said)
    assert sorted(here.iterdir()) == before
