"""What is printed on narrow terminals: no line is too long, and no number is broken."""

from __future__ import annotations

import pytest

from tests.command_line import Command
from tests.core.cli.narrow import check_narrow

COMMANDS = [
    ["sweep", "fig6-slab", "-v", "alpha=0.1..1:4", "-v", "thickness=5km,10km"],
]


@pytest.mark.slow
@pytest.mark.parametrize("arguments", COMMANDS, ids=lambda arguments: " ".join(arguments[:2]))
def test_numbers_do_not_break_and_lines_fit(command: Command, monkeypatch: pytest.MonkeyPatch, arguments: list[str]) -> None:
    check_narrow(command, monkeypatch, arguments)
