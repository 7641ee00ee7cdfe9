"""Every command takes a driver that changes, or refuses it by name in one line."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from tests.command_line import Outcome

SCENARIO = """
[body]
kind = "elastic-slab"
density = 2800
wave_speed = 3500
thickness = 1000
normal_stress = 1e8
[friction]
kind = "coulomb"
static = 0.6
dynamic = 0.5
[loading]
pull_rate = 0.4
far_stress = 0
[loading.driver_reflection]
kind = "steps"
times = [0, "3 s", "6 s"]
values = [-1, 1, -0.5]
[initial]
load = 5.9e7
[run]
duration = "12 s"
"""


def test_every_command_takes_a_driver_that_changes_or_refuses_it_by_name(command: Callable[..., Outcome]) -> None:
    Path("slab.toml").write_text(SCENARIO, encoding="utf-8")
    Path("record.csv").write_text("time (s),slip (m),shear stress (Pa)\n0,0,5e7\n1,0.1,5.1e7\n2,0.2,5e7\n", encoding="utf-8")
    told = " ".join(command("check", "slab.toml").out.split())
    assert "r -1 reflection of waves at the driver at first" in told
    assert "r from 3 s 1 the driver is then set free" in told
    assert "r from 6 s -0.5 the driver is then of impedance 29.4 MPa s/m" in told
    late = command("check", "slab.toml", "--set", "duration=3.1 s").out
    assert "the run ends before the contact feels that the driver changes, at 3.28571 s" in " ".join(late.split())
    assert command("run", "slab.toml", "--set", "loading.driver_reflection.times[1]=3.5 s", "--figure", "a.png").code == 0
    assert command("sweep", "slab.toml", "-v", "loading.driver_reflection.values[1]=0,1", "-q", "slip").code == 0
    refusals = {
        ("schemes", "slab.toml"): "schemes: a driver that changes is not in the schemes: leave driver_reflection out",
        ("infer", "slab.toml", "record.csv", "--free", "static"): "infer: a driver that changes is not fitted",
        ("analogy", "slab.toml", "--map", "static=0.7..0.8:2", "--map", "dynamic=0.4..0.5:2"): (
            "analogy: a block has no driver that changes: leave driver_reflection out"
        ),
    }
    for words, refusal in refusals.items():
        assert command(*words).refusal.startswith(refusal), words
