"""A block has no driver that changes."""

from __future__ import annotations

from pathlib import Path

from tests.command_line import Command
from tests.core.cli.changing_driver import SCENARIO


def test_analogy_refuses_a_driver_that_changes(command: Command) -> None:
    Path("slab.toml").write_text(SCENARIO, encoding="utf-8")
    words = ("analogy", "slab.toml", "--map", "static=0.7..0.8:2", "--map", "dynamic=0.4..0.5:2")
    assert command(*words).refusal.startswith(
        "analogy: a driver that changes has no counterpart beside a block: leave driver_reflection out"
    )
