"""Schemes refuse a driver that changes."""

from __future__ import annotations

from pathlib import Path

from tests.command_line import Command
from tests.core.cli.changing_driver import SCENARIO


def test_schemes_refuse_a_driver_that_changes(command: Command) -> None:
    Path("slab.toml").write_text(SCENARIO, encoding="utf-8")
    refusal = "schemes: a driver that changes is not in the schemes: leave driver_reflection out"
    assert command("schemes", "slab.toml").refusal.startswith(refusal)
