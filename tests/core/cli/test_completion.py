"""What the shells are told when they ask for completions, in the words of each."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.command_line import SHELLS, Command, completions


@pytest.mark.sampled(every=8)
@pytest.mark.parametrize("shell", SHELLS)
@pytest.mark.parametrize(
    ("typed", "offered"),
    [
        ("stickslip ch", ["check"]),
        ("stickslip run second-event-m", ["second-event-maximal", "second-event-maxwell", "second-event-minimal"]),
        ("stickslip run fig6-slab --sel", ["--selection"]),
        ("stickslip run fig6-slab --selection maxw", ["maxwell"]),
        ("stickslip run mi", ["mine.toml"]),
        ("stickslip run fig6-slab --set friction.al", ["friction.alpha=", "friction.alpha=VALUE"]),
        ("stickslip nothing fig6", []),
        ("stickslip nothing", []),
    ],
)
def test_shells_are_offered_what_fits(
    command: Command, monkeypatch: pytest.MonkeyPatch, shell: str, typed: str, offered: list[str]
) -> None:
    Path("mine.toml").touch()
    assert sorted(completions(command, monkeypatch, shell, typed)) == offered


@pytest.mark.parametrize("shell", SHELLS)
def test_each_shell_gets_its_script(command: Command, monkeypatch: pytest.MonkeyPatch, shell: str) -> None:
    monkeypatch.setenv("_STICKSLIP_COMPLETE", f"source_{shell}")
    found = command()
    assert found.code == 0
    assert f"_STICKSLIP_COMPLETE=complete_{shell}" in found.out
