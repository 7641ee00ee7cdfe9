"""Commands take a driver that changes, and say what it does."""

from __future__ import annotations

from pathlib import Path

from tests.command_line import Command
from tests.core.cli.changing_driver import SCENARIO


def test_run_and_check_take_a_driver_that_changes(command: Command) -> None:
    Path("slab.toml").write_text(SCENARIO, encoding="utf-8")
    told = " ".join(command("check", "slab.toml").out.split())
    assert "r -1 reflection of waves at the driver at first" in told
    assert "r from 3 s 1 the driver is then set free" in told
    assert "r from 6 s -0.5 the driver is then of impedance 29.4 MPa s/m" in told
    late = command("check", "slab.toml", "--set", "duration=3.1 s").out
    assert "the run ends before the contact feels that the driver changes, at 3.28571 s" in " ".join(late.split())
    assert command("run", "slab.toml", "--set", "loading.driver_reflection.times[1]=3.5 s", "--figure", "a.png").code == 0
