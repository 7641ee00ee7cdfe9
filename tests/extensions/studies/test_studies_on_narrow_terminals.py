"""What is printed on narrow terminals: no line is too long, and no number is broken."""

from __future__ import annotations

import pytest

from tests.command_line import Command
from tests.core.cli.narrow import check_narrow

COMMANDS = [
    ["compare", "fig6-block-reconstructed", "fig6-slab"],
    ["analogy", "block-or-slab", "--map", "wavelength=5..41.6:2:log", "--map", "alpha=0.00392..1:2:log"],
]


@pytest.mark.sampled(every=2)
@pytest.mark.parametrize("arguments", COMMANDS, ids=lambda arguments: " ".join(arguments[:2]))
def test_numbers_do_not_break_and_lines_fit(command: Command, monkeypatch: pytest.MonkeyPatch, arguments: list[str]) -> None:
    check_narrow(command, monkeypatch, arguments)
