"""Every run of many nodes that cannot be carried out is refused in one line, and writes nothing."""

from __future__ import annotations

import pytest

from tests.command_line import Command, check_refusal

CASES = [
    (["check", "planar-patch", "--set", "duration=1e20 years"], "check: --set: [contact] 3.15576e+27 s are 1.41e+29 time steps"),
    (["run", "planar-patch", "--set", "wave_speed=1e40"], "run: --set: [contact] "),
]


@pytest.mark.parametrize(("arguments", "message"), CASES)
def test_bad_input_gives_one_line_and_writes_nothing(command: Command, arguments: list[str], message: str) -> None:
    check_refusal(command, arguments, message)
