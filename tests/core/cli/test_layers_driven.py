"""Scenarios of layers on moving ground, behind a driver that changes or is a machine: read, changed, checked, saved."""

from __future__ import annotations

from pathlib import Path

import pytest

import stickslip as ss
from tests.command_line import Command
from tests.core.cli.driven_layers import DRIVEN, LAYERS


@pytest.mark.sampled(every=3)
@pytest.mark.parametrize("name", DRIVEN)
def test_layers_are_driven_from_a_scenario(command: Command, name: str) -> None:
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
