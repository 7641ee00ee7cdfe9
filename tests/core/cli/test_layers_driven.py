"""Scenarios of layers on moving ground, behind a driver that changes or is a machine: read, changed, checked, saved, refused."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

import stickslip as ss
from tests.command_line import Outcome

LAYERS = """
[body]
kind = "layered-slab"
thickness = ["1 km", "2 km"]
density = [2800, 2800]
wave_speed = [1750, 3500]
normal_stress = "100 MPa"
{machine}
[friction]
kind = "coulomb"
static = 0.6
dynamic = 0.5
[loading]
pull_rate = 0.2
{loading}
[initial]
load = "59 MPa"
[run]
duration = "12 s"
"""
FREED = """far_stress = 0
[loading.driver_reflection]
kind = "steps"
times = [0, "3 s", "6 s"]
values = [-1, 1, -0.5]
"""
SHAKEN = """
[loading.ground_velocity]
kind = "sinusoidal"
mean = 0
amplitude = 0.1
period = "2 s"
"""
MACHINE = """driver_impedance = "5 MPa s/m"
driver_integral_gain = "1 MPa/m"
"""
DRIVEN = {
    "driver": ({"loading": FREED}, "loading.driver_reflection.times[1]=0.5 s"),
    "ground": ({"loading": SHAKEN}, "loading.ground_velocity.amplitude=0.2"),
    "machine": ({"machine": MACHINE}, "driver_integral_gain=2e6"),
}
"""Lines of a scenario of layers, and what --set changes."""


@pytest.mark.parametrize("name", DRIVEN)
def test_layers_are_driven_from_a_scenario(command: Callable[..., Outcome], name: str) -> None:
    texts, change = DRIVEN[name]
    Path("layers.toml").write_text(LAYERS.format(**{"machine": "", "loading": ""} | texts), encoding="utf-8")
    told = " ".join(command("check", "layers.toml").out.split())
    if name == "driver":
        assert "r -1 reflection of waves at the driver at first" in told
        assert "r from 3 s 1 the driver is then set free, as the contact feels 1.14286 s later" in told
        assert "r from 6 s -0.5 the driver is then of impedance 29.4 MPa s/m" in told
        late = command("check", "layers.toml", "--set", "duration=4 s").out
        assert "the run ends before the contact feels that the driver changes, at 4.14286 s" in " ".join(late.split())
    if name == "machine":
        assert "reflection of sharp fronts at the driver" in told
    plain = command("run", "layers.toml", "--out", "plain.nc")
    other = command("run", "layers.toml", "--set", change, "--figure", "other.png", "--out", "other.nc")
    assert (plain.code, other.code) == (0, 0)
    first, second = (ss.open_solution(path) for path in ("plain.nc", "other.nc"))
    assert abs(first.slip(12.0) - second.slip(12.0)) > 1e-3
    assert abs(float(first.energy([11.0]).balance[0])) < 1e-9 * abs(float(first.energy([11.0]).work[0]))
    assert command("sweep", "layers.toml", "-v", f"{change.split('=')[0]}=2,3", "-q", "slip").code == 0
    assert command("schemes", "layers.toml").refusal.startswith("schemes: ")
    if name != "ground":
        assert command("analogy", "layers.toml", "--map", "static=0.7..0.8:2", "--map", "dynamic=0.4..0.5:2").refusal
