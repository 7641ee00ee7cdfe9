"""Schemes refuse layers, whatever drives them."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.command_line import Command
from tests.core.cli.driven_layers import DRIVEN, LAYERS


@pytest.mark.parametrize("name", DRIVEN)
def test_schemes_refuse_layers(command: Command, name: str) -> None:
    texts, _ = DRIVEN[name]
    Path("layers.toml").write_text(LAYERS.format(**{"machine": "", "loading": ""} | texts), encoding="utf-8")
    assert command("schemes", "layers.toml").refusal.startswith("schemes: ")
