"""What drives layers is varied."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.command_line import Command
from tests.core.cli.driven_layers import DRIVEN, LAYERS


@pytest.mark.parametrize("name", DRIVEN)
def test_what_drives_layers_is_varied(command: Command, name: str) -> None:
    texts, change = DRIVEN[name]
    Path("layers.toml").write_text(LAYERS.format(**{"machine": "", "loading": ""} | texts), encoding="utf-8")
    varied = f"{change.partition('=')[0]}=2,3"
    assert command("sweep", "layers.toml", "-v", varied, "-q", "slip").code == 0
