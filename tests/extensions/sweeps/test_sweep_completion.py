"""What the shells are told when they ask for completions of a sweep, in the words of each."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.command_line import SHELLS, Command, completions


@pytest.mark.sampled(every=3)
@pytest.mark.parametrize("shell", SHELLS)
@pytest.mark.parametrize(
    ("typed", "offered"),
    [
        ("stickslip sweep fig6-slab -v friction.al", ["friction.alpha=", "friction.alpha=VALUE"]),
        ("stickslip sweep fig6-slab -v alpha=1,2 --vary friction.al", ["friction.alpha=", "friction.alpha=VALUE"]),
        ("stickslip sweep -v friction.al", []),
        ("stickslip sweep nothing.toml -v friction.al", []),
    ],
)
def test_shells_are_offered_what_fits(
    command: Command, monkeypatch: pytest.MonkeyPatch, shell: str, typed: str, offered: list[str]
) -> None:
    Path("mine.toml").touch()
    assert sorted(completions(command, monkeypatch, shell, typed)) == offered
