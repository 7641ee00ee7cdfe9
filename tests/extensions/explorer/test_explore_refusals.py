"""Every exploration that cannot be carried out is refused in one line, and writes nothing."""

from __future__ import annotations

import pytest

from tests.command_line import Command, check_refusal

CASES = [
    (["explore", "--port", "70000"], "explore: --port must be a whole number"),
    (["explore", "--sessions", "0"], "explore: --sessions must be a whole number, at least 1, got '0'"),
    (["explore", "--allow-origin", "*"], "explore: --allow-origin must be NAME or NAME:PORT, got '*'"),
    (["explore", "--address", "nowhere.invalid", "--no-browser"], "explore: cannot listen on nowhere.invalid port"),
]


@pytest.mark.parametrize(("arguments", "message"), CASES)
def test_bad_input_gives_one_line_and_writes_nothing(command: Command, arguments: list[str], message: str) -> None:
    check_refusal(command, arguments, message)
