"""Every test of this folder calls the command, or what is behind it."""

import pytest


@pytest.fixture(autouse=True)
def _as_commands(pictures: None) -> None:
    """Begin with a compiled engine, and leave pictures blank unless a test says otherwise."""
