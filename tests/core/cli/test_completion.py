"""What the shells are told when they ask for completions, in the words of each."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path

import pytest

from tests.command_line import Outcome

Complete = Callable[[str, str], list[str]]
SHELLS = ("bash", "zsh", "fish")
OFFERED_TO_ZSH = re.compile("""^(?:_arguments '[^(]*[(]{2})?"([^"]+)["]""", re.MULTILINE)


@pytest.fixture
def complete(command: Callable[..., Outcome], monkeypatch: pytest.MonkeyPatch) -> Complete:
    """Return a function that asks as a shell does, and returns the words that it is offered."""

    def ask(shell: str, typed: str) -> list[str]:
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

    return ask


@pytest.mark.parametrize("shell", SHELLS)
@pytest.mark.parametrize(
    ("typed", "offered"),
    [
        ("stickslip ch", ["check"]),
        ("stickslip run second-event-m", ["second-event-maximal", "second-event-maxwell", "second-event-minimal"]),
        ("stickslip run fig6-slab --sel", ["--selection"]),
        ("stickslip run fig6-slab --selection maxw", ["maxwell"]),
        ("stickslip run mi", ["mine.toml"]),
        ("stickslip sweep fig6-slab -v friction.al", ["friction.alpha=", "friction.alpha=VALUE"]),
        ("stickslip sweep fig6-slab -v alpha=1,2 --vary friction.al", ["friction.alpha=", "friction.alpha=VALUE"]),
        ("stickslip run fig6-slab --set friction.al", ["friction.alpha=", "friction.alpha=VALUE"]),
        ("stickslip sweep -v friction.al", []),
        ("stickslip sweep nothing.toml -v friction.al", []),
        ("stickslip nothing fig6", []),
        ("stickslip nothing", []),
    ],
)
def test_shells_are_offered_what_fits(complete: Complete, tmp_path: Path, shell: str, typed: str, offered: list[str]) -> None:
    (tmp_path / "mine.toml").touch()
    assert sorted(complete(shell, typed)) == offered


@pytest.mark.parametrize("shell", SHELLS)
def test_each_shell_gets_its_script(command: Callable[..., Outcome], monkeypatch: pytest.MonkeyPatch, shell: str) -> None:
    monkeypatch.setenv("_STICKSLIP_COMPLETE", f"source_{shell}")
    found = command()
    assert found.code == 0
    assert f"_STICKSLIP_COMPLETE=complete_{shell}" in found.out
