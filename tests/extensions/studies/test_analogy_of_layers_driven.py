"""A block stands for no layers behind such drivers."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.command_line import Command
from tests.core.cli.driven_layers import DRIVEN, LAYERS


@pytest.mark.parametrize("name", ["driver", "machine"])
def test_analogy_refuses_layers_behind_such_drivers(command: Command, name: str) -> None:
    texts, _ = DRIVEN[name]
    Path("layers.toml").write_text(LAYERS.format(**{"machine": "", "loading": ""} | texts), encoding="utf-8")
    assert command("analogy", "layers.toml", "--map", "static=0.7..0.8:2", "--map", "dynamic=0.4..0.5:2").refusal
