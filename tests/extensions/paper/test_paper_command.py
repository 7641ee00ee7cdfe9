"""Every reproduction of the paper that cannot be carried out is refused in one line, and writes nothing."""

from __future__ import annotations

import pytest

from tests.command_line import Command, check_refusal

CASES = [
    (["paper", "--out", "bad.toml/paper"], "--out bad.toml/paper:"),
]


@pytest.mark.parametrize(("arguments", "message"), CASES)
def test_bad_input_gives_one_line_and_writes_nothing(command: Command, arguments: list[str], message: str) -> None:
    check_refusal(command, arguments, message)
