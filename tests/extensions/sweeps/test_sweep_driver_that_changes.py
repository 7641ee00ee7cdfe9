"""Sweeps take a driver that changes."""

from __future__ import annotations

from pathlib import Path

from tests.command_line import Command
from tests.core.cli.changing_driver import SCENARIO


def test_what_a_driver_becomes_is_varied(command: Command) -> None:
    Path("slab.toml").write_text(SCENARIO, encoding="utf-8")
    assert command("sweep", "slab.toml", "-v", "loading.driver_reflection.values[1]=0,1", "-q", "slip").code == 0
