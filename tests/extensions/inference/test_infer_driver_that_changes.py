"""A driver that changes is not fitted."""

from __future__ import annotations

from pathlib import Path

from tests.command_line import Command
from tests.core.cli.changing_driver import SCENARIO


def test_infer_refuses_a_driver_that_changes(command: Command) -> None:
    Path("slab.toml").write_text(SCENARIO, encoding="utf-8")
    Path("record.csv").write_text("time (s),slip (m),shear stress (Pa)\n0,0,5e7\n1,0.1,5.1e7\n2,0.2,5e7\n", encoding="utf-8")
    said = command("infer", "slab.toml", "record.csv", "--free", "static").refusal
    assert said.startswith("infer: a driver that changes is not fitted")
