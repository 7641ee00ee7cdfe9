"""What a command printed, as the fixture `command` returns it, and what holds for all refusals."""

from __future__ import annotations

import os
import re
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import pytest

from stickslip.problem.scenarios.templates import template
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


TABLE = "A (mm/s),B\n1,0.6\n2,0.5\n3,0.45\n4,0.43\n"
"""A file whose headings nobody knows."""


def check_columns_named(command: Command, *words: str, name: str = "time") -> None:
    """Fail unless a command that reads a.csv refuses wrong `--column`s of this name in one line that helps."""
    Path("a.csv").write_text(TABLE)
    missing = command(*words, "--column", f"{name}=C").refusal
    assert f"a.csv, line 1: columns: there is no column 'C' for {name}; it has 'A (mm/s)', 'B'" in missing
    mistyped = command(*words, "--column", "time").refusal
    assert mistyped.startswith(f"{words[0]}: --column must be NAME=HEADING, as load_point=\"Vert_disp (micron)\", got 'time'")
    assert "--column: 'time' is given twice" in command(*words, "--column", "time=A", "--column", "time=B").refusal


SHELLS = ("bash", "zsh", "fish")
OFFERED_TO_ZSH = re.compile("""^(?:_arguments '[^(]*[(]{2})?"([^"]+)["]""", re.MULTILINE)


def completions(command: Command, monkeypatch: pytest.MonkeyPatch, shell: str, typed: str) -> list[str]:
    """Return the words that are offered to a shell, asked for in its words."""
    monkeypatch.setenv("_STICKSLIP_COMPLETE", f"complete_{shell}")
    monkeypatch.setenv("COMP_WORDS", typed.replace(" ", "\n"))
    monkeypatch.setenv("COMP_CWORD", str(typed.count(" ")))
    monkeypatch.setenv("_TYPER_COMPLETE_ARGS", typed)
    monkeypatch.setenv("_TYPER_COMPLETE_FISH_ACTION", "get-args")
    found = command()
    assert found.err == ""
    if shell == "zsh":
        return OFFERED_TO_ZSH.findall(found.out)
    return [line.split("\t")[0] for line in found.out.splitlines() if line]
