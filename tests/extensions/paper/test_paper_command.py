"""Every reproduction of the paper that cannot be carried out is refused in one line, and writes nothing."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.command_line import Command, check_refusal

CASES = [
    (["paper", "--out", "bad.toml/paper"], "--out bad.toml/paper:"),
]


@pytest.mark.parametrize(("arguments", "message"), CASES)
def test_bad_input_gives_one_line_and_writes_nothing(command: Command, arguments: list[str], message: str) -> None:
    check_refusal(command, arguments, message)


def test_paper_says_what_it_wrote(command, monkeypatch: pytest.MonkeyPatch):
    def make(out: Path, progress) -> Path:
        progress("figure 1")
        return out / "report.html"

    monkeypatch.setattr("stickslip.extensions.paper.make.make", make)
    shown = command("paper", "--out", "new/folder")
    assert (shown.code, shown.out, shown.err) == (0, f"written: {Path('new/folder/report.html')}\n", "")
